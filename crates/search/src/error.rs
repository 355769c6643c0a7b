//! What can be wrong with the plan of a search or with what it is told.

use core::fmt;

/// A search that cannot be made, or cannot go on.
#[derive(Clone, Debug, PartialEq)]
pub enum SearchError {
    /// Nothing to search over.
    NoAxes,
    /// An axis that is no interval: bounds that are not finite, or a low one that is not below the high one.
    NotAnInterval {
        /// Number of the axis.
        axis: usize,
        /// Its low bound.
        low: f64,
        /// Its high bound.
        high: f64,
    },
    /// A number of the plan that makes no sense.
    OutOfRange {
        /// What it is.
        what: &'static str,
        /// What it has to be.
        expected: &'static str,
    },
    /// A point with the wrong number of coordinates.
    Length {
        /// What it is.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// The library behind a search refused.
    Refused(&'static str),
}

impl fmt::Display for SearchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAxes => write!(f, "there is nothing to search over"),
            Self::NotAnInterval { axis, low, high } => {
                write!(f, "axis {axis} runs from {low} to {high}; expected two finite numbers, the lower first")
            }
            Self::OutOfRange { what, expected } => write!(f, "{what}: expected {expected}"),
            Self::Length { what, found, expected } => write!(f, "{what}: {found} given, {expected} expected"),
            Self::Refused(why) => write!(f, "{why}"),
        }
    }
}

impl core::error::Error for SearchError {}

/// Refuses a list of the wrong length.
pub(crate) fn counted(what: &'static str, found: usize, expected: usize) -> Result<(), SearchError> {
    if found == expected { Ok(()) } else { Err(SearchError::Length { what, found, expected }) }
}

/// Refuses a number of the plan where `good` does not hold.
pub(crate) fn hold(good: bool, what: &'static str, expected: &'static str) -> Result<(), SearchError> {
    if good { Ok(()) } else { Err(SearchError::OutOfRange { what, expected }) }
}
