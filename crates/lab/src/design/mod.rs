//! Designs: environments are generated, filtered, and tried on groups, beside the same trials without them.
//!
//! A design file names a workspace, where candidates come from, what makes them feasible, a scenario, and behaviours.
//! [`plan`] reads it, [`execute`] tries candidate after candidate and keeps each in an append-only log, [`results`] counts
//! what came of them, [`tables`] writes the tables, [`report`] draws the page, [`export`] writes the best environments,
//! [`robustness`] changes them a little, [`inverse`] asks which group it is that was seen in them.

pub mod execute;
pub mod export;
pub mod form;
pub mod inverse;
pub mod plan;
pub mod report;
pub mod results;
pub mod robustness;
pub mod tables;

pub use plan::{Plan, read};

/// A commented design to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
