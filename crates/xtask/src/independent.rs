//! The independent recomputation (`tests/independent`): answers of `measure` beside those of NumPy, SciPy, statsmodels and
//! scikit-learn, where Python has them.

use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::workspace::Workspace;
use std::process::Stdio;

/// Where an environment of its own would be, made by `.ci/run` or by hand.
const ENVIRONMENT: &str = "target/independent/bin/python";

/// Runs the comparison. Where something is missing it is left out, and the output says so and what helps.
pub(crate) fn test(workspace: &Workspace) -> Result<Outcome, Failure> {
    let own = workspace.path(ENVIRONMENT);
    let python = if own.is_file() { own.display().to_string() } else { "python3".to_owned() };
    if !imports(workspace, &python) {
        say!(
            "the independent recomputation is left out: there is no Python with numpy, scipy, statsmodels and \
             scikit-learn; `python3 -m venv target/independent` and `target/independent/bin/python -m pip install -r \
             tests/independent/requirements.txt`"
        );
        return Ok(Outcome::default());
    }
    let mut cargo = workspace.cargo();
    // with all crates at once, as the tests are built, so that nothing is compiled twice
    cargo.args(["build", "--quiet", "--workspace", "--example", "independent"]);
    if crate::workspace::succeed(&mut cargo, "").is_err() {
        say!("the example `independent` of `measure` did not build: counted as one failure");
        return Ok(Outcome { passed: 0, failed: 1 });
    }
    let mut tests = workspace.tool(&python);
    tests.args(["-B", "tests/independent/run.py"]).arg(program(workspace));
    Outcome::of(&mut tests, "the independent recomputation")
}

/// The built example, in the folder that cargo builds in.
fn program(workspace: &Workspace) -> std::path::PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.path("target"), Into::into);
    target.join("debug/examples/independent")
}

/// Whether this Python has what the comparison imports.
fn imports(workspace: &Workspace, python: &str) -> bool {
    let mut tool = workspace.tool(python);
    tool.args(["-c", "import numpy, scipy, statsmodels, sklearn"]).stdout(Stdio::null()).stderr(Stdio::null());
    tool.status().is_ok_and(|status| status.success())
}
