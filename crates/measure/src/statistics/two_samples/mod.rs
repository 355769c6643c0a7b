//! Two samples, or pairs of values, compared: one file each.

mod mann_whitney;
mod t_test;
mod wilcoxon;

pub use mann_whitney::{MannWhitney, mann_whitney};
pub(super) use t_test::welch_degrees;
pub use t_test::{TTest, one_sample_t_test, paired_t_test, t_test, welch_t_test};
pub(super) use wilcoxon::signed_ranks;
pub use wilcoxon::{Wilcoxon, wilcoxon};

/// How a p value was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// From all arrangements of the ranks.
    Exact,
    /// From the normal distribution that they approach.
    Normal,
}
