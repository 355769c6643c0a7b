//! Tournament: the best of a few.

use super::Selection;
use crate::Draws;

/// The best of `size` candidates drawn at random with repetition; of equals the one drawn first.
#[derive(Clone, Copy, Debug)]
pub struct Tournament {
    /// How many are drawn.
    pub size: usize,
}

impl Default for Tournament {
    fn default() -> Self {
        Self { size: 2 }
    }
}

impl Selection for Tournament {
    fn pick(&self, scores: &[f64], count: usize, draws: &Draws) -> Vec<usize> {
        let size = self.size.max(1) as u64;
        let winner = |parent: u64| {
            let mut best = draws.below(scores.len(), parent * size, 0);
            for entrant in 1..size {
                let other = draws.below(scores.len(), parent * size + entrant, 0);
                if scores[other] > scores[best] {
                    best = other;
                }
            }
            best
        };
        (0..count as u64).map(winner).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{close, shares};
    use super::*;

    #[test]
    fn chances_follow_from_the_order_alone() {
        // the best wins unless it is not drawn: 1 - (2/3)^2
        close(&shares(&Tournament::default(), &[1.0, 2.0, 500.0]), &[1.0 / 9.0, 3.0 / 9.0, 5.0 / 9.0]);
        close(&shares(&Tournament { size: 1 }, &[1.0, 2.0]), &[0.5, 0.5]);
    }
}
