//! Every crate takes the lints of the workspace.

use super::Rule;
use crate::failure::Failure;
use crate::workspace::Workspace;

pub(super) const RULE: Rule = Rule {
    name: "lints",
    sentence: "these crates lack the two lines `[lints]` and `workspace = true` in their Cargo.toml:",
    broken,
};

fn broken(workspace: &Workspace) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for name in workspace.entries("crates")? {
        let file = format!("crates/{name}/Cargo.toml");
        if workspace.path(&file).is_file() && !inherits(&workspace.read(&file)?) {
            problems.push(file);
        }
    }
    Ok(problems)
}

fn inherits(manifest: &str) -> bool {
    let lines = manifest.lines().map(str::trim);
    let section = lines.skip_while(|line| *line != "[lints]").skip(1);
    section.take_while(|line| !line.starts_with('[')).any(|line| line.replace(' ', "") == "workspace=true")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_section_counts() {
        assert!(inherits("[package]\nname = \"a\"\n\n[lints]\nworkspace = true\n"));
        assert!(!inherits("[package]\nname = \"a\"\n"));
        assert!(!inherits("[lints]\n[dependencies]\nworkspace = true\n"));
    }
}
