//! How far the loneliest member is from its nearest neighbour.

use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `nearest_neighbour_distance_max`.
#[derive(Clone, Copy, Debug, Default)]
pub struct NearestNeighbourDistanceMax;

impl Metric for NearestNeighbourDistanceMax {
    const CARD: MetricCard = MetricCard {
        id: "nearest_neighbour_distance_max",
        title: "Greatest nearest-neighbour distance",
        symbol: "max NND",
        unit: "length",
        range: None,
        definition: "max_i min_{j != i} |d_ij|; two or more members",
        variant: "greatest over members of one frame",
        source: "plain maximum",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        sample.nearest_distances()?.iter().copied().reduce(f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        close(NearestNeighbourDistanceMax.on(&placed(Space::open(), &[[0.0], [1.0], [4.0]])), 3.0);
        close(NearestNeighbourDistanceMax.on(&placed(Space::periodic([5.0]), &[[0.0], [1.0], [4.0]])), 1.0);
    }
}
