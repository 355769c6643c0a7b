//! Adding a model touches one file and one line: in a copy of the engine's sources, as an author would do it.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const NAME: &str = "mean_heading_of_the_test";
const LIST: &str = "crates/swarm/src/models/mod.rs";

#[test]
fn one_file_and_one_line_and_it_compiles() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("new-model");
    let copy = folder.join("workspace");
    let _ = std::fs::remove_dir_all(&copy);
    copy_engine(&copy);

    let before = contents(&copy);
    let xtask = |name: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
        command.args(["new-model", name]).current_dir(&copy).stdout(Stdio::null()).status().unwrap().code()
    };
    assert_eq!(xtask(NAME), Some(0));
    let after = contents(&copy);
    let file = format!("crates/swarm/src/models/{NAME}.rs");
    let touched: Vec<&str> =
        after.iter().filter(|(f, text)| before.get(*f) != Some(text)).map(|(f, _)| f.as_str()).collect();
    assert_eq!(touched, [file.as_str(), LIST]);
    assert_eq!(before.len() + 1, after.len(), "nothing was removed");
    let line = "    streams mean_heading_of_the_test::MeanHeadingOfTheTest in [2, 3];\n";
    assert_eq!(after[LIST].replacen(line, "", 1), before[LIST]);

    // the same name again, and names that cannot be, change nothing
    assert_eq!(xtask(NAME), Some(2));
    assert_eq!(xtask("Mean-Heading"), Some(2));
    assert_eq!(contents(&copy), after);

    // with its tests; dependencies are those of this workspace, so that no network is needed
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let check = Command::new(cargo)
        .args(["check", "--offline", "--package", "swarm", "--lib", "--profile", "test"])
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .current_dir(&copy)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&check.stderr);
    assert!(check.status.success(), "{said}");
    assert!(!said.contains(&file), "the new file compiles without a warning: {said}");
    std::fs::remove_dir_all(&copy).unwrap();
}

/// Copies the crate `swarm`, the crates it stands on, and a manifest of these alone.
fn copy_engine(to: &Path) {
    let from: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut members = vec!["swarm".to_owned()];
    let mut at = 0;
    while at < members.len() {
        let folder = format!("crates/{}", members[at]);
        let manifest = std::fs::read_to_string(from.join(&folder).join("Cargo.toml")).unwrap();
        for name in manifest.lines().filter_map(|line| line.split_once(".workspace").map(|(name, _)| name.trim())) {
            if from.join("crates").join(name).is_dir() && !members.iter().any(|member| member == name) {
                members.push(name.to_owned());
            }
        }
        copy_folder(&from.join(&folder), &to.join(&folder));
        at += 1;
    }
    let list: Vec<String> = members.iter().map(|member| format!("\"crates/{member}\"")).collect();
    let mut manifest = String::new();
    for line in std::fs::read_to_string(from.join("Cargo.toml")).unwrap().lines() {
        if line.starts_with("members = ") {
            manifest += &format!("members = [{}]\n", list.join(", "));
        } else if !line.starts_with("default-members") {
            manifest += &format!("{line}\n");
        }
    }
    std::fs::write(to.join("Cargo.toml"), manifest).unwrap();
    for file in ["Cargo.lock", "rustfmt.toml"] {
        std::fs::copy(from.join(file), to.join(file)).unwrap();
    }
}

fn copy_folder(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let place = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy_folder(&entry.path(), &place);
        } else {
            std::fs::copy(entry.path(), place).unwrap();
        }
    }
}

/// Every file of a folder with its text.
fn contents(folder: &Path) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(here) = folders.pop() {
        for entry in std::fs::read_dir(&here).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().replace('\\', "/");
                found.insert(name, String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned());
            }
        }
    }
    found
}
