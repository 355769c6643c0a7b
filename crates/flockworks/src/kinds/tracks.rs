//! `kind = "tracks"`: recordings of individuals, analysed and compared.

use super::{Input, Kind, shown};
use crate::analyze::{self, Job};
use crate::fault::{Fault, wrong};
use crate::run::RunOptions;
use lab::live::{LiveError, Shown, Tracked};
use lab::run::{EVENTS, METRICS, TRAJECTORY};
use lab::tracks::tables::OVER_TIME;
use lab::tracks::{self, file, folder};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;

/// Recordings of individuals, analysed and compared.
pub(super) struct Tracks;

impl Tracks {
    fn read(input: &Input) -> Result<file::Read, Fault> {
        file::read(&input.name, &input.text, &input.sets).map_err(|problems| shown(&problems))
    }
}

impl Kind for Tracks {
    fn id(&self) -> &'static str {
        "tracks"
    }
    fn template(&self) -> &'static str {
        file::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<file::TracksFile>("flockworks tracks")
    }
    fn reference(&self) -> String {
        let lead = "Every key of a file of tracks, TOML: which recordings, how they are read and cleaned, and what is \
                    measured. The same can be said in options of `flockworks analyze`.";
        lab::file::reference::reference::<file::TracksFile>("Files of tracks", lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let read = Self::read(input)?;
        let mut parts = Vec::new();
        for written in &read.file.recording {
            let path = read.folder.join(&written.file);
            let recording = tracks::read(&path, written.name.as_deref(), &written.ask())?;
            let understood = &recording.understood;
            parts.push(format!(
                "{}: {} individuals, {} frames",
                recording.name, understood.individuals, understood.frames
            ));
        }
        Ok(parts.join("; "))
    }
    fn run(&self, input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        if let Some(option) = options.study.given() {
            return wrong(format!("{option} is for studies, and `{}` is a file of tracks", input.name));
        }
        if options.seed.is_some() || options.quick {
            return wrong("--seed and --quick are for simulations; tracks are as they were recorded");
        }
        let read = Self::read(&input)?;
        let to = options.out.clone().unwrap_or_else(|| folder::place(&input.name, &read.file));
        let sets: Vec<String> = input.sets.iter().map(|set| format!(" --set '{set}'")).collect();
        let job = Job {
            file: &read.file,
            text: (input.name.clone(), if sets.is_empty() { input.text.clone() } else { file::text(&read.file) }),
            from: &read.folder,
            command: format!("flockworks run {}{}", input.name, sets.concat()),
            per_frame: None,
            out: Some(&to),
            threads: options.threads,
        };
        analyze::run(&job, out)?;
        Ok(0)
    }
    fn records(&self) -> bool {
        true
    }
    fn recordings(&self, path: &Path) -> Result<usize, Fault> {
        let manifest = folder::manifest_of(path)?;
        Ok(manifest.get("recordings").and_then(Json::as_array).map_or(0, Vec::len))
    }
    fn names(&self, path: &Path) -> Result<Vec<String>, Fault> {
        let manifest = folder::manifest_of(path)?;
        let name = |one: &Json| one.get("name").and_then(Json::as_str).unwrap_or_default().to_owned();
        Ok(manifest.get("recordings").and_then(Json::as_array).into_iter().flatten().map(name).collect())
    }
    fn show(&self, path: &Path, recording: usize) -> Result<Box<dyn Shown>, LiveError> {
        Ok(Box::new(Tracked::open(path, recording)?))
    }
    fn tables(&self, path: &Path) -> Result<Vec<&'static str>, Fault> {
        folder::manifest_of(path)?;
        Ok(vec![TRAJECTORY, METRICS, EVENTS, OVER_TIME])
    }
    fn report(&self, path: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        let manifest = folder::manifest_of(path)?;
        let word = |at: &str| manifest.pointer(at).and_then(Json::as_str).unwrap_or_default().to_owned();
        let input = Input { name: word("/file/name"), text: word("/file/text"), sets: Vec::new() };
        let read = Self::read(&input)?;
        let job = Job {
            file: &read.file,
            text: (input.name, input.text),
            from: &read.folder,
            command: word("/command"),
            per_frame: None,
            out: Some(path),
            threads: None,
        };
        analyze::run(&job, out)
    }
}
