//! Distribution functions: upper tails that keep their digits where they are tiny, and quantiles.
//!
//! The incomplete gamma function and the inverse error function are those of `statrs`, the error function that of `libm`. Every function
//! takes finite arguments and at least a little more than zero degrees of freedom; tails are probabilities in [0, 1].

use super::beta::incomplete_beta;
use super::root;
use statrs::function::{erf, gamma};

pub use super::noncentral::{noncentral_f_tail, noncentral_t_tail};
pub use super::studentised_range::{studentised_range, studentised_range_quantile, studentised_range_tail};

/// P(Z <= z) of the standard normal.
pub fn normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z * core::f64::consts::FRAC_1_SQRT_2)
}

/// P(Z > z) of the standard normal.
pub fn normal_tail(z: f64) -> f64 {
    normal(-z)
}

/// The z with P(Z <= z) = p, for 0 < p < 1.
pub fn normal_quantile(p: f64) -> f64 {
    if p > 0.5 {
        return -normal_quantile(1.0 - p);
    }
    let z = -core::f64::consts::SQRT_2 * erf::erfc_inv(2.0 * p);
    // one step of Newton's method takes off what the rational approximation leaves
    let slope = normal_density(z);
    if slope > 0.0 { z - (normal(z) - p) / slope } else { z }
}

/// The density of the standard normal.
pub fn normal_density(z: f64) -> f64 {
    libm::exp(-0.5 * z * z) * 0.5 * core::f64::consts::FRAC_2_SQRT_PI * core::f64::consts::FRAC_1_SQRT_2
}

/// P(|T| > |t|) of Student's t.
pub fn t_two_sided(t: f64, degrees: f64) -> f64 {
    incomplete_beta(0.5 * degrees, 0.5, degrees, t * t)
}

/// P(T > t) of Student's t.
pub fn t_tail(t: f64, degrees: f64) -> f64 {
    let outside = 0.5 * t_two_sided(t, degrees);
    if t > 0.0 { outside } else { 1.0 - outside }
}

/// The t > 0 with P(|T| <= t) = confidence, for 0 < confidence < 1.
pub fn t_two_sided_quantile(confidence: f64, degrees: f64) -> f64 {
    root::of_decreasing(|t| t_two_sided(t, degrees) - (1.0 - confidence))
}

/// P(F > f) of Fisher's F, for f >= 0.
pub fn f_tail(f: f64, between: f64, within: f64) -> f64 {
    incomplete_beta(0.5 * within, 0.5 * between, within, between * f)
}

/// The f with P(F > f) = tail, for 0 < tail < 1.
pub fn f_tail_quantile(tail: f64, between: f64, within: f64) -> f64 {
    root::of_decreasing(|f| f_tail(f, between, within) - tail)
}

/// P(X > x) of chi squared, for x >= 0.
pub fn chi_squared_tail(x: f64, degrees: f64) -> f64 {
    if x <= 0.0 { 1.0 } else { gamma::checked_gamma_ur(0.5 * degrees, 0.5 * x).map_or(0.0, |p| p.clamp(0.0, 1.0)) }
}

/// The x with P(X <= x) = p of the beta distribution, for 0 < p < 1.
pub fn beta_quantile(p: f64, a: f64, b: f64) -> f64 {
    root::bracketed(|x| regularised_beta(a, b, x) - p, 0.0, 1.0)
}

/// The regularised incomplete beta function I_x(a, b).
pub fn regularised_beta(a: f64, b: f64, x: f64) -> f64 {
    incomplete_beta(a, b, x, 1.0 - x)
}
