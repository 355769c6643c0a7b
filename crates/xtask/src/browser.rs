//! The tests of the pages in a browser (`web/tests`), where node and a browser are there.

use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::workspace::Workspace;
use std::path::Path;
use std::process::{Command, Stdio};

/// Where the tests look for the browser.
const BROWSER: &str = "/usr/bin/chromium";
/// What `npm install` puts there.
const DRIVER: &str = "web/tests/node_modules/playwright-core";

/// Runs the tests. Where something is missing they are left out, and the output says so and what helps.
pub(crate) fn test(workspace: &Workspace) -> Result<Outcome, Failure> {
    if let Some((missing, remedy)) = missing(workspace) {
        say!("browser tests are left out: {missing}; {remedy}");
        return Ok(Outcome::default());
    }
    let mut node = workspace.tool("node");
    node.args(["--test", "--test-reporter=tap"]).current_dir(workspace.path("web/tests"));
    Outcome::of(&mut node, "the browser tests")
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
    fn versions() {
        assert_eq!([major("v20.20.2\n"), major("v8.1"), major("20"), major("")], [Some(20), Some(8), None, None]);
    }
}
