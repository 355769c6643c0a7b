//! Means over the estimate of a standard deviation, by the trapezoidal rule.

use super::beta::stirling_remainder;

/// Terms below this share of their sum are left out.
pub(super) const NEGLIGIBLE: f64 = 1e-18;

/// The mean of a smooth function over s, the root of chi squared over its degrees of freedom: what is left unknown of a
/// deviation that was estimated with so many degrees.
///
/// With s = exp(x) the density is exp(c + v (x - (exp(2 x) - 1) / 2)), v the degrees, nearly normal with a deviation of
/// 1 / sqrt(2 v). `centre` is an x near the greatest product with the function.
pub(super) fn over_deviation(degrees: f64, centre: f64, of: impl Fn(f64) -> f64) -> f64 {
    // ln of 2 (v / 2)^(v / 2) exp(-v / 2) / Gamma(v / 2)
    let half = 0.5 * degrees;
    let constant = core::f64::consts::LN_2 + 0.5 * libm::log(half / core::f64::consts::TAU) - stirling_remainder(half);
    let step = (0.4 / libm::sqrt(2.0 * degrees)).min(0.12);
    trapezoid(centre, step, |x| libm::exp(constant + degrees * (x - 0.5 * libm::expm1(2.0 * x))) * of(libm::exp(x)))
}

/// The integral over the line of a function with one rise and one fall, from somewhere near its top outwards.
///
/// For analytic functions that vanish at both ends the error falls exponentially with the step.
pub(super) fn trapezoid(centre: f64, step: f64, of: impl Fn(f64) -> f64) -> f64 {
    /// Enough for any of our integrands; a bound, so that no input can hang.
    const MOST: usize = 20_000;
    let mut sum = of(centre);
    for direction in [step, -step] {
        let mut last = 0.0;
        for place in 1..MOST {
            let term = of(centre + direction * place as f64);
            sum += term;
            if term <= last && term <= NEGLIGIBLE * sum {
                break;
            }
            last = term;
        }
    }
    sum * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_the_deviation() {
        for degrees in [1.0, 2.0, 7.0, 99.0, 101.0, 1e4, 1e7] {
            assert!((over_deviation(degrees, 0.0, |_| 1.0) - 1.0).abs() < 1e-12, "{degrees}");
            assert!((over_deviation(degrees, 0.0, |s| s * s) - 1.0).abs() < 1e-12, "{degrees}");
        }
        // E s = sqrt(2 / v) Gamma((v + 1) / 2) / Gamma(v / 2): sqrt(2 / pi) for one degree
        assert!((over_deviation(1.0, 0.0, |s| s) - core::f64::consts::FRAC_2_PI.sqrt()).abs() < 1e-13);
    }
}
