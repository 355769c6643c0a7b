//! Formatting, file by file: model files are declared inside a macro, which `cargo fmt` does not follow.

use crate::failure::Failure;
use crate::workspace::{Workspace, not_run, succeed};
use std::process::Command;

fn rustfmt(workspace: &Workspace) -> Result<Command, Failure> {
    let files = workspace.rust_files()?;
    let mut command = workspace.tool("rustfmt");
    command.args(["--edition", "2024"]).args(files);
    Ok(command)
}

/// Formats every Rust file.
pub(crate) fn format(workspace: &Workspace) -> Result<(), Failure> {
    succeed(&mut rustfmt(workspace)?, "rustfmt could not format every file")
}

/// The files that are formatted differently.
pub(crate) fn unformatted(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let mut command = rustfmt(workspace)?;
    command.args(["--check", "--files-with-diff"]);
    let output = command.output().map_err(|error| not_run(&command, &error))?;
    // a file is listed once for itself and once for every file that declares it
    let root = workspace.path("");
    let mut files: Vec<String> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| line.strip_prefix(&*root.to_string_lossy()).unwrap_or(line).to_owned())
        .collect();
    files.sort_unstable();
    files.dedup();
    if files.is_empty() && !output.status.success() {
        return Err(Failure::Tool(format!("rustfmt: {}", String::from_utf8_lossy(&output.stderr).trim())));
    }
    Ok(files)
}
