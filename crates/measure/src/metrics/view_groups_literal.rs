//! Into how many groups the members fall by their fields of view, in the literal reading. Blind zones play no part.

use crate::metric::takes;
use crate::{Bounds, Parameter};
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

/// How far members see.
pub const VIEW_RADIUS: Parameter = Parameter {
    name: "view_radius",
    unit: "length",
    default: Some(24.0),
    bounds: Bounds::Positive,
    about: "Radius of the field of view, from the surface of the body (r_fov).",
};

/// How large members are.
pub const BODY_RADIUS: Parameter = Parameter {
    name: "body_radius",
    unit: "length",
    default: Some(1.0),
    bounds: Bounds::Positive,
    about: "Radius of the body (r_agent).",
};

takes! {
    /// `view_groups_literal`.
    pub struct ViewGroupsLiteral { view_radius: VIEW_RADIUS, body_radius: BODY_RADIUS }
}

impl Metric for ViewGroupsLiteral {
    const CARD: MetricCard = MetricCard {
        id: "view_groups_literal",
        title: "Groups by fields of view (literal)",
        symbol: "G_v",
        unit: "1",
        range: None,
        definition: "number of connected components of the graph |d_ij| <= 2 (view_radius + body_radius): the fields \
                    of view intersect",
        variant: "literal linking; the other reading is view_groups_mutual",
        source: "behaviour selection, section 7 (D-LINK)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "1", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        Some(sample.group_sizes(2.0 * (self.view_radius + self.body_radius)).len() as f64)
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
        close(ViewGroupsLiteral::default().on(&near), 2.0);
        close(ViewGroupsLiteral::default().on(&far), 3.0);
    }
}
