//! Confidence intervals of means and of shares.

use super::descriptive::centre;
use super::{StatisticsError, check, distribution};

/// A confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Student's interval of a mean. Assumes normal values, or many.
///
/// # Errors
/// For fewer than two values, one that is not finite, values too large for their squares, or a confidence outside 0 and 1.
/// Equal values give an interval of width zero.
pub fn mean_interval(values: &[f64], confidence: f64) -> Result<Interval, StatisticsError> {
    check::between_0_and_1("the confidence", confidence)?;
    let error = (super::variance(values)? / values.len() as f64).sqrt();
    let half = distribution::t_two_sided_quantile(confidence, (values.len() - 1) as f64) * error;
    let mean = centre(values);
    Ok(Interval { low: mean - half, high: mean + half })
}

/// Wilson's interval of a share of successes (1927, J. Am. Stat. Assoc. 22:209), without correction for continuity: its
/// mean coverage is near the confidence even for few trials (statsmodels `proportion_confint(method="wilson")`).
///
/// # Errors
/// For no trial, more successes than trials, or a confidence outside 0 and 1.
pub fn wilson(successes: u64, trials: u64, confidence: f64) -> Result<Interval, StatisticsError> {
    share(successes, trials, confidence)?;
    let (n, p) = (trials as f64, successes as f64 / trials as f64);
    let z = -distribution::normal_quantile(0.5 * (1.0 - confidence));
    let z2 = z * z / n;
    let centre = (p + 0.5 * z2) / (1.0 + z2);
    let half = z / (1.0 + z2) * (p * (1.0 - p) / n + 0.25 * z2 / n).sqrt();
    // exactly 0 and 1 at the ends, where rounding would leave a trace
    let low = if successes == 0 { 0.0 } else { (centre - half).max(0.0) };
    let high = if successes == trials { 1.0 } else { (centre + half).min(1.0) };
    Ok(Interval { low, high })
}

/// The interval of Clopper and Pearson (1934), from binomial tails: its coverage is never less than the confidence
/// (statsmodels `proportion_confint(method="beta")`).
///
/// # Errors
/// As [`wilson`].
pub fn clopper_pearson(successes: u64, trials: u64, confidence: f64) -> Result<Interval, StatisticsError> {
    share(successes, trials, confidence)?;
    let (yes, no) = (successes as f64, (trials - successes) as f64);
    let outside = 0.5 * (1.0 - confidence);
    let low = if successes == 0 { 0.0 } else { distribution::beta_quantile(outside, yes, no + 1.0) };
    let high = if successes == trials { 1.0 } else { 1.0 - distribution::beta_quantile(outside, no, yes + 1.0) };
    Ok(Interval { low, high })
}

fn share(successes: u64, trials: u64, confidence: f64) -> Result<(), StatisticsError> {
    check::at_least("trials", 1, usize::try_from(trials).unwrap_or(usize::MAX))?;
    check::in_range("the number of successes", "at most the number of trials", successes as f64, successes <= trials)?;
    check::between_0_and_1("the confidence", confidence)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms() {
        // no success in n: Wilson's upper end is z^2 / (n + z^2), Clopper and Pearson's 1 - (alpha / 2)^(1 / n)
        let z = -distribution::normal_quantile(0.025);
        let ours = wilson(0, 10, 0.95).unwrap();
        assert!(ours.low == 0.0 && (ours.high - z * z / (10.0 + z * z)).abs() < 1e-15);
        let exact = clopper_pearson(0, 10, 0.95).unwrap();
        assert!(exact.low == 0.0 && (exact.high - (1.0 - 0.025f64.powf(0.1))).abs() < 1e-14);
        // mirrored
        let (a, b) = (wilson(3, 10, 0.9).unwrap(), wilson(7, 10, 0.9).unwrap());
        assert!((a.low - (1.0 - b.high)).abs() < 1e-15);
        assert_eq!(wilson(10, 10, 0.95).unwrap().high, 1.0);
        // the broken twin of Wald is empty at the end
        assert!(ours.high > 0.2);
        let mean = mean_interval(&[1.0, 2.0, 3.0], 0.5).unwrap();
        // two degrees: the quartile is sqrt(2 / 3)
        assert!((mean.high - 2.0 - (2.0 / 3.0f64).sqrt() / 3f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn many_trials_and_bad_input() {
        let many = clopper_pearson(300_000, 1_000_000, 0.95).unwrap();
        let normal = wilson(300_000, 1_000_000, 0.95).unwrap();
        assert!((many.low - normal.low).abs() < 1e-5 && (many.high - normal.high).abs() < 1e-5);
        assert!(wilson(0, 0, 0.95).is_err() && wilson(3, 2, 0.95).is_err() && wilson(1, 2, 1.0).is_err());
        assert!(mean_interval(&[1.0], 0.95).is_err());
        assert_eq!(mean_interval(&[1.0, 1.0], 0.95), Ok(Interval { low: 1.0, high: 1.0 }));
    }
}
