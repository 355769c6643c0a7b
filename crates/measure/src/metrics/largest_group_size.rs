//! How many members the largest group has.

use super::group_count::LINKING_DISTANCE;
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `largest_group_size`.
    pub struct LargestGroupSize { linking_distance: LINKING_DISTANCE }
}

impl Metric for LargestGroupSize {
    const CARD: MetricCard = MetricCard {
        id: "largest_group_size",
        title: "Members of the largest group",
        symbol: "N_g",
        unit: "1",
        range: None,
        definition: "max_g n_g,  n_g the sizes of the groups of group_count",
        variant: "single linkage, distance included",
        source: "catalogue of models, section 5 (group membership)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "1", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(sample.group_sizes(self.linking_distance).into_iter().max().unwrap_or(0) as f64)
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
        close(LargestGroupSize { linking_distance: 5.0 }.on(&worked), 3.0);
        close(LargestGroupSize { linking_distance: 0.1 }.on(&worked), 1.0);
    }
}
