//! Maps: which parameters of a schema make a group do what is wanted, by dynamic resolution.
//!
//! A map file names a workspace, a schema with axes, a scenario, and a behaviour. [`plan`] reads it, [`execute`] evaluates cell
//! after cell and keeps each in an append-only log, [`measures`] tells densities and components, [`tables`] writes the leaves,
//! [`report`] draws the page.

pub mod execute;
pub mod form;
pub mod measures;
pub mod plan;
pub mod report;
pub mod tables;

pub use plan::{Plan, read};

/// A commented map to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
