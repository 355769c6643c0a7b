//! All pairs by ranks.

use super::{letters, pairs_below};
use crate::statistics::anova::kruskal_wallis;
use crate::statistics::multiple::{Correction, adjusted};
use crate::statistics::rank::ranked;
use crate::statistics::{StatisticsError, check, distribution};

/// Two groups compared by their mean ranks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RankPair {
    /// Place of the first group.
    pub first: usize,
    /// Place of the second group.
    pub second: usize,
    /// Mean rank of the first less that of the second.
    pub difference: f64,
    /// The difference over its standard error.
    pub z: f64,
    /// P(|Z| > |z|), of this pair alone.
    pub p: f64,
    /// The same, corrected for all pairs.
    pub adjusted: f64,
}

/// All pairs compared by ranks.
#[derive(Clone, Debug, PartialEq)]
pub struct RankComparison {
    /// Every pair: (0, 1), (0, 2), ... (1, 2), ...
    pub pairs: Vec<RankPair>,
    /// For each group the letters it shares with those it does not differ from at the level given.
    pub letters: Vec<String>,
}

/// Which pairs of groups differ in their ranks, after [`kruskal_wallis`]?
///
/// z = (R_i - R_j) / sqrt((n (n + 1) - sum(t^3 - t) / (n - 1)) / 12 (1 / n_i + 1 / n_j)) with the mean ranks R of the common
/// ranking (Dunn 1964, Technometrics 6:241), p corrected for the number of pairs.
///
/// # Errors
/// As [`kruskal_wallis`], or for a level outside 0 and 1.
pub fn dunn(groups: &[&[f64]], correction: Correction, level: f64) -> Result<RankComparison, StatisticsError> {
    check::between_0_and_1("the level", level)?;
    let mean_ranks = kruskal_wallis(groups)?.mean_ranks;
    let (_, ties) = ranked(&groups.concat());
    let count = groups.iter().map(|group| group.len()).sum::<usize>() as f64;
    let variance = (count * (count + 1.0) - ties / (count - 1.0)) / 12.0;
    let size = |group: usize| groups[group].len() as f64;
    let mut pairs: Vec<RankPair> = pairs_below(groups.len())
        .map(|(first, second)| {
            let difference = mean_ranks[first] - mean_ranks[second];
            let z = difference / (variance * (1.0 / size(first) + 1.0 / size(second))).sqrt();
            let p = (2.0 * distribution::normal_tail(z.abs())).min(1.0);
            RankPair { first, second, difference, z, p, adjusted: p }
        })
        .collect();
    let corrected = adjusted(&pairs.iter().map(|pair| pair.p).collect::<Vec<_>>(), correction);
    pairs.iter_mut().zip(corrected).for_each(|(pair, p)| pair.adjusted = p);
    let different = |a: usize, b: usize| {
        let pair = pairs.iter().find(|pair| (pair.first, pair.second) == (a.min(b), a.max(b)));
        pair.is_some_and(|pair| pair.adjusted <= level)
    };
    let letters = letters(&mean_ranks, different);
    Ok(RankComparison { pairs, letters })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_groups_are_kruskal_wallis() {
        let groups: [&[f64]; 2] = [&[1.0, 2.0, 2.0, 5.0], &[2.0, 7.0, 8.0]];
        let (pair, test) = (dunn(&groups, Correction::Holm, 0.05).unwrap().pairs[0], kruskal_wallis(&groups).unwrap());
        assert!((pair.z * pair.z - test.h).abs() < 1e-12 && (pair.p - test.p).abs() < 1e-12);
        assert_eq!(pair.p, pair.adjusted);
        // the broken twin without ties
        let twin = pair.difference / (7.0 * 8.0 / 12.0 * (1.0 / 4.0 + 1.0 / 3.0f64)).sqrt();
        assert!((twin - pair.z).abs() > 0.01);
    }
}
