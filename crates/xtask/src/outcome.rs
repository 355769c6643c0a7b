//! Counts of tests that other programs run.

use crate::failure::Failure;
use crate::workspace::not_run;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// What came of tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Outcome {
    pub(crate) passed: usize,
    pub(crate) failed: usize,
}

impl Outcome {
    /// Runs tests that print the Test Anything Protocol with `# pass N` and `# fail N` at the end, and shows what they
    /// print. Tests that do not reach their end count as one failure.
    pub(crate) fn of(tests: &mut Command, name: &str) -> Result<Self, Failure> {
        let mut child = tests.stdout(Stdio::piped()).spawn().map_err(|error| not_run(tests, &error))?;
        let mut outcome = Self::default();
        if let Some(output) = child.stdout.take() {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                say!("{line}");
                outcome.read(&line);
            }
        }
        let status = child.wait().map_err(|error| not_run(tests, &error))?;
        if outcome == Self::default() || (!status.success() && outcome.failed == 0) {
            say!("{name} did not reach their end: counted as one failure");
            outcome.failed += 1;
        }
        Ok(outcome)
    }
    /// Takes what a line of the output says, if it is one of the counts at its end. A test that did not reach its end
    /// has failed.
    fn read(&mut self, line: &str) {
        let Some((what, count)) = line.trim_end().strip_prefix("# ").and_then(|line| line.split_once(' ')) else {
            return;
        };
        let Ok(count) = count.parse::<usize>() else { return };
        match what {
            "pass" => self.passed += count,
            "fail" | "cancelled" => self.failed += count,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_counts_at_the_end() {
        let mut outcome = Outcome::default();
        for line in
            ["ok 1 - a", "# Subtest: pass 3", "# tests 8", "# pass 5", "# fail 2", "# cancelled 1", "# skipped 4"]
        {
            outcome.read(line);
        }
        assert_eq!(outcome, Outcome { passed: 5, failed: 3 });
    }

    #[test]
    fn tests_that_stop_early_have_failed() {
        let of = |script: &str| Outcome::of(Command::new("sh").args(["-c", script]), "tests");
        assert!(of("echo '# pass 2'").is_ok_and(|outcome| outcome == Outcome { passed: 2, failed: 0 }));
        assert!(of("echo '# pass 2'; exit 1").is_ok_and(|outcome| outcome == Outcome { passed: 2, failed: 1 }));
        assert!(of("true").is_ok_and(|outcome| outcome == Outcome { passed: 0, failed: 1 }));
    }
}
