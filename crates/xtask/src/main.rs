//! `cargo xtask`: the tasks of this workspace. Nothing but the standard library, so that it builds at once.

#![allow(clippy::print_stderr, reason = "a command line tool")]

/// Prints a line; a reader that went away is no failure of the task.
macro_rules! say {
    ($($text:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stdout(), $($text)*);
    }};
}

mod browser;
mod check;
mod code;
mod docs;
mod failure;
mod independent;
mod list;
mod literature;
mod new_model;
mod outcome;
mod rustfmt;
mod test;
mod workspace;

use failure::Failure;
use std::process::ExitCode;
use workspace::Workspace;

const USAGE: &str = "\
cargo xtask TASK

  check            formatting, clippy, and the rules of the house
  test             check, then every test, of pages in a browser and against SciPy too; the last line is \"N passed, N failed\"
  test --literature
                   published results made again, by the studies of studies/literature; minutes
  bench [ARGS]     flockworks bench, release build; the arguments are passed on
  docs [--check]   write docs/models from the code, or only say whether it is up to date
  new-model NAME   write a model file and its line in the list of models
  fmt              format every Rust file

Exit codes: 0 done; 1 ran, and the answer is no; 2 the input is wrong; 70 a tool could not be run.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if !matches!(failure, Failure::Said(_)) {
                eprintln!("xtask: {failure}");
            }
            ExitCode::from(failure.code())
        }
    }
}

fn run(arguments: &[String]) -> Result<(), Failure> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        [] | ["help" | "--help" | "-h"] => {
            say!("{USAGE}");
            Ok(())
        }
        ["check"] => check::check(&Workspace::find()?),
        ["test"] => test::test(&Workspace::find()?),
        ["test", "--literature"] => literature::test(&Workspace::find()?),
        ["bench", rest @ ..] => bench(&Workspace::find()?, rest),
        ["docs"] => docs::write(&Workspace::find()?),
        ["docs", "--check"] => docs::compare(&Workspace::find()?),
        ["new-model", name] => new_model::new_model(&Workspace::find()?, name),
        ["new-model", ..] => Err(Failure::Input("new-model takes one name in lower snake case".into())),
        ["fmt"] => rustfmt::format(&Workspace::find()?),
        [task @ ("check" | "test" | "docs" | "fmt"), argument, ..] => {
            Err(Failure::Input(format!("`{task}` does not take `{argument}`\n\n{USAGE}")))
        }
        [task, ..] => Err(Failure::Input(format!("there is no task `{task}`\n\n{USAGE}"))),
    }
}

fn bench(workspace: &Workspace, arguments: &[&str]) -> Result<(), Failure> {
    let mut cargo = workspace.cargo();
    cargo.args(["run", "--release", "--package", "flockworks", "--", "bench"]).args(arguments);
    workspace::succeed(&mut cargo, "the benchmark did not finish")
}
