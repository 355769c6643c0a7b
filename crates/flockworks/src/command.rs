//! The commands and their options.

use crate::conformance::{ConformanceOptions, conformance};
use crate::fault::Fault;
use crate::step::{StepOptions, step};
use clap::{Parser, Subcommand};
use std::io::Write;

/// A laboratory for collective motion: models, steps, conformance, speed.
#[derive(Parser, Debug)]
#[command(
    name = "flockworks",
    version,
    max_term_width = 100,
    after_help = "\
Exit codes: 0 done; 1 ran, and the answer is no (a case failed); 2 the input is wrong; 70 our fault."
)]
pub struct Line {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// A command.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Print the state of a case after some steps, as JSON.
    Step(StepOptions),
    /// Run every case of a file and compare with the state it expects.
    ///
    /// The last line is `N of M`: cases passed of cases run. The exit code is 1 if a case fails or its model is unknown.
    Conformance(ConformanceOptions),
}

/// Runs a command; the answer is its exit code.
///
/// # Errors
/// See [`Fault`].
pub fn run(line: &Line, out: &mut dyn Write) -> Result<u8, Fault> {
    match &line.command {
        Command::Step(options) => step(options, out).map(|()| 0),
        Command::Conformance(options) => conformance(options, out).map(|good| u8::from(!good)),
    }
}
