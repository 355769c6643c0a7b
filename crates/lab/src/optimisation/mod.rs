//! Optimisations: the search for the best construct of a schema, by several methods with equally many evaluations.
//!
//! An optimisation file names a workspace, a schema with axes, a scenario, a behaviour, and methods. [`plan`] reads it,
//! [`searcher`] proposes candidates, [`trials`] tries them, [`execute`] keeps each evaluation in an append-only log, [`results`]
//! tells what came of it, [`tables`] and [`report`] write it down.

pub mod execute;
pub mod form;
pub mod plan;
pub mod report;
pub mod results;
pub mod searcher;
pub mod tables;
pub mod trials;

pub use plan::{Plan, read};

/// A commented optimisation to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
