//! The rank sum test of Wilcoxon, Mann and Whitney.

use super::Method;
use crate::statistics::rank::ranked;
use crate::statistics::{StatisticsError, check, distribution};

/// The rank sum test, two-sided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MannWhitney {
    /// Pairs of a value of the first and a smaller one of the second sample; equal ones count half.
    pub u: f64,
    /// Probability of so uneven a count, or more so, if both samples had one distribution.
    pub p: f64,
    /// How p was found.
    pub method: Method,
}

/// With no more values than this in one sample, and no ties, the exact distribution is used.
const EXACT: usize = 8;

/// Do two independent samples come from one distribution, whatever it is?
///
/// Exact without ties where a sample has at most eight values, else normal with the corrections for ties and for
/// continuity (Mann & Whitney 1947): as `scipy.stats.mannwhitneyu` chooses.
///
/// # Errors
/// For an empty sample, a value that is not finite, or all values equal.
pub fn mann_whitney(first: &[f64], second: &[f64]) -> Result<MannWhitney, StatisticsError> {
    check::values("the first sample", first, 1)?;
    check::values("the second sample", second, 1)?;
    let (ranks, ties) = ranked(&[first, second].concat());
    let (a, b) = (first.len() as f64, second.len() as f64);
    let u = ranks[..first.len()].iter().sum::<f64>() - 0.5 * a * (a + 1.0);
    let greater = u.max(a * b - u);
    if ties == 0.0 && first.len().min(second.len()) <= EXACT {
        let p = 2.0 * share_at_most(first.len(), second.len(), (a * b - greater) as usize);
        return Ok(MannWhitney { u, p: p.min(1.0), method: Method::Exact });
    }
    let count = a + b;
    let variance = a * b / 12.0 * ((count + 1.0) - ties / (count * (count - 1.0)));
    if variance <= 0.0 {
        return Err(StatisticsError::NoSpread { what: "in both samples".into() });
    }
    let z = (greater - 0.5 * a * b - 0.5) / variance.sqrt();
    Ok(MannWhitney { u, p: (2.0 * distribution::normal_tail(z)).min(1.0), method: Method::Normal })
}

/// The share of all choices of `first` among `first + second` ranks with a count of at most `u`.
///
/// Ranks are given out from the highest down: the next one goes to the first sample with the probability (left in it) /
/// (left in both), and then counts those left in the second (after Mann & Whitney's recursion, as shares).
fn share_at_most(first: usize, second: usize, u: usize) -> f64 {
    let counts = first * second + 1;
    // for each number b of the second sample, shares of the counts; grown over the number a of the first
    let mut rows: Vec<Vec<f64>> = vec![vec![1.0]; second + 1];
    for a in 1..=first {
        let mut last: Vec<f64> = vec![1.0];
        for (b, row) in rows.iter_mut().enumerate() {
            let mut next = vec![0.0; (a * b + 1).min(counts)];
            if b == 0 {
                next[0] = 1.0;
            } else {
                let take = a as f64 / (a + b) as f64;
                for (count, share) in row.iter().enumerate() {
                    next[count + b] += take * share;
                }
                for (count, share) in last.iter().enumerate() {
                    next[count] += (1.0 - take) * share;
                }
            }
            last.clone_from(&next);
            *row = next;
        }
    }
    rows[second][..=u].iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // 2 and 2 values: six choices with the counts 0 1 2 2 3 4
        assert_eq!(mann_whitney(&[1.0, 2.0], &[3.0, 4.0]).unwrap().u, 0.0);
        let shares = [1.0, 2.0, 4.0, 5.0, 6.0].map(|x| x / 6.0);
        for (u, share) in shares.into_iter().enumerate() {
            assert!((share_at_most(2, 2, u) - share).abs() < 1e-15);
        }
        let test = mann_whitney(&[4.0, 3.0], &[1.0, 2.0]).unwrap();
        assert!((test.u, test.method) == (4.0, Method::Exact) && (test.p - 1.0 / 3.0).abs() < 1e-15);
        // ties: normal
        let ties = mann_whitney(&[1.0, 2.0, 2.0], &[2.0, 3.0]).unwrap();
        assert_eq!((ties.u, ties.method), (1.0, Method::Normal));
        // many against few stay exact and finite
        let many: Vec<f64> = (0..3000).map(f64::from).collect();
        assert!((mann_whitney(&[-1.0], &many).unwrap().p - 2.0 / 3001.0).abs() < 1e-14);
    }

    #[test]
    fn bad_input() {
        assert!(mann_whitney(&[], &[1.0]).is_err());
        assert!(mann_whitney(&[1.0, 1.0], &[1.0]).is_err());
        assert!(mann_whitney(&[f64::INFINITY], &[1.0]).is_err());
    }
}
