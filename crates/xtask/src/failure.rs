//! What can go wrong, and the exit code it means.

use core::fmt;

/// Why a task did not end well.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The task ran, and the answer is no.
    No(String),
    /// What was asked for cannot be.
    Input(String),
    /// A tool or a file of the workspace could not be used.
    Tool(String),
    /// Said already; this is its exit code.
    Said(u8),
}

impl Failure {
    /// The exit code.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::No(_) => 1,
            Self::Input(_) => 2,
            Self::Tool(_) => 70,
            Self::Said(code) => *code,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::No(text) | Self::Input(text) | Self::Tool(text) => write!(out, "{text}"),
            Self::Said(_) => Ok(()),
        }
    }
}
