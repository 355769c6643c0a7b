//! Physical motion, the fifth stage: from the wanted to the actual motion.
//!
//! [`Mobility`] is what a body can do by itself; [`Contact`] is what happens where the way is not free.

pub mod capsule;
mod contact;
mod mobility;

pub use contact::{Contact, Met, Resolved, free_of_environment, resolve};
pub use mobility::{DifferentialDrive, Mobility};
