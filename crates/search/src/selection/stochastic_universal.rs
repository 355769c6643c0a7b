//! Stochastic universal sampling: one spin for all parents.

use super::{Selection, pointed, wheel};
use crate::Draws;
use crate::draws::place;

/// All parents by one turn of a wheel with evenly spaced pointers, so that each is picked its expected number of times,
/// rounded up or down.
///
/// The parents are then shuffled: in the order of the wheel neighbours would nearly always meet themselves.
#[derive(Clone, Copy, Debug, Default)]
pub struct StochasticUniversal;

impl Selection for StochasticUniversal {
    fn pick(&self, scores: &[f64], count: usize, draws: &Draws) -> Vec<usize> {
        let wheel = wheel(scores);
        let first = draws.uniform(0, 0);
        let mut parents: Vec<usize> =
            (0..count).map(|pointer| pointed(&wheel, (pointer as f64 + first) / count as f64)).collect();
        for last in (1..count).rev() {
            parents.swap(last, place(draws.uniform(last as u64, 1), last + 1));
        }
        parents
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{close, shares};
    use super::*;

    #[test]
    fn each_is_picked_its_expected_number_of_times() {
        for generation in 0..50 {
            let picked = StochasticUniversal.pick(&[1.0, 2.0, 5.0], 16, &Draws::new(9, generation));
            let count = |candidate| picked.iter().filter(|&&p| p == candidate).count();
            assert_eq!([count(0), count(1), count(2)], [2, 4, 10]);
        }
        close(&shares(&StochasticUniversal, &[1.0, 2.0, 5.0]), &[0.125, 0.25, 0.625]);
    }

    #[test]
    fn parents_are_shuffled() {
        let first = |generation| StochasticUniversal.pick(&[1.0, 1.0], 2, &Draws::new(9, generation))[0];
        let zeros = (0..400).filter(|&generation| first(generation) == 0).count();
        assert!((150..250).contains(&zeros), "{zeros}");
    }
}
