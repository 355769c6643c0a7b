//! `flockworks models`: what the models say of themselves.

use crate::case::model;
use crate::fault::{Fault, wrong};
use crate::table::Table;
use crate::taxonomy::{Classification, Condition, conditions, leave_some, meets, rows_of};
use clap::{Args, ValueEnum};
use lab::scenario::agents::{default_in_files, in_radians, unit_in_files};
use serde_json::{Value as Json, json};
use space::{Column, ColumnKind};
use std::io::Write;
use swarm::card::{Avoidance, Composition, Information, Taxonomy};
use swarm::models::{Entry, LIST};
use swarm::parameters::{Descriptor, Range, Value};

/// Widest line of running text.
const WIDTH: usize = 100;

/// Form of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For reading in a terminal.
    Text,
    /// JSON.
    Json,
    /// Markdown.
    Md,
    /// Comma-separated values, of lists and tables.
    Csv,
}

/// Options of `models`.
#[derive(Args, Debug)]
pub struct ModelsOptions {
    /// A model's id, for all that its code says of it; without it, a table of all models.
    #[arg(conflicts_with_all = ["table", "condition"])]
    pub id: Option<String>,
    /// The publications and their models as the dissertation classifies them, by design or by validation.
    #[arg(long, value_enum)]
    pub table: Option<Classification>,
    /// Only what is classified so, such as `velocity=no collision=all`; keys are the columns of the tables, or their beginnings.
    #[arg(long = "where", value_name = "CONDITIONS")]
    pub condition: Option<String>,
    /// Form of the output.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// Draw a typical run of the model instead, as SVG.
    #[arg(long, requires = "id", conflicts_with = "format")]
    pub picture: bool,
}

/// Prints the table of models, or one model's card.
///
/// # Errors
/// An unknown id, a condition that cannot be, conditions that no model meets, or a reader that went away.
pub fn models(options: &ModelsOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let text = match &options.id {
        Some(id) => {
            let entry = model(id)?;
            match options.format {
                _ if options.picture => crate::picture::typical_run(entry)?,
                Format::Text => card_text(entry),
                Format::Md => card_markdown(entry),
                Format::Json => pretty(&card_json(entry)),
                Format::Csv => return wrong("a model's card has no csv form; use text, md or json"),
            }
        }
        None => {
            let conditions = options.condition.as_deref().map_or_else(|| Ok(Vec::new()), conditions)?;
            leave_some(&conditions)?;
            match options.table {
                Some(which) => classified(which, &conditions, options.format)?,
                None => all(&conditions, options.format),
            }
        }
    };
    out.write_all(text.as_bytes())?;
    Ok(())
}

/// The list of the models that meet the conditions.
fn all(conditions: &[Condition], format: Format) -> String {
    let chosen: Vec<&Entry> = LIST.iter().filter(|entry| meets(&entry.card.taxonomy, conditions)).collect();
    match format {
        Format::Text => {
            let plural = if chosen.len() == 1 { "model" } else { "models" };
            format!("{}\n{} {plural}; `flockworks models ID` shows one.\n", list(&chosen).text(), chosen.len())
        }
        Format::Md => list(&chosen).markdown(),
        Format::Csv => list(&chosen).csv(),
        Format::Json => pretty(&Json::from(chosen.into_iter().map(brief_json).collect::<Vec<_>>())),
    }
}

/// A table of publications in a form.
fn classified(which: Classification, conditions: &[Condition], format: Format) -> Result<String, Fault> {
    let (headings, rows) = rows_of(which, conditions);
    if rows.is_empty() {
        return wrong(
            "--where: models meet these conditions, but no row of this table does: a row has the classes of the first model of \
             its publication; leave `--table` out to see them",
        );
    }
    if format == Format::Json {
        let object = |row: Vec<String>| -> Json {
            headings.iter().map(|&heading| heading.to_owned()).zip(row.into_iter().map(Json::from)).collect()
        };
        return Ok(pretty(&rows.into_iter().map(object).collect()));
    }
    let mut table = Table::new(&headings);
    rows.into_iter().for_each(|row| table.row(row));
    Ok(match format {
        Format::Md => table.markdown(),
        Format::Csv => table.csv(),
        Format::Text | Format::Json => table.text(),
    })
}

pub(crate) fn pretty(value: &Json) -> String {
    format!("{value:#}\n")
}

fn list(entries: &[&Entry]) -> Table {
    let mut table = Table::new(&["id", "title", "dimensions", "what members do"]);
    for entry in entries {
        let card = entry.card;
        table.row(vec![card.id.into(), card.title.into(), dimensions(entry), card.about.into()]);
    }
    table
}

fn dimensions(entry: &Entry) -> String {
    let numbers: Vec<String> = entry.dimensions.iter().map(ToString::to_string).collect();
    numbers.join(", ")
}

fn brief_json(entry: &Entry) -> Json {
    let card = entry.card;
    json!({ "id": card.id, "title": card.title, "dimensions": entry.dimensions, "about": card.about })
}

/// The rows of the stage table that the model has.
fn stages(entry: &Entry) -> Vec<(&'static str, &'static str)> {
    let stages = &entry.card.stages;
    let mut rows = vec![
        ("sensing", stages.sensing),
        ("detection", stages.detection),
        ("selection", stages.selection),
        ("motion", stages.motion),
        ("physics", stages.physics),
        ("obstacles", stages.obstacles),
    ];
    rows.retain(|(_, text)| !text.is_empty());
    rows
}

/// What a parameter takes, with the range of its numbers.
fn takes(parameter: &Descriptor) -> String {
    match (parameter.takes.to_string().as_str(), parameter.range) {
        ("a number", range) => range.to_string(),
        (takes, Range::Any) => takes.to_owned(),
        (takes, range) => format!("{takes}, {range}"),
    }
}

pub(crate) fn json_of(value: &Value) -> Json {
    match value {
        Value::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => Json::from(*number as i64),
        Value::Number(number) => Json::from(*number),
        Value::Truth(truth) => Json::from(*truth),
        Value::Text(text) => Json::from(text.as_str()),
        Value::List(list) => list.iter().map(json_of).collect(),
        Value::Table(table) => Json::Object(table.iter().map(|(name, value)| (name.clone(), json_of(value))).collect()),
    }
}

/// The unit of a parameter, and that of files where it is another.
fn unit(parameter: &Descriptor) -> String {
    if in_radians(parameter) {
        format!("{}, in files {}", parameter.unit, unit_in_files(parameter))
    } else {
        parameter.unit.to_owned()
    }
}

/// The default of a parameter in a file, where angles have another unit there.
fn in_files(parameter: &Descriptor) -> Option<Value> {
    let default = default_in_files(parameter);
    (in_radians(parameter) && default != parameter.default).then(|| match default {
        Value::Number(degrees) => Value::Number((1e4 * degrees).round() / 1e4),
        other => other,
    })
}

/// The named sets of parameters, a sentence each.
fn presets(entry: &Entry) -> String {
    let one = |&(name, values): &swarm::motion::Preset| match values {
        [] => format!("`preset = \"{name}\"`: the defaults."),
        values => {
            let values: Vec<String> = values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            format!("`preset = \"{name}\"`: {}.", values.join(", "))
        }
    };
    (entry.presets)().iter().map(one).collect::<Vec<_>>().join("\n")
}

/// How obstacles are given to a law that looks at them.
const OBSTACLES: &str = "In a scenario they are `obstacle`s and the walls of the space; in a case they stand among the parameters: \
     `walls` (from, to: [x, y, x, y]), `discs` or `spheres` (centre and radius: [x, y, r]), `planes` (a point and a normal).";

fn kind(column: &Column) -> String {
    match column.kind {
        ColumnKind::Quantity => "quantity".into(),
        ColumnKind::Count => "count".into(),
        ColumnKind::Label(words) => format!("one of {}", words.join(", ")),
    }
}

pub(crate) fn information(information: Information) -> &'static str {
    match information {
        Information::Global => "global",
        Information::Local => "local",
        Information::Inferred => "inferred",
        Information::Constant => "constant",
        Information::None => "none",
    }
}

pub(crate) fn yes(truth: bool) -> &'static str {
    if truth { "yes" } else { "no" }
}

fn taxonomy(taxonomy: &Taxonomy) -> Vec<(&'static str, String)> {
    let [position, velocity, orientation] = taxonomy.uses;
    let [of_position, of_velocity, of_orientation] = taxonomy.information.map(information);
    let mut validated = Vec::new();
    for (letter, word) in [('M', "mathematics"), ('S', "simulation"), ('P', "physical robots")] {
        if taxonomy.validation.contains(letter) {
            validated.push(word);
        }
    }
    let composition = match taxonomy.composition {
        Composition::Homogeneous => "homogeneous",
        Composition::Heterogeneous => "heterogeneous",
    };
    let avoidance = match taxonomy.avoidance {
        Avoidance::None => "none",
        Avoidance::Member => "members",
        Avoidance::Environment => "environment",
        Avoidance::All => "members and environment",
    };
    vec![
        ("composition", composition.into()),
        ("mobility", if taxonomy.idealized { "idealised" } else { "constrained" }.into()),
        ("time", if taxonomy.discrete { "discrete" } else { "continuous" }.into()),
        ("avoids collisions with", avoidance.into()),
        ("identification", yes(taxonomy.identification).into()),
        ("uses position", format!("{}, {of_position}", yes(position))),
        ("uses velocity", format!("{}, {of_velocity}", yes(velocity))),
        ("uses orientation", format!("{}, {of_orientation}", yes(orientation))),
        ("validated by", if validated.is_empty() { "-".into() } else { validated.join(", ") }),
        ("synchronous", yes(taxonomy.synchronous).into()),
        ("environment", taxonomy.environment.into()),
    ]
}

pub(crate) fn parameters_table(parameters: &[Descriptor]) -> Table {
    let mut table = Table::new(&["name", "alias", "symbol", "unit", "range", "default", "origin", "what it is"]);
    for p in parameters {
        table.row(vec![
            p.name.into(),
            p.alias.unwrap_or("-").into(),
            p.symbol.into(),
            unit(p),
            takes(p),
            in_files(p).map_or_else(|| p.default.to_string(), |told| format!("{}, in files {told}", p.default)),
            p.origin.word().into(),
            p.about.trim().into(),
        ]);
    }
    table
}

fn columns_table(columns: &[Column]) -> Table {
    let mut table = Table::new(&["name", "unit", "kind", "what it is"]);
    for column in columns {
        table.row(vec![column.name.into(), column.unit.into(), kind(column), column.about.trim().into()]);
    }
    table
}

/// Text broken into lines, every line indented.
fn wrapped(text: &str, indent: usize) -> String {
    let space = " ".repeat(indent);
    let mut out = String::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && indent + line.chars().count() + 1 + word.chars().count() > WIDTH {
                out += &format!("{space}{line}\n");
                line.clear();
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += word;
        }
        out += &format!("{space}{line}\n");
    }
    out
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {}\n", line.trim_end())).collect()
}

fn rows(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let row = |(name, text): &(&str, String)| {
        let body = wrapped(text, width + 4);
        format!("  {name:<width$}  {}", body.trim_start())
    };
    rows.iter().map(row).collect()
}

fn card_text(entry: &Entry) -> String {
    let card = entry.card;
    let mut text = format!("{}: {}\n\n{}\n", card.id, card.title, wrapped(card.about, 0));
    let mut part = |title: &str, body: String| {
        if !body.is_empty() {
            text += &format!("{title}\n{body}\n");
        }
    };
    part("Dimensions", format!("  {}\n", dimensions(entry)));
    part("Reference", wrapped(card.reference, 2));
    part("Equations", indented(card.equations));
    let stage = |(name, text): (&'static str, &str)| (name, text.to_owned());
    part("Stages", rows(&stages(entry).into_iter().map(stage).collect::<Vec<_>>()));
    let body = card_parameters(&(entry.parameters)());
    part("Parameters", if body.is_empty() { "  none\n".into() } else { body });
    part("Parameter sets", wrapped(&presets(entry), 2));
    part("Obstacles", if card.stages.obstacles.is_empty() { String::new() } else { wrapped(OBSTACLES, 2) });
    let columns = columns_table((entry.columns)());
    part("State columns", if columns.is_empty() { String::new() } else { indented(&columns.text()) });
    let random: Vec<(&str, String)> = card.random.iter().map(|q| (q.name, q.about.to_owned())).collect();
    part("Random quantities", if random.is_empty() { "  none\n".into() } else { rows(&random) });
    part("Edge rules", wrapped(card.edge, 2));
    part("Departures from the publication", wrapped(card.departures, 2));
    part("Classification", rows(&taxonomy(&card.taxonomy)));
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// The parameters, each with its sentence.
pub(crate) fn card_parameters(parameters: &[Descriptor]) -> String {
    let mut body = String::new();
    for p in parameters {
        let alias = p.alias.map_or_else(String::new, |alias| format!(" (or {alias})"));
        let unit = if p.unit == "-" { String::new() } else { format!(" {}", p.unit) };
        let symbol = if p.symbol == "-" { String::new() } else { format!(", symbol {}", p.symbol) };
        let told = in_files(p).map_or_else(String::new, |told| format!(" (in files {told} {})", unit_in_files(p)));
        body += &format!("  {}{alias} = {}{unit}{told}{symbol}; {}\n", p.name, p.default, p.origin.word());
        body += &wrapped(&format!("{} {}.", p.about.trim(), capital(&takes(p))), 6);
    }
    body
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn card_markdown(entry: &Entry) -> String {
    let card = entry.card;
    let mut text = format!("# `{}`: {}\n\n{}\n\n", card.id, card.title, card.about);
    let mut part = |title: &str, body: &str| {
        if !body.is_empty() {
            text += &format!("## {title}\n\n{}\n\n", body.trim_end());
        }
    };
    part("Dimensions", &dimensions(entry));
    part("Reference", card.reference);
    part("Equations", &format!("```\n{}\n```", card.equations));
    let mut table = Table::new(&["stage", "choice"]);
    for (name, text) in stages(entry) {
        table.row(vec![name.into(), text.into()]);
    }
    part("Stages", &table.markdown());
    let parameters = parameters_table(&(entry.parameters)());
    part("Parameters", &if parameters.is_empty() { "None.".into() } else { parameters.markdown() });
    part("Parameter sets", &presets(entry));
    part("Obstacles", if card.stages.obstacles.is_empty() { "" } else { OBSTACLES });
    let columns = columns_table((entry.columns)());
    part("State columns", &if columns.is_empty() { String::new() } else { columns.markdown() });
    let mut table = Table::new(&["name", "distribution"]);
    for quantity in card.random {
        table.row(vec![format!("`{}`", quantity.name), quantity.about.into()]);
    }
    part("Random quantities", &if table.is_empty() { "None.".into() } else { table.markdown() });
    part("Edge rules", card.edge);
    part("Departures from the publication", card.departures);
    let mut table = Table::new(&["class", "this model"]);
    for (name, value) in taxonomy(&card.taxonomy) {
        table.row(vec![name.into(), value]);
    }
    part("Classification", &table.markdown());
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

fn card_json(entry: &Entry) -> Json {
    let card = entry.card;
    let parameter = |p: Descriptor| {
        let (low, high) = match p.range {
            Range::Any => (None, None),
            Range::NonNegative | Range::Positive => (Some(0.0), None),
            Range::Within(low, high) => (Some(low), Some(high)),
        };
        json!({
            "name": p.name, "alias": p.alias, "symbol": p.symbol, "unit": p.unit, "takes": p.takes.to_string(),
            "range": p.range.to_string(), "low": low, "high": high, "low_included": p.range != Range::Positive,
            "default": json_of(&p.default), "unit_in_files": unit_in_files(&p),
            "default_in_files": json_of(&default_in_files(&p)), "origin": p.origin.word(), "about": p.about.trim(),
        })
    };
    let column = |column: &Column| {
        let words = if let ColumnKind::Label(words) = column.kind { Some(words) } else { None };
        let kind = match column.kind {
            ColumnKind::Quantity => "quantity",
            ColumnKind::Count => "count",
            ColumnKind::Label(_) => "label",
        };
        json!({ "name": column.name, "unit": column.unit, "kind": kind, "labels": words, "about": column.about.trim() })
    };
    let stages: serde_json::Map<String, Json> =
        stages(entry).into_iter().map(|(name, text)| (name.to_owned(), Json::from(text))).collect();
    let taxonomy: serde_json::Map<String, Json> =
        taxonomy(&card.taxonomy).into_iter().map(|(name, text)| (name.replace(' ', "_"), Json::from(text))).collect();
    json!({
        "id": card.id,
        "title": card.title,
        "about": card.about,
        "dimensions": entry.dimensions,
        "reference": card.reference,
        "equations": card.equations.lines().collect::<Vec<_>>(),
        "stages": stages,
        "parameters": (entry.parameters)().into_iter().map(parameter).collect::<Vec<_>>(),
        "columns": (entry.columns)().iter().map(column).collect::<Vec<_>>(),
        "random": card.random.iter().map(|q| json!({ "name": q.name, "about": q.about })).collect::<Vec<_>>(),
        "edge": card.edge,
        "departures": card.departures,
        "taxonomy": taxonomy,
    })
}
