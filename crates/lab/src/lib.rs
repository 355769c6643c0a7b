//! `lab`: files that say what they are, the run store, executors, reports. It knows nothing of HTTP.

pub mod decomposition;
pub mod design;
pub mod environment;
pub mod evolution;
pub mod explain;
pub mod export;
pub mod file;
pub mod formation;
pub mod gallery;
pub mod live;
pub mod map;
pub mod optimisation;
pub mod prediction;
pub mod report;
pub mod run;
pub mod scenario;
pub mod searched;
pub mod sketch;
pub mod store;
pub mod study;
pub mod tracks;
