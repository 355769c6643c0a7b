//! The command line `flockworks`.

use flockworks::command::run;
use flockworks::{Fault, usage};
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    // a fault of ours is one message, never a backtrace
    std::panic::set_hook(Box::new(|panic| {
        let _ = writeln!(std::io::stderr(), "flockworks: this is our fault: {panic}");
        std::process::exit(70);
    }));
    let line = match usage::read() {
        Ok(line) => line,
        Err(error) => {
            match usage::mistake(&error) {
                Some(fault) => drop(writeln!(std::io::stderr(), "flockworks: {fault}")),
                None => drop(error.print()),
            }
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
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
