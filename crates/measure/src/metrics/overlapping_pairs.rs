//! How many pairs of bodies overlap. Its mean over frames is the collision rate of the catalogue.

use super::view_groups_literal::BODY_RADIUS;
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `overlapping_pairs`.
    pub struct OverlappingPairs { body_radius: BODY_RADIUS }
}

impl Metric for OverlappingPairs {
    const CARD: MetricCard = MetricCard {
        id: "overlapping_pairs",
        title: "Overlapping pairs of bodies",
        symbol: "N_c",
        unit: "1",
        range: None,
        definition: "number of pairs i < j with |d_ij| < 2 body_radius",
        variant: "bodies that touch do not overlap; pairs in a frame, not events",
        source: "catalogue of models, section 5 (collision rate)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let reach = 2.0 * self.body_radius;
        let mut pairs = 0usize;
        sample.pairs_within(reach, &mut |i, j| pairs += usize::from(sample.distance(i, j) < reach));
        Some(pairs as f64)
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
    fn touching_is_not_overlapping() {
        let places = [[0.0], [2.0], [3.5], [3.6], [9.5]];
        close(OverlappingPairs { body_radius: 1.0 }.on(&placed(Space::open(), &places)), 3.0);
        close(OverlappingPairs { body_radius: 1.0 }.on(&placed(Space::periodic([10.0]), &places)), 4.0);
    }
}
