//! The command line `flockworks`.

#![allow(clippy::print_stderr, reason = "the one place where messages are printed")]

use clap::Parser;
use flockworks::Fault;
use flockworks::command::{Line, run};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    // a fault of ours is one message, never a backtrace
    std::panic::set_hook(Box::new(|panic| {
        eprintln!("flockworks: this is our fault: {panic}");
        std::process::exit(70);
    }));
    let line = Line::parse();
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    let done = run(&line, &mut out);
    let flushed = out.flush().map_err(Fault::from);
    match done.and_then(|code| flushed.map(|()| code)) {
        Ok(code) => ExitCode::from(code),
        Err(fault) => {
            match &fault {
                Fault::Closed => {}
                Fault::Shown(_) => eprintln!("{fault}"),
                Fault::Input(_) | Fault::Ours(_) => eprintln!("flockworks: {fault}"),
            }
            ExitCode::from(fault.code())
        }
    }
}
