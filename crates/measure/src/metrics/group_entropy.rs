//! How uncertain it is to which group a member belongs.

use super::group_count::LINKING_DISTANCE;
use crate::behaviours::blocks::entropy;
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `group_entropy`.
    pub struct GroupEntropy { linking_distance: LINKING_DISTANCE }
}

impl Metric for GroupEntropy {
    const CARD: MetricCard = MetricCard {
        id: "group_entropy",
        title: "Entropy of the groups",
        symbol: "H",
        unit: "1",
        range: None,
        definition: "-sum_g p_g ln p_g,  p_g the shares of the groups of group_count",
        variant: "natural logarithm; see balance for its share of the greatest",
        source: "catalogue of models, section 5 (balance)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        entropy(&sample.group_sizes(self.linking_distance))
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
        close(GroupEntropy { linking_distance: 5.0 }.on(&worked), 0.75 * (4.0f64 / 3.0).ln() + 0.25 * 4f64.ln());
        close(GroupEntropy { linking_distance: 0.1 }.on(&worked), 4f64.ln());
        close(GroupEntropy::default().on(&worked), 0.0);
    }
}
