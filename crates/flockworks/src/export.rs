//! `flockworks export`: what is in a folder in another form, to be sent.

use crate::fault::{Fault, hint, wrong};
use crate::kinds::{self, Kind};
use crate::run::PROGRAM;
use clap::Args;
use clap::builder::PossibleValuesParser;
use core::ops::RangeInclusive;
use lab::export::{Chosen, Form, LIST, Look, Recording, find, read, size};
use lab::live::{LiveError, Shown};
use lab::report::{Figure, html};
use lab::searched::{At, Searched};
use lab::store::folder::whole_file;
use lab::store::table::Table;
use lab::store::{StoreError, export as tables};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The form of tables, which any folder has.
const CSV: &str = "csv";
/// The page that every complete folder of a search has.
const PAGE: &str = "report.html";
/// The form of a page.
const HTML: &str = "html";
/// What is played on the page of a search: so many places, in so many frames each, where nobody says more.
const PLAYED: usize = 3;
const PLAYED_FRAMES: usize = 400;

/// Options of `export`.
#[derive(Args, Debug)]
pub struct ExportOptions {
    /// Folder of a complete run, analysis or search.
    pub folder: PathBuf,
    /// Form to export to.
    #[arg(long, value_name = "FORM", value_parser = PossibleValuesParser::new(names()), long_help = about())]
    pub to: String,
    /// Folder for the files; left out, the one that is exported.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of the recording, from 0, where the folder has several.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub recording: usize,
    /// Of a search, the place that is sent, by numbers: as `cell=3,trial=1`, `generation=20` or `task=0,method=2`. Left out, what tells
    /// most: the champion, the best environment, the first trials.
    #[arg(long, value_name = "PLACE")]
    pub at: Option<String>,
    /// The frame that a picture shows, from 0; left out, the last.
    #[arg(long, value_name = "F")]
    pub frame: Option<u64>,
    /// From which frame to which what moves goes; left out, all.
    #[arg(long, value_name = "FROM..TO", value_parser = range)]
    pub frames: Option<RangeInclusive<u64>>,
    /// Keep one frame in so many; left out, as many as the form has room for.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub every: Option<u64>,
    /// Width of pictures, in pixels.
    #[arg(long, value_name = "N", default_value_t = 720, value_parser = clap::value_parser!(u32).range(120..=7680))]
    pub width: u32,
    /// Frames in a second of what moves.
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=120))]
    pub rate: u32,
}

fn names() -> Vec<&'static str> {
    [CSV].into_iter().chain(LIST.iter().map(|form| form.id())).collect()
}

fn about() -> String {
    let forms = LIST.iter().map(|form| format!("{:5}{}", form.id(), form.about()));
    let csv = format!("{CSV:5}one file of comma-separated values for each table");
    let lines: Vec<String> = [csv].into_iter().chain(forms).collect();
    format!("Form to export to:\n\n{}", lines.join("\n"))
}

fn range(text: &str) -> Result<RangeInclusive<u64>, String> {
    let ends = text.split_once("..").and_then(|(from, to)| Some((from.parse().ok()?, to.parse().ok()?)));
    let (from, to) = ends.ok_or("two numbers are wanted, as in 10..200")?;
    if from <= to { Ok(from..=to) } else { Err("the first frame must not lie behind the last".into()) }
}

/// Writes what is in a folder in another form.
///
/// # Errors
/// A folder that is not complete, has no recording, or cannot be written to; frames that are not there.
pub fn export(options: &ExportOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let from = &options.folder;
    let kind = kinds::of_folder(from)?;
    let to = options.out.as_ref().unwrap_or(from);
    std::fs::create_dir_all(to).map_err(|error| StoreError::io("make the folder", to, error))?;
    match find(&options.to) {
        None => csv(kind, from, to, out),
        Some(form) => recorded(kind, form, options, to, out),
    }
}

/// Every table as comma-separated values.
fn csv(kind: &dyn Kind, from: &Path, to: &Path, out: &mut dyn Write) -> Result<(), Fault> {
    for name in kind.tables(from)? {
        let path = from.join(name);
        if !path.exists() {
            continue;
        }
        let table = Table::open(&path)?;
        let target = to.join(name).with_extension(CSV);
        whole_file(&target, |file| tables::csv(&table, file))?;
        writeln!(out, "{}: {} rows", target.display(), table.rows())?;
    }
    Ok(())
}

fn recorded(
    kind: &dyn Kind,
    form: &dyn Form,
    options: &ExportOptions,
    to: &Path,
    out: &mut dyn Write,
) -> Result<(), Fault> {
    let from = &options.folder;
    let name = from.canonicalize().ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let target = to.join(format!("{}.{}", name.as_deref().unwrap_or("recording"), form.ending()));
    if !kind.records() {
        return searched(kind, form, options, &target, out);
    }
    if options.at.is_some() {
        return wrong(format!("--at is for searches, and `{}` holds a {}", from.display(), kind.id()));
    }
    let recordings = kind.recordings(from)?;
    if options.recording >= recordings {
        return wrong(format!("there is no recording {}: `{}` has {recordings}", options.recording, from.display()));
    }
    let mut shown = kind.show(from, options.recording).map_err(refused)?;
    made(&mut *shown, form, options, &target, out)
}

fn refused(error: LiveError) -> Fault {
    Fault::Input(error.to_string())
}

/// The frames that are wanted.
fn chosen(options: &ExportOptions) -> Chosen {
    Chosen { frame: options.frame, frames: options.frames.clone(), every: options.every, most: None }
}

/// Writes what can be looked at in a form.
fn made(
    shown: &mut dyn Shown,
    form: &dyn Form,
    options: &ExportOptions,
    target: &Path,
    out: &mut dyn Write,
) -> Result<(), Fault> {
    let (recording, every) = read(shown, form, &chosen(options), PROGRAM).map_err(refused)?;
    let look = Look { width: options.width, rate: f64::from(options.rate) };
    let bytes = form.bytes(&recording, &look)?;
    let (agents, frames) = (recording.replay.group.len(), recording.replay.times.len());
    let frames = if form.still() { "1 frame".to_owned() } else { format!("{frames} frames") };
    let thinned = if every > 1 && !form.still() { format!(", one in {every} kept (--every)") } else { String::new() };
    // the size is told before anything is written
    writeln!(out, "{}: {}, {agents} agents, {frames}{thinned}", target.display(), size(bytes.len()))?;
    out.flush()?;
    written(target, &bytes)
}

/// A place of a search: by itself in most forms; in a page, that of the folder, with what tells most to be played.
fn searched(
    kind: &dyn Kind,
    form: &dyn Form,
    options: &ExportOptions,
    target: &Path,
    out: &mut dyn Write,
) -> Result<(), Fault> {
    let from = &options.folder;
    let search = kind.search(from)?;
    let given = options.at.as_deref().map(|words| place(&*search, words)).transpose()?;
    let told = search.telling();
    let anything = |at: Option<At>| {
        let none = format!("nothing was tried yet in `{}`: there is nothing to be sent", from.display());
        at.ok_or(Fault::Input(none))
    };
    if form.id() != HTML {
        let at = anything(given.or_else(|| told.into_iter().next()))?;
        let (mut shown, _) = search.watched(&at).and_then(|watched| watched.shown(1)).map_err(refused)?;
        return made(&mut *shown, form, options, target, out);
    }
    if !from.join(PAGE).exists() {
        return wrong(format!("`{}` is not complete and has no page; `flockworks run` continues it", from.display()));
    }
    let mut page = search.page(PROGRAM);
    // a page that plays something by itself is sent as it is
    let plays = page.figures.iter().any(|figure| matches!(figure, Figure::Replay(_)));
    let places = match given {
        Some(at) => vec![at],
        None if plays => Vec::new(),
        None => told.into_iter().take(PLAYED).collect(),
    };
    let replays = places.iter().map(|at| {
        let (mut shown, _) = search.watched(at).and_then(|watched| watched.shown(1)).map_err(refused)?;
        let some = Chosen { most: Some(PLAYED_FRAMES), ..chosen(options) };
        let (Recording { title, mut replay, .. }, _) = read(&mut *shown, form, &some, PROGRAM).map_err(refused)?;
        replay.title = title;
        Ok(Figure::Replay(replay))
    });
    let replays = replays.collect::<Result<Vec<Figure>, Fault>>()?;
    let played = page.figures.iter().chain(&replays).filter(|figure| matches!(figure, Figure::Replay(_))).count();
    page.figures.splice(0..0, replays);
    let bytes = html(&page).into_bytes();
    writeln!(out, "{}: {}, the page of the {} with {played} to play", target.display(), size(bytes.len()), kind.id())?;
    out.flush()?;
    written(target, &bytes)
}

/// A place of a search from its words.
fn place(search: &dyn Searched, words: &str) -> Result<At, Fault> {
    let names = search.words();
    let at = At::written(words).map_err(|what| Fault::Input(format!("--at takes {}: {what}", names.join(", "))))?;
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    match at.unknown(&known).first() {
        None => Ok(at),
        Some(other) => {
            wrong(format!("a place has no `{other}`{}; --at takes {}", hint(other, &known), names.join(", ")))
        }
    }
}

fn written(target: &Path, bytes: &[u8]) -> Result<(), Fault> {
    let write = |file: &mut std::io::BufWriter<std::fs::File>| {
        file.write_all(bytes).map_err(|error| StoreError::io("write", target, error))
    };
    Ok(whole_file(target, write)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_frames() {
        assert_eq!(range("3..9"), Ok(3..=9));
        assert!(range("9..3").is_err() && range("3").is_err() && range("a..b").is_err());
    }
}
