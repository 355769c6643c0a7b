//! The folder of a run: its manifest, its lock, and files that are whole or not there.

use crate::StoreError;
use serde_json::Value as Json;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Name of the manifest: everything that may differ between two equal runs is in it, and only in it.
pub const MANIFEST: &str = "manifest.json";
/// Name of the lock.
const LOCK: &str = ".lock";

/// A folder that this process alone writes to.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    /// Held, not read.
    _lock: File,
}

impl Folder {
    /// Claims a folder, which is made if it is not there. It must be empty or the folder of a run.
    ///
    /// # Errors
    /// Where the system refuses, another process writes there, or it holds other things.
    pub fn claim(path: &Path) -> Result<Self, StoreError> {
        let other = |entry: std::io::Result<std::fs::DirEntry>| entry.is_ok_and(|e| e.file_name() != LOCK);
        if path.exists() && !path.join(MANIFEST).exists() {
            let mut entries =
                std::fs::read_dir(path).map_err(|error| StoreError::io("read the folder", path, error))?;
            if entries.any(other) {
                return Err(StoreError::Refused(format!(
                    "`{}` holds files that are no run of this program; choose another folder with --out",
                    path.display()
                )));
            }
        }
        std::fs::create_dir_all(path).map_err(|error| StoreError::io("make the folder", path, error))?;
        let lock = path.join(LOCK);
        let open = OpenOptions::new().write(true).create(true).truncate(false).open(&lock);
        let file = open.map_err(|error| StoreError::io("write in the folder", path, error))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), _lock: file }),
            Err(TryLockError::WouldBlock) => {
                Err(StoreError::Refused(format!("another process is writing to `{}`", path.display())))
            }
            Err(TryLockError::Error(error)) => Err(StoreError::io("lock", &lock, error)),
        }
    }
    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
    /// The place of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
    /// Writes the manifest.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn write_manifest(&self, manifest: &Json) -> Result<(), StoreError> {
        let mut text = serde_json::to_string_pretty(manifest).unwrap_or_default();
        text.push('\n');
        self.write(MANIFEST, |out| {
            out.write_all(text.as_bytes()).map_err(|error| StoreError::io("write", &self.file(MANIFEST), error))
        })
    }
    /// Writes a file so that it is either whole or as it was before.
    ///
    /// # Errors
    /// What `fill` says, or where the system refuses.
    pub fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), StoreError>,
    ) -> Result<(), StoreError> {
        whole_file(&self.file(name), fill)
    }
    /// As [`Self::write`], a text.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn write_text(&self, name: &str, text: &str) -> Result<(), StoreError> {
        let path = self.file(name);
        self.write(name, |out| out.write_all(text.as_bytes()).map_err(|error| StoreError::io("write", &path, error)))
    }
}

/// Writes a file so that it is either whole or as it was before.
///
/// # Errors
/// What `fill` says, or where the system refuses.
pub fn whole_file(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> Result<(), StoreError>,
) -> Result<(), StoreError> {
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    let part = PathBuf::from(part);
    let attempt = || {
        let file = File::create(&part).map_err(|error| StoreError::io("create", &part, error))?;
        let mut out = BufWriter::with_capacity(1 << 18, file);
        fill(&mut out)?;
        let file = out.into_inner().map_err(|error| StoreError::io("write", path, error.into_error()))?;
        drop(file);
        std::fs::rename(&part, path).map_err(|error| StoreError::io("write", path, error))
    };
    let done = attempt();
    if done.is_err() {
        // nothing half-written stays; that it could not be removed says no more than the first error
        let _ = std::fs::remove_file(&part);
    }
    done
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(self.path.join(LOCK));
    }
}

/// The manifest of a folder; none where there is none.
///
/// # Errors
/// Where the system refuses or it is damaged.
pub fn manifest(path: &Path) -> Result<Option<Json>, StoreError> {
    let file = path.join(MANIFEST);
    match std::fs::read_to_string(&file) {
        Ok(text) => serde_json::from_str(&text).map(Some).map_err(|error| {
            StoreError::Damaged(format!("`{}` is damaged: {error}; remove the folder to run anew", file.display()))
        }),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(StoreError::io("read", &file, error)),
    }
}

/// The folder for what a file makes: the one asked for, or one below `runs`, called `stem`, that is free or holds the same.
/// `what` it is, and what may be added to it, is told where it holds another; `differences` tells from a manifest where.
///
/// # Errors
/// A folder asked for that holds another.
pub fn place(
    out: Option<&Path>,
    stem: &str,
    (what, may_grow): (&str, &str),
    differences: &dyn Fn(&Json) -> Vec<String>,
) -> Result<PathBuf, StoreError> {
    if let Some(out) = out {
        let lines = manifest(out)?.map_or_else(Vec::new, |manifest| differences(&manifest));
        return if lines.is_empty() { Ok(out.to_owned()) } else { Err(other(out, (what, may_grow), lines)) };
    }
    free(stem, &|manifest| differences(manifest).is_empty()).map(|(path, _)| path)
}

/// A folder below `runs`, called `stem`, that is free or holds what is the `same` by its manifest, which comes with it.
///
/// # Errors
/// Where none is free.
pub fn free(stem: &str, same: &dyn Fn(&Json) -> bool) -> Result<(PathBuf, Option<Json>), StoreError> {
    for number in 1.. {
        let path = Path::new("runs").join(if number == 1 { stem.to_owned() } else { format!("{stem}-{number}") });
        if !path.exists() {
            return Ok((path, None));
        }
        // a damaged or foreign folder is somebody's: the next number is free
        if let Ok(Some(manifest)) = manifest(&path)
            && same(&manifest)
        {
            return Ok((path, Some(manifest)));
        }
    }
    Err(StoreError::Refused("no folder is free below `runs`".into()))
}

/// Says that a folder holds another study (or whatever it is), with the first lines of where it differs.
pub fn other(path: &Path, (what, may_grow): (&str, &str), lines: Vec<String>) -> StoreError {
    let help = format!("{may_grow} may be added, nothing else may change; choose another folder with --out");
    StoreError::Refused(format!("`{}` holds another {what}; {help}\n  {}", path.display(), first(lines)))
}

/// The first lines of where two files differ, and how many more there are.
pub fn first(mut lines: Vec<String>) -> String {
    let more = lines.len().saturating_sub(8);
    lines.truncate(8);
    if more > 0 {
        lines.push(format!("and {more} more"));
    }
    lines.join("\n  ")
}

/// Where two files as resolved differ, one line for each path.
pub fn differences(there: &Json, now: &Json) -> Vec<String> {
    let mut lines = Vec::new();
    compare("", Some(there), Some(now), &mut lines);
    lines
}

fn compare(path: &str, there: Option<&Json>, now: Option<&Json>, lines: &mut Vec<String>) {
    match (there, now) {
        (Some(Json::Object(a)), Some(Json::Object(b))) => {
            let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            a.iter().for_each(|(key, value)| compare(&below(key), Some(value), b.get(key), lines));
            let added = b.iter().filter(|(key, _)| !a.contains_key(*key));
            added.for_each(|(key, value)| compare(&below(key), None, Some(value), lines));
        }
        (a, b) if a == b => {}
        (a, b) => {
            let text = |value: Option<&Json>| match value {
                None => "nothing".to_owned(),
                Some(value) => {
                    let text = value.to_string();
                    if text.chars().count() > 60 { text.chars().take(57).chain("...".chars()).collect() } else { text }
                }
            };
            lines.push(format!("{path}: {} there, {} now", text(a), text(b)));
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn differences_are_named_by_path() {
        let (a, b) = (json!({"x": {"y": 1, "z": [1, 2]}, "only": 3}), json!({"x": {"y": 2, "z": [1, 2]}, "new": "n"}));
        assert_eq!(
            differences(&a, &b),
            ["x.y: 1 there, 2 now", "only: 3 there, nothing now", "new: nothing there, \"n\" now"]
        );
        assert!(differences(&a, &a).is_empty());
    }

    #[test]
    fn a_folder_has_one_writer_and_no_half_files() {
        let path = std::env::temp_dir().join(format!("flockworks-folder-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        let folder = Folder::claim(&path).unwrap();
        assert!(Folder::claim(&path).unwrap_err().to_string().contains("another process"));
        folder.write("a", |out| out.write_all(b"one").map_err(|e| StoreError::io("write", &path, e))).unwrap();
        let failed = folder.write("a", |out| {
            out.write_all(b"two").map_err(|e| StoreError::io("write", &path, e))?;
            Err(StoreError::Refused("no".into()))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read(path.join("a")).unwrap(), b"one");
        assert!(!path.join("a.part").exists());
        drop(folder);
        assert!(Folder::claim(&path).unwrap_err().to_string().contains("no run of this program"));
        std::fs::write(path.join(MANIFEST), "{").unwrap();
        assert!(manifest(&path).unwrap_err().to_string().contains("damaged"));
        std::fs::remove_dir_all(&path).unwrap();
    }
}
