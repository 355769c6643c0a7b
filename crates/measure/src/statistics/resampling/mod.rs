//! Intervals by resampling.
//!
//! Draws are `U(seed, resampling, replicate, place)`: a replicate has the same values on any number of threads, whatever
//! else is resampled.

mod blocks;
mod bootstrap;

pub use blocks::{Blocks, block_bootstrap};
pub use bootstrap::{bootstrap, bootstrap_rows};

use super::descriptive::{quantile_of_sorted, sorted, squares};
use super::interval::Interval;
use super::{StatisticsError, check};
use space::random::{Purpose, uniform};

/// How often to resample, and how sure to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resampling {
    /// Number of replicates; a few thousand for an interval.
    pub replicates: u32,
    /// Seed of the draws.
    pub seed: u64,
    /// Confidence of the interval.
    pub confidence: f64,
}

impl Default for Resampling {
    fn default() -> Self {
        Self { replicates: 5_000, seed: 0, confidence: 0.95 }
    }
}

/// A statistic and how sure it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The statistic of the values themselves.
    pub value: f64,
    /// Its confidence interval.
    pub interval: Interval,
    /// Standard deviation over the replicates.
    pub standard_error: f64,
    /// The statistic of each replicate in which it is defined, in their order.
    pub replicates: Vec<f64>,
}

impl Resampling {
    fn check(&self) -> Result<(), StatisticsError> {
        check::between_0_and_1("the confidence", self.confidence)?;
        let enough = (100..=10_000_000).contains(&self.replicates);
        check::in_range("the number of replicates", "from 100 to 10000000", self.replicates.into(), enough)
    }
    /// One of `count` places, for the draw of this number in a replicate.
    fn place(&self, replicate: u32, draw: u32, count: usize) -> usize {
        ((self.draw(replicate, draw) * count as f64) as usize).min(count - 1)
    }
    /// A uniform draw of a replicate.
    fn draw(&self, replicate: u32, draw: u32) -> f64 {
        uniform(self.seed, Purpose::Resampling, replicate.into(), draw)
    }
    /// The estimate, where the ends of the interval are quantiles of the replicates at the shares given.
    fn estimate(
        &self,
        value: f64,
        replicates: Vec<f64>,
        ends: impl Fn(&[f64]) -> [f64; 2],
    ) -> Result<Estimate, StatisticsError> {
        let half = self.replicates as usize / 2;
        check::at_least("replicates in which the statistic is defined", half.max(2), replicates.len())?;
        let sorted = sorted(&replicates);
        let [low, high] = ends(&sorted).map(|share| quantile_of_sorted(&sorted, share));
        let variance = squares(&replicates) / (replicates.len() - 1) as f64;
        let standard_error = check::not_overflown("a variance", variance)?.sqrt();
        Ok(Estimate { value, interval: Interval { low, high }, standard_error, replicates })
    }
}

/// Refuses samples so long that draws could not be told apart.
fn drawable(values: usize) -> Result<(), StatisticsError> {
    check::in_range("the number of values to resample", "at most 2^31", values as f64, values <= 1 << 31)
}
