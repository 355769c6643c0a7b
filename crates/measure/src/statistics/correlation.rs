//! Do two quantities go together?

use super::descriptive::centre;
use super::interval::Interval;
use super::rank::ranked;
use super::{StatisticsError, check, distribution};

/// A coefficient of correlation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// The coefficient, from -1 to 1.
    pub r: f64,
    /// Probability of so large a coefficient, of either sign, without correlation.
    pub p: f64,
    /// Confidence interval by Fisher's transformation; `None` for fewer than four pairs.
    pub interval: Option<Interval>,
}

/// Pearson's coefficient of linear correlation (`scipy.stats.pearsonr`). p and interval assume normal values.
///
/// # Errors
/// For samples of different length, fewer than three pairs, a value that is not finite, a sample without spread, values
/// too large for their squares, or a confidence outside 0 and 1.
pub fn pearson(x: &[f64], y: &[f64], confidence: f64) -> Result<Correlation, StatisticsError> {
    check::pairs(x, y, 3)?;
    coefficient(x, y, confidence, 1.0)
}

/// Spearman's coefficient: Pearson's of the ranks (`scipy.stats.spearmanr`), for any monotone relation. p from Student's t;
/// the interval with the variance (1 + r^2 / 2) / (n - 3) of Bonett and Wright (2000).
///
/// # Errors
/// As [`pearson`].
pub fn spearman(x: &[f64], y: &[f64], confidence: f64) -> Result<Correlation, StatisticsError> {
    check::pairs(x, y, 3)?;
    let (x, y) = (ranked(x).0, ranked(y).0);
    let r = coefficient(&x, &y, confidence, 1.0)?.r;
    coefficient(&x, &y, confidence, 1.0 + 0.5 * r * r)
}

fn coefficient(x: &[f64], y: &[f64], confidence: f64, inflation: f64) -> Result<Correlation, StatisticsError> {
    check::between_0_and_1("the confidence", confidence)?;
    let n = x.len() as f64;
    let x_length = (check::spread_of("in the first sample", x)? * (n - 1.0)).sqrt();
    let y_length = (check::spread_of("in the second sample", y)? * (n - 1.0)).sqrt();
    let (x_mean, y_mean) = (centre(x), centre(y));
    let r: f64 = x.iter().zip(y).map(|(x, y)| (x - x_mean) / x_length * ((y - y_mean) / y_length)).sum();
    let r = r.clamp(-1.0, 1.0);
    // t^2 = r^2 (n - 2) / (1 - r^2)
    let p = super::beta::incomplete_beta(0.5 * (n - 2.0), 0.5, (1.0 - r) * (1.0 + r), r * r);
    let interval = (n > 3.0).then(|| {
        let half = -distribution::normal_quantile(0.5 * (1.0 - confidence)) * (inflation / (n - 3.0)).sqrt();
        let middle = libm::atanh(r);
        Interval { low: libm::tanh(middle - half), high: libm::tanh(middle + half) }
    });
    Ok(Correlation { r, p, interval })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // deviations -1 0 1 and -1 2 -1... r = 0; and a line: r = 1, p = 0
        let none = pearson(&[1.0, 2.0, 3.0], &[1.0, 4.0, 1.0], 0.95).unwrap();
        assert!(none.r.abs() < 1e-15 && (none.p - 1.0).abs() < 1e-12 && none.interval.is_none());
        let line = pearson(&[1.0, 2.0, 3.0, 4.0], &[-2.0, -4.0, -6.0, -8.0], 0.95).unwrap();
        assert!((line.r + 1.0).abs() < 1e-15 && line.p < 1e-7);
        // a curve that rises is a perfect rank correlation, and no perfect line
        let (x, y) = ([1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 8.0, 27.0, 64.0, 125.0]);
        assert!((spearman(&x, &y, 0.95).unwrap().r - 1.0).abs() < 1e-15);
        assert!(pearson(&x, &y, 0.95).unwrap().r < 0.95);
    }

    #[test]
    fn bad_input() {
        assert!(pearson(&[1.0, 2.0], &[1.0, 2.0], 0.95).is_err());
        assert!(pearson(&[1.0, 2.0, 3.0], &[1.0, 1.0, 1.0], 0.95).is_err());
        assert!(pearson(&[1.0, 2.0, 3.0], &[1.0, 1.0], 0.95).is_err());
        assert!(spearman(&[1.0, f64::NAN, 3.0], &[1.0, 2.0, 1.0], 0.95).is_err());
    }
}
