//! How much room a group takes in space: the volume of its convex hull.

use crate::hull::solid_hull;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `hull_volume`.
#[derive(Clone, Copy, Debug, Default)]
pub struct HullVolume;

impl Metric for HullVolume {
    const CARD: MetricCard = MetricCard {
        id: "hull_volume",
        title: "Volume of the convex hull",
        symbol: "V",
        unit: "length^3",
        range: None,
        definition: "volume of the convex hull of all members; undefined where all are in one plane",
        variant: "three-dimensional hull; on periodic axes of the group seen from its centre",
        source: "textbook",
        counted: Counted::Positions,
        dimensions: &[3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        if D != 3 {
            return None;
        }
        let places: Vec<Vector<f64, 3>> = sample.unwrapped()?.iter().map(|place| Vector::of(&place.0)).collect();
        Some(solid_hull(&places)?.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn a_cube() {
        let cube = Vec::from_iter((0..27).map(|k| [f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)]));
        close(HullVolume.on(&placed(Space::open(), &cube)), 8.0);
        let seam = cube.iter().map(|place| place.map(|x| (x + 8.5) % 10.0));
        close(HullVolume.on(&placed(Space::periodic([10.0; 3]), &Vec::from_iter(seam))), 8.0);
        assert_eq!(HullVolume.on(&placed(Space::open(), &cube[..9])), None);
    }
}
