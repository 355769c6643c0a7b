//! How far people who walk in opposite directions have formed lanes: 1 in perfect lanes, about 1/n by chance with n in a lane.
//!
//! M. Rex, H. Lowen (2007), Lane formation in oppositely charged colloids driven by an electric field, Physical Review E 75:051402; for
//! pedestrians S. Nowak, A. Schadschneider (2012), Quantitative analysis of pedestrian counterflow in a cellular automaton model, Physical
//! Review E 85:066128.

use crate::metric::takes;
use crate::{Bounds, Parameter};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use std::collections::BTreeMap;

/// Width of a lane.
const LANE_WIDTH: Parameter = Parameter {
    name: "lane_width",
    unit: "length",
    default: Some(0.8),
    bounds: Bounds::Positive,
    about: "Width of a lane: of a person.",
};

/// Along which axis people walk.
const AXIS: Parameter = Parameter {
    name: "axis",
    unit: "1",
    default: Some(1.0),
    bounds: Bounds::Whole,
    about: "The axis along which people walk: 1 for x, 2 for y.",
};

takes! {
    /// `lane_order`.
    pub struct LaneOrder { lane_width: LANE_WIDTH, axis: AXIS }
}

/// The order of walkers, each by its place across the lanes and its velocity along them, and how many have one; NaN where nobody has.
pub fn order(walkers: impl IntoIterator<Item = (f64, f64)>, lane_width: f64) -> (f64, f64) {
    let mut lanes: BTreeMap<i64, (f64, f64)> = BTreeMap::new();
    for (across, velocity) in walkers.into_iter().filter(|(_, velocity)| *velocity != 0.0) {
        let (ahead, back) = lanes.entry((across / lane_width).floor() as i64).or_default();
        *(if velocity > 0.0 { ahead } else { back }) += 1.0;
    }
    let walkers: f64 = lanes.values().map(|(ahead, back)| ahead + back).sum();
    let order: f64 = lanes.values().map(|(ahead, back)| (ahead - back) * (ahead - back) / (ahead + back)).sum();
    (order / walkers, walkers)
}

impl TrackMetric for LaneOrder {
    const CARD: TrackCard = TrackCard {
        id: "lane_order",
        title: "Lane order",
        definition: "phi = mean_i ((n_same - n_opposite) / (n_same + n_opposite))^2,  counted over the lane in which \
                    i walks (itself included); lanes are lane_width wide along the axis; a direction is the sign of \
                    the velocity along it",
        variant: "lanes of a fixed width from 0 on; individuals without a velocity along the axis left out",
        source: "Rex and Lowen 2007; Nowak and Schadschneider 2012",
        counted: Counted::Velocities,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::number("phi", "1", "Lane order."),
            Field::count("individuals", "Individuals that walk along the axis."),
        ],
        edge: "NaN where nobody walks",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let along = usize::from(self.axis > 1.5);
        for (frame, &number) in tracks.frames().iter().enumerate() {
            let walker = |row: usize| Some((tracks.position(row).0[1 - along], tracks.velocity(row)?.0[along]));
            let (order, walkers) = order(tracks.rows(frame).filter_map(walker), self.lane_width);
            found.push([number as f64, tracks.times()[frame], order, walkers]);
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn lanes_and_a_mixed_crowd() -> Fine {
        // two lanes of two: first in order, then one of each in both
        let place = |ordered: bool| {
            move |frame: i64, k: u32| {
                let ahead = if ordered { k < 2 } else { k.is_multiple_of(2) };
                Some([if ahead { frame as f64 } else { -frame as f64 }, f64::from(k / 2) + 0.5])
            }
        };
        let order = LaneOrder { lane_width: 1.0, axis: 1.0 };
        let lanes = order.on(&tracks(Space::open(), 1.0, 2, 4, place(true))?)?;
        close(&lanes.columns[2], &[f64::NAN, 1.0]);
        close(&lanes.columns[3], &[0.0, 4.0]);
        let mixed = order.on(&tracks(Space::open(), 1.0, 2, 4, place(false))?)?;
        close(&mixed.columns[2], &[f64::NAN, 0.0]);
        Ok(())
    }
}
