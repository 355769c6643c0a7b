//! Which share of the members is in the largest group by fields of view, in the literal reading.

use super::view_groups_literal::{BODY_RADIUS, VIEW_RADIUS};
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `view_largest_share_literal`.
    pub struct ViewLargestShareLiteral { view_radius: VIEW_RADIUS, body_radius: BODY_RADIUS }
}

impl Metric for ViewLargestShareLiteral {
    const CARD: MetricCard = MetricCard {
        id: "view_largest_share_literal",
        title: "Share of the largest group by fields of view (literal)",
        symbol: "n_v/N",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "max_g n_g / N,  n_g the sizes of the groups of view_groups_literal",
        variant: "literal linking",
        source: "behaviour selection, section 7 (D-LINK)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "1", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let largest = sample.group_sizes(2.0 * (self.view_radius + self.body_radius)).into_iter().max()?;
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
    fn the_limit_is_inclusive() {
        let near = placed(Space::open(), &[[0.0], [50.0], [200.0]]);
        let far = placed(Space::open(), &[[0.0], [50.0 + 1e-9], [200.0]]);
        close(ViewLargestShareLiteral::default().on(&near), 2.0 / 3.0);
        close(ViewLargestShareLiteral::default().on(&far), 1.0 / 3.0);
    }
}
