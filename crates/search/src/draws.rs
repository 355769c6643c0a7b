//! The random numbers of a search.

use space::random::{Purpose, child_seed, normal, uniform};

/// Random numbers of one generation (or round) of a search: functions of what they are for.
///
/// The key of a generation is derived from the seed by its number. In it `U(key, search, a, b)` is drawn with `a` the
/// offspring (or whatever is counted) and `b` the slot: 0 to 15 for selection, crossover and mutation, 16 and on one for
/// each gene.
#[derive(Clone, Copy, Debug)]
pub struct Draws {
    key: u64,
}

/// What a child key is derived for.
const GENERATION: u32 = 1;

/// First of the slots that belong to single genes.
pub(crate) const GENES: u32 = 16;

impl Draws {
    /// The draws of a generation.
    pub fn new(seed: u64, generation: u64) -> Self {
        Self { key: child_seed(seed, GENERATION, generation, 0) }
    }
    /// Uniform in [0, 1).
    pub fn uniform(&self, of: u64, slot: u32) -> f64 {
        uniform(self.key, Purpose::Search, of, slot)
    }
    /// Standard normal, from `slot` and `slot + 1`.
    pub fn normal(&self, of: u64, slot: u32) -> f64 {
        normal(self.uniform(of, slot), self.uniform(of, slot + 1))
    }
    /// A whole number below `count`, which must not be zero.
    pub fn below(&self, count: usize, of: u64, slot: u32) -> usize {
        place(self.uniform(of, slot), count)
    }
}

/// The place of a uniform number among `count` equal parts of [0, 1).
pub(crate) fn place(uniform: f64, count: usize) -> usize {
    ((uniform * count as f64) as usize).min(count.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_spread_evenly_and_stay_inside() {
        assert_eq!([place(0.0, 3), place(0.34, 3), place(0.999, 3), place(1.0 - f64::EPSILON / 2.0, 3)], [0, 1, 2, 2]);
        let draws = Draws::new(3, 8);
        let mut counts = [0; 4];
        for k in 0..4000 {
            counts[draws.below(4, k, 0)] += 1;
        }
        assert!(counts.iter().all(|&count| (900..1100).contains(&count)), "{counts:?}");
    }

    #[test]
    fn generations_differ_and_repeat() {
        let [first, again, next] = [Draws::new(3, 8), Draws::new(3, 8), Draws::new(3, 9)];
        assert_eq!(first.uniform(1, 2), again.uniform(1, 2));
        assert_ne!(first.uniform(1, 2), next.uniform(1, 2));
        assert_ne!(first.uniform(1, 2), first.uniform(2, 2));
    }
}
