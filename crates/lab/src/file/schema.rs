//! JSON schemas, from the forms: editors complete and check files with them.

use super::form::{Field, Form, Rule, Shape};
use serde_json::{Map, Value as Json, json};
use swarm::parameters::Range;

/// The JSON schema (draft 2020-12) of a kind of file.
pub fn schema<T: Form>(title: &str) -> Json {
    let mut definitions = Map::new();
    let root = of(&T::shape(&Rule::FREE), &mut definitions);
    let mut schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
    });
    if let (Json::Object(schema), Json::Object(root)) = (&mut schema, root) {
        schema.extend(root);
        schema.insert("$defs".into(), Json::Object(definitions));
    }
    schema
}

fn of(shape: &Shape, definitions: &mut Map<String, Json>) -> Json {
    match shape {
        Shape::Number { range, .. } => bounds(*range, "number"),
        Shape::Whole { range, .. } => bounds(*range, "integer"),
        Shape::Truth => json!({ "type": "boolean" }),
        Shape::Text => json!({ "type": "string" }),
        Shape::Word(words) => {
            let about: Vec<String> = words
                .iter()
                .filter(|(_, about)| !about.is_empty())
                .map(|(word, about)| format!("{word}: {about}"))
                .collect();
            let words: Vec<&str> = words.iter().map(|&(word, _)| word).collect();
            if about.is_empty() {
                json!({ "enum": words })
            } else {
                json!({ "enum": words, "description": about.join("\n") })
            }
        }
        Shape::List(entry) => json!({ "type": "array", "items": of(entry, definitions) }),
        Shape::Either(shapes) => {
            let shapes: Vec<Json> = shapes.iter().map(|shape| of(shape, definitions)).collect();
            json!({ "anyOf": shapes })
        }
        Shape::Anything => json!({}),
        Shape::Fields(fields) => object(fields, definitions),
        Shape::Named(entry) => json!({ "type": "object", "additionalProperties": of(entry, definitions) }),
        Shape::Table { name, about, fields } => defined(name, definitions, |definitions| {
            let mut table = object(&fields(), definitions);
            table["description"] = json!(about);
            table
        }),
        Shape::Tagged { name, about, variants } => defined(name, definitions, |definitions| {
            let mut choices = Vec::new();
            let mut bare = Vec::new();
            for variant in variants() {
                let mut below = of(&variant.shape, definitions);
                if below.get("$ref").is_none() {
                    below["description"] = json!(variant.about);
                }
                // a word is enough where nothing below must be said
                if may_be_left_out(&variant.shape) {
                    bare.push(variant.name);
                }
                choices.push(json!({
                    "type": "object",
                    "description": variant.about,
                    "properties": { variant.name: below },
                    "required": [variant.name],
                    "additionalProperties": false,
                }));
            }
            if !bare.is_empty() {
                choices.push(json!({ "enum": bare }));
            }
            json!({ "description": about, "oneOf": choices })
        }),
    }
}

/// Whether an empty table would do.
fn may_be_left_out(shape: &Shape) -> bool {
    match shape {
        Shape::Fields(fields) => fields.iter().all(|field| !field.required),
        Shape::Table { fields, .. } => fields().iter().all(|field| !field.required),
        Shape::Named(_) => true,
        _ => false,
    }
}

fn defined(name: &str, definitions: &mut Map<String, Json>, make: impl FnOnce(&mut Map<String, Json>) -> Json) -> Json {
    if !definitions.contains_key(name) {
        // known before it is made, since forms may contain themselves
        definitions.insert(name.to_owned(), Json::Null);
        let made = make(definitions);
        definitions.insert(name.to_owned(), made);
    }
    json!({ "$ref": format!("#/$defs/{name}") })
}

fn object(fields: &[Field], definitions: &mut Map<String, Json>) -> Json {
    let mut properties = Map::new();
    for field in fields {
        let mut property = of(&field.shape, definitions);
        let unit = if field.unit.is_empty() || field.unit == "1" || field.unit == "-" {
            String::new()
        } else {
            format!(" Unit: {}.", field.unit)
        };
        let words =
            property.get("description").and_then(Json::as_str).map_or_else(String::new, |words| format!("\n{words}"));
        property["description"] = json!(format!("{}{unit}{words}", field.about));
        if let Some(default) = &field.default {
            property["default"] = default.json();
        }
        if let Some(alias) = field.alias {
            properties.insert(alias.to_owned(), property.clone());
        }
        properties.insert(field.name.clone(), property);
    }
    let required: Vec<&str> = fields.iter().filter(|field| field.required).map(|field| field.name.as_str()).collect();
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn bounds(range: Range, kind: &str) -> Json {
    match range {
        Range::Any => json!({ "type": kind }),
        Range::NonNegative => json!({ "type": kind, "minimum": 0 }),
        Range::Positive => json!({ "type": kind, "exclusiveMinimum": 0 }),
        Range::Within(low, high) => json!({ "type": kind, "minimum": low, "maximum": high }),
    }
}
