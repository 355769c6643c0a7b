//! `swarm`: the five stages, the models, bodies and robots, resources, the world and its engine.
//!
//! A step reads as the data flow: world -> sensing -> detection -> selection -> motion -> physics -> world'.
//! It knows no file and no screen.

pub mod adaptation;
pub mod card;
pub mod conduct;
pub mod detection;
pub mod engine;
pub mod models;
pub mod motion;
pub mod names;
pub mod pace;
pub mod parameters;
pub mod physics;
pub mod resources;
pub mod selection;
pub mod sensing;
pub mod stimulus;
pub mod terms;

pub use engine::{Driver, Group, World, WorldError, WorldPlan};
