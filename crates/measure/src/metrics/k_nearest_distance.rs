//! How far the k nearest neighbours are, on average.

use super::kth_neighbour_distance::NEIGHBOURS;
use crate::metric::takes;
use crate::sample::mean;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `k_nearest_distance`.
    pub struct KNearestDistance { neighbours: NEIGHBOURS }
}

impl Metric for KNearestDistance {
    const CARD: MetricCard = MetricCard {
        id: "k_nearest_distance",
        title: "Mean distance to the k nearest neighbours",
        symbol: "NND_1..k",
        unit: "length",
        range: None,
        definition: "mean_i of the mean distance to the k nearest others; more than k members",
        variant: "all k alike",
        source: "plain mean",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let others = sample.nearest_others(self.neighbours as usize)?;
        mean(others.iter().map(|other| other.0))
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        self.place(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        let places = [[0.0], [1.0], [4.0], [6.0]];
        close(KNearestDistance { neighbours: 2.0 }.on(&placed(Space::open(), &places)), (5.0 + 4.0 + 5.0 + 7.0) / 8.0);
    }
}
