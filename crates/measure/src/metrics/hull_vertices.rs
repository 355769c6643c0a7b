//! How many members are on the edge of a group: the corners of its convex hull.

use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `hull_vertices`.
#[derive(Clone, Copy, Debug, Default)]
pub struct HullVertices;

impl Metric for HullVertices {
    const CARD: MetricCard = MetricCard {
        id: "hull_vertices",
        title: "Corners of the convex hull",
        symbol: "N_h",
        unit: "1",
        range: None,
        definition: "number of corners of the convex hull of all members; undefined where all are on one line",
        variant: "members on a side are no corners",
        source: "textbook",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(sample.hull()?.corners.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn members_on_a_side_do_not_count() {
        let lattice = Vec::from_iter((0..25).map(|k| [f64::from(k % 5), f64::from(k / 5)]));
        close(HullVertices.on(&placed(Space::open(), &lattice)), 4.0);
        let ring = |k: i32| [(f64::from(k) * 30.0).to_radians().cos(), (f64::from(k) * 30.0).to_radians().sin()];
        close(HullVertices.on(&placed(Space::open(), &Vec::from_iter((0..12).map(ring)))), 12.0);
    }
}
