//! One trial: a condition's world with the seed of the trial, stepped to its end and looked at on the way.

use super::arrival::Arrival;
use super::bearing::Bearing;
use super::consensus::Consensus;
use super::correlation::CorrelationLength;
use super::emptied::Emptied;
use super::form::{
    ClusterQuantity, ClusterReading, ContactReading, CoverageReading, DetectionReading, GroundReading, InsideReading,
    LaneReading, Partner, PathQuantity, Quantity, ShareReading, Statistic, Whose,
};
use super::ground;
use super::meals::Meals;
use super::plan::{Condition, Plan, entry_place};
use super::profile::Profile;
use super::reversals::Reversals;
use super::standing::Standing;
use super::transfer::OfTransfer;
use super::way_points::{WayPoints, detections};
use crate::file::{Desk, Node};
use crate::scenario::build;
use crate::with_types;
use measure::looks::{Clusters, Coverage, Curvature, mean_displacement};
use measure::metrics::{angular_momentum, expanse, mean_angular_deviation, polarisation};
use measure::over_time::lane_order;
use measure::{Measure, Metric, Sample};
use space::obstacles::Obstacle;
use space::shape::Shape;
use space::{ColumnKind, Edge, Real, Space, Vector};
use swarm::World;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;
use swarm::physics::Met;

/// Steps between two questions whether to stop.
const ASKED: u64 = 64;

/// The steps at which a trial is looked at: the first and the distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Looks {
    /// The first that any reading wants.
    first: u64,
    /// The first of the window.
    window: u64,
    every: u64,
}

/// The looks at a condition.
///
/// # Errors
/// Times that are no multiples of the step, or lie after the end; by key of the file.
fn looks(condition: &Condition, plan: &Plan) -> Result<Looks, (String, String)> {
    let step = condition.schedule.step;
    let steps = |time: f64, key: &str| {
        let steps = time / step;
        if (steps - steps.round()).abs() > 1e-6 * steps.max(1.0) {
            return Err((key.to_owned(), format!("{time} is no multiple of the step of {step}")));
        }
        Ok(steps.round() as u64)
    };
    let every = steps(plan.looks.interval, "looks.interval")?;
    if every == 0 {
        return Err(("looks.interval".into(), "it is shorter than a step".into()));
    }
    let window = plan.looks.from.map_or(Ok(every), |from| steps(from, "looks.from"))?;
    if window > condition.schedule.steps {
        let what = format!("the first look would come after the end, at step {window} of {}", condition.schedule.steps);
        return Err(("looks".into(), what));
    }
    let mut first = window;
    for (name, reading) in &plan.readings {
        if let Quantity::Coverage(CoverageReading { from: Some(from), .. }) = reading.of {
            let key = format!("reading.{name}.of.coverage.from");
            let own = steps(from, &key)?;
            if own > window || !(window - own).is_multiple_of(every) {
                let what = "it must lie so many intervals before the first look".to_owned();
                return Err((key, what));
            }
            first = first.min(own);
        }
    }
    Ok(Looks { first, window, every })
}

/// Whether everything that is to be read can be read in a condition; what cannot goes to the desk.
pub(crate) fn check(condition: &Condition, plan: &Plan, tree: &Node, desk: &mut Desk) {
    if let Err((key, what)) = looks(condition, plan) {
        desk.problem(&tree.place(&key), what, "", "");
        return;
    }
    with_types!(condition.scenario, R, D => check_in::<R, D>(condition, plan, tree, desk));
}

fn check_in<R: Scalar, const D: usize>(condition: &Condition, plan: &Plan, tree: &Node, desk: &mut Desk)
where
    Models: Catalogue<R, D>,
{
    let world = match build::world::<R, D>(&condition.scenario, plan.seed_of(1), 1) {
        Ok(world) => world,
        Err(what) => {
            desk.problem(&tree.span, what, "", "");
            return;
        }
    };
    for (name, reading) in &plan.readings {
        if let Err(what) = reader::<R, D>(&reading.of, &world) {
            let place = entry_place(tree, "reading", name);
            desk.problem(&place, format!("`{name}`: {what}"), "cannot be read", "");
        }
    }
}

/// Runs a trial; what was read, in the order of the readings, NaN where there was nothing to read. None where it was
/// stopped.
///
/// # Errors
/// What this seed makes impossible, in a sentence.
pub fn run(plan: &Plan, condition: &Condition, seed: u64, stop: &dyn Fn() -> bool) -> Result<Option<Vec<f64>>, String> {
    let looks = looks(condition, plan).map_err(|(key, what)| format!("{key}: {what}"))?;
    with_types!(condition.scenario, R, D => tried::<R, D>(plan, condition, looks, seed, stop))
}

fn tried<R: Scalar, const D: usize>(
    plan: &Plan,
    condition: &Condition,
    looks: Looks,
    seed: u64,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Vec<f64>>, String>
where
    Models: Catalogue<R, D>,
{
    let mut world = build::world::<R, D>(&condition.scenario, seed, 1)?;
    let mut readers = Vec::new();
    for (_, reading) in &plan.readings {
        readers.push(reader::<R, D>(&reading.of, &world)?);
    }
    let every_step: Vec<usize> = (0..readers.len()).filter(|&k| readers[k].steps()).collect();
    loop {
        let step = world.step_number();
        if step >= looks.first && (step - looks.first).is_multiple_of(looks.every) {
            let look = Look::of(&world, condition.schedule.step * looks.every as f64, step >= looks.window);
            for reader in &mut readers {
                reader.look(&look);
            }
        }
        if step == condition.schedule.steps {
            break;
        }
        if step.is_multiple_of(ASKED) && stop() {
            return Ok(None);
        }
        world.step();
        for &k in &every_step {
            readers[k].step(&world);
        }
    }
    Ok(Some(readers.iter().map(|reader| reader.value(&world).unwrap_or(f64::NAN)).collect()))
}

/// Updates of agents in a second on this machine, from a few steps of a condition.
///
/// # Errors
/// What the first seed makes impossible.
pub fn rate(plan: &Plan, condition: &Condition, seconds: f64) -> Result<f64, String> {
    fn timed<R: Scalar, const D: usize>(plan: &Plan, condition: &Condition, seconds: f64) -> Result<f64, String>
    where
        Models: Catalogue<R, D>,
    {
        let mut world = build::world::<R, D>(&condition.scenario, plan.seed_of(1), 1)?;
        // groups begin dense, which costs more than what they settle to
        let (settle, began) = (condition.schedule.steps / 20, std::time::Instant::now());
        while world.step_number() < settle && began.elapsed().as_secs_f64() < seconds {
            world.step();
        }
        let (from, began) = (world.step_number(), std::time::Instant::now());
        while began.elapsed().as_secs_f64() < seconds {
            world.step();
        }
        Ok((world.step_number() - from) as f64 * condition.agents as f64 / began.elapsed().as_secs_f64())
    }
    with_types!(condition.scenario, R, D => timed::<R, D>(plan, condition, seconds))
}

/// What can be seen at one moment: the living, in the order of their ids.
pub(super) struct Look<'w, R: Scalar, const D: usize> {
    pub(super) world: &'w World<R, D>,
    pub(super) space: Space<f64, D>,
    pub(super) ids: Vec<usize>,
    pub(super) rows: Vec<usize>,
    pub(super) positions: Vec<Vector<f64, D>>,
    pub(super) velocities: Vec<Vector<f64, D>>,
    /// Time since the look before.
    pub(super) interval: f64,
    /// Whether it lies in the window in which most is read.
    pub(super) window: bool,
    pub(super) sample: Sample<D>,
    clusters: std::cell::RefCell<Vec<(f64, std::rc::Rc<Clusters>)>>,
}

impl<'w, R: Scalar, const D: usize> Look<'w, R, D> {
    fn of(world: &'w World<R, D>, interval: f64, window: bool) -> Self {
        let frame = world.frame();
        let lives = |row: &usize| world.mortality().is_none_or(|c| frame.columns.state[c][*row] > R::ZERO);
        let rows: Vec<usize> = frame.rows_by_id().into_iter().filter(lives).collect();
        let wide = |v: Vector<R, D>| Vector(v.0.map(R::to_f64));
        let space = wide_space(frame.space);
        let positions: Vec<_> = rows.iter().map(|&row| wide(frame.columns.position(row))).collect();
        let velocities: Vec<_> = rows.iter().map(|&row| wide(frame.columns.velocity(row))).collect();
        let sample = Sample::new(space, positions.iter().copied().zip(velocities.iter().copied()));
        Self {
            world,
            space,
            ids: rows.iter().map(|&row| frame.columns.id[row] as usize).collect(),
            rows,
            positions,
            velocities,
            interval,
            window,
            sample,
            clusters: std::cell::RefCell::default(),
        }
    }
    /// The clusters by a distance, found once.
    fn clusters(&self, distance: f64) -> std::rc::Rc<Clusters> {
        let mut known = self.clusters.borrow_mut();
        if let Some((_, clusters)) = known.iter().find(|(own, _)| *own == distance) {
            return clusters.clone();
        }
        let clusters = std::rc::Rc::new(Clusters::of(&self.space, &self.positions, distance));
        known.push((distance, clusters.clone()));
        clusters
    }
    /// The living of a group, or all of them.
    pub(super) fn members(&self, group: Option<usize>) -> Vec<usize> {
        let ids = group.map_or(0..usize::MAX, |group| {
            let range = &self.world.frame().groups[group];
            range.first as usize..(range.first + range.count) as usize
        });
        (0..self.ids.len()).filter(|&k| ids.contains(&self.ids[k])).collect()
    }
    /// A sample of some of the living.
    fn part(&self, members: &[usize]) -> Sample<D> {
        Sample::new(self.space, members.iter().map(|&k| (self.positions[k], self.velocities[k])))
    }
}

pub(super) fn wide_space<R: Real, const D: usize>(space: &Space<R, D>) -> Space<f64, D> {
    Space {
        edges: space.edges.map(|edge| match edge {
            Edge::Open => Edge::Open,
            Edge::Periodic(length) => Edge::Periodic(length.to_f64()),
            Edge::Walls(length) => Edge::Walls(length.to_f64()),
        }),
    }
}

/// What reads one number off a trial.
pub(super) trait Reader<R: Scalar, const D: usize> {
    /// Takes in a look.
    fn look(&mut self, look: &Look<'_, R, D>);
    /// Whether it wants to know of every step.
    fn steps(&self) -> bool {
        false
    }
    /// Takes in a step that was made.
    fn step(&mut self, world: &World<R, D>) {
        let _ = world;
    }
    /// The number, at the end.
    fn value(&self, world: &World<R, D>) -> Option<f64>;
}

/// The reader of a quantity in a world.
///
/// # Errors
/// What cannot be read there.
fn reader<R: Scalar, const D: usize>(of: &Quantity, world: &World<R, D>) -> Result<Box<dyn Reader<R, D>>, String> {
    let declared = world.frame().declared;
    let column = |name: &str| {
        declared.iter().position(|column| column.name == name).ok_or_else(|| {
            let near = space::spelling::nearest(name, declared.iter().map(|column| column.name));
            let hint = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            format!("no model here keeps a column `{name}`{hint}")
        })
    };
    let group = |name: Option<&str>| {
        let place = |name: &str| world.frame().groups.iter().position(|group| group.name == name);
        name.map(|name| place(name).ok_or_else(|| format!("there is no group `{name}`"))).transpose()
    };
    Ok(match of {
        Quantity::Metric(reading) => {
            let mut metric = measure::metrics::find::<D>(&reading.id).map_err(|error| error.to_string())?;
            if !metric.card().dimensions.contains(&D) {
                return Err(format!("`{}` is not defined in {D} dimensions", reading.id));
            }
            for (name, value) in &reading.parameters.0 {
                metric.set(name, *value).map_err(|error| error.to_string())?;
            }
            let group = group(reading.group.as_deref())?;
            let within = [reading.at_least, reading.at_most];
            Box::new(OfMetric { metric, group, within, scale: reading.scale, values: Values::new(reading.statistic) })
        }
        Quantity::Inside(reading) => {
            corners::<D>(&reading.low, &reading.high)?;
            let values = Values::new(reading.statistic);
            Box::new(OfInside { group: group(reading.group.as_deref())?, reading: reading.clone(), values })
        }
        Quantity::Share(reading) => {
            let column = column(&reading.column)?;
            let ColumnKind::Label(labels) = declared[column].kind else {
                return Err(format!("the column `{}` has no named states", reading.column));
            };
            let state = labels.iter().position(|label| *label == reading.state).ok_or_else(|| {
                format!("`{}` is never `{}`; it is one of {}", reading.column, reading.state, labels.join(", "))
            })?;
            let group = group(reading.group.as_deref())?;
            Box::new(OfShare { column, state, group, reading: reading.clone(), mean: Mean::default() })
        }
        Quantity::Column(reading) => {
            let (column, group) = (column(&reading.column)?, group(reading.group.as_deref())?);
            let values = Values::new(reading.statistic);
            Box::new(OfColumn { column, group, scale: reading.scale, mean: Mean::default(), values })
        }
        Quantity::Alive(reading) => {
            let values = Values::new(reading.statistic);
            Box::new(OfAlive { group: group(reading.group.as_deref())?, values })
        }
        Quantity::Ground(reading) => {
            let (group, with) = (group(reading.group.as_deref())?, group(reading.with.as_deref())?);
            Box::new(OfGround { group, with, reading: reading.clone(), values: Values::new(reading.statistic) })
        }
        Quantity::Contacts(reading) => {
            Box::new(OfContacts { reading: reading.clone(), before: Vec::new(), events: [0; 3] })
        }
        Quantity::Coverage(reading) => {
            let coverage = Coverage::new(&wide_space(world.frame().space), reading.cells)
                .ok_or("coverage needs a space that ends on every axis")?;
            // a share of 0.3 of 10 is 3, whatever rounding makes of it
            let needed = reading.share * world.frame().columns.len() as f64 - 1e-9;
            Box::new(OfCoverage { coverage, needed, reading: reading.clone() })
        }
        Quantity::Cluster(reading) => {
            Box::new(OfCluster { reading: reading.clone(), before: None, mean: Mean::default() })
        }
        Quantity::Path(reading) => Box::new(OfPath {
            quantity: reading.quantity,
            scale: reading.scale,
            before: None,
            curvature: Curvature::default(),
            mean: Mean::default(),
        }),
        Quantity::Lanes(reading) => {
            if D != 2 {
                return Err(format!("lanes are defined in 2 dimensions, found {D}"));
            }
            Box::new(OfLanes { reading: reading.clone(), values: Values::new(reading.statistic) })
        }
        Quantity::WayPoints(reading) => Box::new(WayPoints::new(reading, declared)?),
        Quantity::Detection(reading) => Box::new(OfDetections { reading: reading.clone() }),
        Quantity::Food(reading) => Box::new(Meals::new(reading, world)?),
        Quantity::Arrival(reading) => {
            if reading.at.len() != D {
                return Err(format!("`at` has {} coordinates in {D} dimensions", reading.at.len()));
            }
            Box::new(Arrival::new(reading, group(reading.group.as_deref())?))
        }
        Quantity::Transfer(reading) => {
            Box::new(OfTransfer::new(reading, column(&reading.column)?, group(reading.group.as_deref())?))
        }
        Quantity::Standing(reading) => {
            let with = reading.with.as_deref().map(column).transpose()?;
            Box::new(Standing::new(reading, with, group(reading.group.as_deref())?))
        }
        Quantity::ObstacleDistance(reading) => Box::new(OfObstacles { scale: reading.scale }),
        Quantity::Profile(reading) => Box::new(Profile::new(reading, world)?),
        Quantity::Correlation(reading) => Box::new(CorrelationLength::new(reading)),
        Quantity::Consensus(reading) => Box::new(Consensus::new(reading)),
        Quantity::Bearing(reading) => Box::new(Bearing::<D>::new(reading, group(reading.group.as_deref())?)?),
        Quantity::Reversals(reading) => Box::new(Reversals::new(reading, group(reading.group.as_deref())?, D)?),
        Quantity::Emptied(reading) => {
            corners::<D>(&reading.low, &reading.high)?;
            Box::new(Emptied::new(reading, group(reading.group.as_deref())?))
        }
    })
}

/// Whether both corners of a box have a coordinate for each axis.
///
/// # Errors
/// One that has not.
fn corners<const D: usize>(low: &[f64], high: &[f64]) -> Result<(), String> {
    match [("low", low), ("high", high)].into_iter().find(|(_, corner)| corner.len() != D) {
        Some((key, corner)) => Err(format!("`{key}` has {} coordinates in {D} dimensions", corner.len())),
        None => Ok(()),
    }
}

/// A mean over looks; those without a value do not count.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: Option<f64>) {
        if let Some(value) = value {
            self.sum += value;
            self.count += 1.0;
        }
    }
    fn value(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

/// What is made of the values of the looks; those without a value do not count.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    statistic: Statistic,
    count: f64,
    /// Sums of the first, the second and the fourth power.
    sums: [f64; 3],
    least: f64,
    greatest: f64,
    last: f64,
}

impl Values {
    pub(super) fn new(statistic: Statistic) -> Self {
        Self {
            statistic,
            count: 0.0,
            sums: [0.0; 3],
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            last: f64::NAN,
        }
    }
    pub(super) fn add(&mut self, value: Option<f64>) {
        let Some(value) = value else { return };
        self.count += 1.0;
        let square = value * value;
        self.sums.iter_mut().zip([value, square, square * square]).for_each(|(sum, power)| *sum += power);
        (self.least, self.greatest, self.last) = (self.least.min(value), self.greatest.max(value), value);
    }
    pub(super) fn value(&self) -> Option<f64> {
        let [first, second, fourth] = self.sums.map(|sum| sum / self.count);
        let value = match self.statistic {
            Statistic::Mean => first,
            Statistic::Deviation => (second - first * first).max(0.0).sqrt(),
            Statistic::Least => self.least,
            Statistic::Greatest => self.greatest,
            Statistic::Last => self.last,
            Statistic::Binder => 1.0 - fourth / (3.0 * second * second),
        };
        (self.count > 0.0).then_some(value)
    }
}

struct OfMetric<const D: usize> {
    metric: Box<dyn Measure<D>>,
    group: Option<usize>,
    /// What it is at least and at most in looks that are counted; where neither is given the metric itself is read.
    within: [Option<f64>; 2],
    scale: f64,
    values: Values,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfMetric<D> {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let value = match self.group {
                None => self.metric.on(&look.sample),
                Some(group) => self.metric.on(&look.part(&look.members(Some(group)))),
            };
            let counted = |value: f64| {
                let [low, high] = self.within;
                let within = low.is_none_or(|low| value >= low) && high.is_none_or(|high| value <= high);
                if within { 1.0 } else { 0.0 }
            };
            self.values.add(if self.within == [None; 2] { value } else { value.map(counted) });
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value().map(|value| self.scale * value)
    }
}

struct OfInside {
    group: Option<usize>,
    reading: InsideReading,
    values: Values,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfInside {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let InsideReading { low, high, .. } = &self.reading;
            let inside = |&k: &usize| (0..D).all(|a| (low[a]..=high[a]).contains(&look.positions[k].0[a]));
            self.values.add(Some(look.members(self.group).into_iter().filter(inside).count() as f64));
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value().map(|value| self.reading.scale * value)
    }
}

struct OfShare {
    column: usize,
    state: usize,
    group: Option<usize>,
    reading: ShareReading,
    mean: Mean,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfShare {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        let state = &look.world.frame().columns.state[self.column];
        let members = match self.reading.of {
            Whose::Everyone => look.members(self.group),
            Whose::LargestCluster => look.clusters(self.reading.linking_distance).largest(),
        };
        for k in members {
            let is = state[look.rows[k]].to_f64() as usize == self.state;
            self.mean.add(Some(f64::from(u8::from(is))));
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.mean.value().map(|mean| self.reading.scale * mean)
    }
}

struct OfColumn {
    column: usize,
    group: Option<usize>,
    scale: f64,
    /// Over all members and looks.
    mean: Mean,
    /// The means of the looks.
    values: Values,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfColumn {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let state = &look.world.frame().columns.state[self.column];
            let mut now = Mean::default();
            for k in look.members(self.group) {
                let value = state[look.rows[k]].to_f64();
                self.mean.add(Some(value));
                now.add(Some(value));
            }
            self.values.add(now.value());
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        // a look at few members does not count as much as one at many
        let value = if self.values.statistic == Statistic::Mean { self.mean.value() } else { self.values.value() };
        value.map(|value| self.scale * value)
    }
}

struct OfGround {
    group: Option<usize>,
    with: Option<usize>,
    reading: GroundReading,
    values: Values,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfGround {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let places = |group| look.members(group).into_iter().map(|k| look.positions[k]);
            let (own, other) = (places(self.group), places(self.with));
            self.values.add(ground::value(self.reading.quantity, own, other, self.reading.cell));
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value()
    }
}

struct OfAlive {
    group: Option<usize>,
    values: Values,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfAlive {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let frame = look.world.frame();
            let all = self.group.map_or(frame.columns.len(), |group| frame.groups[group].count as usize);
            self.values.add((all > 0).then(|| look.members(self.group).len() as f64 / all as f64));
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value()
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Meals<R, D> {
    fn look(&mut self, _: &Look<'_, R, D>) {}
    fn steps(&self) -> bool {
        true
    }
    fn step(&mut self, world: &World<R, D>) {
        Self::step(self, world);
    }
    fn value(&self, world: &World<R, D>) -> Option<f64> {
        Self::value(self, world)
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for WayPoints {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            Self::look(self, look.world, &look.ids, &look.rows);
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        Self::value(self)
    }
}

struct OfLanes {
    reading: LaneReading,
    values: Values,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfLanes {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let along = self.reading.axis - 1;
            let walkers = look.positions.iter().zip(&look.velocities).map(|(x, v)| (x.0[1 - along], v.0[along]));
            let (order, _) = lane_order::order(walkers, self.reading.width);
            self.values.add(order.is_finite().then_some(order));
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value().map(|value| self.reading.scale * value)
    }
}

struct OfDetections {
    reading: DetectionReading,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfDetections {
    fn look(&mut self, _: &Look<'_, R, D>) {}
    fn value(&self, world: &World<R, D>) -> Option<f64> {
        detections(world, &self.reading)
    }
}

struct OfContacts {
    reading: ContactReading,
    /// What each agent met in the step before.
    before: Vec<Met>,
    /// Events with members, obstacles, walls.
    events: [u64; 3],
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfContacts {
    fn look(&mut self, _: &Look<'_, R, D>) {}
    fn steps(&self) -> bool {
        self.reading.events
    }
    fn step(&mut self, world: &World<R, D>) {
        let met = world.met();
        self.before.resize(met.len(), Met::Nothing);
        for (now, before) in met.iter().zip(&mut self.before) {
            if *before == Met::Nothing {
                match now {
                    Met::Nothing => {}
                    Met::Member => self.events[0] += 1,
                    Met::Obstacle => self.events[1] += 1,
                    Met::Wall => self.events[2] += 1,
                }
            }
            *before = *now;
        }
    }
    fn value(&self, world: &World<R, D>) -> Option<f64> {
        let (members, obstacles, walls) = world.collisions();
        let counts = if self.reading.events { self.events } else { [members, obstacles, walls] };
        let count = match self.reading.with {
            Partner::Anything => counts.iter().sum(),
            Partner::Members => counts[0],
            Partner::Obstacles => counts[1],
            Partner::Walls => counts[2],
        };
        let updates = world.step_number() as f64 * world.frame().columns.len() as f64;
        let scale = self.reading.per_updates.map_or(Some(1.0), |wanted| (updates > 0.0).then(|| wanted / updates));
        scale.map(|scale| count as f64 * scale)
    }
}

struct OfCoverage<const D: usize> {
    coverage: Coverage<D>,
    needed: f64,
    reading: CoverageReading,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfCoverage<D> {
    fn look(&mut self, look: &Look<'_, R, D>) {
        // readings with an earlier first look begin at the first that anyone wants
        if look.window || self.reading.from.is_some_and(|from| look.world.time() >= from - look.interval / 2.0) {
            self.coverage.look(&look.ids, &look.positions, self.needed);
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        let at_once = self.coverage.at_once()?;
        Some(100.0 * if self.reading.at_once { at_once } else { self.coverage.visited(self.needed) })
    }
}

struct OfCluster<const D: usize> {
    reading: ClusterReading,
    /// Ids and places of the largest cluster at the look before.
    before: Option<(Vec<usize>, Vec<Vector<f64, D>>)>,
    mean: Mean,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfCluster<D> {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        let members = look.clusters(self.reading.linking_distance).largest();
        let part = || look.part(&members);
        self.mean.add(match self.reading.quantity {
            ClusterQuantity::Members => Some(members.len() as f64),
            ClusterQuantity::Polarisation => Metric::on(&polarisation::Polarisation, &part()),
            ClusterQuantity::AngularMomentum => Metric::on(&angular_momentum::AngularMomentum, &part()),
            ClusterQuantity::AngularDeviation => Metric::on(&mean_angular_deviation::MeanAngularDeviation, &part()),
            ClusterQuantity::Expanse => Metric::on(&expanse::Expanse, &part()),
            ClusterQuantity::Speed => {
                let moved = self.before.as_ref().and_then(|(ids, places)| displaced(look, ids, places));
                let ids = members.iter().map(|&k| look.ids[k]).collect();
                self.before = Some((ids, members.iter().map(|&k| look.positions[k]).collect()));
                moved.map(|moved| moved / look.interval)
            }
        });
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.mean.value().map(|mean| self.reading.scale * mean)
    }
}

/// Length of the mean displacement of those members that are still there.
fn displaced<R: Scalar, const D: usize>(
    look: &Look<'_, R, D>,
    ids: &[usize],
    places: &[Vector<f64, D>],
) -> Option<f64> {
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for (id, &place) in ids.iter().zip(places) {
        if let Ok(k) = look.ids.binary_search(id) {
            before.push(place);
            after.push(look.positions[k]);
        }
    }
    mean_displacement(&look.space, &before, &after)
}

/// Ids, places and velocities at a look.
type Seen<const D: usize> = (Vec<usize>, Vec<Vector<f64, D>>, Vec<Vector<f64, D>>);

struct OfPath<const D: usize> {
    quantity: PathQuantity,
    scale: f64,
    before: Option<Seen<D>>,
    curvature: Curvature,
    mean: Mean,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfPath<D> {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        if let Some((ids, places, velocities)) = &self.before {
            match self.quantity {
                PathQuantity::GroupSpeed => {
                    self.mean.add(displaced(look, ids, places).map(|moved| moved / look.interval));
                }
                PathQuantity::Curvature => {
                    for k in 0..ids.len() {
                        if let Ok(now) = look.ids.binary_search(&ids[k]) {
                            let offset = look.space.offset(places[k], look.positions[now]);
                            self.curvature.take([velocities[k], look.velocities[now]], offset);
                        }
                    }
                }
            }
        }
        self.before = Some((look.ids.clone(), look.positions.clone(), look.velocities.clone()));
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        let value = match self.quantity {
            PathQuantity::GroupSpeed => self.mean.value(),
            PathQuantity::Curvature => self.curvature.value(),
        };
        value.map(|value| self.scale * value)
    }
}

struct OfObstacles {
    scale: f64,
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfObstacles {
    fn look(&mut self, _: &Look<'_, R, D>) {}
    fn value(&self, world: &World<R, D>) -> Option<f64> {
        let centre = |obstacle: &Obstacle<R, D>| match &obstacle.shape {
            Shape::Ball { centre, .. } => Some((Vector(centre.0.map(R::to_f64)), Vector::ZERO)),
            _ => None,
        };
        let centres: Vec<_> = world.obstacles().list().iter().filter_map(centre).collect();
        let sample = Sample::new(wide_space(world.frame().space), centres);
        let distances = sample.nearest_distances()?;
        Some(self.scale * distances.iter().sum::<f64>() / distances.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_looks() {
        let of = |statistic, values: &[f64]| {
            let mut all = Values::new(statistic);
            values.iter().for_each(|&value| all.add(Some(value)));
            all.add(None);
            all.value()
        };
        let values = [3.0, -1.0, 1.0];
        for (statistic, expected) in [
            (Statistic::Mean, 1.0),
            (Statistic::Deviation, (8f64 / 3.0).sqrt()),
            (Statistic::Least, -1.0),
            (Statistic::Greatest, 3.0),
            (Statistic::Last, 1.0),
            // mean x^4 = 83 / 3, mean x^2 = 11 / 3
            (Statistic::Binder, 1.0 - 83.0 / 121.0),
        ] {
            let found = of(statistic, &values).unwrap_or(f64::NAN);
            assert!((found - expected).abs() < 1e-12, "{statistic:?}: {found}, expected {expected}");
            assert_eq!(of(statistic, &[]), None);
        }
        // a value that never changes: two thirds
        assert_eq!(of(Statistic::Binder, &[0.5; 4]), Some(1.0 - 1.0 / 3.0));
    }
}
