//! The distribution of the studentised range, by our own quadrature.

use super::chi::{NEGLIGIBLE, over_deviation, trapezoid};
use super::distribution::{normal, normal_density};
use super::root;

/// P(Q <= q): the range of `groups` standard normal values over an independent estimate of their deviation with
/// `degrees` degrees of freedom is no more than q.
///
/// P = int_0^inf f(s) W(q s) ds with W(w) = k int phi(z) (Phi(z) - Phi(z - w))^(k - 1) dz and f the density of the root of
/// a mean square of normal values. Trapezoidal sums over the whole line, whose error is below 1e-12; compared with SciPy
/// at 1e-10. For fewer than two groups the range is 0 and P is 1.
pub fn studentised_range(q: f64, groups: usize, degrees: f64) -> f64 {
    if groups < 2 {
        return 1.0;
    }
    if q <= 0.0 {
        return 0.0;
    }
    let tail = studentised_range_tail(q, groups, degrees);
    if tail < 0.5 {
        return 1.0 - tail;
    }
    over_deviation(degrees, 0.0, |s| range(q * s, groups)).min(1.0)
}

/// P(Q > q), with all its digits where it is tiny; see [`studentised_range`].
pub fn studentised_range_tail(q: f64, groups: usize, degrees: f64) -> f64 {
    if groups < 2 {
        return 0.0;
    }
    if q <= 0.0 {
        return 1.0;
    }
    // far out, small deviations make most of the probability: where f(s) exp(-(q s)^2 / 4) is largest
    let centre = -0.5 * libm::log1p(0.5 * q * q / degrees);
    over_deviation(degrees, centre, |s| range_tail(q * s, groups)).min(1.0)
}

/// The q with P(Q <= q) = p, for 0 < p < 1 and two groups or more.
pub fn studentised_range_quantile(p: f64, groups: usize, degrees: f64) -> f64 {
    root::of_decreasing(|q| studentised_range_tail(q, groups, degrees) - (1.0 - p))
}

/// Step of the sums over z.
const STEP: f64 = 0.2;

/// P(range of `groups` standard normal values <= w).
fn range(w: f64, groups: usize) -> f64 {
    let exponent = (groups - 1) as f64;
    let of = |z: f64| {
        // the share between z - w and z, from the side where it keeps its digits
        let between = if z > 0.5 * w { normal(w - z) - normal(-z) } else { normal(z) - normal(z - w) };
        normal_density(z) * libm::pow(between.max(0.0), exponent)
    };
    // between both ends of a narrow range, and where the density is, for a wide one
    groups as f64 * trapezoid((0.5 * w).min(1.0), STEP, of)
}

/// P(range > w): k int phi(z) (Phi(z)^(k - 1) - (Phi(z) - Phi(z - w))^(k - 1)) dz, whose terms are all positive.
fn range_tail(w: f64, groups: usize) -> f64 {
    let exponent = (groups - 1) as f64;
    let of = |z: f64| {
        let below = normal(z);
        if below < NEGLIGIBLE {
            return 0.0;
        }
        let far = (normal(z - w) / below).min(1.0);
        normal_density(z) * libm::pow(below, exponent) * -libm::expm1(exponent * libm::log1p(-far))
    };
    groups as f64 * trapezoid(0.5 * w, STEP, of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::distribution::{t_two_sided, t_two_sided_quantile};

    #[test]
    fn two_groups_are_student_t() {
        for degrees in [1.0, 2.0, 5.0, 30.0, 495.0, 1e6] {
            for t in [0.01, 0.5, 1.0, 3.0, 8.0, 20.0] {
                let (ours, exact) = (studentised_range_tail(t * 2f64.sqrt(), 2, degrees), t_two_sided(t, degrees));
                if exact > 1e-100 {
                    assert!((ours / exact - 1.0).abs() < 1e-10, "t {t}, {degrees}: {ours} {exact}");
                }
                let below = studentised_range(t * 2f64.sqrt(), 2, degrees);
                assert!((below - (1.0 - exact)).abs() < 1e-12, "t {t}, {degrees}: {below} {exact} {ours}");
            }
            let q = studentised_range_quantile(0.95, 2, degrees);
            assert!((q / 2f64.sqrt() / t_two_sided_quantile(0.95, degrees) - 1.0).abs() < 1e-10);
        }
    }

    #[test]
    fn three_groups_with_many_degrees() {
        // P(range of three <= w) has a closed form only as an integral; the published critical value is 3.31
        let q = studentised_range_quantile(0.95, 3, 1e7);
        assert!((q - 3.3145).abs() < 5e-5, "{q}");
        // Pearson & Hartley's table: k = 5, 20 degrees: 4.23 (5 %), 5.29 (1 %)
        let at = |p| (100.0 * studentised_range_quantile(p, 5, 20.0)).round();
        assert_eq!([at(0.95), at(0.99)], [423.0, 529.0]);
    }

    #[test]
    fn ends() {
        assert_eq!((studentised_range(0.0, 3, 5.0), studentised_range_tail(-1.0, 3, 5.0)), (0.0, 1.0));
        assert_eq!((studentised_range(3.0, 1, 5.0), studentised_range_tail(3.0, 1, 5.0)), (1.0, 0.0));
        let far = studentised_range_tail(1e4, 4, 30.0);
        assert!(far > 0.0 && far < 1e-60);
    }
}
