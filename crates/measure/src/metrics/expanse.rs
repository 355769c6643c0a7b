//! How widely a group is spread: the root mean square distance of its members to their centre.
//!
//! The mean square itself also goes by this name.

use crate::sample::mean;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `expanse`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Expanse;

impl Metric for Expanse {
    const CARD: MetricCard = MetricCard {
        id: "expanse",
        title: "Expanse",
        symbol: "E",
        unit: "length",
        range: None,
        definition: "sqrt(mean_i |x_i - c|^2),  c the centre (circular mean on periodic axes)",
        variant: "root of the mean square",
        source: "catalogue of models, section 5 (the root of the mean quadratic distance)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean(sample.distances_to_centre()?.iter().map(|distance| distance * distance)).map(f64::sqrt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        // squared distances 18, 10, 10, 98
        let worked = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [10.0, 10.0]];
        close(Expanse.on(&placed(Space::open(), &worked)), 34f64.sqrt());
        close(Expanse.on(&placed(Space::open(), &[[-1.0], [1.0], [3.0], [5.0]])), 5f64.sqrt());
        close(Expanse.on(&placed(Space::periodic([10.0]), &[[9.0], [1.0]])), 1.0);
        close(Expanse.on(&placed(Space::open(), &[[0.1, 0.2, 0.3]; 7])), 0.0);
    }

    #[test]
    fn places_spread_evenly_round_an_axis_have_no_centre() {
        let places = [[0.0], [2.5], [5.0], [7.5]];
        assert_eq!(Expanse.on(&placed(Space::periodic([10.0]), &places)), None);
        close(Expanse.on(&placed(Space::walled([10.0]), &places)), (125.0f64 / 16.0).sqrt());
    }
}
