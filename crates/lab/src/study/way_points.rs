//! What is read off the way-points that members choose, and off what lasers detect.

use super::form::{DetectionQuantity, DetectionReading, WayPointQuantity, WayPointReading};
use measure::way_points::{Rule, effective_percentage_ha, jitter, percentage_ha, smoothness};
use space::{Column, ColumnKind, Vector};
use swarm::World;
use swarm::parameters::Scalar;

/// Columns of a way-point in the own frame, and of the nearest input in it.
const FRAME: [&str; 4] = ["way_point_ahead", "way_point_left", "nearest_ahead", "nearest_left"];

/// The way-points of a trial so far: a cycle of control for each look.
#[derive(Clone, Debug)]
pub(super) struct WayPoints {
    reading: WayPointReading,
    /// The column of the mode, and the rule that each of its states follows.
    mode: (usize, Vec<Rule>),
    /// The columns of way-point and nearest input.
    frame: [usize; 4],
    /// Way-points of each member, by id.
    chosen: Vec<Vec<Option<Vector<f64, 2>>>>,
    rules: Vec<Rule>,
    /// Way-point and nearest input where a rule chose by it.
    pairs: Vec<(Vector<f64, 2>, Vector<f64, 2>)>,
    /// Distances to the nearest input, summed, and how many.
    nearest: (f64, f64),
}

impl WayPoints {
    /// Of a world whose members keep these columns.
    ///
    /// # Errors
    /// Members that do not keep their way-points.
    pub(super) fn new(reading: &WayPointReading, declared: &[Column]) -> Result<Self, String> {
        let find = |name: &str| {
            let found = declared.iter().position(|column| column.name == name);
            found.ok_or_else(|| format!("no model here keeps a column `{name}`, as `ha_extended` does"))
        };
        let mode = find("mode")?;
        let ColumnKind::Label(labels) = declared[mode].kind else {
            return Err("the column `mode` has no named states".into());
        };
        let rule = |label: &&str| match *label {
            "HA" | "HA_PERP" => Rule::Ha,
            "SNN" => Rule::Snn,
            _ => Rule::Keep,
        };
        let mut frame = [0; 4];
        for (column, name) in frame.iter_mut().zip(FRAME) {
            *column = find(name)?;
        }
        Ok(Self {
            reading: reading.clone(),
            mode: (mode, labels.iter().map(rule).collect()),
            frame,
            chosen: Vec::new(),
            rules: Vec::new(),
            pairs: Vec::new(),
            nearest: (0.0, 0.0),
        })
    }
    /// Takes in a cycle: ids and rows of the living.
    pub(super) fn look<R: Scalar, const D: usize>(&mut self, world: &World<R, D>, ids: &[usize], rows: &[usize]) {
        let state = &world.frame().columns.state;
        for (&id, &row) in ids.iter().zip(rows) {
            let of = |column: usize| state[column][row].to_f64();
            let (place, rules) = &self.mode;
            let rule = rules.get(of(*place) as usize).copied().unwrap_or(Rule::Keep);
            let [ahead, left, nearest_ahead, nearest_left] = self.frame.map(of);
            let (way_point, nearest) = (Vector([ahead, left]), Vector([nearest_ahead, nearest_left]));
            if self.chosen.len() <= id {
                self.chosen.resize(id + 1, Vec::new());
            }
            self.chosen[id].push((rule != Rule::Keep).then_some(way_point));
            self.rules.push(rule);
            if rule != Rule::Keep {
                // who stays chooses no direction: the nearest input decided that
                self.pairs.push((if way_point.is_tiny() { nearest } else { way_point }, nearest));
                self.nearest = (self.nearest.0 + nearest.length(), self.nearest.1 + 1.0);
            }
        }
    }
    /// What came of it.
    pub(super) fn value(&self) -> Option<f64> {
        let of_members = |of: fn(&[Option<Vector<f64, 2>>]) -> Option<f64>| {
            let values: Vec<f64> = self.chosen.iter().filter_map(|chosen| of(chosen)).collect();
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        let value = match self.reading.quantity {
            WayPointQuantity::Smoothness => of_members(smoothness),
            WayPointQuantity::Jitter => of_members(jitter),
            WayPointQuantity::Ha => percentage_ha(self.rules.iter().copied()),
            WayPointQuantity::EffectiveHa => effective_percentage_ha(self.pairs.iter().copied()),
            WayPointQuantity::NearestInput => (self.nearest.1 > 0.0).then(|| self.nearest.0 / self.nearest.1),
        };
        value.map(|value| self.reading.scale * value)
    }
}

/// What came of the detections of all lasers since the start; nothing where there was nobody to detect, or no detection.
pub(super) fn detections<R: Scalar, const D: usize>(world: &World<R, D>, reading: &DetectionReading) -> Option<f64> {
    let errors = world.detection_errors();
    let share = |part: u64, whole: u64| (whole > 0).then(|| part as f64 / whole as f64);
    let value = match reading.quantity {
        DetectionQuantity::FalseNegatives => share(errors.members_missed, errors.members_in_view),
        DetectionQuantity::VisibleFalseNegatives => {
            share(errors.missed_not_fully_occluded, errors.members_not_fully_occluded)
        }
        DetectionQuantity::FalsePositives => share(errors.false_detections, errors.detections),
        DetectionQuantity::Detected => Some((errors.members_in_view - errors.members_missed) as f64),
        DetectionQuantity::Inputs => Some(errors.detections as f64),
    };
    value.map(|value| reading.scale * value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::Space;
    use std::collections::BTreeMap;
    use swarm::WorldPlan;
    use swarm::engine::{GroupPlan, Placement, Start};
    use swarm::parameters::Values;
    use swarm::physics::{DifferentialDrive, Mobility};

    /// Three that head right, or stand on two wheels: the first has one to its right and one beyond it.
    fn read(quantity: WayPointQuantity, exclusion: f64, stands: bool) -> Option<f64> {
        let position = vec![Vector([0.0, 0.0]), Vector([3.0, 0.0]), Vector([3.0, 4.0])];
        let velocity = Some(vec![Vector([if stands { 0.0 } else { 0.1 }, 0.0]); 3]);
        let placement = Placement::Given(Start { position, velocity, columns: BTreeMap::new() });
        let values = Values::from([("exclusion_distance".to_owned(), exclusion.into())]);
        let mut group = GroupPlan::new("members", "ha_extended", values, 3, placement);
        if stands {
            group.mobility = Mobility::DifferentialDrive(DifferentialDrive::default());
        }
        let plan = WorldPlan::new(Space::<f64, 2>::open(), group);
        let mut world = World::new(plan).ok()?;
        let reading = WayPointReading { quantity, scale: 1.0 };
        let mut way_points = WayPoints::new(&reading, world.frame().declared).ok()?;
        world.step();
        way_points.look(&world, &[0, 1, 2], &world.frame().rows_by_id());
        way_points.value()
    }

    #[test]
    fn a_cycle_of_three() {
        // with the published exclusion all aim between two; the first two see their nearest 3 away, the third 4
        assert_eq!(read(WayPointQuantity::Ha, 0.5, false), Some(100.0));
        assert_eq!(read(WayPointQuantity::EffectiveHa, 0.5, false), Some(100.0));
        let mean = read(WayPointQuantity::NearestInput, 0.5, false);
        assert!(mean.is_some_and(|mean| (mean - 10.0 / 3.0).abs() < 1e-12), "{mean:?}");
        // one cycle each: nothing varies, and there is no change
        assert_eq!(read(WayPointQuantity::Smoothness, 0.5, false), Some(0.0));
        assert_eq!(read(WayPointQuantity::Jitter, 0.5, false), None);
        // nobody is beyond so large an exclusion: all go to the nearest
        assert_eq!(read(WayPointQuantity::Ha, 100.0, false), Some(0.0));
        assert_eq!(read(WayPointQuantity::EffectiveHa, 100.0, false), Some(0.0));
    }

    #[test]
    fn robots_that_stand_know_where_ahead_is() {
        assert_eq!(read(WayPointQuantity::EffectiveHa, 0.5, true), Some(100.0));
        let mean = read(WayPointQuantity::NearestInput, 0.5, true);
        assert!(mean.is_some_and(|mean| (mean - 10.0 / 3.0).abs() < 1e-12), "{mean:?}");
    }

    #[test]
    fn members_without_way_points_cannot_be_read() {
        let reading = WayPointReading { quantity: WayPointQuantity::Ha, scale: 1.0 };
        assert!(WayPoints::new(&reading, &[]).is_err_and(|problem| problem.contains("mode")));
    }
}
