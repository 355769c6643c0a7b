//! Comparisons of all pairs of groups after an analysis of variance, one file each.

mod dunn;
mod games_howell;
mod letters;
mod tukey_kramer;

pub use dunn::{RankComparison, RankPair, dunn};
pub use games_howell::games_howell;
pub use letters::letters;
pub use tukey_kramer::tukey_kramer;

/// Two groups compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Place of the first group.
    pub first: usize,
    /// Place of the second group.
    pub second: usize,
    /// Mean of the first less mean of the second.
    pub difference: f64,
    /// The test statistic: q of the studentised range.
    pub statistic: f64,
    /// Degrees of freedom of the statistic.
    pub degrees: f64,
    /// Probability of so large a statistic for any pair, if all means were equal.
    pub p: f64,
    /// Lower end of the simultaneous confidence interval of the difference.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// All pairs compared.
#[derive(Clone, Debug, PartialEq)]
pub struct PairComparison {
    /// Every pair: (0, 1), (0, 2), ... (1, 2), ...
    pub pairs: Vec<Pair>,
    /// For each group the letters it shares with those it does not differ from, see [`letters()`].
    pub letters: Vec<String>,
    /// The share of such sets of intervals that hold all true differences.
    pub confidence: f64,
}

impl PairComparison {
    /// With the letters that follow from the pairs; groups with the higher means come first in the alphabet.
    fn new(means: &[f64], pairs: Vec<Pair>, confidence: f64) -> Self {
        let different = |a: usize, b: usize| {
            pairs.iter().any(|pair| {
                (pair.first, pair.second) == (a.min(b), a.max(b)) && pair.p <= 1.0 - confidence + 4.0 * f64::EPSILON
            })
        };
        let letters = letters(means, different);
        Self { pairs, letters, confidence }
    }
    /// The comparison of two groups, in either order of their places.
    pub fn pair(&self, a: usize, b: usize) -> Option<&Pair> {
        self.pairs.iter().find(|pair| (pair.first, pair.second) == (a.min(b), a.max(b)))
    }
}

/// Every pair of places below a number, in the order of [`PairComparison::pairs`].
fn pairs_below(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |first| (first + 1..count).map(move |second| (first, second)))
}
