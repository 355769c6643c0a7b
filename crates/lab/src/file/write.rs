//! A tree as TOML text.

use super::tree::{Entry, Node, Tree};
use core::fmt::Write;

/// The text of a table: plain values first, then a section for each table, in which deeper keys have dots.
pub fn toml(tree: &Node) -> String {
    let mut text = String::new();
    let Tree::Table(entries) = &tree.tree else { return text };
    let is_table = |entry: &&Entry| matches!(&entry.node.tree, Tree::Table(below) if !below.is_empty());
    for entry in entries.iter().filter(|entry| !is_table(entry)) {
        // writing to a string cannot fail, here and below
        let _ = writeln!(text, "{} = {}", key(&entry.key), value(&entry.node.tree));
    }
    for entry in entries.iter().filter(is_table) {
        let _ = writeln!(text, "\n[{}]", key(&entry.key));
        dotted(&mut text, "", &entry.node);
    }
    text
}

/// The text of a value, in one line.
pub fn inline(tree: &Tree) -> String {
    value(tree)
}

fn dotted(text: &mut String, before: &str, node: &Node) {
    let Tree::Table(entries) = &node.tree else { return };
    for entry in entries {
        let path = format!("{before}{}", key(&entry.key));
        match &entry.node.tree {
            Tree::Table(below) if !below.is_empty() => dotted(text, &format!("{path}."), &entry.node),
            tree => drop(writeln!(text, "{path} = {}", value(tree))),
        }
    }
}

fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { name.to_owned() } else { quoted(name) }
}

/// A text in quotes; the escapes of JSON are those of TOML.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007f")
}

fn value(tree: &Tree) -> String {
    match tree {
        Tree::Number(number) if number.is_nan() => "nan".to_owned(),
        // so that it stays a number with a fraction
        Tree::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => format!("{number:.1}"),
        Tree::Number(number) => format!("{number:?}"),
        Tree::Whole(number) => number.to_string(),
        Tree::Truth(truth) => truth.to_string(),
        Tree::Text(text) => quoted(text),
        Tree::List(list) => {
            format!("[{}]", list.iter().map(|node| value(&node.tree)).collect::<Vec<_>>().join(", "))
        }
        Tree::Table(entries) => {
            let entry = |entry: &Entry| format!("{} = {}", key(&entry.key), value(&entry.node.tree));
            let entries: Vec<String> = entries.iter().map(entry).collect();
            if entries.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", entries.join(", ")) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::Sources;
    use crate::file::tree::parse;

    #[test]
    fn what_is_written_reads_back() {
        let text = "a = 1\nb = [1.5, 2.0, -inf, 1e300]\n\"q \\\"\" = \"x\\n\\\"y\\\" \\u007f\"\nt = {}\n[c.d]\ne = true\nf = [{ g = 1 }]\n[c.h]\n";
        let read = |text: &str| {
            let mut sources = Sources::default();
            let source = sources.add("a.toml", text);
            let mut problems = Vec::new();
            let node = parse(&sources, source, &mut problems);
            assert!(problems.is_empty(), "{text}: {problems:?}");
            node
        };
        let node = read(text);
        let again = toml(&node);
        assert_eq!(read(&again).tree.json(), node.tree.json(), "{again}");
        assert!(again.contains("[c]\nd.e = true\nd.f = [{ g = 1 }]\nh = {}"), "{again}");
    }
}
