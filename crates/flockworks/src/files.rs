//! `flockworks new`, `schema`, `metrics`, `export`, `completions`, `man`: what helps with files.

use crate::command::Line;
use crate::fault::{Fault, hint, wrong};
use crate::kinds;
use crate::run::read_back;
use crate::table::Table;
use clap::{Args, CommandFactory, ValueEnum};
use lab::run::{EVENTS, METRICS, TRAJECTORY};
use lab::store::table::Table as Stored;
use lab::store::{StoreError, export as forms};
use std::io::Write;
use std::path::PathBuf;

/// Options of `new`.
#[derive(Args, Debug)]
pub struct KindOptions {
    /// Kind of file, as it stands behind `kind =` in it.
    pub kind: String,
}

/// Form of a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaForm {
    /// JSON schema.
    Json,
    /// Markdown, to read.
    Md,
}

/// Options of `schema`.
#[derive(Args, Debug)]
pub struct SchemaOptions {
    /// Kind of file, as it stands behind `kind =` in it. Left out, the kinds there are.
    pub kind: Option<String>,
    /// Form of the output.
    #[arg(long, value_enum, default_value = "json")]
    pub format: SchemaForm,
}

/// Form of a list of metrics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MetricsForm {
    /// For reading in a terminal.
    Text,
    /// Markdown.
    Md,
}

/// Options of `metrics`.
#[derive(Args, Debug)]
pub struct MetricsOptions {
    /// A metric's id, for all there is to know about it; without it, a table of all metrics.
    pub id: Option<String>,
    /// Form of the output.
    #[arg(long, value_enum, default_value = "text")]
    pub format: MetricsForm,
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

/// Options of `explain`.
#[derive(Args, Debug)]
pub struct ExplainOptions {
    /// Folder of a complete run.
    pub folder: PathBuf,
    /// Number of the kept frame, from 0.
    #[arg(long, value_name = "F")]
    pub frame: u64,
    /// Number of the agent in the world, from 0.
    #[arg(long, value_name = "I")]
    pub agent: u32,
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

/// Prints a commented file to start from.
///
/// # Errors
/// An unknown kind, or a reader that went away.
pub fn new(options: &KindOptions, out: &mut dyn Write) -> Result<(), Fault> {
    out.write_all(kinds::find(&options.kind)?.template().as_bytes())?;
    Ok(())
}

/// Prints the schema of a kind of file, or the kinds there are.
///
/// # Errors
/// An unknown kind, or a reader that went away.
pub fn schema(options: &SchemaOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let Some(kind) = &options.kind else {
        writeln!(out, "{}", kinds::ids().join("\n"))?;
        return Ok(());
    };
    let kind = kinds::find(kind)?;
    match options.format {
        SchemaForm::Md => out.write_all(kind.reference().as_bytes())?,
        SchemaForm::Json => writeln!(out, "{}", serde_json::to_string_pretty(&kind.schema()).unwrap_or_default())?,
    }
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
        if options.format == MetricsForm::Md {
            writeln!(out, "{}", table.markdown())?;
            for card in list {
                writeln!(out, "{}", metric(card, options.format))?;
            }
            return Ok(());
        }
        writeln!(out, "{}\n{} metrics; `flockworks metrics ID` shows one.", table.text(), list.len())?;
        writeln!(out, "Shares of the named states of a model, and contacts, are measured by themselves.")?;
        return Ok(());
    };
    let Some(card) = list.iter().find(|card| card.id == id) else {
        let ids: Vec<&str> = list.iter().map(|card| card.id).collect();
        return wrong(format!("unknown metric `{id}`{}", hint(id, &ids)));
    };
    write!(out, "{}", metric(card, options.format))?;
    Ok(())
}

/// All there is to know about a metric.
fn metric(card: &measure::MetricCard, form: MetricsForm) -> String {
    let counted = match card.counted {
        measure::Counted::Positions => "those with a position",
        measure::Counted::Velocities => "those with a position and a velocity",
        measure::Counted::Headings => "those with a heading, that is with a speed above 1e-12",
    };
    let edge = &card.edge;
    let mut rows = vec![
        ("Definition", format!("{} = {}", card.symbol, card.definition.replace('\n', " "))),
        ("Unit", card.unit.to_owned()),
        ("Source", card.source.to_owned()),
        ("Members counted", counted.to_owned()),
        (
            "Where there is little to measure",
            format!("no members: {}; one: {}; all at rest: {}", edge.empty, edge.one, edge.at_rest),
        ),
    ];
    for p in card.parameters {
        rows.push(("Parameter", format!("{} = {} {}: {}", p.name, p.default, p.unit, p.about)));
    }
    let mut text = match form {
        MetricsForm::Text => format!("{}: {}\n", card.id, card.title),
        MetricsForm::Md => format!("## {}\n\n{}\n\n", card.id, card.title),
    };
    for (name, value) in rows {
        text += &match form {
            MetricsForm::Text => format!("\n{name}\n  {value}\n"),
            MetricsForm::Md => format!("- {name}: {value}\n"),
        };
    }
    text
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

/// Prints what an agent does in the step that begins at a frame, stage by stage, as JSON.
///
/// # Errors
/// A folder that is of no complete run, a frame or an agent that is not there, or a reader that went away.
pub fn explain(options: &ExplainOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let explanation = lab::explain::at(&options.folder, options.frame, options.agent)?;
    writeln!(out, "{}", serde_json::to_string_pretty(&explanation).unwrap_or_default())?;
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
