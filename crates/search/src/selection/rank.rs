//! Linear rank: chances by order, not by size of the score.

use super::{Selection, pointed, wheel};
use crate::Draws;

/// Each parent with a chance in proportion to its rank, the worst having rank 1. Equals share the mean of their ranks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rank;

impl Selection for Rank {
    fn pick(&self, scores: &[f64], count: usize, draws: &Draws) -> Vec<usize> {
        let rank = |&score: &f64| {
            let below = scores.iter().filter(|&&other| other < score).count();
            let equal = scores.iter().filter(|&&other| other == score).count();
            below as f64 + (equal as f64 + 1.0) / 2.0
        };
        let wheel = wheel(&scores.iter().map(rank).collect::<Vec<_>>());
        (0..count as u64).map(|parent| pointed(&wheel, draws.uniform(parent, 0))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{close, shares};
    use super::*;

    #[test]
    fn chances_are_in_proportion_to_the_rank() {
        close(&shares(&Rank, &[-7.0, 0.1, 1e9]), &[1.0 / 6.0, 2.0 / 6.0, 3.0 / 6.0]);
        close(&shares(&Rank, &[4.0, 4.0, 9.0]), &[0.25, 0.25, 0.5]);
    }
}
