//! `cargo xtask check`: formatting, clippy, and the rules of the house, one file each.

mod formatting;
mod lints;
mod model_list;
mod names;
mod paths;
mod placeholders;
mod unsafe_code;

use crate::failure::Failure;
use crate::workspace::{Workspace, succeed};

/// A rule that every file has to keep.
struct Rule {
    /// Its name in the output.
    name: &'static str,
    /// Said when it is broken, before the places.
    sentence: &'static str,
    /// The places where it is broken.
    broken: fn(&Workspace) -> Result<Vec<String>, Failure>,
}

const RULES: &[Rule] =
    &[formatting::RULE, model_list::RULE, placeholders::RULE, names::RULE, paths::RULE, lints::RULE, unsafe_code::RULE];

/// Runs every rule and clippy, and reports all that is wrong.
pub(crate) fn check(workspace: &Workspace) -> Result<(), Failure> {
    let mut failed = Vec::new();
    for rule in RULES {
        let places = (rule.broken)(workspace)?;
        if places.is_empty() {
            say!("check {}: ok", rule.name);
        } else {
            say!("check {}: failed\n  {}\n    {}", rule.name, rule.sentence, places.join("\n    "));
            failed.push(rule.name);
        }
    }
    say!("unsafe code is allowed in:\n  {}", unsafe_code::ALLOWED.join("\n  "));
    let mut cargo = workspace.cargo();
    cargo.args(["clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"]);
    match succeed(&mut cargo, "clippy") {
        Ok(()) => say!("check clippy: ok"),
        Err(Failure::No(_)) => {
            say!("check clippy: failed\n  clippy has something to say; its words are above or below this line");
            failed.push("clippy");
        }
        Err(failure) => return Err(failure),
    }
    if failed.is_empty() { Ok(()) } else { Err(Failure::No(format!("failed checks: {}", failed.join(", ")))) }
}
