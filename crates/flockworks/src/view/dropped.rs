//! Files that were dropped on the page: what they are, and what is shown of them.
//!
//! A browser does not say where a file lies, so it hands over the bytes. They are kept in a folder of the server's own for as long as
//! it runs, and opened from there as the command line opens them.

use super::{Given, ViewOptions, given_of};
use crate::analyze::{self, Job};
use crate::fault::Fault;
use crate::kinds;
use lab::live::{Course, Replayed};
use lab::report::replays;
use lab::store::StoreError;
use lab::store::folder::MANIFEST;
use lab::tracks::file::{self, TracksFile};
use serde_json::Value as Json;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Largest drop, in bytes; the page refuses more.
pub(super) const LARGEST: usize = 513 << 20;

/// The folder in which what was dropped is kept.
pub(super) struct Kept {
    path: PathBuf,
    number: AtomicUsize,
}

impl Kept {
    pub(super) fn new() -> Self {
        let path = std::env::temp_dir().join(format!("flockworks-view-{}", std::process::id()));
        Self { path, number: AtomicUsize::new(0) }
    }
    /// A folder of its own for a drop.
    fn next(&self) -> Result<PathBuf, Fault> {
        let path = self.path.join(self.number.fetch_add(1, Ordering::Relaxed).to_string());
        std::fs::create_dir_all(&path).map_err(|error| StoreError::io("make the folder", &path, error))?;
        Ok(path)
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        // a folder among those for passing things is no loss
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

/// Files with their paths below what was dropped.
type Files<'a> = Vec<(PathBuf, &'a [u8])>;

fn input(text: impl Into<String>) -> Fault {
    Fault::Input(text.into())
}

/// The files of a drop: a line of JSON with path and size of each, then their bytes.
fn unpacked(body: &[u8]) -> Result<Files<'_>, Fault> {
    let damaged = || input("what came is not what the page sends");
    let end = body.iter().position(|&byte| byte == b'\n').ok_or_else(damaged)?;
    let head: Vec<Json> = serde_json::from_slice(&body[..end]).map_err(|_| damaged())?;
    let mut rest = &body[end + 1..];
    let mut files = Vec::new();
    for one in &head {
        let path = Path::new(one.get("path").and_then(Json::as_str).ok_or_else(damaged)?);
        // a path may lead down and nowhere else
        if path.as_os_str().is_empty() || !path.components().all(|part| matches!(part, Component::Normal(_))) {
            return Err(damaged());
        }
        let size = one.get("size").and_then(Json::as_u64).and_then(|size| usize::try_from(size).ok());
        let (own, other) = size.and_then(|size| rest.split_at_checked(size)).ok_or_else(damaged)?;
        files.push((path.to_owned(), own));
        rest = other;
    }
    if files.is_empty() || !rest.is_empty() { Err(damaged()) } else { Ok(files) }
}

fn kept(to: &Path, files: &Files<'_>) -> Result<(), Fault> {
    for (path, bytes) in files {
        let path = to.join(path);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| StoreError::io("make the folder", folder, error))?;
        }
        std::fs::write(&path, bytes).map_err(|error| StoreError::io("write", &path, error))?;
    }
    Ok(())
}

fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
}

fn called(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// What was dropped, and what is to be told of it.
///
/// # Errors
/// What cannot be opened, with what can.
pub(super) fn opened(body: &[u8], kept_in: &Kept) -> Result<(Vec<Given>, String), Fault> {
    let files = unpacked(body)?;
    if let Some((place, _)) = files.iter().find(|(path, _)| called(path) == MANIFEST) {
        let to = kept_in.next()?;
        kept(&to, &files)?;
        let folder = to.join(place.parent().unwrap_or(Path::new("")));
        return Ok((given_of(&folder, true)?, String::new()));
    }
    let [(path, bytes)] = files.as_slice() else {
        // the tables of TRex are a folder of tables; others are no recording
        let to = kept_in.next()?;
        kept(&to, &files)?;
        let root = files.first().and_then(|(path, _)| path.components().next());
        let folder = root.map_or(to.clone(), |root| to.join(root));
        return tracks(&folder, &to).map_err(|fault| {
            input(format!(
                "Among these files there is no {MANIFEST}, so that they are no folder of a run, search or analysis; and read as a \
                 recording: {fault}"
            ))
        });
    };
    match ending(path).as_str() {
        "html" | "htm" => page(path, &String::from_utf8_lossy(bytes)),
        "toml" => {
            let (kind, read) = kinds::read_text(&called(path), &String::from_utf8_lossy(bytes))?;
            let (name, text) = kind.view(&read, &ViewOptions::default())?;
            Ok((vec![Given::Scenario(name, text)], String::new()))
        }
        "csv" | "tsv" | "txt" | "parquet" => {
            let to = kept_in.next()?;
            kept(&to, &files)?;
            tracks(&to.join(path), &to)
        }
        "log" => Err(input("It is part of the folder of a run or search: drop the whole folder.")),
        _ => Err(input(
            "What can be opened: the folder of a run, search or analysis; a scenario or another file in TOML; a table of tracks (.csv, \
             .tsv, .txt, .parquet); a page with a replay (.html); a drawing (.svg, .geojson, .wkt).",
        )),
    }
}

/// The recordings of a page.
fn page(path: &Path, text: &str) -> Result<(Vec<Given>, String), Fault> {
    let found = replays(text).map_err(|what| input(format!("{what}.")))?;
    let count = found.len();
    let given = found.into_iter().map(|(title, replay)| {
        let course = Course {
            title,
            about: format!("Read out of the page {}.", called(path)),
            source: String::new(),
            seed: None,
            guides: Vec::new(),
            replay,
        };
        // what cannot be shown is told now, not when it is looked at
        Replayed::new(course.clone()).map_err(|error| input(error.to_string()))?;
        Ok(Given::Course(called(path), std::sync::Arc::new(course)))
    });
    let given = given.collect::<Result<Vec<Given>, Fault>>()?;
    let told = if count > 1 { format!("The page holds {count} replays; the first is shown.") } else { String::new() };
    Ok((given, told))
}

/// A recording that was handed over: it is analysed as `flockworks analyze` does.
fn tracks(path: &Path, to: &Path) -> Result<(Vec<Given>, String), Fault> {
    let out = to.join("analysis");
    let text = |more: &str| {
        let name = path.display().to_string();
        format!("kind = \"tracks\"\ntitle = {:?}\n[[recording]]\nfile = {name:?}\n{more}", called(path))
    };
    let tried = |more: &str| {
        let text = text(more);
        let read = file::read("the table", &text, &[]).map_err(|problems| input(problems.to_string()))?;
        let file: &TracksFile = &read.file;
        let job = Job {
            file,
            text: (String::new(), text.clone()),
            from: Path::new(""),
            command: format!("flockworks analyze {}", called(path)),
            per_frame: None,
            out: Some(&out),
            threads: None,
        };
        analyze::run(&job, &mut std::io::sink())
    };
    // what a table leaves open is settled by no guess: times are counted in frames, lengths in the units of the table
    let told = match tried("") {
        Ok(()) => String::new(),
        Err(first) => match tried("fps = \"unknown\"\n").or_else(|_| tried("fps = \"unknown\"\nunits = \"unit\"\n")) {
            Ok(()) => format!(
                "The table does not say all: {first} Until then times are in frames. `flockworks analyze` takes --fps and --units."
            ),
            // the first complaint is about the table as it is
            Err(_) => {
                let name = path.display().to_string();
                return Err(input(first.to_string().replace(&name, &called(path))));
            }
        },
    };
    let told = told.replace(&path.display().to_string(), &called(path));
    Ok((given_of(&out, true)?, told))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn files_come_one_after_the_other_and_lead_nowhere_else() {
        let body = b"[{\"path\":\"run/manifest.json\",\"size\":2},{\"path\":\"run/a.parquet\",\"size\":3}]\n{}abc";
        let files = unpacked(body).unwrap();
        assert_eq!(
            files,
            [(PathBuf::from("run/manifest.json"), &b"{}"[..]), (PathBuf::from("run/a.parquet"), &b"abc"[..])]
        );
        for wrong in [
            &b"[{\"path\":\"../a\",\"size\":0}]\n"[..],
            b"[{\"path\":\"/a\",\"size\":0}]\n",
            b"[{\"path\":\"a\",\"size\":9}]\nabc",
            b"[{\"path\":\"a\",\"size\":1}]\nabc",
            b"[]\n",
            b"{",
        ] {
            assert!(unpacked(wrong).is_err(), "{}", String::from_utf8_lossy(wrong));
        }
    }
}
