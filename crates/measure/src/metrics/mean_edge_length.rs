//! How far members are apart that interact, on average.

use crate::metric::takes;
use crate::sample::mean;
use crate::{Bounds, Counted, EdgeCases, Metric, MetricCard, Parameter, Sample, Takes};

/// How far members interact: what the metrics of a lattice take.
pub const INTERACTION_RADIUS: Parameter = Parameter {
    name: "interaction_radius",
    unit: "length",
    default: Some(8.4),
    bounds: Bounds::Positive,
    about: "Members less than this far apart are joined by an edge (r).",
};

/// Lengths of the edges between members less than a radius apart, each pair once, in the same order on every machine.
pub(super) fn edges<const D: usize>(sample: &Sample<D>, radius: f64) -> Vec<f64> {
    let mut lengths = Vec::new();
    sample.pairs_within(radius, &mut |i, j| lengths.push(sample.distance(i, j)));
    lengths.retain(|&length| length < radius);
    lengths
}

takes! {
    /// `mean_edge_length`.
    pub struct MeanEdgeLength { interaction_radius: INTERACTION_RADIUS }
}

impl Metric for MeanEdgeLength {
    const CARD: MetricCard = MetricCard {
        id: "mean_edge_length",
        title: "Mean edge length",
        symbol: "d_E",
        unit: "length",
        range: None,
        definition: "mean of |d_ij| over pairs i < j with |d_ij| < interaction_radius; one such pair or more",
        variant: "each pair once; the radius is excluded, as in the source",
        source: "the proximity net of Olfati-Saber 2006; plain mean",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean(edges(sample, self.interaction_radius).into_iter())
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
        let near = MeanEdgeLength { interaction_radius: 3.5 };
        // edges of 1, 3 and, across the seam, 2 and 3
        let places = [[0.0], [1.0], [4.0], [8.0]];
        close(near.on(&placed(Space::open(), &places)), 2.0);
        close(near.on(&placed(Space::periodic([10.0]), &places)), 9.0 / 4.0);
        // a hexagon about a member: six spokes and six sides, all of the same length
        let corner = |k: i32| [(f64::from(k) * 60.0).to_radians().cos(), (f64::from(k) * 60.0).to_radians().sin()];
        let hexagon = Vec::from_iter((0..6).map(corner).chain([[0.0, 0.0]]));
        close(MeanEdgeLength { interaction_radius: 1.2 }.on(&placed(Space::open(), &hexagon)), 1.0);
        // many members take another way
        let line = Vec::from_iter((0..400).map(|k| [f64::from(k)]));
        close(MeanEdgeLength { interaction_radius: 2.5 }.on(&placed(Space::periodic([400.0]), &line)), 1.5);
    }

    #[test]
    fn the_radius_is_excluded_and_without_edges_there_is_no_mean() {
        let pair = placed(Space::open(), &[[0.0, 0.0], [0.0, 2.0]]);
        assert_eq!(MeanEdgeLength { interaction_radius: 2.0 }.on(&pair), None);
        close(MeanEdgeLength { interaction_radius: 2.0 + 1e-9 }.on(&pair), 2.0);
        close(MeanEdgeLength::default().on(&placed(Space::open(), &[[3.0]; 5])), 0.0);
    }
}
