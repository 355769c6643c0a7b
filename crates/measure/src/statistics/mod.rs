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
mod assumptions;
mod autocorrelation;
mod beta;
mod check;
mod chi;
mod comparison;
mod correlation;
mod descriptive;
pub mod distribution;
mod effect_size;
mod error;
mod interval;
mod linear_model;
mod multiple;
mod noncentral;
mod power;
mod rank;
mod regression;
mod resampling;
mod root;
mod sequential;
mod studentised_range;
mod two_samples;

pub use anova::{
    Blocked, Effect, Factorial, KruskalWallis, OneWay, Residual, SquaresType, Welch, blocked, factorial,
    kruskal_wallis, one_way, welch_anova,
};
pub use assumptions::{NormalityTest, VarianceTest, bartlett, brown_forsythe, dagostino, levene, shapiro_wilk};
pub use autocorrelation::{AutocorrelationTime, autocorrelation_time, autocorrelations};
pub use comparison::{Pair, PairComparison, RankComparison, RankPair, dunn, games_howell, letters, tukey_kramer};
pub use correlation::{Correlation, pearson, spearman};
pub use descriptive::{Summary, mean, median, quantile, variance};
pub use effect_size::EffectSize;
pub use error::StatisticsError;
pub use interval::{Interval, clopper_pearson, mean_interval, wilson};
pub use multiple::{Correction, adjust};
pub use power::{Design, power, trials_needed};
pub use rank::ranks;
pub use regression::{Line, linear_regression};
pub use resampling::{Blocks, Estimate, Resampling, block_bootstrap, bootstrap, bootstrap_rows};
pub use sequential::{Behaviour, Decision, SequentialTest, is_narrow, trials_for_width};
pub use two_samples::{
    MannWhitney, Method, TTest, Wilcoxon, mann_whitney, one_sample_t_test, paired_t_test, t_test, welch_t_test,
    wilcoxon,
};
