//! How much the distance to the nearest neighbour differs from member to member.

use crate::sample::spread;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `nearest_neighbour_distance_sd`.
#[derive(Clone, Copy, Debug, Default)]
pub struct NearestNeighbourDistanceSd;

impl Metric for NearestNeighbourDistanceSd {
    const CARD: MetricCard = MetricCard {
        id: "nearest_neighbour_distance_sd",
        title: "Standard deviation of the nearest-neighbour distance",
        symbol: "sd(NND)",
        unit: "length",
        range: None,
        definition: "sqrt(sum_i (d_i - mean d)^2 / (N - 1)),  d_i = min_{j != i} |d_ij|; two or more members",
        variant: "between members of one frame; divisor N - 1",
        source: "plain standard deviation",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(spread(sample.nearest_distances()?)?.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        // nearest distances 1, 1, 3
        close(NearestNeighbourDistanceSd.on(&placed(Space::open(), &[[0.0], [1.0], [4.0]])), (4.0f64 / 3.0).sqrt());
        close(NearestNeighbourDistanceSd.on(&placed(Space::open(), &[[0.0], [7.0]])), 0.0);
    }
}
