//! Every model file has exactly one line in the list, and every line its file.

use super::Rule;
use crate::failure::Failure;
use crate::list::{self, List};
use crate::workspace::Workspace;

pub(super) const RULE: Rule = Rule {
    name: "list of models",
    sentence: "every file in crates/swarm/src/models has one line in the list of models, and every line a file:",
    broken,
};

fn broken(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let list = List::read(workspace)?;
    let files: Vec<String> = workspace.entries(list::FOLDER)?;
    let modules: Vec<&str> = files.iter().filter_map(|file| file.strip_suffix(".rs")).collect();
    Ok(compare(&modules, &list.ids(), &list.other_modules()))
}

fn compare(modules: &[&str], ids: &[String], others: &[String]) -> Vec<String> {
    let mut problems = Vec::new();
    for module in modules.iter().filter(|&&m| m != "mod" && !others.iter().any(|other| other == m)) {
        match ids.iter().filter(|id| id == module).count() {
            1 => {}
            lines => problems.push(format!("{module}.rs has {lines} lines in the list")),
        }
    }
    for id in ids.iter().filter(|id| !modules.contains(&id.as_str())) {
        problems.push(format!("`{id}` is in the list and has no file {id}.rs"));
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways() {
        let ids = |words: &[&str]| words.iter().map(|&w| w.to_owned()).collect::<Vec<_>>();
        let others = ids(&["oracle"]);
        assert_eq!(compare(&["mod", "oracle", "a", "b"], &ids(&["b", "a"]), &others), [""; 0]);
        assert_eq!(compare(&["a"], &[], &others), ["a.rs has 0 lines in the list"]);
        assert_eq!(compare(&["a"], &ids(&["a", "a"]), &others), ["a.rs has 2 lines in the list"]);
        assert_eq!(compare(&[], &ids(&["a"]), &others), ["`a` is in the list and has no file a.rs"]);
    }
}
