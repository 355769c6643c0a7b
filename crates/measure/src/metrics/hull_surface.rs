//! How much surface a group has in space: that of its convex hull.

use crate::hull::solid_hull;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `hull_surface`.
#[derive(Clone, Copy, Debug, Default)]
pub struct HullSurface;

impl Metric for HullSurface {
    const CARD: MetricCard = MetricCard {
        id: "hull_surface",
        title: "Surface of the convex hull",
        symbol: "S_h",
        unit: "length^2",
        range: None,
        definition: "surface of the convex hull of all members; undefined where all are in one plane",
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
        Some(solid_hull(&places)?.1)
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
        close(HullSurface.on(&placed(Space::open(), &cube)), 24.0);
        let seam = cube.iter().map(|place| place.map(|x| (x + 8.5) % 10.0));
        close(HullSurface.on(&placed(Space::periodic([10.0; 3]), &Vec::from_iter(seam))), 24.0);
        assert_eq!(HullSurface.on(&placed(Space::open(), &cube[..9])), None);
    }
}
