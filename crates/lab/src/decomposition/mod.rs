//! Decompositions: which primitives a known construct is made of, by what its fragments do to a group.
//!
//! A decomposition file names a construct and a scenario. [`plan`] reads it and cuts the construct into fragments, [`probe`] tells what a
//! trial with one of them came to, [`execute`] tries fragment after fragment and keeps each in an append-only log, [`clusters`] puts
//! what does the same together, [`directed`] fits and varies stretches whose effect is known, [`results`] names the clusters, [`tables`] writes them down, [`primitives`] as grammars that design
//! files can name, [`report`] draws the page.

pub mod clusters;
pub mod directed;
pub mod execute;
pub mod form;
pub mod plan;
pub mod primitives;
pub mod probe;
pub mod report;
pub mod results;
pub mod tables;

pub use plan::{Plan, read};

/// A commented decomposition to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
