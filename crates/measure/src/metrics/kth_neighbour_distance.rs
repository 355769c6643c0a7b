//! How far the k-th nearest neighbour is, on average.

use crate::metric::takes;
use crate::sample::mean;
use crate::{Bounds, Parameter};
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

/// How many neighbours.
pub const NEIGHBOURS: Parameter = Parameter {
    name: "neighbours",
    unit: "1",
    default: Some(6.0),
    bounds: Bounds::Whole,
    about: "So many of the nearest neighbours (k).",
};

takes! {
    /// `kth_neighbour_distance`.
    pub struct KthNeighbourDistance { neighbours: NEIGHBOURS }
}

impl Metric for KthNeighbourDistance {
    const CARD: MetricCard = MetricCard {
        id: "kth_neighbour_distance",
        title: "Distance to the k-th nearest neighbour",
        symbol: "NND_k",
        unit: "length",
        range: None,
        definition: "mean_i of the distance to the k-th nearest other; more than k members",
        variant: "the k-th alone",
        source: "Clark and Evans 1954, for k = 1",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let k = self.neighbours as usize;
        let others = sample.nearest_others(k)?;
        mean(others.chunks_exact(k).filter_map(|nearest| nearest.last()).map(|other| other.0))
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
        // second nearest: 4, 3, 3, 5
        close(KthNeighbourDistance { neighbours: 2.0 }.on(&placed(Space::open(), &places)), 15.0 / 4.0);
        close(KthNeighbourDistance { neighbours: 3.0 }.on(&placed(Space::open(), &places)), 21.0 / 4.0);
        assert_eq!(KthNeighbourDistance { neighbours: 4.0 }.on(&placed(Space::open(), &places)), None);
        let line = Vec::from_iter((0..400).map(|k| [f64::from(k)]));
        close(KthNeighbourDistance { neighbours: 2.0 }.on(&placed(Space::periodic([400.0]), &line)), 1.0);
    }
}
