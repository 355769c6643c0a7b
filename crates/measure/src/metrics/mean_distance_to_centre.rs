//! How far members are from the centre of the group, on average.

use crate::sample::mean;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `mean_distance_to_centre`.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeanDistanceToCentre;

impl Metric for MeanDistanceToCentre {
    const CARD: MetricCard = MetricCard {
        id: "mean_distance_to_centre",
        title: "Mean distance to the centre",
        symbol: "R",
        unit: "length",
        range: None,
        definition: "mean_i |x_i - c|,  c the centre (circular mean on periodic axes)",
        variant: "mean",
        source: "plain mean",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean(sample.distances_to_centre()?.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        let worked = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [10.0, 10.0]];
        let expected = (18f64.sqrt() + 2.0 * 10f64.sqrt() + 98f64.sqrt()) / 4.0;
        close(MeanDistanceToCentre.on(&placed(Space::open(), &worked)), expected);
        close(MeanDistanceToCentre.on(&placed(Space::periodic([8.0, 8.0]), &[[7.0, 1.0], [1.0, 1.0]])), 1.0);
    }
}
