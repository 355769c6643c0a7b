//! How far the members are from a lattice in which all that interact have the same distance.

use super::mean_edge_length::{INTERACTION_RADIUS, edges};
use crate::metric::takes;
use crate::{Bounds, Counted, EdgeCases, Metric, MetricCard, Parameter, Sample, Takes};

/// The distance that members of a lattice keep.
pub const SPACING: Parameter = Parameter {
    name: "spacing",
    unit: "length",
    default: Some(7.0),
    bounds: Bounds::Positive,
    about: "Distance between neighbours in a perfect lattice (d).",
};

takes! {
    /// `deviation_energy`.
    pub struct DeviationEnergy { interaction_radius: INTERACTION_RADIUS, spacing: SPACING }
}

impl Metric for DeviationEnergy {
    const CARD: MetricCard = MetricCard {
        id: "deviation_energy",
        title: "Deviation energy of a lattice",
        symbol: "E",
        unit: "length^2",
        range: None,
        definition: "1/(|E| + 1) sum_{(i,j) in E} (|d_ij| - spacing)^2,  E the ordered pairs i != j with |d_ij| < \
                     interaction_radius",
        variant: "each pair twice, in the sum and in |E|, as in the source; not divided by spacing^2, as its figures are \
                  (the normalised energy)",
        source: "Olfati-Saber 2006, deviation energy of quasi alpha-lattices",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "0", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let edges = edges(sample, self.interaction_radius);
        let sum: f64 = edges.iter().map(|length| (length - self.spacing) * (length - self.spacing)).sum();
        Some(2.0 * sum / (2.0 * edges.len() as f64 + 1.0))
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
    fn a_lattice_has_none_and_a_stretched_one_that_of_its_edges() {
        let hexagon = |side: f64| {
            let corner = move |k: i32| {
                let angle = (f64::from(k) * 60.0).to_radians();
                [side * angle.cos(), side * angle.sin()]
            };
            placed(Space::open(), &Vec::from_iter((0..6).map(corner).chain([[0.0, 0.0]])))
        };
        close(DeviationEnergy::default().on(&hexagon(7.0)), 0.0);
        // twelve edges, each counted twice
        close(DeviationEnergy::default().on(&hexagon(6.5)), 24.0 * 0.25 / 25.0);
        // edges of 1, 3 and, across the seam, 2 and 3
        let unequal = DeviationEnergy { interaction_radius: 3.5, spacing: 2.0 };
        let places = [[0.0], [1.0], [4.0], [8.0]];
        close(unequal.on(&placed(Space::open(), &places)), 4.0 / 5.0);
        close(unequal.on(&placed(Space::periodic([10.0]), &places)), 6.0 / 9.0);
    }

    #[test]
    fn nothing_deviates_without_edges_and_the_coincident_by_all_of_it() {
        close(DeviationEnergy::default().on(&placed(Space::open(), &[[0.0, 0.0], [8.4, 0.0]])), 0.0);
        // six pairs
        close(DeviationEnergy::default().on(&placed(Space::open(), &[[3.0]; 4])), 12.0 * 49.0 / 13.0);
    }
}
