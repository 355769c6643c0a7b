//! What behaviours are built of: groups and their balance, conditions that last, shares of members.

use space::{Real, Vector};

/// Entropy of the shares of groups by their sizes, `H = -sum p ln p`. `None` without members.
pub fn entropy(sizes: &[usize]) -> Option<f64> {
    let members: usize = sizes.iter().sum();
    let shares = sizes.iter().filter(|&&size| size > 0).map(|&size| size as f64 / members as f64);
    (members > 0).then(|| shares.map(|p| -p * Real::ln(p)).sum::<f64>().max(0.0))
}

/// Entropy of the shares of groups over that of equal shares, `H / ln g`; 0 for fewer than two groups.
pub fn entropy_ratio(sizes: &[usize]) -> f64 {
    let groups = sizes.iter().filter(|&&size| size > 0).count();
    entropy(sizes).filter(|_| groups > 1).map_or(0.0, |entropy| entropy / Real::ln(groups as f64))
}

/// Whether there are at least two groups, with an [`entropy_ratio`] of at least `fraction`.
pub fn is_balanced(sizes: &[usize], fraction: f64) -> bool {
    sizes.iter().filter(|&&size| size > 0).count() > 1 && entropy_ratio(sizes) >= fraction
}

/// Whether this many of all is at least the share. Nobody has no share.
pub fn has_share(count: usize, all: usize, share: f64) -> bool {
    all > 0 && count as f64 / all as f64 >= share
}

/// Standard deviation with the divisor n - 1; `None` of fewer than two numbers.
pub fn sample_deviation(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    if values.len() < 2 {
        return None;
    }
    // from differences to the first, so that equal numbers have exactly none
    let first = values[0];
    let mean = values.iter().map(|value| value - first).sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - first - mean) * (value - first - mean)).sum();
    Some((squares / (n - 1.0)).sqrt())
}

/// The middle of points; `None` of no points.
pub fn centroid(points: &[Vector<f64, 2>]) -> Option<Vector<f64, 2>> {
    let sum = points.iter().fold(Vector::ZERO, |sum, &p| sum + p);
    (!points.is_empty()).then(|| sum / points.len() as f64)
}

/// Counts steps of a condition in a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Run {
    /// Steps in a row, up to now.
    pub length: u64,
}

impl Run {
    /// Takes the next step; whether the condition has now held in `steps` steps in a row.
    pub fn sustained(&mut self, holds: bool, steps: u64) -> bool {
        self.length = if holds { self.length + 1 } else { 0 };
        self.length >= steps
    }
}

/// The first step, from 0, that completes `steps` steps in a row of a condition within the first `horizon` steps. The
/// condition is given as runs: what it is, and for how many steps.
pub fn sustained(runs: &[(bool, u64)], steps: u64, horizon: u64) -> Option<u64> {
    let (mut passed, mut row) = (0u64, 0u64);
    for &(holds, length) in runs {
        if !holds {
            row = if length > 0 { 0 } else { row };
        } else if row.saturating_add(length) >= steps && length > 0 {
            let completing = passed + steps.saturating_sub(row).max(1) - 1;
            return (completing < horizon).then_some(completing);
        } else {
            row += length;
        }
        passed = passed.saturating_add(length);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balance_as_worked_out() {
        assert_eq!([entropy_ratio(&[25]), entropy_ratio(&[]), entropy_ratio(&[25, 0])], [0.0; 3]);
        assert!((entropy_ratio(&[23, 2]) - 0.402).abs() < 5e-4 && (entropy_ratio(&[24, 1]) - 0.242).abs() < 5e-4);
        assert_eq!(entropy_ratio(&[5, 5]), 1.0);
        assert!(is_balanced(&[23, 2], 0.3) && !is_balanced(&[24, 1], 0.3) && !is_balanced(&[25], 0.0));
    }

    #[test]
    fn conditions_that_last() {
        assert_eq!(sustained(&[(false, 40), (true, 50), (false, 110)], 50, 200), Some(89));
        assert_eq!(sustained(&[(false, 40), (true, 49), (false, 1), (true, 200)], 50, 200), Some(139));
        assert_eq!(sustained(&[(false, 151), (true, 49)], 50, 200), None);
        assert_eq!(sustained(&[(false, 150), (true, 50)], 50, 200), Some(199));
        assert_eq!(sustained(&[(false, 151), (true, 500)], 50, 200), None, "completed too late");
        assert_eq!(sustained(&[(true, 20), (true, 30)], 50, 200), Some(49), "runs in a row are one");
        assert_eq!(sustained(&[(true, 20), (false, 0), (true, 30)], 50, 200), Some(49));
        assert_eq!(sustained(&[], 1, 10), None);
        // the same, step by step
        for start in 0..4 {
            let steps: Vec<bool> = (0..12).map(|k| k >= start && k % 5 != 4).collect();
            let mut run = Run::default();
            let by_step = steps.iter().position(|&holds| run.sustained(holds, 3)).map(|k| k as u64);
            let runs: Vec<(bool, u64)> = steps.iter().map(|&holds| (holds, 1)).collect();
            assert_eq!(sustained(&runs, 3, 12), by_step);
        }
    }

    #[test]
    fn shares_and_deviations() {
        assert!(has_share(9, 10, 0.9) && has_share(27, 30, 0.9) && !has_share(6, 7, 0.9) && !has_share(0, 0, 0.0));
        let ten: Vec<f64> = (0..10).map(f64::from).collect();
        assert_eq!(sample_deviation(&ten), Some(3.027_650_354_097_491_7));
        assert_eq!([sample_deviation(&[1.0]), sample_deviation(&[])], [None, None]);
        assert_eq!(sample_deviation(&[0.1; 7]), Some(0.0));
        assert_eq!(centroid(&[]), None);
    }
}
