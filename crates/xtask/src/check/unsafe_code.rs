//! Unsafe code stands where it is reviewed, and nowhere else.

use super::Rule;
use crate::code::lines_with;
use crate::failure::Failure;
use crate::workspace::Workspace;

pub(super) const RULE: Rule = Rule {
    name: "unsafe code",
    sentence: "unsafe code is allowed in the hot loop's files alone (docs/ARCHITECTURE.md says which and why), not here:",
    broken,
};

/// Vector instructions, shared slices, and the loops that write disjoint rows from several threads.
pub(super) const ALLOWED: [&str; 7] = [
    "crates/space/src/grid.rs",
    "crates/space/src/lanes.rs",
    "crates/space/src/parallel.rs",
    "crates/swarm/src/engine/kernel.rs",
    "crates/swarm/src/engine/layered.rs",
    "crates/swarm/src/engine/step.rs",
    "crates/swarm/src/engine/world.rs",
];

fn broken(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for file in workspace.rust_files()?.iter().filter(|file| !ALLOWED.contains(&file.as_str())) {
        for line in lines_with(&workspace.read(file)?, "unsafe") {
            problems.push(format!("{file}:{line}"));
        }
    }
    Ok(problems)
}
