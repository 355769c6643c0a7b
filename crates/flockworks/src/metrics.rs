//! `flockworks metrics`: what can be measured, of a frame and over time.

use crate::fault::{Fault, hint, wrong};
use crate::table::Table;
use clap::{Args, ValueEnum};
use measure::metrics as of_frames;
use measure::{Counted, MetricCard, Parameter, TrackCard, over_time};
use std::io::Write;

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

/// Prints the tables of metrics, or one metric's card.
///
/// # Errors
/// An unknown id, or a reader that went away.
pub fn metrics(options: &MetricsOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let form = options.format;
    let frames = of_frames::LIST.iter().map(|card| (card.id, of_frame(card, form)));
    let cards: Vec<(&str, String)> =
        frames.chain(over_time::LIST.iter().map(|card| (card.id, over(card, form)))).collect();
    if let Some(id) = &options.id {
        let Some((_, text)) = cards.iter().find(|(known, _)| known == id) else {
            let ids: Vec<&str> = cards.iter().map(|card| card.0).collect();
            return wrong(format!("unknown metric `{id}`{}", hint(id, &ids)));
        };
        write!(out, "{text}")?;
        return Ok(());
    }
    let mut frame = Table::new(&["id", "title", "unit", "dimensions", "definition"]);
    for card in of_frames::LIST {
        let texts = [card.id, card.title, card.unit, &listed(card.dimensions), first_line(card.definition)];
        frame.row(texts.map(str::to_owned).to_vec());
    }
    let mut tracks = Table::new(&["id", "title", "dimensions", "definition"]);
    for card in over_time::LIST {
        let texts = [card.id, card.title, &listed(card.dimensions), first_line(card.definition)];
        tracks.row(texts.map(str::to_owned).to_vec());
    }
    if form == MetricsForm::Md {
        writeln!(out, "Of a frame: a number each.\n\n{}", frame.markdown())?;
        writeln!(out, "Over time, of tracks: a table each.\n\n{}", tracks.markdown())?;
        for (_, text) in &cards {
            writeln!(out, "{text}")?;
        }
        return Ok(());
    }
    writeln!(
        out,
        "{}\n{} metrics of a frame; `flockworks metrics ID` shows one.",
        frame.text(),
        of_frames::LIST.len()
    )?;
    writeln!(out, "Shares of the named states of a model, and contacts, are measured by themselves.\n")?;
    writeln!(out, "{}\n{} metrics over time, of tracks; each gives a table.", tracks.text(), over_time::LIST.len())?;
    Ok(())
}

/// All there is to know about a metric of a frame.
fn of_frame(card: &MetricCard, form: MetricsForm) -> String {
    let edge = &card.edge;
    let little = format!("no members: {}; one: {}; all at rest: {}", edge.empty, edge.one, edge.at_rest);
    let range = card.range.map_or_else(|| "no natural one".to_owned(), |(low, high)| format!("{low} to {high}"));
    let mut rows = vec![
        ("Definition", format!("{} = {}", card.symbol, card.definition.replace('\n', " "))),
        ("Variant", card.variant.to_owned()),
        ("Unit", card.unit.to_owned()),
        ("Range", range),
        ("Source", card.source.to_owned()),
        ("Members counted", counted(card.counted).to_owned()),
        ("Where there is little to measure", little),
    ];
    rows.extend(card.parameters.iter().map(parameter));
    page(card.id, card.title, &rows, form)
}

/// All there is to know about a metric over time.
fn over(card: &TrackCard, form: MetricsForm) -> String {
    let mut rows = vec![
        ("Definition", card.definition.to_owned()),
        ("Variant", card.variant.to_owned()),
        ("Source", card.source.to_owned()),
        ("Members counted", counted(card.counted).to_owned()),
        ("Where there is little to measure", card.edge.to_owned()),
    ];
    rows.extend(card.parameters.iter().map(parameter));
    rows.extend(card.fields.iter().map(|field| {
        let unit = if field.unit.is_empty() { String::new() } else { format!(" ({})", field.unit) };
        ("Column", format!("{}{unit}: {}", field.name, field.about))
    }));
    page(card.id, card.title, &rows, form)
}

fn counted(counted: Counted) -> &'static str {
    match counted {
        Counted::Positions => "those with a position",
        Counted::Velocities => "those with a position and a velocity",
        Counted::Headings => "those with a heading, that is with a speed above 1e-12",
        Counted::Bodies => "those whose direction of the body is known",
    }
}

fn parameter(parameter: &Parameter) -> (&'static str, String) {
    let default = match parameter.default {
        None => "(to be given)".to_owned(),
        Some(value) if value.is_infinite() => "(no limit)".to_owned(),
        Some(value) => value.to_string(),
    };
    ("Parameter", format!("{} = {default} {}: {}", parameter.name, parameter.unit, parameter.about))
}

fn listed(dimensions: &[usize]) -> String {
    dimensions.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or("")
}

/// A card in one of the forms.
fn page(id: &str, title: &str, rows: &[(&str, String)], form: MetricsForm) -> String {
    let mut text = match form {
        MetricsForm::Text => format!("{id}: {title}\n"),
        MetricsForm::Md => format!("## {id}\n\n{title}\n\n"),
    };
    for (name, value) in rows {
        text += &match form {
            MetricsForm::Text => format!("\n{name}\n  {value}\n"),
            MetricsForm::Md => format!("- {name}: {value}\n"),
        };
    }
    text
}
