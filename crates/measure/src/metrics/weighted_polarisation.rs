//! Polarisation in which the fast count for more: the length of the summed velocities over the sum of the speeds.
//!
//! This is what the package trajectorytools calls polarisation. It equals [`super::polarisation`] only where all speeds
//! are equal.

use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `weighted_polarisation`.
#[derive(Clone, Copy, Debug, Default)]
pub struct WeightedPolarisation;

impl Metric for WeightedPolarisation {
    const CARD: MetricCard = MetricCard {
        id: "weighted_polarisation",
        title: "Weighted polarisation",
        symbol: "P_v",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "|sum_i v_i| / sum_i |v_i|,  over members with a velocity",
        variant: "of velocities: the fast count for more",
        source: "the package trajectorytools, where it is called polarisation",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "1", at_rest: "undefined" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        sample.headings().next()?;
        let (sum, speeds) = sample.velocities().fold((Vector::ZERO, 0.0), |(sum, s), v| (sum + v, s + v.length()));
        Some(sum.length() / speeds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, moving};

    #[test]
    fn closed_forms() {
        let p = |velocities: &[[f64; 2]]| WeightedPolarisation.on(&moving(velocities));
        close(p(&[[3.0, 0.0], [0.0, 4.0]]), 5.0 / 7.0);
        close(p(&[[3.0, 0.0], [-1.0, 0.0]]), 0.5);
        close(p(&[[3.0, 0.0], [-1.0, 0.0], [0.0, 0.0]]), 0.5);
        close(p(&[[1.0, 0.0], [-1.0, 0.0]]), 0.0);
        assert_eq!(p(&[[0.0, 0.0], [1e-13, 0.0]]), None);
    }
}
