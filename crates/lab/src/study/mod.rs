//! Studies: one scenario, varied and repeated.
//!
//! A study file names a scenario, factors with their levels, a design that makes cells of them, and what is read off each
//! trial. [`plan`] makes cells and conditions of it, [`execute`] runs what is missing and keeps it in an append-only log,
//! [`tables`] writes the tables, [`claims`] judges statements, [`report`] draws the page.

mod arrival;
pub mod bearing;
pub mod claims;
pub mod consensus;
pub mod correlation;
pub mod emptied;
pub mod execute;
pub mod expression;
pub mod form;
mod ground;
mod meals;
pub mod plan;
pub mod profile;
pub mod report;
pub mod reversals;
mod standing;
pub mod tables;
mod transfer;
pub mod trial;
mod way_points;

pub use plan::{Plan, read};

/// A commented study to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
