//! Which share of the members is in the largest group.

use super::group_count::LINKING_DISTANCE;
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `largest_group_share`.
    pub struct LargestGroupShare { linking_distance: LINKING_DISTANCE }
}

impl Metric for LargestGroupShare {
    const CARD: MetricCard = MetricCard {
        id: "largest_group_share",
        title: "Share of the largest group",
        symbol: "p_max",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "max_g n_g / N,  n_g the sizes of the groups of group_count",
        variant: "single linkage, distance included",
        source: "catalogue of models, section 5 (group membership)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "1", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let largest = sample.group_sizes(self.linking_distance).into_iter().max()?;
        Some(largest as f64 / sample.len() as f64)
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
    fn worked_example_of_the_catalogue() {
        let worked = placed(Space::open(), &[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [10.0, 10.0]]);
        close(LargestGroupShare { linking_distance: 5.0 }.on(&worked), 0.75);
        close(LargestGroupShare::default().on(&worked), 1.0);
        close(LargestGroupShare { linking_distance: 0.1 }.on(&worked), 0.25);
    }
}
