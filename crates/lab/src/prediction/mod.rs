//! Predictions: what a construct will do to a group, told by a model of the group as a whole (a macroscopic model) that is fitted to trials
//! among other constructs.
//!
//! A prediction file names a schema with ranges, a scenario and a behaviour. [`plan`] reads it and draws constructs; [`state`] is the group in
//! a few numbers, [`surroundings`] the walls as it meets them, [`model`] the law from one moment to the next, fitted by [`regression`] and
//! [`cells`]; [`course`] runs it among the walls of a construct, without agents. [`execute`] simulates and predicts construct after construct
//! and keeps each in an append-only log, [`results`] holds both beside each other, [`tables`] writes them down, [`report`] draws the page.

pub mod cells;
pub mod course;
pub mod execute;
pub mod form;
pub mod model;
pub mod plan;
pub mod regression;
pub mod report;
pub mod results;
pub mod state;
pub mod surroundings;
pub mod tables;

pub use plan::{Plan, read};

/// A commented prediction to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
