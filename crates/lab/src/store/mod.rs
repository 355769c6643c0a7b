//! What comes out of a run, on disk: what `store` keeps, and what is kept of a file.

pub mod job;
pub mod texts;

pub use ::store::{StoreError, export, folder, log, table};
