//! Roulette wheel: a spin for each parent.

use super::{Selection, pointed, wheel};
use crate::Draws;

/// Each parent by a spin of its own, with a chance in proportion to its score.
///
/// Scores are shifted by their minimum where any is negative.
#[derive(Clone, Copy, Debug, Default)]
pub struct Roulette;

impl Selection for Roulette {
    fn pick(&self, scores: &[f64], count: usize, draws: &Draws) -> Vec<usize> {
        let wheel = wheel(scores);
        (0..count as u64).map(|parent| pointed(&wheel, draws.uniform(parent, 0))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{close, shares};
    use super::*;

    #[test]
    fn chances_are_in_proportion() {
        close(&shares(&Roulette, &[1.0, 2.0, 5.0]), &[0.125, 0.25, 0.625]);
        close(&shares(&Roulette, &[-1.0, 0.0, 1.0]), &[0.0, 1.0 / 3.0, 2.0 / 3.0]);
    }
}
