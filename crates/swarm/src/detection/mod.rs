//! Detection, the second stage: which percepts are members?
//!
//! Under ideal sensing everyone sensed is a member. Behind a scanner members have to be found among readings.

pub mod association;
pub mod readings;
