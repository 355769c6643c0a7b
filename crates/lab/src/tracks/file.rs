//! `kind = "tracks"`: which recordings, how they are read and cleaned, and what is measured.

use super::clean::Cleaning;
use super::{Ask, MANY, Rate};
use crate::file::tree::parse;
use crate::file::{Desk, Form, Named, Node, Problem, Problems, Rule, Shape, Sources, Span, Tree};
use crate::scenario::build::{self, Wrong};
use crate::{form, words};
use std::path::{Path, PathBuf};

/// A commented file to start from.
pub const TEMPLATE: &str = include_str!("template.toml");

words! {
    /// What kind of file it is.
    pub enum TracksKind {
        /// Recordings, analysed.
        Tracks = "tracks",
    }
}

impl Form for Rate {
    fn read(node: &Node, rule: &Rule<'_>, desk: &mut Desk) -> Option<Self> {
        match &node.tree {
            Tree::Text(word) if word == "unknown" => Some(Self::Unknown),
            Tree::Text(_) => {
                desk.kind(node, rule, "a number or \"unknown\"");
                None
            }
            _ => desk.number(node, rule).map(Self::Known),
        }
    }
    fn shape(rule: &Rule<'_>) -> Shape {
        let unknown = Shape::Word(vec![("unknown", "Nobody knows: times are counted in frames.")]);
        Shape::Either(vec![f64::shape(rule), unknown])
    }
    fn write(&self) -> Tree {
        match self {
            Self::Known(rate) => Tree::Number(*rate),
            Self::Unknown => Tree::Text("unknown".into()),
        }
    }
}

form! {
    /// A recording. What the table itself says need not be said; what it leaves open is asked for by an error.
    pub struct WrittenRecording {
        /// The table, or the folder of a run or of tables of TRex; from where this file stands.
        file: String = need, "", Any;
        /// What it is called; left out, the name of the file.
        name: Option<String> = none, "", Any;
        /// How the table is laid out, as `flockworks analyze --help` lists it; `auto` recognises it.
        layout: String = ["auto"], "", Any;
        /// Which columns are what, as in `{ frame = "frame", id = "fish", x = "px", y = "py" }`: frame, time, id, x, y, z,
        /// longitude, latitude, vx, vy, vz by their names or by their numbers from 1, `"none"` for none; `point`, the body
        /// part that stands for an individual, or `"mean"`; `wide`, `"xy"` or `"xyz"`; `clock`, the unit of
        /// times that are numbers, `"ms"`.
        columns: Named<String> = [Named::default()], "", Any;
        /// Frames per second; `"unknown"` counts times in frames. Left out: what the table says.
        fps: Option<Rate> = none, "1/s", Positive;
        /// Unit of length of the positions, after `scale`.
        units: Option<String> = none, "", Any;
        /// What positions are multiplied with, as for pixels of known size.
        scale: f64 = [1.0], "1", Positive;
        /// Least confidence of a point that is used.
        confidence: Option<f64> = none, "1", Within(0.0, 1.0);
        /// Most individuals: more of them are taken for a mistake about the column that names them.
        individuals: usize = [MANY], "1", Within(1.0, 20_000_000.0);
        /// Whether the first row of an individual in a frame is kept, and others are no error.
        keep_first: bool = [false], "", Any;
    }
}

form! {
    /// The filter of Savitzky and Golay.
    pub struct Smooth {
        /// Frames in its window, an odd number.
        window: usize = need, "frames", Within(3.0, 999.0);
        /// Order of the polynomial, less than the window.
        order: usize = [2usize], "1", Within(0.0, 9.0);
    }
}

form! {
    /// Cleaning. Nothing is done unless it is asked for, and what was done is counted.
    pub struct Clean {
        /// Longest gap that is filled by a straight line.
        interpolate: Option<usize> = none, "frames", Within(1.0, 1_000_000.0);
        /// Smooths the paths.
        smooth: Option<Smooth> = none, "", Any;
        /// Speed above which a position is flagged as impossible.
        greatest_speed: Option<f64> = none, "length/time", Positive;
        /// Whether pairs that went to where the other had been are flagged as swapped.
        swaps: bool = [false], "", Any;
    }
}

form! {
    /// What is measured.
    pub struct Measured {
        /// Metrics by their ids, as `flockworks metrics` lists them. Left out: all that need no distance, time or speed, or
        /// one given here; of metrics over time, where there are up to a million positions.
        metrics: Option<Vec<String>> = none, "", Any;
        /// Parameters of metrics, by name: each holds for every metric that has it.
        parameters: Named<f64> = [Named::default()], "", Any;
    }
}

form! {
    /// Recordings of individuals, analysed and compared.
    pub struct TracksFile {
        /// What kind of file this is.
        kind: TracksKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what to look for; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// The recordings, one by one.
        recording: Vec<WrittenRecording> = need, "", Any;
        /// Cleaning, the same for all.
        clean: Clean = [Clean { interpolate: None, smooth: None, greatest_speed: None, swaps: false }], "", Any;
        /// What is measured.
        measure: Measured = [Measured { metrics: None, parameters: Named::default() }], "", Any;
    }
}

impl WrittenRecording {
    /// A table of which nothing is said.
    pub fn of(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            name: None,
            layout: "auto".into(),
            columns: Named::default(),
            fps: None,
            units: None,
            scale: 1.0,
            confidence: None,
            individuals: MANY,
            keep_first: false,
        }
    }
    /// What it says of its table.
    pub fn ask(&self) -> Ask {
        Ask {
            layout: Some(self.layout.clone()),
            columns: self.columns.0.clone(),
            fps: self.fps,
            units: self.units.clone(),
            scale: self.scale,
            confidence: self.confidence,
            individuals: self.individuals,
            keep_first: self.keep_first,
        }
    }
}

impl Clean {
    /// What is asked for.
    pub fn ask(&self) -> Cleaning {
        Cleaning {
            interpolate: self.interpolate,
            smooth: self.smooth.as_ref().map(|smooth| (smooth.window, smooth.order)),
            greatest_speed: self.greatest_speed,
            swaps: self.swaps,
        }
    }
}

/// A file of tracks as read.
#[derive(Clone, Debug)]
pub struct Read {
    /// The texts.
    pub sources: Sources,
    /// What it says.
    pub file: TracksFile,
    /// From where its recordings are named.
    pub folder: PathBuf,
}

/// Reads a file of tracks from its text and the values put over it (`path=value`).
///
/// # Errors
/// Everything that is wrong with it, at its place. The tables are not read yet.
pub fn read(name: &str, text: &str, sets: &[String]) -> Result<Read, Problems> {
    let mut sources = Sources::default();
    let source = sources.add(name, text);
    let mut desk = Desk::default();
    let mut tree = parse(&sources, source, &mut desk.problems);
    if !desk.problems.is_empty() {
        return Err(Problems::new(sources, desk.problems));
    }
    build::put(&mut tree, sets, &mut sources, &mut desk);
    let file = TracksFile::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut desk);
    let wrongs = file.as_ref().map_or_else(Vec::new, check);
    for wrong in wrongs {
        let span = if wrong.path.is_empty() { Span { source, bytes: 0..0 } } else { tree.place(&wrong.path) };
        desk.problems.push(Problem { span, what: wrong.what, expected: wrong.expected, help: wrong.help });
    }
    let folder = Path::new(name).parent().map(Path::to_owned).unwrap_or_default();
    match file.filter(|_| desk.problems.is_empty()) {
        Some(file) => Ok(Read { sources, file, folder }),
        None => Err(Problems::new(sources, desk.problems)),
    }
}

/// What is wrong with the values together.
pub fn check(file: &TracksFile) -> Vec<Wrong> {
    let mut wrongs = Vec::new();
    if file.recording.is_empty() {
        wrongs.push(Wrong::new("", "there is no recording", "expected `[[recording]]`"));
    }
    for (k, recording) in file.recording.iter().enumerate() {
        if let Err(error) = recording.ask().check() {
            wrongs.push(Wrong::new(format!("recording.{k}.columns"), error.to_string(), "not known here"));
        }
        let known = super::layouts::LIST.iter().map(|layout| layout.id).chain(["auto"]);
        if !known.clone().any(|id| id == recording.layout) {
            let help = space::spelling::nearest(&recording.layout, known.clone());
            let help = help.map_or_else(String::new, |near| format!("did you mean \"{near}\"?"));
            let all: Vec<&str> = known.collect();
            let what = format!("no layout is called \"{}\"", recording.layout);
            let expected = format!("expected one of {}", all.join(", "));
            wrongs.push(Wrong::new(format!("recording.{k}.layout"), what, expected).help(&help));
        }
    }
    if let Some(smooth) = &file.clean.smooth {
        if smooth.window % 2 == 0 {
            let what = format!("the window must be an odd number of frames, found {}", smooth.window);
            wrongs.push(Wrong::new("clean.smooth.window", what, "expected 3, 5, 7, ..."));
        }
        if smooth.order >= smooth.window {
            let what = "the order of the polynomial must be less than the window";
            wrongs.push(Wrong::new("clean.smooth.order", what, "too high"));
        }
    }
    let known = || super::analysis::known().map(|(id, _)| id);
    for id in file.measure.metrics.iter().flatten() {
        if !known().any(|known| known == id) {
            let what = format!("no metric is called `{id}`{}", super::meant(id, known()));
            wrongs.push(Wrong::new("measure.metrics", what, "not a metric").help("`flockworks metrics` lists them"));
        }
    }
    let known = || super::analysis::known().flat_map(|(_, parameters)| parameters.iter().map(|p| p.name));
    for (name, value) in &file.measure.parameters.0 {
        let path = format!("measure.parameters.{name}");
        if !known().any(|other| other == name) {
            let what = format!("no metric has a parameter `{name}`{}", super::meant(name, known()));
            wrongs.push(Wrong::new(path, what, "not a parameter"));
        } else if !value.is_finite() {
            wrongs.push(Wrong::new(path, format!("`{name}` must be a finite number"), "expected a number"));
        }
    }
    wrongs
}

/// A file as it would be written, without what is left at its default.
pub fn text(file: &TracksFile) -> String {
    let blank = TracksFile {
        kind: TracksKind::Tracks,
        title: String::new(),
        about: String::new(),
        recording: Vec::new(),
        clean: Clean { interpolate: None, smooth: None, greatest_speed: None, swaps: false },
        measure: Measured { metrics: None, parameters: Named::default() },
    };
    let mut out = format!("kind = \"tracks\"\ntitle = {}\n", toml(&Tree::Text(file.title.clone())));
    if !file.about.is_empty() {
        out += &format!("about = {}\n", toml(&Tree::Text(file.about.clone())));
    }
    for recording in &file.recording {
        out += "\n[[recording]]\n";
        let plain = WrittenRecording { file: String::new(), ..WrittenRecording::of("") };
        out += &changed(&recording.write(), &plain.write());
    }
    for (name, now, before) in
        [("clean", file.clean.write(), blank.clean.write()), ("measure", file.measure.write(), blank.measure.write())]
    {
        let lines = changed(&now, &before);
        if !lines.is_empty() {
            out += &format!("\n[{name}]\n{lines}");
        }
    }
    out
}

/// The keys of a table whose values are not those of another, a line each.
fn changed(now: &Tree, before: &Tree) -> String {
    let entries = |tree: &Tree| if let Tree::Table(entries) = tree { entries.clone() } else { Vec::new() };
    let known = entries(before);
    let same = |entry: &crate::file::tree::Entry| {
        known.iter().any(|other| other.key == entry.key && other.node.tree == entry.node.tree)
    };
    entries(now).iter().filter(|entry| !same(entry)).map(|e| format!("{} = {}\n", e.key, toml(&e.node.tree))).collect()
}

/// A value in TOML, on one line.
fn toml(tree: &Tree) -> String {
    match tree {
        Tree::Number(number) if number.is_nan() => "nan".to_owned(),
        Tree::Number(number) => format!("{number:?}"),
        Tree::Whole(number) => number.to_string(),
        Tree::Truth(truth) => truth.to_string(),
        // a string of JSON is one of TOML
        Tree::Text(text) => serde_json::Value::from(text.as_str()).to_string(),
        Tree::List(list) => {
            format!("[{}]", list.iter().map(|node| toml(&node.tree)).collect::<Vec<_>>().join(", "))
        }
        Tree::Table(entries) => {
            let entry = |e: &crate::file::tree::Entry| {
                format!("{} = {}", serde_json::Value::from(e.key.as_str()), toml(&e.node.tree))
            };
            format!("{{ {} }}", entries.iter().map(entry).collect::<Vec<_>>().join(", "))
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        let mut file = read("t.toml", TEMPLATE, &[]).unwrap().file;
        assert_eq!(file.recording[0].fps, Some(Rate::Known(25.0)));
        file.title = "a \"title\"\nof two lines".into();
        file.recording[0].columns = Named(vec![("id".into(), "fish".into())]);
        file.recording.push(WrittenRecording { fps: Some(Rate::Unknown), ..WrittenRecording::of("b c.csv") });
        file.clean.smooth = Some(Smooth { window: 9, order: 2 });
        file.measure.parameters = Named(vec![("linking_distance".into(), 3.5)]);
        let again = read("t.toml", &text(&file), &[]).unwrap().file;
        assert_eq!(again, file);
    }

    #[test]
    fn what_does_not_fit_is_said_at_its_place() {
        let text = "kind = \"tracks\"\ntitle = \"t\"\n[[recording]]\nfile = \"a.csv\"\nlayout = \"trx\"\ncolumns = { idd = \"x\" }\n\
                    fps = -1\n[clean]\nsmooth = { window = 4 }\n[measure]\nmetrics = [\"polarization\"]\n";
        let problems = read("t.toml", text, &[]).unwrap_err().to_string();
        assert!(problems.contains("`fps` must be more than 0"), "{problems}");
        let problems = read("t.toml", &text.replace("fps = -1\n", ""), &[]).unwrap_err().to_string();
        for what in ["did you mean \"trex\"", "no column can be `idd`", "odd number", "polarisation"] {
            assert!(problems.contains(what), "{what}: {problems}");
        }
        let problems = read("t.toml", "kind = \"tracks\"\ntitle = \"t\"\nrecording = []", &[]).unwrap_err();
        assert!(problems.to_string().contains("[[recording]]"), "{problems}");
    }
}
