//! Tracks of real and of simulated individuals: read from the tables that tracking programs write, cleaned where asked,
//! measured by the metrics of simulations, and left in a folder that the viewer plays.
//!
//! Reading goes in four steps. The beginning of a table ([`text::Head`]) is recognised by a layout ([`layouts::LIST`]), which
//! makes a plan of what its rows hold; rows become columns (`gather`); times become frames (`settle`); the rows become
//! [`measure::Tracks`]. What was understood is told ([`Understood`]); what is left open is an error that names the option
//! which settles it.

pub mod analysis;
pub mod clean;
pub mod file;
mod flat;
pub mod folder;
mod gather;
pub mod layouts;
pub mod names;
mod run_folder;
mod settle;
mod stamps;
pub mod tables;
pub mod text;

use crate::report::of_run::short;
use crate::store::StoreError;
use gather::Gathered;
use layouts::{Plan, trex};
use measure::{Ground, Rows, Tracks};
use settle::Settled;
use space::Space;
use std::io::Read;
use std::path::{Path, PathBuf};
use text::Head;

/// Individuals beyond which something else than individuals is counted, unless the user says so.
pub const MANY: usize = 100_000;

/// Frames per second, where they are said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rate {
    /// So many.
    Known(f64),
    /// Nobody knows: times are counted in frames.
    Unknown,
}

/// What the user says of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Ask {
    /// The layout; none or `auto` to recognise it.
    pub layout: Option<String>,
    /// Which columns are what, by the roles of [`names::ROLES`] and [`names::CHOICES`].
    pub columns: Vec<(String, String)>,
    /// Frames per second.
    pub fps: Option<Rate>,
    /// Unit of length of the numbers, after scaling.
    pub units: Option<String>,
    /// What positions are multiplied with.
    pub scale: f64,
    /// Least confidence of a point that is used.
    pub confidence: Option<f64>,
    /// Most individuals.
    pub individuals: usize,
    /// Whether the first of an individual's rows in a frame is kept and the others are not an error.
    pub keep_first: bool,
}

impl Default for Ask {
    fn default() -> Self {
        Self {
            layout: None,
            columns: Vec::new(),
            fps: None,
            units: None,
            scale: 1.0,
            confidence: None,
            individuals: MANY,
            keep_first: false,
        }
    }
}

impl Ask {
    /// The column asked for in a role.
    pub fn column(&self, role: &str) -> Option<&str> {
        self.columns.iter().find(|(known, _)| known == role).map(|(_, name)| name.as_str())
    }
    /// Refuses a role that does not exist.
    ///
    /// # Errors
    /// The role, with the nearest that does.
    pub fn check(&self) -> Result<(), StoreError> {
        let known = || names::ROLES.iter().map(|&(role, _)| role).chain(names::CHOICES.map(|(role, _)| role));
        for (role, _) in &self.columns {
            if !known().any(|known| known == role) {
                let all: Vec<&str> = known().collect();
                return Err(StoreError::Refused(format!(
                    "no column can be `{role}`{}; there are {}",
                    meant(role, known()),
                    all.join(", ")
                )));
            }
        }
        Ok(())
    }
}

/// Tracks in the plane (or on the earth) or in space.
#[derive(Clone, Debug)]
pub enum Table {
    /// Two coordinates.
    Plane(Tracks<2>),
    /// Three.
    Space(Tracks<3>),
}

/// Does the same with tracks of either dimension.
#[macro_export]
macro_rules! with_tracks {
    ($table:expr, $tracks:ident => $body:expr) => {
        match $table {
            $crate::tracks::Table::Plane($tracks) => $body,
            $crate::tracks::Table::Space($tracks) => $body,
        }
    };
}

/// What the reader understood of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Understood {
    /// The layout.
    pub layout: String,
    /// Number of individuals.
    pub individuals: usize,
    /// Number of frames, and the first and the last of their numbers.
    pub frames: usize,
    /// Number of the first frame and of the last.
    pub span: (i64, i64),
    /// Time from the first frame to the last.
    pub duration: f64,
    /// Frames per second, where they come at a rate that is known.
    pub rate: Option<f64>,
    /// Unit of time: `s`, or `frame` where there is no rate.
    pub time_unit: String,
    /// Unit of length; `unit` where nobody said one.
    pub unit: String,
    /// Whether places are longitude and latitude.
    pub geographic: bool,
    /// Least and greatest coordinate of each axis.
    pub extent: Vec<(f64, f64)>,
    /// Number of positions.
    pub positions: usize,
    /// Share of individuals times frames without a position.
    pub missing: f64,
    /// Frames without a position between an individual's first and its last, as a share of these.
    pub gaps: f64,
    /// Individuals that are not there from the first frame to the last.
    pub come_and_go: usize,
    /// Rows left out since the individual had one in that frame already.
    pub repeated: usize,
    /// Positions that belong to no individual.
    pub lost: usize,
    /// Points left out for their confidence.
    pub doubtful: usize,
    /// The moment of time 0, where times are dates.
    pub origin: Option<String>,
    /// What else the user should know.
    pub notes: Vec<String>,
}

impl Understood {
    /// It in lines: what, and how much.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let percent = |share: f64| format!("{} %", short((share * 1e4).round() / 100.0));
        let mut lines = vec![("layout", self.layout.clone()), ("individuals", self.individuals.to_string())];
        let (first, last) = self.span;
        lines.push(("frames", format!("{} ({first} to {last})", self.frames)));
        lines.push((
            "rate",
            match self.rate {
                Some(rate) => format!("{} frames per second, {} s", short(rate), short(self.duration)),
                None if self.time_unit == "frame" => "unknown: times are in frames".into(),
                None if self.frames == 1 => "one moment".into(),
                None => format!("not steady, {} s", short(self.duration)),
            },
        ));
        if let Some(origin) = &self.origin {
            lines.push(("begins", origin.clone()));
        }
        let axes: &[&str] = if self.geographic { &["longitude", "latitude"] } else { &crate::run::tables::AXES };
        let unit = if self.geographic { "degrees" } else { self.unit.as_str() };
        let ends = |(axis, (low, high)): (&&str, &(f64, f64))| format!("{axis} {low} to {high}");
        lines.push((
            "units",
            match (self.geographic, unit) {
                (true, _) => "longitude and latitude; distances are geodesic, in m".into(),
                (false, "unit") => "units of the file (--units names them)".into(),
                (false, unit) => unit.into(),
            },
        ));
        lines.push(("extent", axes.iter().zip(&self.extent).map(ends).collect::<Vec<_>>().join(", ")));
        lines.push((
            "positions",
            format!("{}; missing {}, in gaps {}", self.positions, percent(self.missing), percent(self.gaps)),
        ));
        let counts = [
            ("come and go", self.come_and_go, "individuals that are not there from the first frame to the last"),
            ("repeated", self.repeated, "further rows of an individual in one frame, left out"),
            ("lost", self.lost, "positions without an individual, left out"),
            ("doubtful", self.doubtful, "points below the least confidence, left out"),
        ];
        for (name, count, what) in counts.into_iter().filter(|(_, count, _)| *count > 0) {
            lines.push((name, format!("{count} {what}")));
        }
        lines.extend(self.notes.iter().map(|note| ("note", note.clone())));
        lines
    }
}

/// A recording: its tracks, and what was understood.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Its name.
    pub name: String,
    /// Where it was read.
    pub path: PathBuf,
    /// The tracks.
    pub table: Table,
    /// What was understood.
    pub understood: Understood,
}

/// Something wrong with a file.
fn wrong(path: &Path, what: &str) -> StoreError {
    StoreError::Refused(format!("`{}`: {what}", path.display()))
}

/// The name that may have been meant, as the end of a message.
fn meant<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    space::spelling::nearest(name, known).map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

/// Reads a recording: a table of text or Parquet, the folder of a run, or a folder of tables of TRex.
///
/// # Errors
/// A file that cannot be read, is no table of tracks, or leaves something open; the message names the option that settles it.
pub fn read(path: &Path, name: Option<&str>, ask: &Ask) -> Result<Recording, StoreError> {
    ask.check()?;
    let given = name.map(str::to_owned);
    let stem = || path.file_stem().map_or_else(|| "recording".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let name = given.unwrap_or_else(stem);
    let (files, folder) = files_of(path)?;
    // a folder of ours says all of it itself: what is told of tables does not hold for it
    let own = Ask { individuals: usize::MAX, ..Ask::default() };
    let ask = if folder.is_some() { &own } else { ask };
    let mut gathered: Option<Gathered> = None;
    let mut plan = Plan::default();
    for file in &files {
        let head = head_of(file)?;
        plan = match &folder {
            Some(folder) => folder.plan(&head)?,
            None => layouts::plan(&head, ask)?,
        };
        check_header(&head, &plan)?;
        let rows = gathered.get_or_insert_with(|| Gathered::new(&plan));
        match head.delimiter {
            Some(_) => text::each_row(&head, plan.skip, &mut |row| rows.add(file, &plan, ask, row))?,
            None => flat::each_row(&head, &plan, &mut |row| rows.add(file, &plan, ask, row))?,
        }
    }
    let rows = gathered.ok_or_else(|| wrong(path, "holds no table of tracks"))?;
    let (lost, doubtful) = (rows.lost, rows.doubtful);
    let settled = settle::settle(path, &plan, ask, rows)?;
    let mut understood = Understood {
        layout: plan.layout.to_owned(),
        rate: settled.rate,
        time_unit: if ask.fps == Some(Rate::Unknown) { "frame" } else { "s" }.to_owned(),
        geographic: plan.geographic,
        repeated: settled.repeated,
        lost,
        doubtful,
        origin: settled.origin.clone(),
        notes: plan.notes.iter().chain(&settled.notes).cloned().collect(),
        ..Understood::default()
    };
    understood.unit = match (&ask.units, &plan.unit) {
        (Some(unit), Some(stated)) if unit != stated && ask.scale == 1.0 => {
            let converted = "--scale S converts numbers";
            return Err(wrong(path, &format!("its lengths are in {stated} and --units says {unit}; {converted}")));
        }
        (Some(unit), _) => unit.clone(),
        (None, stated) => stated.clone().filter(|_| ask.scale == 1.0).unwrap_or_else(|| "unit".to_owned()),
    };
    let table = match (plan.dimensions(), plan.geographic) {
        (2, true) => Table::Plane(tracks(path, settled, Ground::Globe)?),
        (2, false) => {
            let space = folder.as_ref().map_or(Ok(Space::open()), |folder| folder.space())?;
            Table::Plane(tracks(path, settled, Ground::Plane(space))?)
        }
        _ => {
            let space = folder.as_ref().map_or(Ok(Space::open()), |folder| folder.space())?;
            Table::Space(tracks(path, settled, Ground::Plane(space))?)
        }
    };
    with_tracks!(&table, tracks => count(tracks, &mut understood));
    Ok(Recording { name, path: path.to_owned(), table, understood })
}

/// The tables of a recording, and the run that they are of.
fn files_of(path: &Path) -> Result<(Vec<PathBuf>, Option<run_folder::RunFolder>), StoreError> {
    if !path.is_dir() {
        return Ok((vec![path.to_owned()], None));
    }
    if let Some(folder) = run_folder::RunFolder::open(path)? {
        return Ok((vec![path.join(crate::run::TRAJECTORY)], Some(folder)));
    }
    let entries = std::fs::read_dir(path).map_err(|error| StoreError::io("read the folder", path, error))?;
    let names: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    let number = |file: &PathBuf| {
        let csv = file.extension().is_some_and(|ending| ending == "csv");
        let stem = file.file_stem()?.to_string_lossy().into_owned();
        let number = trex::individual(&stem).filter(|_| csv)?;
        let video = stem[..stem.len() - number.len()].to_owned();
        Some((video, number.parse::<u32>().ok()?, file.clone()))
    };
    let mut tables: Vec<(String, u32, PathBuf)> = names.iter().filter_map(number).collect();
    tables.sort();
    let Some((video, ..)) = tables.first().cloned() else {
        return Err(wrong(
            path,
            "the folder of no run and of no tables of TRex (VIDEO_fish0.csv, ...); name a table in it",
        ));
    };
    if let Some((other, ..)) = tables.iter().find(|(other, ..)| *other != video) {
        return Err(wrong(
            path,
            &format!("tables of several videos, `{video}...` and `{other}...`; put each into a folder of its own"),
        ));
    }
    Ok((tables.into_iter().map(|(.., file)| file).collect(), None))
}

fn head_of(file: &Path) -> Result<Head, StoreError> {
    let mut mark = Vec::new();
    let open = std::fs::File::open(file).map_err(|error| StoreError::io("read", file, error))?;
    open.take(4).read_to_end(&mut mark).map_err(|error| StoreError::io("read", file, error))?;
    if mark == flat::MARK { flat::head(file) } else { Head::of_text(file) }
}

/// A header that has fewer names than the first row has cells, or more, belongs to no table.
fn check_header(head: &Head, plan: &Plan) -> Result<(), StoreError> {
    let (Some(names), Some(first)) = (head.rows.get(plan.skip.wrapping_sub(1)), head.rows.get(plan.skip)) else {
        return Ok(());
    };
    if plan.skip > 0 && names.len() != first.len() {
        return Err(wrong(
            &head.path,
            &format!("{} names of columns and {} cells in the first row", names.len(), first.len()),
        ));
    }
    Ok(())
}

/// The tracks of settled rows.
fn tracks<const D: usize>(path: &Path, settled: Settled, ground: Ground<D>) -> Result<Tracks<D>, StoreError> {
    let Settled { names, frame, who, place, velocity, clock, .. } = settled;
    let axes = |columns: Vec<Vec<f64>>| -> Option<[Vec<f64>; D]> { columns.try_into().ok() };
    let position = axes(place).ok_or_else(|| wrong(path, "places of another number of coordinates"))?;
    let rows = Rows { frame, individual: who, position, velocity: axes(velocity), body: None };
    Tracks::new(rows, names, clock, ground).map_err(|error| wrong(path, &error.to_string()))
}

/// Counts what is there.
fn count<const D: usize>(tracks: &Tracks<D>, understood: &mut Understood) {
    let frames = tracks.frames();
    let (first, last) = (frames.first().copied().unwrap_or(0), frames.last().copied().unwrap_or(0));
    understood.individuals = tracks.names().len();
    understood.frames = frames.len();
    understood.span = (first, last);
    understood.duration = tracks.times().last().unwrap_or(&0.0) - tracks.times().first().unwrap_or(&0.0);
    understood.positions = tracks.len();
    let all = (((last - first) / tracks.step().max(1) + 1) as f64) * tracks.names().len() as f64;
    understood.missing = (1.0 - tracks.len() as f64 / all).max(0.0);
    let ends = |axis: usize| {
        let fold = |(low, high): (f64, f64), &x: &f64| (low.min(x), high.max(x));
        tracks.positions(axis).iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold)
    };
    understood.extent = (0..D).map(ends).collect();
    let mut lives: Vec<Option<(i64, i64, usize)>> = vec![None; tracks.names().len()];
    for (place, &frame) in frames.iter().enumerate() {
        for row in tracks.rows(place) {
            let life = lives[tracks.individuals()[row] as usize].get_or_insert((frame, frame, 0));
            (life.1, life.2) = (frame, life.2 + 1);
        }
    }
    let span = |life: &(i64, i64, usize)| ((life.1 - life.0) / tracks.step().max(1) + 1) as f64;
    let lived: f64 = lives.iter().flatten().map(span).sum();
    let found: f64 = lives.iter().flatten().map(|life| life.2 as f64).sum();
    understood.gaps = if lived > 0.0 { (1.0 - found / lived).max(0.0) } else { 0.0 };
    let whole = |life: &Option<(i64, i64, usize)>| life.is_some_and(|life| (life.0, life.1) == (first, last));
    understood.come_and_go = lives.iter().filter(|life| !whole(life)).count();
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
mod tests;
