//! How far two members are apart, on average.

use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `mean_pair_distance`.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeanPairDistance;

impl Metric for MeanPairDistance {
    const CARD: MetricCard = MetricCard {
        id: "mean_pair_distance",
        title: "Mean pair distance",
        symbol: "D",
        unit: "length",
        range: None,
        definition: "mean over pairs i < j of |d_ij|; two or more members",
        variant: "every pair once; the cost grows with the square of the number of members",
        source: "plain mean",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(sample.mean_and_greatest_pair_distance()?.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        close(MeanPairDistance.on(&placed(Space::open(), &[[0.0], [1.0], [4.0]])), 8.0 / 3.0);
        close(MeanPairDistance.on(&placed(Space::periodic([5.0]), &[[0.0], [1.0], [4.0]])), 4.0 / 3.0);
        // many members take another way
        let line = Vec::from_iter((0..400).map(|k| [f64::from(k)]));
        close(MeanPairDistance.on(&placed(Space::open(), &line)), 401.0 / 3.0);
    }
}
