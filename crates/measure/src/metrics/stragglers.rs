//! Which share of the members has lost the others: their nearest neighbour is farther than a distance.
//!
//! The source counts those farther than 5 body lengths. A frame holds no bodies, so the distance here is a length: 5 units
//! where nothing else is said, and 5 times the body length where that is not 1.

use crate::metric::takes;
use crate::sample::mean;
use crate::{Bounds, Counted, EdgeCases, Metric, MetricCard, Parameter, Sample, Takes};

/// Beyond which distance a member counts as a straggler.
pub const DISTANCE: Parameter = Parameter {
    name: "distance",
    unit: "length",
    default: Some(5.0),
    bounds: Bounds::Positive,
    about: "A member whose nearest neighbour is farther than this is a straggler.",
};

takes! {
    /// `stragglers`.
    pub struct Stragglers { distance: DISTANCE }
}

impl Metric for Stragglers {
    const CARD: MetricCard = MetricCard {
        id: "stragglers",
        title: "Share of stragglers",
        symbol: "S",
        unit: "1",
        range: None,
        definition: "share of members with min_{j != i} |d_ij| > distance; two or more members",
        variant: "share of members, not their number",
        source: "catalogue of models, section 5 (as a share, not a number)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let lost = |&nearest: &f64| if nearest > self.distance { 1.0 } else { 0.0 };
        mean(sample.nearest_distances()?.iter().map(lost))
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
        let worked = placed(Space::open(), &[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [10.0, 10.0]]);
        close(Stragglers::default().on(&worked), 0.25);
        close(Stragglers { distance: 13.0 }.on(&worked), 0.0);
        close(Stragglers { distance: 1.0 }.on(&worked), 1.0);
        close(Stragglers::default().on(&placed(Space::open(), &[[0.0], [5.0]])), 0.0);
        assert_eq!(Stragglers::default().on(&placed(Space::open(), &[[0.0]])), None);
    }
}
