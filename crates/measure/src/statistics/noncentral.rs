//! Noncentral t and F, which the power of a test follows.

use super::beta::incomplete_beta;
use super::chi::over_deviation;
use super::distribution::normal_tail;

/// P(T > t) of the noncentral t: (Z + noncentrality) over an independent estimate of the deviation.
///
/// The mean over the deviation s of P(Z > t s - noncentrality), by the quadrature of the studentised range.
pub fn noncentral_t_tail(t: f64, degrees: f64, noncentrality: f64) -> f64 {
    over_deviation(degrees, 0.0, |s| normal_tail(t * s - noncentrality)).min(1.0)
}

/// P(F > f) of the noncentral F, for f >= 0 and a noncentrality of 0 or more.
///
/// A Poisson mixture of central ones, from its most likely term outwards until the rest is below 1e-17.
pub fn noncentral_f_tail(f: f64, between: f64, within: f64, noncentrality: f64) -> f64 {
    if f <= 0.0 {
        return 1.0;
    }
    let half = 0.5 * noncentrality;
    let middle = half.floor();
    let weight = |j: f64| {
        if half == 0.0 {
            f64::from(u8::from(j == 0.0))
        } else {
            libm::exp(j * libm::log(half) - half - libm::lgamma(j + 1.0))
        }
    };
    let tail = |j: f64| incomplete_beta(0.5 * within, 0.5 * between + j, within, between * f);
    let (mut sum, mut weights) = (0.0, 0.0);
    // upwards with the middle, then downwards
    for (first, step) in [(middle, 1.0), (middle - 1.0, -1.0)] {
        let mut j = first;
        while j >= 0.0 {
            let share = weight(j);
            sum += share * tail(j);
            weights += share;
            if share <= 1e-17 * weights {
                break;
            }
            j += step;
        }
    }
    // the rounding of ln Gamma is common to all weights
    (sum / weights).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::distribution::{f_tail, t_tail};

    #[test]
    fn central_ones_and_each_other() {
        for degrees in [1.0, 4.0, 80.0] {
            assert!((noncentral_t_tail(1.3, degrees, 0.0) - t_tail(1.3, degrees)).abs() < 1e-12);
            assert!((noncentral_f_tail(1.7, 3.0, degrees, 0.0) - f_tail(1.7, 3.0, degrees)).abs() < 1e-13);
            // T squared is F with one degree above
            let (t, shift) = (2.1, 1.4);
            let outside = noncentral_t_tail(t, degrees, shift) + noncentral_t_tail(t, degrees, -shift);
            assert!((noncentral_f_tail(t * t, 1.0, degrees, shift * shift) - outside).abs() < 1e-12);
        }
        assert!(noncentral_f_tail(2.0, 2.0, 30.0, 1e4) > 1.0 - 1e-12);
    }
}
