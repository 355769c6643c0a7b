//! Checks of what other tests assume, one file each.

mod equal_variance;
mod normality;

pub use equal_variance::{VarianceTest, bartlett, brown_forsythe, levene};
pub use normality::{NormalityTest, dagostino, shapiro_wilk};
