//! Evolutions: a search over values of a scenario for what is best by a measure of yours.
//!
//! An evolution file names a scenario, genes (values of it by their paths), a fitness, and a search of room `search`.
//! [`plan`] reads it, [`evaluate`] finds out how good candidates are, [`execute`] runs generation after generation and
//! keeps each in an append-only log. Several variants of the file ([`variants`]) may be searched side by side, and champions
//! may meet what is good without a search ([`contest`]). [`answers`] asks the results what the file asks, [`tables`] writes the
//! tables, [`report`] draws the page.

pub mod answers;
pub mod contest;
pub mod evaluate;
pub mod execute;
pub mod form;
pub mod plan;
pub mod report;
pub mod tables;
pub mod variants;

pub use plan::{Plan, read};
pub use variants::Variants;

/// A commented evolution to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
