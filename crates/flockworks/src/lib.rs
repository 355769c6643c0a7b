//! `flockworks`: the command line. It reads files, hands them to the rooms below, and prints what comes back; the logic is theirs.

pub mod case;
pub mod command;
pub mod conformance;
pub mod fault;
pub mod json;
pub mod step;
pub mod table;

pub use fault::Fault;
