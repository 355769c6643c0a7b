//! Environments that steer a group, in files: workspaces, grammars, filters and behaviours as they are written, the trials by
//! which an environment is judged, and the statements that are made of the results. What files of the kinds `design` and `map`
//! have in common stands here; geometry and behaviours themselves are of the rooms `terrain` and `measure`.

pub mod behaviour;
pub mod candidates;
pub mod claims;
pub mod doors;
pub mod filter;
pub mod grammar;
pub mod relay;
pub mod signal;
pub mod stages;
pub mod trial;
pub mod work;
pub mod workspace;
