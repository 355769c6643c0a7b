//! Reset: a gene drawn anew.

use super::{Mutation, VALUE};
use crate::{Axis, Draws};

/// A value drawn anew, uniform between the bounds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reset;

impl Mutation for Reset {
    fn change(&self, _: f64, axis: &Axis, offspring: u64, draws: &Draws) -> f64 {
        axis.at(draws.uniform(offspring, VALUE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_fill_the_range() {
        let axis = Axis::new(-2.0, 6.0);
        let values: Vec<f64> = (0..2000).map(|k| Reset.change(0.0, &axis, k, &Draws::new(6, 1))).collect();
        let mean = values.iter().sum::<f64>() / 2000.0;
        assert!((mean - 2.0).abs() < 0.2, "{mean}");
        assert!(values.iter().any(|&v| v < -1.9) && values.iter().any(|&v| v > 5.9));
    }
}
