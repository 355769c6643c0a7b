//! How much members head the same way: the length of the mean heading, whatever their speeds.
//!
//! T. Vicsek, A. Czirok, E. Ben-Jacob, I. Cohen, O. Shochet (1995), Physical Review Letters 75:1226 (order parameter);
//! I. D. Couzin, J. Krause, R. James, G. D. Ruxton, N. R. Franks (2002), Journal of Theoretical Biology 218:1 (group
//! polarisation).

use crate::sample::mean_vector;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `polarisation`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Polarisation;

impl Metric for Polarisation {
    const CARD: MetricCard = MetricCard {
        id: "polarisation",
        title: "Polarisation",
        symbol: "P",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "|mean_i h_i|,  h_i = v_i/|v_i|,  over members with a heading",
        variant: "of headings: every moving member counts alike",
        source: "Vicsek et al. 1995 (order parameter); Couzin et al. 2002 (group polarisation)",
        counted: Counted::Headings,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "1", at_rest: "undefined" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean_vector(sample.headings().map(|(_, heading)| heading)).map(Vector::length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, moving};

    #[test]
    fn closed_forms() {
        let p = |velocities: &[[f64; 2]]| Polarisation.on(&moving(velocities));
        close(p(&[[1.0, 0.0], [0.2, 0.0]]), 1.0);
        close(p(&[[1.0, 0.0], [0.0, 3.0]]), 0.5f64.sqrt());
        close(p(&[[1.0, 0.0], [-5.0, 0.0]]), 0.0);
        let third = |k: f64| [(k * 120f64).to_radians().cos(), (k * 120f64).to_radians().sin()];
        close(p(&[third(0.0), third(1.0), third(2.0)]), 0.0);
    }

    #[test]
    fn members_at_rest_or_of_unknown_velocity_are_left_out() {
        let sample = moving(&[[1.0, 0.0], [0.0, 0.0], [0.0, f64::NAN], [0.0, 2.0]]);
        close(Polarisation.on(&sample), 0.5f64.sqrt());
        assert_eq!(sample.count(Counted::Headings), 2);
        assert_eq!(Polarisation.on(&moving(&[[0.0, 0.0], [0.0, 1e-13]])), None);
    }
}
