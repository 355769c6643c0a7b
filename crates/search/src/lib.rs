//! `search`: searches over plain numbers, which never know what the numbers mean.
//!
//! Every search is asked and told: it hands out points (`ask`, or `candidates`), somebody finds out how good they are,
//! in whatever order and on however many threads, and tells it the values in the order of the points. What a search does
//! next depends on its plan, its seed and the values told, and on nothing else. So it can stop anywhere and go on: the
//! [genetic algorithm](genetic) from its population, [CMA-ES](evolution_strategy) and [MAP-Elites](elites) from the
//! values told so far, a [refinement](refine) from its cells. [Identification](identify) searches among hypotheses instead of points.
//!
//! Larger values are better. A value that is not a number is worse than any number.

#![cfg_attr(test, allow(clippy::unwrap_used, reason = "tests"))]

pub mod crossover;
mod domain;
mod draws;
pub mod elites;
mod error;
pub mod evolution_strategy;
pub mod genetic;
pub mod identify;
pub mod mutation;
pub mod refine;
pub mod selection;

pub use domain::{Axis, Domain};
pub use draws::Draws;
pub use error::SearchError;
