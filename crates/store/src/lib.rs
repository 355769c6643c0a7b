//! `store`: tables, the log they grow in, the folder that holds them. It knows nothing of what it keeps.
//!
//! A crate of its own, since what is written while a run goes on has to be fast, and most of `lab` has not.

pub mod export;
pub mod folder;
pub mod log;
pub mod table;

/// What can go wrong with files.
#[derive(Debug)]
pub enum StoreError {
    /// The system refused something.
    Io {
        /// What was being done, to which file.
        doing: String,
        /// What the system says.
        error: std::io::Error,
    },
    /// A file is not what it should be.
    Damaged(String),
    /// The folder is of something else, or in use: what, and the remedy.
    Refused(String),
}

impl StoreError {
    /// The system refused to do something with a file.
    pub fn io(doing: &str, path: &std::path::Path, error: std::io::Error) -> Self {
        Self::Io { doing: format!("{doing} `{}`", path.display()), error }
    }
}

impl core::fmt::Display for StoreError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Io { doing, error } => {
                // the system's words without the number that follows them
                let text = error.to_string();
                write!(out, "cannot {doing}: {}", text.split(" (os error").next().unwrap_or(&text))
            }
            Self::Damaged(text) | Self::Refused(text) => write!(out, "{text}"),
        }
    }
}
impl core::error::Error for StoreError {}
