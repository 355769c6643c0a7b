//! The texts that a file is made of, as a manifest keeps them, so that a folder can be read again without them.

use crate::file::Sources;
use serde_json::{Value as Json, json};

/// Texts kept in a manifest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texts {
    /// Name and text of each; the first is the file itself.
    texts: Vec<(String, String)>,
    /// What was put over it, each `path=value`.
    pub sets: Vec<String>,
    /// Whether it was run quick.
    pub quick: bool,
}

impl Texts {
    /// What a manifest keeps of sources.
    pub fn json(sources: &Sources, sets: &[String], quick: bool) -> Json {
        let all = (0..).map(|k| (sources.name(k), sources.text(k)));
        let mut texts: Vec<(&str, &str)> = Vec::new();
        for (name, text) in all.take_while(|(name, text)| !(name.is_empty() && text.is_empty())) {
            // a file that several parts extend is kept once
            if name != "--set" && texts.iter().all(|(other, _)| *other != name) {
                texts.push((name, text));
            }
        }
        let texts: Vec<Json> = texts.iter().map(|(name, text)| json!({ "name": name, "text": text })).collect();
        json!({ "texts": texts, "set": sets, "quick": quick })
    }
    /// What a manifest has kept. None where it lacks something.
    pub fn of(manifest: &Json) -> Option<Self> {
        let files = manifest.get("files")?;
        let text = |entry: &Json| {
            let word = |key: &str| entry.get(key).and_then(Json::as_str).map(str::to_owned);
            Some((word("name")?, word("text")?))
        };
        let texts: Vec<_> = files.get("texts")?.as_array()?.iter().filter_map(text).collect();
        let sets = files.get("set")?.as_array()?.iter().filter_map(Json::as_str).map(str::to_owned).collect();
        let quick = files.get("quick").and_then(Json::as_bool).unwrap_or(false);
        (!texts.is_empty()).then_some(Self { texts, sets, quick })
    }
    /// Name and text of the file itself.
    pub fn file(&self) -> (&str, &str) {
        self.texts.first().map_or(("", ""), |(name, text)| (name, text))
    }
    /// The text of a file that it names.
    ///
    /// # Errors
    /// One that was not kept.
    pub fn text(&self, name: &str) -> Result<String, String> {
        let found = self.texts.iter().find(|(other, _)| other == name);
        found.map(|(_, text)| text.clone()).ok_or_else(|| format!("`{name}` is not in the manifest"))
    }
}
