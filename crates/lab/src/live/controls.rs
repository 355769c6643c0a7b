//! The controls of a scenario: every parameter of every group's model, from the descriptors.

use crate::file::Node;
use crate::scenario::Scenario;
use crate::scenario::agents::{Given, default_in_files, unit_in_files};
use serde_json::{Value as Json, json};
use swarm::parameters::{Descriptor, Kind, Range, Value};
use swarm::terms;

/// The controls as the scene lists them. Parameters that are no single value have none.
pub(super) fn controls(scenario: &Scenario, tree: &Node) -> Json {
    let mut list = Vec::new();
    for (name, group) in &scenario.group.0 {
        let below = format!("group.{name}.model.{}", group.model.id);
        let written = below.split('.').try_fold(tree, |node, key| node.get(key));
        for descriptor in group.model.descriptors() {
            let given =
                group.model.parameters.iter().find(|(other, _)| other == descriptor.name).map(|(_, given)| given);
            let default = default_in_files(&descriptor);
            let value = match given {
                None => default.clone(),
                Some(Given::Value(value)) => value.clone(),
                Some(Given::Drawn(_)) => continue,
            };
            let alias = descriptor.alias.filter(|alias| written.is_some_and(|node| node.get(alias).is_some()));
            let path = format!("{below}.{}", alias.unwrap_or(descriptor.name));
            let mut one = |descriptor: &Descriptor, label: &str, path: &str, value: &Value, default: &Value| {
                let unit = scenario.units.of(&unit_in_files(descriptor));
                list.extend(control(descriptor, label, path, name, &unit, value, default));
            };
            match &value {
                // terms have controls where they are written
                Value::List(terms) if descriptor.takes == Kind::Terms && given.is_some() => {
                    for (k, term) in terms.iter().enumerate() {
                        of_term(term, &format!("{path}.{k}"), &mut one);
                    }
                }
                value => one(&descriptor, descriptor.name, &path, value, &default),
            }
        }
    }
    Json::Array(list)
}

/// Calls `one` for each parameter of a stock term.
fn of_term(term: &Value, path: &str, one: &mut dyn FnMut(&Descriptor, &str, &str, &Value, &Value)) {
    let Value::Table(tagged) = term else { return };
    for (id, given) in tagged {
        let (Some(entry), Value::Table(given)) = (terms::find(id), given) else { continue };
        let about = match given.get(terms::SET) {
            Some(Value::Text(set)) => format!("{id} {set}"),
            _ => id.clone(),
        };
        for descriptor in entry.parameters() {
            let default = default_in_files(&descriptor);
            let value = given.get(descriptor.name).unwrap_or(&default);
            let label = format!("{about}: {}", descriptor.name);
            one(&descriptor, &label, &format!("{path}.{id}.{}", descriptor.name), value, &default);
        }
    }
}

fn control(
    descriptor: &Descriptor,
    label: &str,
    path: &str,
    group: &str,
    unit: &str,
    value: &Value,
    default: &Value,
) -> Option<Json> {
    let single = match &descriptor.takes {
        Kind::PerAgent(one) => one,
        other => other,
    };
    let (kind, value, default) = match (single, value, default) {
        (Kind::Number, Value::Number(value), Value::Number(default)) => ("number", json!(value), Some(*default)),
        (Kind::Whole, Value::Number(value), Value::Number(default)) => ("whole", json!(value), Some(*default)),
        (Kind::Truth, Value::Truth(value), _) => ("truth", json!(value), None),
        (Kind::Word(_), Value::Text(value), _) => ("word", json!(value), None),
        _ => return None,
    };
    let words = if let Kind::Word(words) = single { words.clone() } else { Vec::new() };
    let mut control = json!({
        "path": path,
        "group": group,
        "name": label,
        "symbol": descriptor.symbol,
        "about": descriptor.about.trim(),
        "unit": if unit == "1" || unit == "-" { "" } else { unit },
        "kind": kind,
        "value": value,
        "words": words,
    });
    control["default"] = match (default, &descriptor.default) {
        (Some(default), _) => json!(default),
        (None, Value::Truth(truth)) => json!(truth),
        (None, Value::Text(text)) => json!(text),
        (None, _) => Json::Null,
    };
    if let Some(default) = default {
        let now = value.as_f64().unwrap_or(default);
        let (low, high) = ends(descriptor.range, default, now, unit == "deg");
        control["low"] = json!(low);
        control["high"] = json!(high);
        control["step"] = json!(if kind == "whole" { 1.0 } else { stride(high - low) });
    }
    Some(control)
}

/// Ends of a slider: those of the range, or some way around the default and the value.
fn ends(range: Range, default: f64, now: f64, angle: bool) -> (f64, f64) {
    let wide = 3.0 * default.abs().max(now.abs());
    let wide = if wide > 0.0 { wide } else { 1.0 };
    let wide = if angle { wide.min(360.0) } else { wide };
    match range {
        Range::Within(low, high) => (low, high),
        Range::NonNegative => (0.0, wide),
        Range::Positive => (stride(wide), wide),
        Range::Any => (-wide, wide),
    }
}

/// A step of a slider: a power of ten, about a hundredth of its width or less.
fn stride(width: f64) -> f64 {
    10f64.powf((width.abs().max(1e-9) / 100.0).log10().floor())
}
