//! `cargo xtask test`: check, then every test, with the sum over all test binaries, the browser and the independent recomputation
//! as the last line.

use crate::browser;
use crate::check;
use crate::failure::Failure;
use crate::independent;
use crate::workspace::{Workspace, not_run};
use std::io::{BufRead, BufReader};
use std::process::Stdio;

/// Tests that ran.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Sum {
    passed: usize,
    failed: usize,
}

impl Sum {
    /// Adds what a line of a test binary's output says, if it is the closing one.
    fn read(&mut self, line: &str) {
        let Some((_, counts)) = line.split_once("test result: ") else { return };
        let words: Vec<&str> = counts.split([' ', ';', ',']).collect();
        let count = |what: &str| {
            let place = words.iter().position(|&word| word == what)?;
            words.get(place.checked_sub(1)?)?.parse::<usize>().ok()
        };
        self.passed += count("passed").unwrap_or(0);
        self.failed += count("failed").unwrap_or(0);
    }
}

/// Runs the checks and the tests. The tests run even when a check fails; either failing is a failure.
pub(crate) fn test(workspace: &Workspace) -> Result<(), Failure> {
    let checked = check::check(workspace);
    if let Err(failure) = &checked {
        eprintln!("xtask: {failure}");
    }
    let mut cargo = workspace.cargo();
    cargo.args(["test", "--workspace", "--no-fail-fast"]).stdout(Stdio::piped());
    let mut child = cargo.spawn().map_err(|error| not_run(&cargo, &error))?;
    let mut sum = Sum::default();
    if let Some(output) = child.stdout.take() {
        let mut output = BufReader::new(output);
        let mut line = Vec::new();
        loop {
            match output.read_until(b'\n', &mut line) {
                Ok(0) => break,
                Ok(_) => {}
                // the test binaries have nowhere to write from here on, and fail
                Err(error) => {
                    say!("what the tests say cannot be read: {error}");
                    break;
                }
            }
            let text = String::from_utf8_lossy(&line);
            say!("{}", text.trim_end_matches('\n'));
            sum.read(&text);
            line.clear();
        }
    }
    let status = child.wait().map_err(|error| not_run(&cargo, &error))?;
    if !status.success() && sum.failed == 0 {
        say!("a crate did not build, or a test binary did not reach its end: counted as one failure");
        sum.failed = 1;
    }
    for outcome in [browser::test(workspace)?, independent::test(workspace)?] {
        sum.passed += outcome.passed;
        sum.failed += outcome.failed;
    }
    if checked.is_err() {
        say!("the checks before the tests did not pass: see the top of this output");
    }
    say!("{} passed, {} failed", sum.passed, sum.failed);
    // that line stays the last one
    match checked {
        Ok(()) if sum.failed == 0 => Ok(()),
        Ok(()) => Err(Failure::Said(1)),
        Err(failure) => Err(Failure::Said(failure.code())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_the_closing_lines() {
        let mut sum = Sum::default();
        for line in [
            "running 3 tests",
            "test a ... ok",
            "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s",
            "test result: FAILED. 10 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.20s\n",
        ] {
            sum.read(line);
        }
        assert_eq!(sum, Sum { passed: 13, failed: 2 });
    }
}
