//! Where a monotone function is zero.

/// The place in `low..=high` where a monotone function crosses zero, to the last digits of f64.
///
/// Chandrupatla's method (1997, Advances in Engineering Software 28:145): inverse quadratic interpolation where it is
/// safe, else bisection. Where both ends have one sign, the end that is nearer zero.
pub(super) fn bracketed(of: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut a, mut b) = (high, low);
    let (mut at_a, mut at_b) = (of(a), of(b));
    if (at_a > 0.0) == (at_b > 0.0) {
        return if at_a.abs() < at_b.abs() { a } else { b };
    }
    let mut share = 0.5;
    for _ in 0..200 {
        let x = a + share * (b - a);
        let at_x = of(x);
        let (c, at_c);
        if (at_x > 0.0) == (at_a > 0.0) {
            (c, at_c) = (a, at_a);
        } else {
            (c, at_c) = (b, at_b);
            (b, at_b) = (a, at_a);
        }
        (a, at_a) = (x, at_x);
        let best = if at_a.abs() < at_b.abs() { a } else { b };
        let tolerance = 2.0 * f64::EPSILON * best.abs() / (b - a).abs();
        if tolerance > 0.5 || at_a == 0.0 || b == a {
            return best;
        }
        let xi = (a - b) / (c - b);
        let phi = (at_a - at_b) / (at_c - at_b);
        let quadratic = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        share = if quadratic {
            at_a / (at_b - at_a) * at_c / (at_b - at_c)
                + (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        } else {
            0.5
        };
        share = share.clamp(tolerance, 1.0 - tolerance);
    }
    a
}

/// The place in `0..` where a decreasing function crosses zero; 0 where it is not above zero there.
pub(super) fn of_decreasing(of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while of(high) > 0.0 && high < 1e300 {
        (low, high) = (high, 4.0 * high);
    }
    while low == 0.0 && high > 1e-300 && of(high / 4.0) < 0.0 {
        high /= 4.0;
    }
    bracketed(of, if low == 0.0 { high / 4.0 } else { low }, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_roots_of_any_size() {
        assert!((bracketed(|x| x * x * x - 2.0, 0.0, 2.0) - 2f64.cbrt()).abs() < 1e-15);
        for root in [1e-12, 0.3, 1.0, 7.0, 1e9] {
            assert!((of_decreasing(|x: f64| (root / x).ln()) / root - 1.0).abs() < 1e-14, "{root}");
        }
        // no crossing: the end that is nearer
        assert_eq!(bracketed(|x| x + 1.0, 0.0, 3.0), 0.0);
    }
}
