//! The command line `flockworks`.

use clap::Parser;
use flockworks::Fault;
use flockworks::command::{Line, run};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    // a fault of ours is one message, never a backtrace
    std::panic::set_hook(Box::new(|panic| {
        let _ = writeln!(std::io::stderr(), "flockworks: this is our fault: {panic}");
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
                // that nobody reads it any more is no fault
                Fault::Shown(_) => drop(writeln!(std::io::stderr(), "{fault}")),
                Fault::Input(_) | Fault::Ours(_) => drop(writeln!(std::io::stderr(), "flockworks: {fault}")),
            }
            ExitCode::from(fault.code())
        }
    }
}
