//! Student's t and Welch's.

use crate::statistics::descriptive::centre;
use crate::statistics::{StatisticsError, check, distribution};

/// A t test, two-sided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TTest {
    /// Mean of the first sample less that of the second (or less the number compared with).
    pub difference: f64,
    /// The difference over its standard error.
    pub t: f64,
    /// Degrees of freedom.
    pub degrees: f64,
    /// P(|T| > |t|) if the means were equal.
    pub p: f64,
    /// Lower end of the confidence interval of the difference.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl TTest {
    /// From a difference, its variance, and their degrees of freedom.
    fn new(difference: f64, variance: f64, degrees: f64, confidence: f64) -> Result<Self, StatisticsError> {
        let error = variance.sqrt();
        let t = check::not_overflown("t", difference / error)?;
        let half = distribution::t_two_sided_quantile(confidence, degrees) * error;
        let p = distribution::t_two_sided(t, degrees);
        Ok(Self { difference, t, degrees, p, low: difference - half, high: difference + half })
    }
}

/// Do two independent samples have one mean? Student's t with pooled variance (`scipy.stats.ttest_ind`).
///
/// Assumes normal values of equal variance.
///
/// # Errors
/// For an empty sample, fewer than three values in both, a value that is not finite, no spread within the samples, values
/// too large for their squares, or a confidence outside 0 and 1.
pub fn t_test(first: &[f64], second: &[f64], confidence: f64) -> Result<TTest, StatisticsError> {
    check::between_0_and_1("the confidence", confidence)?;
    let pooled = check::pooled_variance(first, second)?;
    let degrees = (first.len() + second.len() - 2) as f64;
    let variance = pooled * (1.0 / first.len() as f64 + 1.0 / second.len() as f64);
    TTest::new(centre(first) - centre(second), variance, degrees, confidence)
}

/// Do two independent samples have one mean, whatever their variances? Welch's t (1947; `scipy.stats.ttest_ind` with
/// `equal_var=False`).
///
/// # Errors
/// For fewer than two values in a sample, a value that is not finite, no spread in a sample, values too large for
/// their squares, or a confidence outside 0 and 1.
pub fn welch_t_test(first: &[f64], second: &[f64], confidence: f64) -> Result<TTest, StatisticsError> {
    check::between_0_and_1("the confidence", confidence)?;
    check::values("the first sample", first, 2)?;
    check::values("the second sample", second, 2)?;
    let a = check::spread_of("in the first sample", first)? / first.len() as f64;
    let b = check::spread_of("in the second sample", second)? / second.len() as f64;
    let degrees = welch_degrees(a, first.len(), b, second.len());
    TTest::new(centre(first) - centre(second), a + b, degrees, confidence)
}

/// Do pairs of values differ in their mean? (`scipy.stats.ttest_rel`.) Assumes normal differences.
///
/// # Errors
/// For samples of different length, fewer than two pairs, a value that is not finite, differences that are all equal or
/// too large for their squares, or a confidence outside 0 and 1.
pub fn paired_t_test(first: &[f64], second: &[f64], confidence: f64) -> Result<TTest, StatisticsError> {
    let differences = check::differences(first, second, 2)?;
    one_sample_t_test(&differences, 0.0, confidence)
}

/// Does a sample have this mean? (`scipy.stats.ttest_1samp`.) Assumes normal values.
///
/// # Errors
/// For fewer than two values, one that is not finite, values that are all equal or too large for their squares, or a
/// confidence outside 0 and 1.
pub fn one_sample_t_test(values: &[f64], mean: f64, confidence: f64) -> Result<TTest, StatisticsError> {
    check::between_0_and_1("the confidence", confidence)?;
    check::values("the sample", values, 2)?;
    check::in_range("the mean to compare with", "finite", mean, mean.is_finite())?;
    let count = values.len() as f64;
    let variance = check::spread_of("in the sample", values)? / count;
    TTest::new(centre(values) - mean, variance, count - 1.0, confidence)
}

/// The degrees of freedom of Welch and Satterthwaite, from the squared standard errors of two means.
pub(in crate::statistics) fn welch_degrees(a: f64, a_count: usize, b: f64, b_count: usize) -> f64 {
    // shares, whose squares cannot overflow
    let (a, b) = (a / (a + b), b / (a + b));
    1.0 / (a * a / (a_count - 1) as f64 + b * b / (b_count - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // means 2 and 5, both variances 1
        let (a, b) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
        let test = t_test(&a, &b, 0.95).unwrap();
        assert!((test.t + 3.0 / (2.0 / 3.0f64).sqrt()).abs() < 1e-14 && test.degrees == 4.0);
        // the table's 2.776 for four degrees
        assert!(((test.high - test.low) / 2.0 / (2.0 / 3.0f64).sqrt() - 2.776_445).abs() < 1e-6);
        let welch = welch_t_test(&a, &b, 0.95).unwrap();
        assert!((welch.t - test.t).abs() < 1e-14 && (welch.degrees - 4.0).abs() < 1e-12);
        // two degrees: P(|T| > t) = 1 - t / sqrt(2 + t^2)
        let pairs = paired_t_test(&[2.0, 4.0, 9.0], &[1.0, 2.0, 6.0], 0.95).unwrap();
        let t = 2.0 * 3f64.sqrt();
        assert!((pairs.t - t).abs() < 1e-14 && (pairs.p - (1.0 - t / (2.0 + t * t).sqrt())).abs() < 1e-14);
        // the broken twin that takes pairs for independent samples
        assert!(t_test(&[2.0, 4.0, 9.0], &[1.0, 2.0, 6.0], 0.95).unwrap().p > 5.0 * pairs.p);
    }

    #[test]
    fn little_and_bad_input() {
        assert!(t_test(&[1.0], &[2.0, 3.0], 0.95).is_ok());
        assert!(t_test(&[1.0], &[2.0], 0.95).is_err());
        assert!(t_test(&[1.0, 1.0], &[2.0, 2.0], 0.95).is_err_and(|error| error.to_string().contains("no spread")));
        assert!(paired_t_test(&[1.0, 2.0], &[2.0, 3.0], 0.95).is_err());
        assert!(paired_t_test(&[1.0, 2.0], &[2.0], 0.95).is_err());
        assert!(welch_t_test(&[1.0, 2.0], &[2.0], 0.95).is_err());
        assert!(t_test(&[1.0, 2.0], &[2.0, 4.0], f64::NAN).is_err());
        assert!(t_test(&[1e200, 2e200], &[2.0, 4.0], 0.95).is_err());
        assert!(paired_t_test(&[1e308, 2.0], &[-1e308, 4.0], 0.95).is_err());
    }
}
