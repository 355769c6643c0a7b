//! The tests of the pages in a browser (`web/tests`), where node and a browser are there.

use crate::failure::Failure;
use crate::workspace::{Workspace, not_run};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

/// Where the tests look for the browser.
const BROWSER: &str = "/usr/bin/chromium";
/// What `npm install` puts there.
const DRIVER: &str = "web/tests/node_modules/playwright-core";

/// What came of the tests in the browser.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Outcome {
    pub(crate) passed: usize,
    pub(crate) failed: usize,
}

impl Outcome {
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

/// Runs the tests. Where something is missing they are left out, and the output says so and what helps.
pub(crate) fn test(workspace: &Workspace) -> Result<Outcome, Failure> {
    if let Some((missing, remedy)) = missing(workspace) {
        say!("browser tests are left out: {missing}; {remedy}");
        return Ok(Outcome::default());
    }
    let mut node = workspace.tool("node");
    node.args(["--test", "--test-reporter=tap"]).current_dir(workspace.path("web/tests")).stdout(Stdio::piped());
    let mut child = node.spawn().map_err(|error| not_run(&node, &error))?;
    let mut outcome = Outcome::default();
    if let Some(output) = child.stdout.take() {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            say!("{line}");
            outcome.read(&line);
        }
    }
    let status = child.wait().map_err(|error| not_run(&node, &error))?;
    if outcome == Outcome::default() || (!status.success() && outcome.failed == 0) {
        say!("the browser tests did not reach their end: counted as one failure");
        outcome.failed += 1;
    }
    Ok(outcome)
}

/// What the tests need and do not find, and what helps.
fn missing(workspace: &Workspace) -> Option<(&'static str, &'static str)> {
    let mut node = Command::new("node");
    let version = node.arg("--version").stderr(Stdio::null()).output().ok().filter(|output| output.status.success());
    let major = version.and_then(|output| major(&String::from_utf8_lossy(&output.stdout)));
    if major.is_none_or(|major| major < 20) {
        Some(("there is no node 20 or later", "install it from your system's packages"))
    } else if !Path::new(BROWSER).exists() {
        Some(("there is no /usr/bin/chromium", "`apt-get install chromium` on Debian"))
    } else if !workspace.path(DRIVER).is_dir() {
        Some(("their driver is not installed", "`npm install` in web/tests"))
    } else {
        None
    }
}

/// The first number of a version `v20.1.2`.
fn major(version: &str) -> Option<usize> {
    version.trim().strip_prefix('v')?.split('.').next()?.parse().ok()
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
    fn versions() {
        assert_eq!([major("v20.20.2\n"), major("v8.1"), major("20"), major("")], [Some(20), Some(8), None, None]);
    }
}
