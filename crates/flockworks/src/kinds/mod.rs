//! The kinds of files that can be run: one file and one line of the list each. The verbs `run`, `check`, `new`, `schema`,
//! `view` and `report` are made from the list.

mod decomposition;
mod design;
mod evolution;
mod formation;
mod map;
mod optimisation;
mod prediction;
mod progress;
mod scenario;
pub mod study;
mod tracks;

use crate::fault::{Fault, hint, wrong};
use crate::run::{RunOptions, text_of};
use crate::view::ViewOptions;
use lab::file::Problems;
use lab::file::kind::kind_of;
use lab::live::{LiveError, Shown, simulate};
use lab::searched::Searched;
use lab::store::folder;
use serde_json::Value as Json;
use std::io::{IsTerminal, Write};
use std::path::Path;

/// Every kind, in the order in which they are named.
pub const LIST: &[&dyn Kind] = &[
    &scenario::Scenario,
    &study::Study,
    &evolution::Evolution,
    &design::Design,
    &map::Map,
    &optimisation::Optimisation,
    &decomposition::Decomposition,
    &prediction::Prediction,
    &formation::Formation,
    &tracks::Tracks,
];

/// A file that was named on the command line.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name as given; `-` is standard input.
    pub name: String,
    /// Its text.
    pub text: String,
    /// What is put over its values, each `path=value`.
    pub sets: Vec<String>,
}

/// What can be done with a kind of file.
pub trait Kind: Sync {
    /// What stands behind `kind =`.
    fn id(&self) -> &'static str;
    /// A commented file to start from.
    fn template(&self) -> &'static str;
    /// The JSON schema of its keys.
    fn schema(&self) -> Json;
    /// The page of its keys, in Markdown.
    fn reference(&self) -> String;
    /// Checks a file and says in a line what it would do.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    fn check(&self, input: &Input) -> Result<String, Fault>;
    /// Runs a file; the answer is the exit code.
    ///
    /// # Errors
    /// What is wrong with the input, the folder or the system.
    fn run(&self, input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault>;
    /// The file, name and text, that shows what this one is about: a scenario, or itself where it is run live.
    ///
    /// # Errors
    /// What is wrong with the file, or that there is nothing to look at.
    fn view(&self, input: &Input, options: &ViewOptions) -> Result<(String, String), Fault> {
        let _ = options;
        wrong(format!("`{}` is of the kind {}, of which there is nothing to look at", input.name, self.id()))
    }
    /// Such a file as a world that runs while one watches.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn live(&self, input: &Input, threads: usize) -> Result<Box<dyn Shown>, LiveError> {
        simulate(&input.name, &input.text, &[], None, threads)
    }
    /// Whether its folders hold recordings.
    fn records(&self) -> bool {
        false
    }
    /// How many recordings there are to look at in a complete folder.
    ///
    /// # Errors
    /// A folder that is not complete, or of a kind that records nothing.
    fn recordings(&self, folder: &Path) -> Result<usize, Fault> {
        let what = "holds no recording of a single run";
        wrong(format!("`{}` {what}", folder.display()))
    }
    /// Names of the recordings, as far as they have any; as many as there are.
    ///
    /// # Errors
    /// As for their number.
    fn names(&self, folder: &Path) -> Result<Vec<String>, Fault> {
        Ok((0..self.recordings(folder)?).map(|number| format!("recording {number}")).collect())
    }
    /// One of them.
    ///
    /// # Errors
    /// A folder that is not complete, or has no such recording.
    fn show(&self, folder: &Path, recording: usize) -> Result<Box<dyn Shown>, LiveError> {
        Err(LiveError::Request(format!("`{}` has no recording {recording}", folder.display())))
    }
    /// A folder of a search to be looked at, complete or not.
    ///
    /// # Errors
    /// A folder that cannot be read, or of a kind that is no search.
    fn search(&self, folder: &Path) -> Result<Box<dyn Searched>, Fault> {
        wrong(format!("`{}` holds a {}, which is no search", folder.display(), self.id()))
    }
    /// The tables of a complete folder, by file name.
    ///
    /// # Errors
    /// A folder that is not complete.
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault>;
    /// Makes the page of a complete folder anew.
    ///
    /// # Errors
    /// A folder that is not complete, or cannot be written to.
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault>;
}

/// The ids of all kinds.
pub fn ids() -> Vec<&'static str> {
    LIST.iter().map(|kind| kind.id()).collect()
}

/// The kind of an id.
///
/// # Errors
/// An unknown id.
pub fn find(id: &str) -> Result<&'static dyn Kind, Fault> {
    let ids = ids();
    match LIST.iter().find(|kind| kind.id() == id) {
        Some(kind) => Ok(*kind),
        None => wrong(format!("no kind of file is called `{id}`{}; there is {}", hint(id, &ids), ids.join(", "))),
    }
}

/// Reads a file, and which kind it is. One that does not say is read as the first kind, which tells what is missing.
///
/// # Errors
/// A file that cannot be read, or of a kind that is not known.
pub fn read(file: &str, sets: &[String]) -> Result<(&'static dyn Kind, Input), Fault> {
    let (kind, input) = read_text(file, &text_of(file)?)?;
    Ok((kind, Input { sets: sets.to_vec(), ..input }))
}

/// A file that came as text, and which kind it is.
///
/// # Errors
/// A kind that is not known.
pub fn read_text(name: &str, text: &str) -> Result<(&'static dyn Kind, Input), Fault> {
    let kind = kind_of(name, text, &ids()).map_err(|problems| shown(&problems))?;
    let kind = find(kind.unwrap_or(LIST[0].id()))?;
    Ok((kind, Input { name: name.to_owned(), text: text.to_owned(), sets: Vec::new() }))
}

/// A file that a kind gave to be viewed, as a world that runs while one watches.
///
/// # Errors
/// What is wrong with the file.
pub fn live(name: &str, text: &str, threads: usize) -> Result<Box<dyn Shown>, LiveError> {
    let (kind, input) = read_text(name, text).map_err(|fault| LiveError::Request(fault.to_string()))?;
    kind.live(&input, threads)
}

/// The kind of file that a folder comes from.
///
/// # Errors
/// A folder without a manifest, or of a kind that is not known.
pub fn of_folder(path: &Path) -> Result<&'static dyn Kind, Fault> {
    let Some(manifest) = folder::manifest(path)? else {
        return wrong(format!("`{}` is not the folder of a run: it has no {}", path.display(), folder::MANIFEST));
    };
    find(manifest.get("kind").and_then(Json::as_str).unwrap_or(LIST[0].id()))
}

/// Problems as they are printed.
pub fn shown(problems: &Problems) -> Fault {
    let styled = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    Fault::Shown(problems.show(styled))
}
