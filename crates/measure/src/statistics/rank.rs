//! Ranks.

use super::{StatisticsError, check};

/// The ranks of values, from 1; equal values share the mean of their ranks (`scipy.stats.rankdata`).
///
/// # Errors
/// Where a value is not finite.
pub fn ranks(values: &[f64]) -> Result<Vec<f64>, StatisticsError> {
    check::finite("the sample", values)?;
    Ok(ranked(values).0)
}

/// The ranks of finite values, and the sum of t^3 - t over runs of t equal values.
pub(super) fn ranked(values: &[f64]) -> (Vec<f64>, f64) {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let (mut ties, mut first) = (0.0, 0);
    // -0 and 0 are the same value
    for run in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let size = run.len() as f64;
        for &place in run {
            ranks[place] = first as f64 + 0.5 * (size + 1.0);
        }
        ties += size * (size * size - 1.0);
        first += run.len();
    }
    (ranks, ties)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_share() {
        assert_eq!(ranked(&[3.0, 1.0, 3.0, 2.0, 3.0]), (vec![4.0, 1.0, 4.0, 2.0, 4.0], 24.0));
        assert_eq!(ranks(&[0.0, -0.0]), Ok(vec![1.5, 1.5]));
        assert_eq!(ranks(&[]), Ok(vec![]));
        assert!(ranks(&[f64::NAN]).is_err());
    }
}
