//! The world and its engine: the only hot loop, the drivers, checkpoints.

mod beside;
mod checkpoint;
mod coarse;
mod compiled;
mod conduct;
mod contacts;
pub mod explain;
mod kernel;
mod layered;
mod plan;
mod step;
mod world;

pub use compiled::Compiled;
pub use explain::Explanation;
pub(crate) use kernel::{Kernel, Listed, SideBySide, Stages, Streamed, mask_of, minimal_lanes};
pub use kernel::{MotionNoise, Sensing};
pub use plan::{
    Clock, ClockPlan, Driver, GroupPlan, IndexChoice, ObstaclePlan, Order, Phase, Placement, Start, WorldError,
    WorldPlan,
};
pub use world::{Checkpoint, Group, World};
