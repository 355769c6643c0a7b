//! Laws and pieces of laws that models of one family share. A model file says what is its own; what several say alike stands
//! here, and is compiled once for all of them.

pub mod angles;
pub mod control;
pub mod environment;
pub mod facing;
pub mod heading_consensus;
pub mod horizon;
pub mod huth_wissel;
pub mod kobot;
pub mod morse;
pub mod nearest_neighbour;
pub mod pair_law;
pub mod tanner;
