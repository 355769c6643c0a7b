//! `cargo xtask test --literature`: published results, made again. Each file of `studies/literature` is a study whose statements
//! of strength A must hold; their pages are left in `target/literature`.

use crate::failure::Failure;
use crate::workspace::{Workspace, not_run, succeed};
use std::path::{Path, PathBuf};

/// The studies.
const STUDIES: &str = "studies/literature";

/// Runs every study anew by the program as tests build it, which is optimised.
pub(crate) fn test(workspace: &Workspace) -> Result<(), Failure> {
    let mut cargo = workspace.cargo();
    // with an example, and so with what tests depend on: else other features would compile the engine once more
    cargo.args(["build", "--workspace", "--bin", "flockworks", "--example", "sample_page"]);
    succeed(&mut cargo, "flockworks did not build")?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.path("target"), PathBuf::from);
    let (mut passed, mut failed) = (0, Vec::new());
    let studies = workspace.entries(STUDIES)?;
    for study in studies.iter().filter_map(|name| name.strip_suffix(".toml")) {
        let out = target.join("literature").join(study);
        clear(&out)?;
        say!("\n{study}");
        let mut run = workspace.tool(&target.join("debug/flockworks").display().to_string());
        run.arg("run").arg(format!("{STUDIES}/{study}.toml")).arg("--out").arg(&out).arg("--must-hold");
        let status = run.status().map_err(|error| not_run(&run, &error))?;
        if status.success() {
            passed += 1;
        } else {
            failed.push(study);
        }
    }
    if !failed.is_empty() {
        say!("\nnot as published: {}", failed.join(", "));
    }
    say!("\n{passed} passed, {} failed", failed.len());
    if failed.is_empty() && passed > 0 { Ok(()) } else { Err(Failure::Said(1)) }
}

/// Removes a folder of results, which would be continued rather than made again.
fn clear(folder: &Path) -> Result<(), Failure> {
    if !folder.exists() {
        return Ok(());
    }
    std::fs::remove_dir_all(folder)
        .map_err(|error| Failure::Tool(format!("cannot remove {}: {error}", folder.display())))
}
