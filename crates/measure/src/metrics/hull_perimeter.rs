//! How long the way round a group is: the perimeter of its convex hull.
//!
//! On the globe the sides are geodesics between the corners of the local plane.

use crate::ground::polygon;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `hull_perimeter`.
#[derive(Clone, Copy, Debug, Default)]
pub struct HullPerimeter;

impl Metric for HullPerimeter {
    const CARD: MetricCard = MetricCard {
        id: "hull_perimeter",
        title: "Perimeter of the convex hull",
        symbol: "C",
        unit: "length",
        range: None,
        definition: "perimeter of the convex hull of all members; undefined where all are on one line",
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
            return Some(hull.perimeter);
        }
        Some(polygon(hull.corners.iter().map(|&corner| sample.places()[corner])).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        let lattice = Vec::from_iter((0..25).map(|k| [f64::from(k % 5), f64::from(k / 5)]));
        close(HullPerimeter.on(&placed(Space::open(), &lattice)), 16.0);
        close(HullPerimeter.on(&placed(Space::open(), &[[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])), 12.0);
    }
}
