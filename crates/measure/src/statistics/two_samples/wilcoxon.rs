//! Wilcoxon's signed ranks.

use super::Method;
use crate::statistics::rank::ranked;
use crate::statistics::{StatisticsError, check, distribution};

/// Wilcoxon's test of pairs, two-sided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wilcoxon {
    /// Sum of the ranks of positive differences.
    pub positive: f64,
    /// Sum of the ranks of negative differences.
    pub negative: f64,
    /// Pairs that differ.
    pub differing: usize,
    /// Probability of so uneven sums, or more so, if differences were symmetric about zero.
    pub p: f64,
    /// How p was found.
    pub method: Method,
}

/// Up to this many pairs without ties the exact distribution is used.
const EXACT: usize = 50;

/// Are differences in pairs symmetric about zero?
///
/// Pairs without a difference are left out (Wilcoxon 1945). Exact for up to 50 pairs without ties among the absolute
/// differences and without zeros, else normal with the correction for ties and without one for continuity: the same as
/// `scipy.stats.wilcoxon` with `method` "exact" and "asymptotic".
///
/// # Errors
/// For samples of different length, no pair that differs, a value that is not finite, or differences too large for f64.
pub fn wilcoxon(first: &[f64], second: &[f64]) -> Result<Wilcoxon, StatisticsError> {
    let all = check::differences(first, second, 1)?;
    let (differences, positive, negative, ties) = signed_ranks(&all);
    if differences == 0 {
        return Err(StatisticsError::NoSpread { what: "within the pairs".into() });
    }
    let exact = ties == 0.0 && differences == all.len() && differences <= EXACT;
    let least = positive.min(negative);
    let count = differences as f64;
    let (p, method) = if exact {
        (2.0 * share_at_most(differences, least as usize), Method::Exact)
    } else {
        let variance = count * (count + 1.0) * (2.0 * count + 1.0) / 24.0 - ties / 48.0;
        let z = (count * (count + 1.0) / 4.0 - least) / variance.sqrt();
        (2.0 * distribution::normal_tail(z), Method::Normal)
    };
    Ok(Wilcoxon { positive, negative, differing: differences, p: p.min(1.0), method })
}

/// How many differences are not zero, the sums of the ranks of the positive and of the negative, and the ties.
pub(in crate::statistics) fn signed_ranks(differences: &[f64]) -> (usize, f64, f64, f64) {
    let differing: Vec<f64> = differences.iter().copied().filter(|&difference| difference != 0.0).collect();
    let (ranks, ties) = ranked(&differing.iter().map(|difference| difference.abs()).collect::<Vec<_>>());
    let sum = |positive: bool| {
        let chosen = ranks.iter().zip(&differing).filter(|(_, difference)| (**difference > 0.0) == positive);
        chosen.map(|(rank, _)| rank).sum::<f64>()
    };
    (differing.len(), sum(true), sum(false), ties)
}

/// The share of all signs of the ranks 1 to `count` whose positive ranks sum to at most `sum`.
fn share_at_most(count: usize, sum: usize) -> f64 {
    let mut shares = vec![0.0; count * (count + 1) / 2 + 1];
    shares[0] = 1.0;
    for rank in 1..=count {
        for total in (0..shares.len()).rev() {
            let with = if total >= rank { shares[total - rank] } else { 0.0 };
            shares[total] = 0.5 * (shares[total] + with);
        }
    }
    shares[..=sum].iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // differences 1 2 3 -4: negative 4 of 10; sums of at most 4 in 7 of 16 signs
        let test = wilcoxon(&[1.0, 2.0, 3.0, 0.0], &[0.0, 0.0, 0.0, 4.0]).unwrap();
        assert_eq!((test.positive, test.negative, test.method), (6.0, 4.0, Method::Exact));
        assert_eq!(test.p, 14.0 / 16.0);
        let all = wilcoxon(&[1.0, 2.0, 3.0, 4.0, 5.0], &[0.0; 5]).unwrap();
        assert_eq!(all.p, 2.0 / 32.0);
    }

    #[test]
    fn little_and_bad_input() {
        assert_eq!(wilcoxon(&[1.0], &[0.0]).unwrap().p, 1.0);
        assert_eq!(wilcoxon(&[1.0, 1.0], &[0.0, 1.0]).unwrap().method, Method::Normal);
        assert!(wilcoxon(&[1.0, 2.0], &[1.0, 2.0]).is_err());
        assert!(wilcoxon(&[], &[]).is_err());
        assert!(wilcoxon(&[f64::NAN], &[1.0]).is_err());
    }
}
