//! The reference page of a kind of file, from its forms.

use super::form::{Field, Form, Rule, Shape};
use std::fmt::Write;
use swarm::parameters::Range;

/// The page, in Markdown: a section for every form, a row for every key.
pub fn reference<T: Form>(title: &str, lead: &str) -> String {
    let mut page = format!("# {title}\n\n{lead}\n");
    let mut todo: Vec<Shape> = vec![T::shape(&Rule::FREE)];
    let mut done: Vec<&str> = Vec::new();
    let mut next = 0;
    while let Some(shape) = todo.get(next).cloned() {
        next += 1;
        match shape {
            Shape::Table { name, about, fields } if !done.contains(&name) => {
                done.push(name);
                let fields = fields();
                section(&mut page, name, about, &fields, &mut todo);
            }
            Shape::Tagged { name, about, variants } if !done.contains(&name) => {
                done.push(name);
                let _ =
                    write!(page, "\n## {name}\n\n{about}\nOne of:\n\n| key | below it | meaning |\n|---|---|---|\n");
                for variant in variants() {
                    // the models have pages of their own
                    let below = if name == "Model" {
                        format!("[parameters](../models/{}.md)", variant.name)
                    } else {
                        words(&variant.shape, &mut todo)
                    };
                    let _ = writeln!(page, "| `{}` | {below} | {} |", variant.name, variant.about);
                }
            }
            _ => {}
        }
    }
    page
}

fn section(page: &mut String, name: &str, about: &str, fields: &[Field], todo: &mut Vec<Shape>) {
    let _ =
        write!(page, "\n## {name}\n\n{about}\n\n| key | takes | unit | default | meaning |\n|---|---|---|---|---|\n");
    for field in fields {
        let takes = words(&field.shape, todo);
        let default = match (&field.default, field.required) {
            (_, true) => "must be given".to_owned(),
            (Some(tree), _) => {
                let text = tree.json().to_string();
                if text.len() > 60 { "see below".to_owned() } else { format!("`{}`", text.replace('|', "\\|")) }
            }
            (None, _) => "none".to_owned(),
        };
        let unit = if field.unit.is_empty() || field.unit == "1" { "" } else { &field.unit };
        let _ = writeln!(page, "| `{}` | {takes} | {unit} | {default} | {} |", field.name, field.about);
    }
}

fn words(shape: &Shape, todo: &mut Vec<Shape>) -> String {
    let range = |range: &Range| if *range == Range::Any { String::new() } else { format!(", {range}") };
    match shape {
        Shape::Number { range: of, .. } => format!("a number{}", range(of)),
        Shape::Whole { range: of, .. } => format!("a whole number{}", range(of)),
        Shape::Truth => "true or false".into(),
        Shape::Text => "a text".into(),
        Shape::Word(words) => {
            let word = |(word, about): &(&str, &str)| {
                if about.is_empty() { format!("\"{word}\"") } else { format!("\"{word}\": {about}") }
            };
            words.iter().map(word).collect::<Vec<_>>().join("<br>")
        }
        Shape::List(entry) => format!("a list of: {}", words(entry, todo)),
        Shape::Either(shapes) => shapes.iter().map(|shape| words(shape, todo)).collect::<Vec<_>>().join("; or "),
        Shape::Anything => "any value".into(),
        Shape::Fields(fields) if fields.is_empty() => "nothing".into(),
        Shape::Fields(_) => "its keys".into(),
        Shape::Named(entry) => format!("a table of names, each with: {}", words(entry, todo)),
        Shape::Table { name, .. } | Shape::Tagged { name, .. } => {
            todo.push(shape.clone());
            format!("[{name}](#{})", name.to_lowercase())
        }
    }
}
