//! Creep: a small step up or down.

use super::{Mutation, VALUE};
use crate::{Axis, Draws};

/// A normal step with a standard deviation of `share` times the reference of the gene; where that is zero, of its range.
#[derive(Clone, Copy, Debug)]
pub struct Creep {
    /// Standard deviation as a share of the reference.
    pub share: f64,
}

impl Default for Creep {
    fn default() -> Self {
        Self { share: 0.2 }
    }
}

impl Mutation for Creep {
    fn change(&self, value: f64, axis: &Axis, offspring: u64, draws: &Draws) -> f64 {
        let scale = if axis.reference == 0.0 { axis.high - axis.low } else { axis.reference.abs() };
        value + self.share * scale * draws.normal(offspring, VALUE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_have_the_stated_deviation() {
        let deviation = |axis: Axis| {
            let steps: Vec<f64> =
                (0..4000).map(|k| Creep::default().change(3.0, &axis, k, &Draws::new(6, 1)) - 3.0).collect();
            let mean = steps.iter().sum::<f64>() / 4000.0;
            assert!(mean.abs() < 0.2);
            (steps.iter().map(|step| step * step).sum::<f64>() / 4000.0).sqrt()
        };
        assert!((deviation(Axis::new(0.0, 100.0).about(10.0)) - 2.0).abs() < 0.1);
        assert!(
            (deviation(Axis::new(-5.0, 5.0).about(0.0)) - 2.0).abs() < 0.1,
            "the range where there is no reference"
        );
    }
}
