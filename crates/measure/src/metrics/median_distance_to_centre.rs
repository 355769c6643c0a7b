//! How far the middle member is from the centre of the group: few outliers change it little.
//!
//! Of the last frame of a run it is what the mean median distance (MMD) averages over runs.

use crate::domains::median;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `median_distance_to_centre`.
#[derive(Clone, Copy, Debug, Default)]
pub struct MedianDistanceToCentre;

impl Metric for MedianDistanceToCentre {
    const CARD: MetricCard = MetricCard {
        id: "median_distance_to_centre",
        title: "Median distance to the centre",
        symbol: "MD",
        unit: "length",
        range: None,
        definition: "median_i |x_i - c|,  c the centre (circular mean on periodic axes); the mean of the two middle values \
                     of an even number",
        variant: "median",
        source: "catalogue of models, section 5 (the MMD of one frame)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        median(sample.distances_to_centre()?.to_vec())
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
        close(MedianDistanceToCentre.on(&worked), (10f64.sqrt() + 18f64.sqrt()) / 2.0);
        assert!(MedianDistanceToCentre.on(&worked).is_some_and(|median| (median - 3.702459).abs() < 5e-7));
        assert_eq!(worked.centre(), Some(space::Vector([3.0, 3.0])));
    }

    #[test]
    fn odd_and_even_numbers() {
        close(MedianDistanceToCentre.on(&placed(Space::open(), &[[-4.0], [0.0], [1.0], [3.0], [0.0]])), 1.0);
        close(MedianDistanceToCentre.on(&placed(Space::open(), &[[-3.0], [3.0], [-1.0], [1.0]])), 2.0);
    }
}
