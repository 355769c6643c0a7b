//! What can be wrong with a request for a statistic.

/// Why a statistic cannot be given.
#[derive(Clone, Debug, PartialEq)]
pub enum StatisticsError {
    /// A value is NaN or infinite.
    NotFinite {
        /// What holds the value: `group 2`, `first sample`.
        what: String,
        /// Its place there, from 0.
        place: usize,
        /// The value.
        found: f64,
    },
    /// There are too few values, groups or blocks.
    TooFew {
        /// What there is too little of: `groups`, `values in group 2`.
        what: String,
        /// The least number.
        needed: usize,
        /// The number given.
        found: usize,
    },
    /// Two lists belong together, place by place, and are not of the same length.
    Lengths {
        /// What they are.
        what: String,
        /// The length expected.
        expected: usize,
        /// The length given.
        found: usize,
    },
    /// All values are equal where the statistic divides by their spread.
    NoSpread {
        /// Where: `within the groups`.
        what: String,
    },
    /// Values so large that a sum of squares leaves the range of f64.
    TooLarge {
        /// What was computed.
        what: String,
    },
    /// A number that is outside its range: a confidence, a share, a power.
    Range {
        /// What the number is.
        what: &'static str,
        /// What it can be.
        expected: &'static str,
        /// The number given.
        found: f64,
    },
    /// A combination of levels without any value, where every combination is needed.
    EmptyCell {
        /// The combination: `level 2 of factor 0 with level 1 of factor 1`.
        what: String,
    },
    /// What one factor explains cannot be told from what others explain.
    Confounded {
        /// Which, counted from the constant.
        what: String,
    },
}

impl core::fmt::Display for StatisticsError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite { what, place, found } => {
                write!(out, "value {place} of {what} is {found}; statistics need finite numbers")
            }
            Self::TooFew { what, needed, found } => write!(out, "at least {needed} {what} are needed, found {found}"),
            Self::Lengths { what, expected, found } => write!(out, "{what} must have {expected} values, found {found}"),
            Self::NoSpread { what } => write!(out, "all values are equal {what}: there is no spread to compare with"),
            Self::TooLarge { what } => write!(out, "{what}: the values are too large for f64; use a larger unit"),
            Self::Range { what, expected, found } => write!(out, "{what} must be {expected}, found {found}"),
            Self::EmptyCell { what } => write!(out, "there is no value for {what}"),
            Self::Confounded { what } => write!(out, "{what} cannot be told apart from the terms before it"),
        }
    }
}
impl core::error::Error for StatisticsError {}
