//! Into how many groups the members fall by their fields of view, in the mutual reading. Blind zones play no part.

use super::view_groups_literal::{BODY_RADIUS, VIEW_RADIUS};
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `view_groups_mutual`.
    pub struct ViewGroupsMutual { view_radius: VIEW_RADIUS, body_radius: BODY_RADIUS }
}

impl Metric for ViewGroupsMutual {
    const CARD: MetricCard = MetricCard {
        id: "view_groups_mutual",
        title: "Groups by fields of view (mutual)",
        symbol: "G_v",
        unit: "1",
        range: None,
        definition: "number of connected components of the graph |d_ij| <= view_radius + 2 body_radius: one can see \
                    the other",
        variant: "mutual linking; the other reading is view_groups_literal",
        source: "behaviour selection, section 7 (D-LINK)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "1", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(sample.group_sizes(self.view_radius + 2.0 * self.body_radius).len() as f64)
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
        let near = placed(Space::open(), &[[0.0], [26.0], [200.0]]);
        let far = placed(Space::open(), &[[0.0], [26.0 + 1e-9], [200.0]]);
        close(ViewGroupsMutual::default().on(&near), 2.0);
        close(ViewGroupsMutual::default().on(&far), 3.0);
    }
}
