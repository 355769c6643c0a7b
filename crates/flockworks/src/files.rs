//! `flockworks new`, `schema`, `metrics`, `export`, `completions`, `man`: what helps with files.

use crate::command::Line;
use crate::fault::{Fault, hint, wrong};
use crate::run::read_back;
use crate::table::Table;
use clap::{Args, CommandFactory, ValueEnum};
use lab::run::{EVENTS, METRICS, TRAJECTORY};
use lab::scenario::Scenario;
use lab::store::table::Table as Stored;
use lab::store::{StoreError, export as forms};
use std::io::Write;
use std::path::PathBuf;

/// Kinds of files that can be run.
const KINDS: [&str; 1] = ["scenario"];

/// Options of `new` and `schema`.
#[derive(Args, Debug)]
pub struct KindOptions {
    /// Kind of file: scenario.
    pub kind: String,
}

/// Options of `metrics`.
#[derive(Args, Debug)]
pub struct MetricsOptions {
    /// A metric's id, for all there is to know about it; without it, a table of all metrics.
    pub id: Option<String>,
}

/// A form in which tables can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// Comma-separated values with a line of names: one file for each table.
    Csv,
}

/// Options of `export`.
#[derive(Args, Debug)]
pub struct ExportOptions {
    /// Folder of a complete run.
    pub folder: PathBuf,
    /// Form to export to.
    #[arg(long, value_enum)]
    pub to: Form,
    /// Folder for the files; left out, the run's own.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Options of `completions`.
#[derive(Args, Debug)]
pub struct CompletionsOptions {
    /// The shell.
    pub shell: clap_complete::Shell,
}

/// Options of `man`.
#[derive(Args, Debug)]
pub struct ManOptions {
    /// Folder for the pages, one for each command.
    pub folder: PathBuf,
}

fn known(kind: &str) -> Result<(), Fault> {
    if KINDS.contains(&kind) {
        return Ok(());
    }
    wrong(format!("no kind of file is called `{kind}`{}; there is {}", hint(kind, &KINDS), KINDS.join(", ")))
}

/// Prints a commented file to start from.
///
/// # Errors
/// An unknown kind, or a reader that went away.
pub fn new(options: &KindOptions, out: &mut dyn Write) -> Result<(), Fault> {
    known(&options.kind)?;
    out.write_all(lab::scenario::TEMPLATE.as_bytes())?;
    Ok(())
}

/// Prints the JSON schema of a kind of file.
///
/// # Errors
/// An unknown kind, or a reader that went away.
pub fn schema(options: &KindOptions, out: &mut dyn Write) -> Result<(), Fault> {
    known(&options.kind)?;
    let schema = lab::file::schema::schema::<Scenario>("flockworks scenario");
    writeln!(out, "{}", serde_json::to_string_pretty(&schema).unwrap_or_default())?;
    Ok(())
}

/// Prints the table of metrics, or one metric's card.
///
/// # Errors
/// An unknown id, or a reader that went away.
pub fn metrics(options: &MetricsOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let list = measure::metrics::LIST;
    let Some(id) = &options.id else {
        let mut table = Table::new(&["id", "title", "unit", "dimensions", "definition"]);
        for card in list {
            let dimensions: Vec<String> = card.dimensions.iter().map(ToString::to_string).collect();
            let first = card.definition.lines().next().unwrap_or("").to_owned();
            table.row(vec![card.id.into(), card.title.into(), card.unit.into(), dimensions.join(", "), first]);
        }
        writeln!(out, "{}\n{} metrics; `flockworks metrics ID` shows one.", table.text(), list.len())?;
        writeln!(out, "Shares of the named states of a model, and contacts, are measured by themselves.")?;
        return Ok(());
    };
    let Some(card) = list.iter().find(|card| card.id == id) else {
        let ids: Vec<&str> = list.iter().map(|card| card.id).collect();
        return wrong(format!("unknown metric `{id}`{}", hint(id, &ids)));
    };
    writeln!(out, "{}: {}\n", card.id, card.title)?;
    writeln!(out, "Definition\n  {} = {}", card.symbol, card.definition.replace('\n', "\n  "))?;
    writeln!(out, "Unit\n  {}", card.unit)?;
    writeln!(out, "Source\n  {}", card.source)?;
    writeln!(
        out,
        "Members counted\n  {}",
        match card.counted {
            measure::Counted::Positions => "those with a position",
            measure::Counted::Velocities => "those with a position and a velocity",
            measure::Counted::Headings => "those with a heading, that is with a speed above 1e-12",
        }
    )?;
    let edge = &card.edge;
    writeln!(
        out,
        "Where there is little to measure\n  no members: {}; one: {}; all at rest: {}",
        edge.empty, edge.one, edge.at_rest
    )?;
    if !card.parameters.is_empty() {
        writeln!(out, "Parameters")?;
        for p in card.parameters {
            writeln!(out, "  {} = {} {}: {}", p.name, p.default, p.unit, p.about)?;
        }
    }
    Ok(())
}

/// Writes the tables of a run in another form.
///
/// # Errors
/// A folder that is of no complete run, or one that cannot be written to.
pub fn export(options: &ExportOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let from = &options.folder;
    read_back(from)?;
    let to = options.out.as_ref().unwrap_or(from);
    std::fs::create_dir_all(to).map_err(|error| StoreError::io("make the folder", to, error))?;
    for name in [TRAJECTORY, METRICS, EVENTS] {
        let path = from.join(name);
        if !path.exists() {
            continue;
        }
        let table = Stored::open(&path)?;
        let Form::Csv = options.to;
        let target = to.join(name).with_extension("csv");
        let part = target.with_extension("csv.part");
        let write = || {
            let file = std::fs::File::create(&part).map_err(|error| StoreError::io("create", &part, error))?;
            let mut file = std::io::BufWriter::new(file);
            forms::csv(&table, &mut file)?;
            file.flush().map_err(|error| StoreError::io("write", &target, error))?;
            std::fs::rename(&part, &target).map_err(|error| StoreError::io("write", &target, error))
        };
        if let Err(error) = write() {
            // nothing half-written stays; the first error is the one to tell
            let _ = std::fs::remove_file(&part);
            return Err(error.into());
        }
        writeln!(out, "{}: {} rows", target.display(), table.rows())?;
    }
    Ok(())
}

/// Prints completions for a shell.
///
/// # Errors
/// A reader that went away.
pub fn completions(options: &CompletionsOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut Line::command(), "flockworks", &mut text);
    out.write_all(&text)?;
    Ok(())
}

/// Writes the man pages.
///
/// # Errors
/// A folder that cannot be written to.
pub fn man(options: &ManOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let folder = &options.folder;
    std::fs::create_dir_all(folder).map_err(|error| StoreError::io("make the folder", folder, error))?;
    clap_mangen::generate_to(Line::command(), folder)
        .map_err(|error| StoreError::io("write man pages in", folder, error))?;
    writeln!(out, "{}", folder.join("flockworks.1").display())?;
    Ok(())
}
