//! What can be wrong with a request for an environment.

use space::spelling::nearest;
use std::fmt;

/// Why something of this room cannot be.
#[derive(Clone, Debug, PartialEq)]
pub enum TerrainError {
    /// A name that nothing has.
    Unknown {
        /// What kind of thing: `schema`, `anchor`, `shape`...
        kind: &'static str,
        /// The name given.
        name: String,
        /// The name that may have been meant, or all there are.
        nearest: Option<String>,
    },
    /// A number is outside what is allowed.
    Range {
        /// Of what it is the number.
        name: String,
        /// What was expected.
        expected: String,
        /// The number given.
        found: f64,
    },
    /// Lengths in metres beside lengths in field units.
    Units {
        /// What is in the one.
        first: String,
        /// What is in the other.
        second: String,
    },
    /// A grammar whose parts do not fit together; the text says where and why.
    Grammar(String),
    /// A text that cannot be read.
    Text {
        /// Line, from 1.
        line: usize,
        /// What was expected, and what found.
        problem: String,
    },
    /// More candidates than allowed.
    TooMany {
        /// How many there would be.
        count: f64,
        /// How many are allowed.
        limit: f64,
    },
    /// A derivation that ended without an environment: it reached its limit, and the grammar rejects such.
    Unfinished,
    /// Stages that cannot be put together, whatever they are built of; the text says which and why.
    Stages(String),
    /// A construct that a filter does not let through, and why.
    Infeasible(String),
    /// What was built of stages does not fit together; the text says which and why. Other constructs of theirs may.
    Misfit(String),
}

impl TerrainError {
    /// An unknown name, with the nearest of those there are.
    pub fn unknown<'a>(kind: &'static str, name: &str, among: impl Iterator<Item = &'a str>) -> Self {
        Self::Unknown { kind, name: name.to_owned(), nearest: nearest(name, among).map(str::to_owned) }
    }
    /// A number out of range.
    pub fn range(name: impl Into<String>, expected: impl Into<String>, found: f64) -> Self {
        Self::Range { name: name.into(), expected: expected.into(), found }
    }
}

impl fmt::Display for TerrainError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { kind, name, nearest } => {
                write!(out, "unknown {kind} `{name}`")?;
                nearest.as_ref().map_or(Ok(()), |nearest| write!(out, "; did you mean `{nearest}`?"))
            }
            Self::Range { name, expected, found } => write!(out, "{name}: expected {expected}, found {found}"),
            Self::Units { first, second } => write!(out, "{first} cannot be combined with {second}"),
            Self::Infeasible(why) => write!(out, "not feasible: {why}"),
            Self::Grammar(text) | Self::Stages(text) | Self::Misfit(text) => out.write_str(text),
            Self::Text { line, problem } => write!(out, "line {line}: {problem}"),
            Self::TooMany { count, limit } => write!(out, "{count} candidates are more than the {limit} allowed"),
            Self::Unfinished => out.write_str("the derivation reached its limit of steps before it was done"),
        }
    }
}

impl std::error::Error for TerrainError {}
