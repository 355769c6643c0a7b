//! `flockworks analyze`: tracks of animals, people and simulations, understood, cleaned, measured.

use crate::fault::{Fault, wrong};
use crate::run::PROGRAM;
use crate::table::Table;
use clap::Args;
use lab::file::Named;
use lab::report::of_tracks::averages;
use lab::store::folder::whole_file;
use lab::tracks::analysis::Analysed;
use lab::tracks::file::{self, Clean, Measured, Smooth, TracksFile, TracksKind, WrittenRecording};
use lab::tracks::folder::{self, Request, analyse_all};
use lab::tracks::{MANY, Rate, Recording, tables};
use space::parallel::Workers;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Options of `analyze`.
#[derive(Args, Debug)]
#[command(after_help = "\
Layouts that are recognised: trex (give the folder), deeplabcut, sleap, animalta, idtracker, pedestrian (PeTrack, JuPedSim),
long (a row for each individual at each time), wide (a row for each frame); as text or Parquet; and folders of runs.
Nothing is guessed: what a table leaves open is an error that names the option which settles it.

flockworks analyze fish.csv --fps 25 --units cm --out fish
flockworks analyze gps.csv --columns id=bird,time=utc --set measure.parameters.linking_distance=20
flockworks analyze real.csv runs/schooling --fps 25 --out both      # the same measures of both, on one page")]
pub struct AnalyzeOptions {
    /// The tables (CSV, TSV, other text, Parquet), folders of runs, or folders of tables of TRex.
    #[arg(required = true, value_name = "TRACKS")]
    pub tracks: Vec<String>,
    /// Which columns are what: frame, time, id, x, y, z, longitude, latitude, vx, vy, vz, each by its name or its number
    /// from 1, `none` for none; point=PART (or mean) among body parts; wide=xy or xyz; clock=ms.
    #[arg(long, value_name = "ROLE=NAME,...", value_delimiter = ',')]
    pub columns: Vec<String>,
    /// Frames per second; `unknown` measures in frames. Left out: what the table says.
    #[arg(long, value_name = "F")]
    pub fps: Option<String>,
    /// Unit of length of the positions (after --scale), as it stands behind numbers.
    #[arg(long, value_name = "U")]
    pub units: Option<String>,
    /// What positions are multiplied with, as for pixels of known size.
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    pub scale: f64,
    /// Layout of the tables.
    #[arg(long, value_name = "LAYOUT", default_value = "auto")]
    pub layout: String,
    /// Least confidence of a point that is used, where the table tells one.
    #[arg(long, value_name = "C")]
    pub confidence: Option<f64>,
    /// Most individuals: more are taken for a mistake about the column that names them.
    #[arg(long, value_name = "N", default_value_t = MANY)]
    pub individuals: usize,
    /// Keep the first row of an individual in a frame where there are several.
    #[arg(long)]
    pub keep_first: bool,
    /// Fill gaps of at most so many frames by straight lines.
    #[arg(long, value_name = "FRAMES")]
    pub interpolate: Option<usize>,
    /// Smooth the paths by a Savitzky-Golay filter: frames in its window, and the order of its polynomial.
    #[arg(long, value_name = "WINDOW[,ORDER]")]
    pub smooth: Option<String>,
    /// Flag positions that are farther from the last good one than this speed allows.
    #[arg(long, value_name = "SPEED")]
    pub greatest_speed: Option<f64>,
    /// Flag pairs that went to where the other had been.
    #[arg(long)]
    pub swaps: bool,
    /// Metrics by their ids. Left out: all that need no parameter, or one that was given.
    #[arg(long, value_name = "ID,...", value_delimiter = ',')]
    pub metrics: Vec<String>,
    /// Put a value over those of the options, as in a file of the kind tracks: `measure.parameters.linking_distance=20`.
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Write the metrics of every frame as CSV.
    #[arg(long, value_name = "OUT.csv")]
    pub per_frame: Option<PathBuf>,
    /// Leave a folder: tracks, metrics and events as Parquet, a manifest, and the page.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of threads. The results are the same for any. Left out: as many as there are processors.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
}

impl AnalyzeOptions {
    /// The same as a file of the kind tracks.
    fn file(&self) -> Result<TracksFile, Fault> {
        let mut columns = Vec::new();
        for column in &self.columns {
            let Some((role, name)) = column.split_once('=') else {
                return wrong(format!("--columns takes ROLE=NAME, found `{column}`"));
            };
            columns.push((role.trim().to_owned(), name.trim().to_owned()));
        }
        let fps = match self.fps.as_deref() {
            None => None,
            Some("unknown") => Some(Rate::Unknown),
            Some(text) => match text.parse::<f64>() {
                Ok(rate) if rate.is_finite() && rate > 0.0 => Some(Rate::Known(rate)),
                _ => return wrong(format!("--fps takes a number above 0 or `unknown`, found `{text}`")),
            },
        };
        let smooth = self.smooth.as_deref().map(smooth).transpose()?;
        let recording = |path: &String| WrittenRecording {
            layout: self.layout.clone(),
            columns: Named(columns.clone()),
            fps,
            units: self.units.clone(),
            scale: self.scale,
            confidence: self.confidence,
            individuals: self.individuals,
            keep_first: self.keep_first,
            ..WrittenRecording::of(path)
        };
        let names: Vec<String> = self.tracks.iter().map(|path| stem(path)).collect();
        Ok(TracksFile {
            kind: TracksKind::Tracks,
            title: names.join(", "),
            about: String::new(),
            recording: self.tracks.iter().map(recording).collect(),
            clean: Clean {
                interpolate: self.interpolate,
                smooth,
                greatest_speed: self.greatest_speed,
                swaps: self.swaps,
            },
            measure: Measured {
                metrics: (!self.metrics.is_empty()).then(|| self.metrics.clone()),
                parameters: Named::default(),
            },
        })
    }
}

fn stem(path: &str) -> String {
    Path::new(path).file_stem().map_or_else(|| path.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

fn smooth(text: &str) -> Result<Smooth, Fault> {
    let mut parts = text.split(',').map(|part| part.trim().parse::<usize>());
    match (parts.next(), parts.next(), parts.next()) {
        (Some(Ok(window)), None, None) => Ok(Smooth { window, order: 2 }),
        (Some(Ok(window)), Some(Ok(order)), None) => Ok(Smooth { window, order }),
        _ => wrong(format!("--smooth takes frames, or frames and an order as in `9,2`; found `{text}`")),
    }
}

/// Analyses tracks.
///
/// # Errors
/// What is wrong with the options or a table, or a file that cannot be written.
pub fn analyze(options: &AnalyzeOptions, out: &mut dyn Write) -> Result<(), Fault> {
    // options and file go the same way, so that both are checked alike
    let text = file::text(&options.file()?);
    let read = file::read("the options", &text, &options.set).map_err(|problems| {
        let list: Vec<String> = problems.list.iter().map(told).collect();
        Fault::Input(list.join("\n"))
    })?;
    let job = Job {
        file: &read.file,
        text: (String::new(), file::text(&read.file)),
        from: Path::new(""),
        command: command_line(),
        per_frame: options.per_frame.as_deref(),
        out: options.out.as_deref(),
        threads: options.threads,
    };
    run(&job, out)
}

/// A problem in one line: the file that options stand for is not the user's.
fn told(problem: &lab::file::Problem) -> String {
    let help = if problem.help.is_empty() { String::new() } else { format!("; {}", problem.help) };
    format!("{}{help}", problem.what)
}

/// The command as it was given.
fn command_line() -> String {
    let word = |word: String| {
        let plain = |c: char| c.is_alphanumeric() || "-_./=,:+%".contains(c);
        if !word.is_empty() && word.chars().all(plain) { word } else { format!("'{}'", word.replace('\'', "'\\''")) }
    };
    let words = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    core::iter::once("flockworks".to_owned()).chain(words.map(word)).collect::<Vec<_>>().join(" ")
}

/// What is to be done with a file of tracks.
pub(crate) struct Job<'a> {
    pub(crate) file: &'a TracksFile,
    /// Its name and its text.
    pub(crate) text: (String, String),
    pub(crate) from: &'a Path,
    pub(crate) command: String,
    pub(crate) per_frame: Option<&'a Path>,
    pub(crate) out: Option<&'a Path>,
    pub(crate) threads: Option<usize>,
}

/// Analyses the recordings of a file, tells what was found, and writes what is wanted.
pub(crate) fn run(job: &Job<'_>, out: &mut dyn Write) -> Result<(), Fault> {
    if job.threads == Some(0) {
        return wrong("--threads must be 1 or more, found 0");
    }
    if let Some(folder) = job.out {
        folder::check_place(folder, job.file)?;
    }
    let threads = job.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let workers = Arc::new(Workers::new(threads));
    let mut broken = None;
    let all = analyse_all(job.file, job.from, &workers, &mut |recording| {
        if broken.is_none() {
            broken = tell(recording, out).err();
        }
        Ok(())
    })?;
    if let Some(error) = broken {
        return Err(error.into());
    }
    for one in &all {
        summary(one, all.len() > 1, out)?;
    }
    if let Some(path) = job.per_frame {
        whole_file(path, |file| tables::write_csv(&all, file))?;
        writeln!(out, "metrics  {}", path.display())?;
    }
    if let Some(path) = job.out {
        let request = Request {
            file: job.file,
            text: job.text.clone(),
            from: job.from,
            command: job.command.clone(),
            program: PROGRAM.to_owned(),
        };
        folder::write(path, &request, &all)?;
        writeln!(out, "tables  {}", path.display())?;
        writeln!(out, "page    {}", path.join(lab::run::REPORT).display())?;
    }
    Ok(())
}

/// What was understood of a recording, before it is measured.
fn tell(recording: &Recording, out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(out, "{}: {}", recording.name, recording.path.display())?;
    for (what, text) in recording.understood.lines() {
        writeln!(out, "  {what:<11}  {text}")?;
    }
    out.flush()
}

/// The averages of a recording.
fn summary(one: &Analysed, several: bool, out: &mut dyn Write) -> Result<(), Fault> {
    let cleaned = &one.cleaned;
    writeln!(out)?;
    if several {
        writeln!(out, "{}", one.recording.name)?;
    }
    let (gaps, smooth) = (cleaned.asked.interpolate.is_some(), cleaned.asked.smooth.is_some());
    let counts = [
        (gaps, cleaned.filled.1, format!("gaps filled, {} positions", cleaned.filled.0)),
        (gaps, cleaned.left, "gaps left: they are too long".to_owned()),
        (smooth, cleaned.smoothed.0, "positions smoothed".to_owned()),
        (smooth, cleaned.smoothed.1, "positions not smoothed: in stretches shorter than the window".to_owned()),
    ];
    for (_, count, what) in counts.iter().filter(|(asked, ..)| *asked) {
        writeln!(out, "{count} {what}")?;
    }
    for (flag, count) in cleaned.flag_counts() {
        writeln!(out, "{count} positions flagged: {}", flag.word().replace('_', " "))?;
    }
    let short = lab::report::of_run::short;
    let flagged = one.unflagged.is_some();
    let mut headings = vec!["metric", "mean", "sd", "least", "greatest", "unit", "frames"];
    if flagged {
        headings.push("mean without flagged");
    }
    let mut table = Table::new(&headings);
    table.right(&[1, 2, 3, 4, 6, 7]);
    for (k, card) in one.cards.iter().enumerate() {
        let (all, rest) = averages(one, k);
        let Some(a) = all else {
            table.row(vec![card.id.into(), "undefined".into()]);
            continue;
        };
        let sd = if a.sd.is_finite() { short(a.sd) } else { String::new() };
        let mut row = vec![card.id.into(), short(a.mean), sd, short(a.least), short(a.greatest)];
        row.extend([tables::unit_of(one, card.unit), a.frames.to_string()]);
        if flagged {
            row.push(short(rest.unwrap_or(a).mean));
        }
        table.row(row);
    }
    write!(out, "{}", table.text())?;
    for what in &one.undefined {
        writeln!(out, "not measured: {what}")?;
    }
    if !one.over_time.is_empty() {
        let ids: Vec<&str> = one.over_time.iter().map(|(card, _)| card.id).collect();
        writeln!(out, "over time (tables in the folder of --out): {}", ids.join(", "))?;
    }
    if !one.left_out.is_empty() {
        writeln!(out, "not measured, for want of a parameter (--set measure.parameters.NAME=VALUE):")?;
        let mut by_name: Vec<(String, Vec<&str>)> = Vec::new();
        for (id, open) in &one.left_out {
            let names = open.join(", ");
            match by_name.iter_mut().find(|(known, _)| *known == names) {
                Some((_, ids)) => ids.push(id),
                None => by_name.push((names, vec![id])),
            }
        }
        for (names, ids) in by_name {
            writeln!(out, "  {names}: {}", ids.join(", "))?;
        }
    }
    writeln!(out)?;
    Ok(())
}
