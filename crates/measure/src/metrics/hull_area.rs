//! How much room a group takes: the area of its convex hull.
//!
//! On the globe the sides are geodesics between the corners of the local plane.

use crate::ground::polygon;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `hull_area`.
#[derive(Clone, Copy, Debug, Default)]
pub struct HullArea;

impl Metric for HullArea {
    const CARD: MetricCard = MetricCard {
        id: "hull_area",
        title: "Area of the convex hull",
        symbol: "A",
        unit: "length^2",
        range: None,
        definition: "area of the convex hull of all members; undefined where all are on one line",
        variant: "two-dimensional hull; on periodic axes of the group seen from its centre",
        source: "textbook",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let hull = sample.hull()?;
        if sample.places().is_empty() {
            return Some(hull.area);
        }
        Some(polygon(hull.corners.iter().map(|&corner| sample.places()[corner])).0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        let ring = |k: i32| [(f64::from(k) * 30.0).to_radians().cos(), (f64::from(k) * 30.0).to_radians().sin()];
        close(HullArea.on(&placed(Space::open(), &Vec::from_iter((0..12).map(ring)))), 3.0);
        let corner = [[9.5, 9.5], [0.5, 9.5], [9.5, 0.5], [0.5, 0.5], [0.0, 0.0]];
        close(HullArea.on(&placed(Space::periodic([10.0; 2]), &corner)), 1.0);
        close(HullArea.on(&placed(Space::walled([10.0; 2]), &corner)), 85.5);
        assert_eq!(HullArea.on(&placed(Space::open(), &[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]])), None);
    }
}
