//! Whether a group has split: 1 where it has, 0 where it has not. Its mean over frames is the share of time.

use super::group_count::LINKING_DISTANCE;
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `fragmented`.
    pub struct Fragmented { linking_distance: LINKING_DISTANCE }
}

impl Metric for Fragmented {
    const CARD: MetricCard = MetricCard {
        id: "fragmented",
        title: "Fragmented",
        symbol: "F",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "1 for two or more groups of group_count, else 0",
        variant: "by the fragmentation threshold",
        source: "catalogue of models, section 5 (group membership)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let groups = sample.group_sizes(self.linking_distance).len();
        (groups > 0).then_some(if groups > 1 { 1.0 } else { 0.0 })
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
        close(Fragmented { linking_distance: 5.0 }.on(&worked), 1.0);
        close(Fragmented { linking_distance: 13.0 }.on(&worked), 0.0);
    }
}
