//! Statistics over trials: summaries, analyses of variance, comparisons of all pairs, intervals, effect sizes, power.
//!
//! The unit is the trial (or the individual that was observed once): each value is one independent number, unless a
//! method says otherwise. Groups are slices of values, named by their place in the list; names are the caller's.
//!
//! All functions are pure, take sums in the order of the values, and refuse what they cannot answer with a
//! [`StatisticsError`]: no result holds NaN or an infinite number. The gamma and error functions of [`distribution`]
//! are those of `statrs` and `libm`; the rest of it is our own. `tests/independent` compares all of them
//! with SciPy and statsmodels.
//!
//! ```
//! use measure::statistics::{one_way, tukey_kramer};
//!
//! let groups: [&[f64]; 3] = [&[0.61, 0.58, 0.66, 0.63], &[0.81, 0.79, 0.86], &[0.62, 0.69, 0.64, 0.70]];
//! let anova = one_way(&groups)?;
//! assert!(anova.effect.p < 0.001);
//! let pairs = tukey_kramer(&anova.groups, &anova.residual, 0.95)?;
//! assert_eq!(pairs.letters, ["b", "a", "b"]);
//! # Ok::<(), measure::statistics::StatisticsError>(())
//! ```

mod anova;
mod beta;
mod check;
mod chi;
mod comparison;
mod descriptive;
pub mod distribution;
mod error;
mod root;
mod studentised_range;

pub use anova::{Blocked, Effect, OneWay, Residual, blocked, one_way};
pub use comparison::{Pair, PairComparison, letters, tukey_kramer};
pub use descriptive::{Summary, mean, median, quantile, variance};
pub use error::StatisticsError;
