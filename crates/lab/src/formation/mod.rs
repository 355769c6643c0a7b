//! Formations: robots in the places of walls, and other ways of herding, on tasks that a group is to follow.
//!
//! A formation file names targets (a scenario), tasks (trajectories with gates and a goal) and methods (walls, formations of robots,
//! herding controllers). Where a task gives no walls, [`solver`] finds them. [`plan`] reads the file, [`trial`] runs one trial,
//! [`course`] one to be played, [`crate::live::form`] one to be watched, [`execute`] runs them all and keeps each in an append-only log,
//! [`results`] counts, [`tables`] and [`report`] tell.

pub mod controllers;
pub mod course;
pub mod execute;
pub mod form;
pub mod plan;
pub mod report;
pub mod results;
pub mod robot;
pub mod solver;
pub mod tables;
pub mod task;
pub mod trial;

pub use plan::{Plan, Watched, read};

/// A commented file to start from.
pub const TEMPLATE: &str = include_str!("template.toml");
