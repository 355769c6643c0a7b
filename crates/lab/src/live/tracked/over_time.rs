//! Metrics over time of a recording, as far as they belong to moments or to individuals.

use super::{MEASURED, column};
use crate::store::StoreError;
use crate::store::table::Table;
use measure::{Field, Kind, TrackCard, over_time};
use serde_json::{Value as Json, json};
use std::collections::{BTreeMap, HashMap};

/// Numbers of a table beyond which a metric is left to the page of the analysis.
const MOST: usize = 2_000_000;
/// Lines of a chart, at most.
const LINES: usize = 60;

/// What was found of a recording.
#[derive(Default)]
pub(super) struct Found {
    /// Charts as the scene lists metrics; their lines come by themselves.
    pub charts: Vec<Json>,
    /// The lines of the charts.
    pub lines: Vec<Json>,
    /// What was found of each individual, by its name: title, number, unit.
    pub each: HashMap<String, Vec<(String, f64, String)>>,
}

/// A row of a metric's table: numbers and labels by field.
type Row = HashMap<String, (f64, String)>;

/// Reads what was measured over time.
pub(super) fn read(table: &Table, recording: usize) -> Result<Found, StoreError> {
    let names = ["run", "metric", "flagged", "row", "field", "unit", "value", "label"];
    let wanted = names.map(|name| column(table, name)).into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut found = Found::default();
    if table.rows() as usize > MOST {
        return Ok(found);
    }
    let mut metrics: BTreeMap<usize, (BTreeMap<i64, Row>, HashMap<String, String>)> = BTreeMap::new();
    for group in 0..table.groups() {
        let read = table.read(group, &wanted)?;
        for row in 0..read[0].len() {
            if read[0].number(row) as usize != recording || read[2].text(row) != "kept" {
                continue;
            }
            let id = read[1].text(row);
            let Some(place) = over_time::LIST.iter().position(|card| card.id == id) else { continue };
            let (rows, units) = metrics.entry(place).or_default();
            let field = read[4].text(row);
            units.entry(field.clone()).or_insert_with(|| read[5].text(row));
            let value = (read[6].number(row), read[7].text(row));
            rows.entry(read[3].number(row) as i64).or_default().insert(field, value);
        }
    }
    for (place, (rows, units)) in metrics {
        let card = over_time::LIST[place];
        let unit = |field: &Field| units.get(field.name).cloned().unwrap_or_default();
        if card.fields.iter().any(|field| field.name == "t") {
            charts(card, &rows, &unit, &mut found);
        } else if card.fields.first().is_some_and(|field| field.kind == Kind::Individual) {
            individuals(card, &rows, &unit, &mut found);
        }
    }
    Ok(found)
}

/// What is measured rather than told: numbers that are no time.
fn numbers(card: &TrackCard) -> impl Iterator<Item = &'static Field> {
    card.fields
        .iter()
        .filter(|field| matches!(field.kind, Kind::Number | Kind::Count) && field.name != "t" && field.name != "rank")
}

fn titled(card: &TrackCard, field: &Field) -> String {
    if numbers(card).count() == 1 {
        return card.title.to_owned();
    }
    format!("{}: {}", card.title, field.name.replace('_', " "))
}

/// A chart for each number of a metric that is told frame by frame. Events are marks, and no lines.
fn charts(card: &'static TrackCard, rows: &BTreeMap<i64, Row>, unit: &dyn Fn(&Field) -> String, found: &mut Found) {
    let is_event = card.id.ends_with("_events") || ["line_crossings", "collisions"].contains(&card.id);
    if is_event
        || card.fields.iter().filter(|field| matches!(field.kind, Kind::Individual)).count() > 1 && !has(card, "rank")
    {
        return;
    }
    let whose = card.fields.iter().find(|field| matches!(field.kind, Kind::Individual | Kind::Group | Kind::Label(_)));
    for field in numbers(card) {
        let mut lines: Vec<(String, Vec<f64>, Vec<Option<f64>>)> = Vec::new();
        for row in rows.values() {
            // of the nearest, the very nearest
            if row.get("rank").is_some_and(|(rank, _)| *rank > 1.0) {
                continue;
            }
            let (Some((t, _)), Some((value, _))) = (row.get("t"), row.get(field.name)) else { continue };
            let name = whose.and_then(|whose| row.get(whose.name)).map_or(String::new(), |(_, label)| label.clone());
            let place = lines.iter().position(|line| line.0 == name).unwrap_or_else(|| {
                lines.push((name, Vec::new(), Vec::new()));
                lines.len() - 1
            });
            lines[place].1.push(*t);
            lines[place].2.push(Some(*value).filter(|value| value.is_finite()));
        }
        // one moment is no line
        lines.retain(|line| line.2.iter().flatten().count() > 1);
        if lines.is_empty() || lines.len() > LINES {
            continue;
        }
        let id = format!("{}.{}", card.id, field.name);
        found.charts.push(
            json!({ "id": id, "title": titled(card, field), "unit": unit(field), "range": Json::Null, "own": true }),
        );
        let line = |(name, t, y): &(String, Vec<f64>, Vec<Option<f64>>)| {
            let every = t.len().div_ceil(MEASURED).max(1);
            json!({
                "name": name,
                "t": t.iter().step_by(every).collect::<Vec<_>>(),
                "y": y.iter().step_by(every).collect::<Vec<_>>(),
            })
        };
        found.lines.push(json!({ "id": id, "lines": lines.iter().map(line).collect::<Vec<_>>() }));
    }
}

fn has(card: &TrackCard, name: &str) -> bool {
    card.fields.iter().any(|field| field.name == name)
}

/// What a metric with a row for each individual found of each.
fn individuals(
    card: &'static TrackCard,
    rows: &BTreeMap<i64, Row>,
    unit: &dyn Fn(&Field) -> String,
    found: &mut Found,
) {
    let others =
        card.fields.iter().filter(|field| matches!(field.kind, Kind::Individual | Kind::Group | Kind::Label(_)));
    if others.count() > 1 {
        return;
    }
    for row in rows.values() {
        let Some((_, name)) = row.get(card.fields[0].name) else { continue };
        for field in numbers(card) {
            let Some((value, _)) = row.get(field.name).filter(|(value, _)| value.is_finite()) else { continue };
            let told = found.each.entry(name.clone()).or_default();
            told.push((titled(card, field).to_lowercase(), *value, unit(field)));
        }
    }
}
