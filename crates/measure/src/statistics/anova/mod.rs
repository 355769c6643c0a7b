//! Analyses of variance, one file each.

mod blocked;
mod factorial;
mod kruskal_wallis;
mod one_way;
mod welch;

pub use blocked::{Blocked, blocked};
pub use factorial::{Factorial, SquaresType, factorial};
pub use kruskal_wallis::{KruskalWallis, kruskal_wallis};
pub use one_way::{OneWay, one_way};
pub use welch::{Welch, welch_anova};

use super::{StatisticsError, check, distribution};

/// What a factor (or an interaction) explains, and how surprising that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// Sum of squares.
    pub sum_of_squares: f64,
    /// Degrees of freedom.
    pub degrees: f64,
    /// Sum of squares over degrees of freedom.
    pub mean_square: f64,
    /// Mean square over that of the residual.
    pub f: f64,
    /// P(F > f) if the factor had no effect.
    pub p: f64,
}

/// What no factor explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Sum of squares.
    pub sum_of_squares: f64,
    /// Degrees of freedom.
    pub degrees: f64,
    /// Sum of squares over degrees of freedom.
    pub mean_square: f64,
}

impl Residual {
    pub(super) fn new(sum_of_squares: f64, degrees: usize) -> Result<Self, StatisticsError> {
        check::at_least("degrees of freedom in the residual", 1, degrees)?;
        let sum_of_squares = check::not_overflown("a sum of squares", sum_of_squares)?;
        let degrees = degrees as f64;
        Ok(Self { sum_of_squares, degrees, mean_square: sum_of_squares / degrees })
    }
}

impl Effect {
    pub(super) fn new(sum_of_squares: f64, degrees: usize, residual: &Residual) -> Result<Self, StatisticsError> {
        let sum_of_squares = check::not_overflown("a sum of squares", sum_of_squares)?;
        let degrees = degrees as f64;
        let mean_square = sum_of_squares / degrees;
        let f = check::not_overflown("F", mean_square / residual.mean_square)?;
        Ok(Self { sum_of_squares, degrees, mean_square, f, p: distribution::f_tail(f, degrees, residual.degrees) })
    }
    /// Partial eta squared: the share of this effect in the sum of its own and the residual sum of squares. In a
    /// one-way analysis this is eta squared.
    pub fn partial_eta_squared(&self, residual: &Residual) -> f64 {
        self.sum_of_squares / (self.sum_of_squares + residual.sum_of_squares)
    }
}
