//! `flockworks`: the command line. It reads files, hands them to the rooms below, and prints what comes back; the logic is theirs.

pub mod analyze;
pub mod bench;
pub mod case;
pub mod command;
pub mod compositions;
pub mod conformance;
pub mod emit;
pub mod eval;
pub mod export;
pub mod fault;
pub mod files;
pub mod json;
pub mod kinds;
pub mod metrics;
pub mod models;
pub mod picture;
pub mod run;
pub mod step;
pub mod table;
pub mod taxonomy;
pub mod terms;
pub mod usage;
pub mod view;
pub mod workloads;

pub use fault::Fault;
