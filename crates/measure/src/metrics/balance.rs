//! How evenly the members are split among groups: the entropy of the shares over that of equal shares. A split is balanced
//! from 0.30 on.

use super::group_count::LINKING_DISTANCE;
use crate::behaviours::blocks::entropy_ratio;
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `balance`.
    pub struct Balance { linking_distance: LINKING_DISTANCE }
}

impl Metric for Balance {
    const CARD: MetricCard = MetricCard {
        id: "balance",
        title: "Balance of the groups",
        symbol: "H/H_max",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "H / ln G,  H = -sum_g p_g ln p_g,  p_g the shares of the G groups of group_count; undefined for fewer \
                     than two groups",
        variant: "entropy over ln of the number of groups, not of members",
        source: "catalogue of models, section 5 (balance)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let sizes = sample.group_sizes(self.linking_distance);
        if sizes.len() < 2 {
            return None;
        }
        Some(entropy_ratio(&sizes))
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
        let ratio = Balance { linking_distance: 5.0 }.on(&worked);
        close(ratio, (0.75 * (4.0f64 / 3.0).ln() + 0.25 * 4f64.ln()) / 2f64.ln());
        assert!(ratio.is_some_and(|ratio| (ratio - 0.8113).abs() < 5e-5));
    }

    #[test]
    fn equal_shares_have_one_and_a_single_group_no_balance() {
        let pairs = placed(Space::open(), &[[0.0], [1.0], [100.0], [101.0], [200.0], [201.0]]);
        close(Balance::default().on(&pairs), 1.0);
        assert_eq!(Balance { linking_distance: 100.0 }.on(&pairs), None);
    }
}
