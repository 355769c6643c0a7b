//! The folder of an analysis: manifest, tables, page.

use super::analysis::{Analysed, analyse};
use super::file::TracksFile;
use super::{Recording, tables};
use crate::file::Form;
use crate::report::of_tracks;
use crate::run::{EVENTS, METRICS, REPORT, TRAJECTORY};
use crate::store::folder::{self, Folder};
use crate::store::table::{Blocks, Heading, Values, join};
use crate::store::{StoreError, folder::MANIFEST};
use crate::with_tracks;
use serde_json::{Value as Json, json};
use space::parallel::Workers;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What an analysis is made of.
pub struct Request<'a> {
    /// What is asked for.
    pub file: &'a TracksFile,
    /// Name and text of the file; of a command without one, what it understood.
    pub text: (String, String),
    /// From where recordings are named.
    pub from: &'a Path,
    /// The command that makes it again.
    pub command: String,
    /// Name of the program with its version.
    pub program: String,
}

/// Reads, cleans and measures the recordings of a file, one after the other.
///
/// # Errors
/// What is wrong with a table, or two recordings of one name.
pub fn analyse_all(
    file: &TracksFile,
    from: &Path,
    workers: &Arc<Workers>,
    told: &mut dyn FnMut(&Recording) -> Result<(), StoreError>,
) -> Result<Vec<Analysed>, StoreError> {
    let mut all: Vec<Analysed> = Vec::new();
    for written in &file.recording {
        let path = from.join(&written.file);
        let recording = super::read(&path, written.name.as_deref(), &written.ask())?;
        if all.iter().any(|other| other.recording.name == recording.name) {
            return Err(StoreError::Refused(format!(
                "two recordings are called `{}`; name them in a file of the kind tracks (`flockworks new tracks`)",
                recording.name
            )));
        }
        told(&recording)?;
        all.push(analyse(recording, file, workers)?);
    }
    Ok(all)
}

/// What decides about the results.
fn identity(file: &TracksFile) -> Json {
    json!({ "tracks": file.write().json() })
}

/// The folder for a file: below `runs`, the first that is free or of the same file.
pub fn place(name: &str, file: &TracksFile) -> PathBuf {
    let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("tracks");
    let same = |path: &Path| {
        let manifest = folder::manifest(path).ok().flatten();
        manifest.is_some_and(|manifest| manifest.get("identity") == Some(&identity(file)))
    };
    let named = |number: usize| if number == 1 { stem.to_owned() } else { format!("{stem}-{number}") };
    let mut paths = (1..).map(|number| Path::new("runs").join(named(number)));
    paths.find(|path| !path.exists() || same(path)).unwrap_or_else(|| Path::new("runs").join(stem))
}

/// Refuses a folder that holds something else.
///
/// # Errors
/// Where it does, with the differences.
pub fn check_place(out: &Path, file: &TracksFile) -> Result<(), StoreError> {
    let Some(manifest) = folder::manifest(out)? else { return Ok(()) };
    let lines = folder::differences(manifest.get("identity").unwrap_or(&Json::Null), &identity(file));
    if lines.is_empty() {
        return Ok(());
    }
    let shown: Vec<&str> = lines.iter().take(8).map(String::as_str).collect();
    Err(StoreError::Refused(format!(
        "`{}` holds another analysis; choose another folder with --out\n  {}",
        out.display(),
        shown.join("\n  ")
    )))
}

/// Writes the folder of an analysis.
///
/// # Errors
/// A folder that holds something else, or that the system refuses to write to.
pub fn write(out: &Path, request: &Request<'_>, all: &[Analysed]) -> Result<(), StoreError> {
    check_place(out, request.file)?;
    let folder = Folder::claim(out)?;
    let mut manifest = manifest(request, all);
    manifest["status"] = json!("running");
    folder.write_manifest(&manifest)?;
    let notes = notes(request, all);
    let headings = tables::trajectory(all);
    folder.write(TRAJECTORY, |file| {
        join(file, &headings, &notes, tables::trajectory_blocks(all, &headings)?).map(|_| ())
    })?;
    let each = |columns: &dyn Fn(usize) -> Vec<Values>, headings: &[Heading]| {
        let mut made = Blocks::new(headings)?;
        let blocks = (0..all.len()).map(columns).filter(|columns| !columns[0].is_empty());
        Ok::<_, StoreError>(blocks.map(|columns| made.next(columns)).collect::<Vec<_>>())
    };
    let headings = tables::metrics(all);
    let blocks = each(&|run| tables::metric_columns(all, run), &headings)?;
    folder.write(METRICS, |file| join(file, &headings, &notes, blocks.into_iter()).map(|_| ()))?;
    let headings = tables::events(all);
    let blocks = each(&|run| tables::event_columns(&all[run], run), &headings)?;
    folder.write(EVENTS, |file| join(file, &headings, &notes, blocks.into_iter()).map(|_| ()))?;
    let headings = tables::over_time();
    let blocks = each(&|run| tables::over_time_columns(&all[run], run), &headings)?;
    folder.write(tables::OVER_TIME, |file| join(file, &headings, &notes, blocks.into_iter()).map(|_| ()))?;
    folder.write_text(REPORT, &crate::report::html(&of_tracks::page(request, all)))?;
    manifest["status"] = json!("complete");
    folder.write_manifest(&manifest)
}

fn notes(request: &Request<'_>, all: &[Analysed]) -> Vec<(String, String)> {
    let note = |key: &str, value: String| (format!("flockworks.{key}"), value);
    vec![
        note("title", request.file.title.clone()),
        note("length", all[0].units.length.clone()),
        note("time", all[0].units.time.clone()),
        note("file", request.text.1.clone()),
    ]
}

fn manifest(request: &Request<'_>, all: &[Analysed]) -> Json {
    let recordings: Vec<Json> = all
        .iter()
        .map(|one| {
            let (understood, cleaned) = (&one.recording.understood, &one.cleaned);
            let names = with_tracks!(&one.recording.table, tracks => tracks.names());
            let lines: serde_json::Map<String, Json> =
                understood.lines().into_iter().map(|(what, text)| (what.to_owned(), json!(text))).collect();
            let (low, high) = with_tracks!(&one.recording.table, tracks => tables::box_of(tracks, &understood.extent));
            json!({
                "name": one.recording.name,
                "file": one.recording.path.display().to_string(),
                "understood": lines,
                "dimensions": understood.extent.len(),
                "low": low,
                "high": high,
                "frames": understood.frames,
                "units": { "length": one.units.length, "time": one.units.time },
                "individuals": names,
                "filled": cleaned.filled.0,
                "smoothed": cleaned.smoothed.0,
                "flags": cleaned.flags.len(),
            })
        })
        .collect();
    json!({
        "format": 1,
        "kind": "tracks",
        "status": "complete",
        "title": request.file.title,
        "about": request.file.about,
        "file": { "name": request.text.0, "text": request.text.1 },
        "command": request.command,
        "identity": identity(request.file),
        "recordings": recordings,
        "events": [],
        "host": { "os": std::env::consts::OS, "processor": std::env::consts::ARCH },
        "sessions": [{ "program": request.program, "started": crate::run::now() }],
    })
}

/// The manifest of the folder of a complete analysis.
///
/// # Errors
/// Another folder, or one that is not complete.
pub fn manifest_of(path: &Path) -> Result<Json, StoreError> {
    let manifest = folder::manifest(path)?.unwrap_or(Json::Null);
    let says = |key: &str, value: &str| manifest.get(key).and_then(Json::as_str) == Some(value);
    if !says("kind", "tracks") {
        return Err(StoreError::Refused(format!("`{}` is not the folder of an analysis of tracks", path.display())));
    }
    if !says("status", "complete") {
        return Err(StoreError::Refused(format!(
            "the analysis in `{}` is not complete (see its {MANIFEST}); the same command makes it anew",
            path.display()
        )));
    }
    Ok(manifest)
}
