//! No file or folder has a name that says nothing.

use super::Rule;
use crate::failure::Failure;
use crate::workspace::Workspace;

pub(super) const RULE: Rule =
    Rule { name: "names", sentence: "call these files by what they are about, not helper, manager or utils:", broken };

const FORBIDDEN: [&str; 6] = ["helper", "helpers", "manager", "managers", "util", "utils"];

fn broken(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let mut files = workspace.files()?;
    files.retain(|file| says_nothing(file));
    Ok(files)
}

fn says_nothing(file: &str) -> bool {
    let words = file.split(['/', '.', '_', '-']).map(str::to_lowercase);
    words.into_iter().any(|word| FORBIDDEN.contains(&word.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_words_only() {
        for bad in ["crates/a/src/utils.rs", "crates/helpers/src/lib.rs", "a/task_manager.rs"] {
            assert!(says_nothing(bad), "{bad}");
        }
        assert!(!says_nothing("crates/a/src/utilisation.rs"));
    }
}
