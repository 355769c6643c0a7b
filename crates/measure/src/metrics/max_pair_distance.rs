//! How wide a group is: the distance between the two members farthest apart.

use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `max_pair_distance`.
#[derive(Clone, Copy, Debug, Default)]
pub struct MaxPairDistance;

impl Metric for MaxPairDistance {
    const CARD: MetricCard = MetricCard {
        id: "max_pair_distance",
        title: "Greatest pair distance",
        symbol: "D_max",
        unit: "length",
        range: None,
        definition: "max over pairs i < j of |d_ij|; two or more members",
        variant: "the diameter of the group; the cost grows with the square of the number of members",
        source: "plain maximum",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(sample.mean_and_greatest_pair_distance()?.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        close(MaxPairDistance.on(&placed(Space::open(), &[[0.0, 3.0], [1.0, 0.0], [4.0, 0.0]])), 5.0);
        close(MaxPairDistance.on(&placed(Space::periodic([5.0]), &[[0.0], [1.0], [4.0]])), 2.0);
    }
}
