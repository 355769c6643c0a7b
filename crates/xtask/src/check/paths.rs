//! No file names a place on somebody's machine.

use super::Rule;
use crate::failure::Failure;
use crate::workspace::Workspace;

pub(super) const RULE: Rule = Rule {
    name: "paths",
    sentence: "these lines name a place on one machine; paths are relative to the workspace, or come from the system:",
    broken,
};

/// First folders of such places.
const FOLDERS: [&str; 6] = ["home", "root", "work", "tmp", "Users", "mnt"];

fn broken(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for file in workspace.files()? {
        // what is not text names no place
        let Ok(text) = std::fs::read_to_string(workspace.path(&file)) else { continue };
        for (number, line) in text.lines().enumerate().filter(|(_, line)| names_a_place(line)) {
            let start: String = line.trim().chars().take(80).collect();
            problems.push(format!("{file}:{}: {start}", number + 1));
        }
    }
    Ok(problems)
}

fn names_a_place(line: &str) -> bool {
    FOLDERS.iter().any(|folder| {
        let place = format!("/{folder}/");
        line.match_indices(&place).any(|(at, _)| {
            let before = line[..at].chars().next_back();
            // not the middle of an address or of a relative path
            before.is_none_or(|letter| !(letter.is_alphanumeric() || "_-./})>*".contains(letter)))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_other_paths() {
        let place = |folder: &str| format!("see \"/{folder}/me/file\"");
        assert!(FOLDERS.iter().all(|folder| names_a_place(&place(folder))));
        assert!(names_a_place(&format!("/{}/a", "home")));
        for fine in ["https://example.org/home/page", "$dir/tmp/x", "target/tmp/new-model", "/usr/bin/env bash"] {
            assert!(!names_a_place(fine), "{fine}");
        }
    }
}
