//! A straight line through points: does a quantity change with another one?

use super::descriptive::centre;
use super::interval::Interval;
use super::{StatisticsError, check, distribution};

/// A line by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Change of y per unit of x.
    pub slope: f64,
    /// y at x = 0.
    pub intercept: f64,
    /// Standard error of the slope.
    pub standard_error: f64,
    /// Degrees of freedom: points less two.
    pub degrees: f64,
    /// The slope over its standard error.
    pub t: f64,
    /// P(|T| > |t|) if the slope were zero.
    pub p: f64,
    /// Confidence interval of the slope.
    pub interval: Interval,
    /// Share of the variance of y that the line explains.
    pub r_squared: f64,
}

/// The line through points, and whether its slope differs from zero (`scipy.stats.linregress`).
///
/// Assumes independent normal errors of equal variance in y alone. A trend over time is tested over seeds: one slope
/// per run, then [`one_sample_t_test`](super::one_sample_t_test) of the slopes, since values of one run are not
/// independent.
///
/// # Errors
/// For samples of different length, fewer than three points, a value that is not finite, x all equal, points exactly on a
/// line, values too large for their squares, or a confidence outside 0 and 1.
pub fn linear_regression(x: &[f64], y: &[f64], confidence: f64) -> Result<Line, StatisticsError> {
    check::pairs(x, y, 3)?;
    check::between_0_and_1("the confidence", confidence)?;
    let n = x.len() as f64;
    let x_squares = check::spread_of("in the first sample", x)? * (n - 1.0);
    let (x_mean, y_mean) = (centre(x), check::not_overflown("a mean", centre(y))?);
    let products: f64 = x.iter().zip(y).map(|(x, y)| (x - x_mean) * (y - y_mean)).sum();
    let slope = check::not_overflown("the slope", products / x_squares)?;
    let rest = x.iter().zip(y).map(|(x, y)| (y - y_mean) - slope * (x - x_mean));
    let rest = check::not_overflown("a sum of squares", rest.map(|rest| rest * rest).sum())?;
    check::spread("around the line", rest, y.len(), check::size(y))?;
    let degrees = n - 2.0;
    let standard_error = (rest / degrees / x_squares).sqrt();
    let t = check::not_overflown("t", slope / standard_error)?;
    let half = distribution::t_two_sided_quantile(confidence, degrees) * standard_error;
    let explained = slope * products;
    Ok(Line {
        slope,
        intercept: y_mean - slope * x_mean,
        standard_error,
        degrees,
        t,
        p: distribution::t_two_sided(t, degrees),
        interval: Interval { low: slope - half, high: slope + half },
        r_squared: explained / (explained + rest),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // slope 1, residuals 1 -2 1 times 1/3
        let line = linear_regression(&[0.0, 1.0, 2.0], &[1.0, 1.0, 3.0], 0.95).unwrap();
        assert!((line.slope - 1.0).abs() < 1e-15 && (line.intercept - 2.0 / 3.0).abs() < 1e-15);
        assert!((line.standard_error - (2.0 / 3.0f64 / 2.0).sqrt()).abs() < 1e-15 && line.degrees == 1.0);
        // one degree is Cauchy: p = 1 - 2 / pi atan(t) with t = sqrt(3), so 1 / 3
        assert!((line.p - 1.0 / 3.0).abs() < 1e-14 && (line.r_squared - 0.75).abs() < 1e-15);
        // a large offset costs no digits
        let far = linear_regression(&[1e8, 1e8 + 1.0, 1e8 + 2.0], &[1.0, 1.0, 3.0], 0.95).unwrap();
        assert_eq!((far.slope, far.p), (line.slope, line.p));
    }

    #[test]
    fn bad_input() {
        let error = |x: &[f64], y: &[f64]| linear_regression(x, y, 0.95).is_err();
        assert!(error(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]) && error(&[1.0, 2.0, 3.0], &[2.0, 4.0, 6.0]));
        assert!(error(&[1.0, 2.0], &[2.0, 4.0]) && error(&[1.0, 2.0, 3.0], &[2.0, 4.0]));
        assert!(error(&[1.0, 2.0, 3.0], &[2.0, f64::NAN, 1.0]) && error(&[1.0, 2.0, 3.0], &[2e200, 0.0, -1e200]));
    }
}
