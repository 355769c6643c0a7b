//! No model keeps the texts that `new-model` leaves to its author.

use super::Rule;
use crate::failure::Failure;
use crate::list;
use crate::workspace::Workspace;

pub(super) const RULE: Rule =
    Rule { name: "placeholders", sentence: "these model files still have texts marked REPLACE ME:", broken };

fn broken(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for name in workspace.entries(list::FOLDER)?.iter().filter(|name| name.ends_with(".rs")) {
        let file = format!("{}/{name}", list::FOLDER);
        let count = workspace.read(&file)?.matches("REPLACE ME").count();
        if count > 0 {
            problems.push(format!("{file}: {count}"));
        }
    }
    Ok(problems)
}
