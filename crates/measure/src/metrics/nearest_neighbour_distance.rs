//! How far away the nearest neighbour is, on average, in units of length (not of bodies).
//!
//! P. J. Clark, F. C. Evans (1954), Distance to nearest neighbor as a measure of spatial relationships in populations,
//! Ecology 35:445.

use crate::sample::mean;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `nearest_neighbour_distance`.
#[derive(Clone, Copy, Debug, Default)]
pub struct NearestNeighbourDistance;

impl Metric for NearestNeighbourDistance {
    const CARD: MetricCard = MetricCard {
        id: "nearest_neighbour_distance",
        title: "Nearest-neighbour distance",
        symbol: "NND",
        unit: "length",
        range: None,
        definition: "mean_i min_{j != i} |d_ij|,  d_ij = x_j - x_i (minimum image); two or more members",
        variant: "mean over all members; between centres",
        source: "Clark and Evans 1954; catalogue of models, section 5",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean(sample.nearest_distances()?.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        let lattice: Vec<[f64; 2]> = (0..25).map(|k| [f64::from(k % 5), f64::from(k / 5)]).collect();
        close(NearestNeighbourDistance.on(&placed(Space::open(), &lattice)), 1.0);
        let ring = |k: i32| [(f64::from(k) * 30.0).to_radians().cos(), (f64::from(k) * 30.0).to_radians().sin()];
        let chord = NearestNeighbourDistance.on(&placed(Space::open(), &Vec::from_iter((0..12).map(ring))));
        close(chord, 0.517_638_090_205_041_5);
        // the worked example of the catalogue: 2, 2, 2 and the way from (10, 10) to (2, 0)
        let worked = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [10.0, 10.0]];
        close(NearestNeighbourDistance.on(&placed(Space::open(), &worked)), (6.0 + 164f64.sqrt()) / 4.0);
    }

    #[test]
    fn neighbours_are_met_across_the_seam() {
        let places = [[0.5, 5.0], [9.5, 5.0], [5.0, 5.0]];
        close(NearestNeighbourDistance.on(&placed(Space::periodic([10.0, 10.0]), &places)), (1.0 + 1.0 + 4.5) / 3.0);
        close(NearestNeighbourDistance.on(&placed(Space::walled([10.0, 10.0]), &places)), 4.5);
    }
}
