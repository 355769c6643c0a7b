//! Are values normal?

use crate::statistics::descriptive::{centre, sorted};
use crate::statistics::{StatisticsError, check, distribution};

/// A test of normality. A large p says that nothing speaks against it, not that values are normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalityTest {
    /// Shapiro and Wilk's W, or D'Agostino and Pearson's K squared.
    pub statistic: f64,
    /// Probability of so small a W or so large a K squared from normal values.
    pub p: f64,
}

/// The test of Shapiro and Wilk (1965), for 3 to 5000 values: W compares the values in order with those expected of
/// normal ones.
///
/// Weights and p by Royston's polynomials (1992, Stat. Comput. 2:117; 1995, Appl. Stat. 44:547, R94), as
/// `scipy.stats.shapiro`. With more values use [`dagostino`].
///
/// # Errors
/// For fewer than three or more than 5000 values, one that is not finite, values that are all equal or too large for
/// their squares.
pub fn shapiro_wilk(values: &[f64]) -> Result<NormalityTest, StatisticsError> {
    check::values("the sample", values, 3)?;
    let count = values.len() as f64;
    check::in_range("the number of values in Shapiro and Wilk's test", "at most 5000", count, values.len() <= 5000)?;
    let variance = check::spread_of("in the sample", values)?;
    let sorted = sorted(values);
    let weights = weights(values.len());
    let last = sorted.len() - 1;
    let slope: f64 =
        weights.iter().enumerate().map(|(place, weight)| weight * (sorted[last - place] - sorted[place])).sum();
    let w = (slope / (variance * (count - 1.0)).sqrt()).powi(2).min(1.0);
    Ok(NormalityTest { statistic: w, p: p_of_w(w, count) })
}

/// The weights of the differences between the values at the same place from both ends.
fn weights(count: usize) -> Vec<f64> {
    if count == 3 {
        return vec![core::f64::consts::FRAC_1_SQRT_2];
    }
    let n = count as f64;
    // normal values expected at the places above the middle, from the end inwards
    let expected: Vec<f64> =
        (0..count / 2).map(|place| -distribution::normal_quantile((place as f64 + 0.625) / (n + 0.25))).collect();
    let squares = 2.0 * expected.iter().map(|m| m * m).sum::<f64>();
    let root = 1.0 / n.sqrt();
    let first = expected[0] / squares.sqrt()
        + polynomial(&[0.0, 0.221_157, -0.147_981, -2.071_19, 4.434_685, -2.706_056], root);
    let second = expected[1] / squares.sqrt()
        + polynomial(&[0.0, 0.042_981, -0.293_762, -1.752_461, 5.682_633, -3.582_633], root);
    let corrected = if count > 5 { vec![first, second] } else { vec![first] };
    let squared = |values: &[f64]| 2.0 * values.iter().map(|x| x * x).sum::<f64>();
    let scale = ((squares - squared(&expected[..corrected.len()])) / (1.0 - squared(&corrected))).sqrt();
    let others = expected[corrected.len()..].iter().map(|m| m / scale);
    corrected.iter().copied().chain(others).collect()
}

/// P(W < w) for normal values.
fn p_of_w(w: f64, count: f64) -> f64 {
    if count == 3.0 {
        // exact; W is at least 3/4
        let p = 6.0 / core::f64::consts::PI * (libm::asin(w.sqrt()) - libm::asin(0.75f64.sqrt()));
        return p.clamp(0.0, 1.0);
    }
    let rest = libm::log((1.0 - w).max(f64::MIN_POSITIVE));
    let (normal, mean, log_deviation) = if count <= 11.0 {
        let bound = polynomial(&[-2.273, 0.459], count);
        if rest >= bound {
            return 0.0;
        }
        let mean = polynomial(&[0.544, -0.399_78, 0.025_054, -6.714e-4], count);
        (-libm::log(bound - rest), mean, polynomial(&[1.3822, -0.778_57, 0.062_767, -0.002_032_2], count))
    } else {
        let log = libm::log(count);
        let mean = polynomial(&[-1.5861, -0.310_82, -0.083_751, 0.003_891_5], log);
        (rest, mean, polynomial(&[-0.4803, -0.082_676, 0.003_030_2], log))
    };
    distribution::normal_tail((normal - mean) / libm::exp(log_deviation))
}

/// A polynomial with its coefficients from the constant upwards.
fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

/// The test of D'Agostino and Pearson (1973) for 20 values or more: K squared adds the squares of skewness and kurtosis,
/// both made normal (D'Agostino 1970; Anscombe & Glynn 1983), as `scipy.stats.normaltest`.
///
/// # Errors
/// For fewer than 20 values, one that is not finite, values that are all equal or too large for their squares.
pub fn dagostino(values: &[f64]) -> Result<NormalityTest, StatisticsError> {
    check::values("the sample", values, 20)?;
    let n = values.len() as f64;
    let deviation = (check::spread_of("in the sample", values)? * (n - 1.0) / n).sqrt();
    let mean = centre(values);
    let moment = |power| values.iter().map(|value| ((value - mean) / deviation).powi(power)).sum::<f64>() / n;
    let skewness = normal_skewness(moment(3), n);
    let kurtosis = normal_kurtosis(moment(4), n);
    let statistic = skewness * skewness + kurtosis * kurtosis;
    Ok(NormalityTest { statistic, p: libm::exp(-0.5 * statistic) })
}

/// D'Agostino's transformation of the skewness of n values.
fn normal_skewness(skewness: f64, n: f64) -> f64 {
    let y = skewness * ((n + 1.0) * (n + 3.0) / (6.0 * (n - 2.0))).sqrt();
    let beta =
        3.0 * (n * n + 27.0 * n - 70.0) * (n + 1.0) * (n + 3.0) / ((n - 2.0) * (n + 5.0) * (n + 7.0) * (n + 9.0));
    let square = (2.0 * (beta - 1.0)).sqrt() - 1.0;
    libm::asinh(y / (2.0 / (square - 1.0)).sqrt()) / (0.5 * libm::log(square)).sqrt()
}

/// Anscombe and Glynn's transformation of the kurtosis (3 for normal values) of n values.
fn normal_kurtosis(kurtosis: f64, n: f64) -> f64 {
    let expected = 3.0 * (n - 1.0) / (n + 1.0);
    let variance = 24.0 * n * (n - 2.0) * (n - 3.0) / ((n + 1.0) * (n + 1.0) * (n + 3.0) * (n + 5.0));
    let x = (kurtosis - expected) / variance.sqrt();
    let skew = 6.0 * (n * n - 5.0 * n + 2.0) / ((n + 7.0) * (n + 9.0))
        * (6.0 * (n + 3.0) * (n + 5.0) / (n * (n - 2.0) * (n - 3.0))).sqrt();
    let a = 6.0 + 8.0 / skew * (2.0 / skew + (1.0 + 4.0 / (skew * skew)).sqrt());
    let below = 1.0 + x * (2.0 / (a - 4.0)).sqrt();
    let cube = libm::cbrt((1.0 - 2.0 / a) / below.abs()).copysign(below);
    (1.0 - 2.0 / (9.0 * a) - cube) / (2.0 / (9.0 * a)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_values_have_a_closed_form() {
        // evenly spaced: W = 1, p = 1; two equal: W = 3 / 4, p = 0
        let even = shapiro_wilk(&[1.0, 2.0, 3.0]).unwrap();
        assert!((even.statistic - 1.0).abs() < 1e-15 && (even.p - 1.0).abs() < 1e-7);
        let two = shapiro_wilk(&[1.0, 1.0, 3.0]).unwrap();
        assert!((two.statistic - 0.75).abs() < 1e-15 && two.p < 1e-7);
    }

    #[test]
    fn tells_normal_from_other_values() {
        let normal: Vec<f64> = (0..50).map(|i| distribution::normal_quantile((f64::from(i) + 0.5) / 50.0)).collect();
        let skewed: Vec<f64> = normal.iter().map(|x| libm::exp(*x)).collect();
        assert!(shapiro_wilk(&normal).unwrap().p > 0.9 && dagostino(&normal).unwrap().p > 0.5);
        assert!(shapiro_wilk(&skewed).unwrap().p < 1e-6 && dagostino(&skewed).unwrap().p < 1e-6);
        // only the shape counts
        let moved: Vec<f64> = skewed.iter().map(|x| 1e6 + 3.0 * x).collect();
        assert!((shapiro_wilk(&moved).unwrap().statistic - shapiro_wilk(&skewed).unwrap().statistic).abs() < 1e-9);
    }

    #[test]
    fn bad_input() {
        assert!(shapiro_wilk(&[1.0, 2.0]).is_err() && shapiro_wilk(&[1.0; 5]).is_err());
        assert!(shapiro_wilk(&vec![1.0; 5001]).is_err() && dagostino(&[1.0; 19]).is_err());
        assert!(shapiro_wilk(&[1.0, 2.0, f64::NAN]).is_err());
    }
}
