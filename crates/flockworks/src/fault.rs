//! What can go wrong, and the exit code it means.

use lab::store::StoreError;
use std::io;

/// Why a command could not do what was asked.
#[derive(Debug)]
pub enum Fault {
    /// The user's input is wrong: what, where, and what was expected.
    Input(String),
    /// The user's input is wrong, and the text shows where in it, ready to be printed.
    Shown(String),
    /// Ours.
    Ours(String),
    /// Nobody reads standard output any more.
    Closed,
}

impl Fault {
    /// Exit code: 2 for input, 70 for our own faults, 0 when the reader went away.
    pub fn code(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Shown(_) => 2,
            Self::Ours(_) => 70,
            Self::Closed => 0,
        }
    }
    /// The same fault with the place it concerns before it.
    #[must_use]
    pub fn at(self, place: &str) -> Self {
        match self {
            Self::Input(text) => Self::Input(format!("{place}: {text}")),
            other => other,
        }
    }
}

impl core::fmt::Display for Fault {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Input(text) | Self::Ours(text) => write!(out, "{text}"),
            Self::Shown(text) => write!(out, "{}", text.trim_end()),
            Self::Closed => Ok(()),
        }
    }
}
impl core::error::Error for Fault {}

impl From<io::Error> for Fault {
    /// Errors of writing to standard output.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::Closed
        } else {
            // a full disk, mostly
            Self::Input(StoreError::Io { doing: "write to standard output".into(), error }.to_string())
        }
    }
}

/// A wrong input.
pub fn wrong<T>(text: impl Into<String>) -> Result<T, Fault> {
    Err(Fault::Input(text.into()))
}

/// A hint at the nearest name there is.
pub fn hint(name: &str, among: &[&str]) -> String {
    match space::spelling::nearest(name, among.iter().copied()) {
        Some(nearest) => format!("; did you mean `{nearest}`?"),
        None => String::new(),
    }
}
