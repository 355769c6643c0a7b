//! The workspace: where it is, which files it has, how its tools are called.

use crate::failure::Failure;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The workspace, by the folder that holds its `Cargo.toml`.
pub(crate) struct Workspace {
    root: PathBuf,
}

impl Workspace {
    /// The workspace around the current folder.
    pub(crate) fn find() -> Result<Self, Failure> {
        let here = std::env::current_dir().map_err(|error| Failure::Tool(format!("no current folder: {error}")))?;
        let is_root = |folder: &&Path| {
            std::fs::read_to_string(folder.join("Cargo.toml"))
                .is_ok_and(|text| text.lines().any(|line| line.trim() == "[workspace]"))
        };
        match here.ancestors().find(is_root) {
            Some(root) => Ok(Self { root: root.to_owned() }),
            None => Err(Failure::Input("run this inside the workspace".into())),
        }
    }
    /// The path of a file, from its path in the workspace.
    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.root.join(file)
    }
    /// The text of a file.
    pub(crate) fn read(&self, file: &str) -> Result<String, Failure> {
        std::fs::read_to_string(self.path(file)).map_err(|error| Failure::Tool(format!("cannot read {file}: {error}")))
    }
    /// Writes a file, making its folder where there is none.
    pub(crate) fn write(&self, file: &str, text: &str) -> Result<(), Failure> {
        let path = self.path(file);
        let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        made.and_then(|()| std::fs::write(&path, text))
            .map_err(|error| Failure::Tool(format!("cannot write {file}: {error}")))
    }
    /// The names of the files and folders in a folder, sorted.
    pub(crate) fn entries(&self, folder: &str) -> Result<Vec<String>, Failure> {
        let path = self.path(folder);
        let broken = |error: std::io::Error| Failure::Tool(format!("cannot read the folder {folder}: {error}"));
        let mut names = Vec::new();
        for entry in std::fs::read_dir(path).map_err(broken)? {
            names.push(entry.map_err(broken)?.file_name().to_string_lossy().into_owned());
        }
        names.sort_unstable();
        Ok(names)
    }
    /// Every file that git tracks or would track, with `/` between folders. Outside a repository: every file that
    /// is not in `target`.
    pub(crate) fn files(&self) -> Result<Vec<String>, Failure> {
        let git = Command::new("git")
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .current_dir(&self.root)
            .stderr(Stdio::null())
            .output();
        let mut files: Vec<String> = match git {
            Ok(output) if output.status.success() => {
                let text = String::from_utf8_lossy(&output.stdout).into_owned();
                text.split('\0').filter(|file| self.path(file).is_file()).map(str::to_owned).collect()
            }
            _ => {
                let mut found = Vec::new();
                self.walk("", &mut found)?;
                found
            }
        };
        files.sort_unstable();
        files.dedup();
        Ok(files)
    }
    fn walk(&self, folder: &str, to: &mut Vec<String>) -> Result<(), Failure> {
        for name in self.entries(folder)? {
            let file = if folder.is_empty() { name.clone() } else { format!("{folder}/{name}") };
            let path = self.path(&file);
            if path.is_dir() && !path.is_symlink() {
                if name != "target" && name != ".git" {
                    self.walk(&file, to)?;
                }
            } else if path.is_file() {
                to.push(file);
            }
        }
        Ok(())
    }
    /// Every Rust file.
    pub(crate) fn rust_files(&self) -> Result<Vec<String>, Failure> {
        let mut files = self.files()?;
        files.retain(|file| file.ends_with(".rs"));
        Ok(files)
    }
    /// The cargo that runs this task, in the root of the workspace and without input.
    pub(crate) fn cargo(&self) -> Command {
        self.tool(&std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()))
    }
    /// A tool, in the root of the workspace and without input.
    pub(crate) fn tool(&self, name: &str) -> Command {
        let mut command = Command::new(name);
        command.current_dir(&self.root).stdin(Stdio::null());
        command
    }
}

/// Runs a command to its end; `problem` is said when it does not succeed.
pub(crate) fn succeed(command: &mut Command, problem: &str) -> Result<(), Failure> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(Failure::No(problem.to_owned())),
        Err(error) => Err(not_run(command, &error)),
    }
}

/// A command that could not be started.
pub(crate) fn not_run(command: &Command, error: &std::io::Error) -> Failure {
    Failure::Tool(format!("cannot run {}: {error}", command.get_program().display()))
}
