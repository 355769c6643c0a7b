//! As much of JSON as GeoJSON needs. (This room stands on `space` alone; the files of the other rooms are read by a
//! library.)

use super::Cursor;
use crate::TerrainError;

/// Deepest nesting that is read.
const DEEPEST: usize = 64;

/// A JSON value. What GeoJSON has no use for, true, false and null, is [`Json::Nothing`].
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Json {
    Nothing,
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

impl Json {
    pub(super) fn read(text: &str) -> Result<Self, TerrainError> {
        let mut cursor = Cursor::new(text);
        let value = value(&mut cursor, 0)?;
        if cursor.rest().is_empty() { Ok(value) } else { cursor.fault("the end") }
    }
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        match self {
            Self::Object(entries) => entries.iter().find(|(known, _)| known == key).map(|(_, value)| value),
            _ => None,
        }
    }
    pub(super) fn text(&self, key: &str) -> Option<&str> {
        match self.get(key) {
            Some(Self::Text(text)) => Some(text),
            _ => None,
        }
    }
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        match self.get(key) {
            Some(Self::Number(number)) => Some(*number),
            _ => None,
        }
    }
    pub(super) fn list(&self) -> &[Self] {
        match self {
            Self::List(list) => list,
            _ => &[],
        }
    }
}

fn value(cursor: &mut Cursor<'_>, depth: usize) -> Result<Json, TerrainError> {
    if depth > DEEPEST {
        return cursor.fault("less deeply nested values");
    }
    for word in ["null", "true", "false"] {
        if cursor.take(word) {
            return Ok(Json::Nothing);
        }
    }
    match cursor.rest().chars().next() {
        Some('"') => Ok(Json::Text(text(cursor)?)),
        Some('[') => {
            let mut list = Vec::new();
            cursor.need("[")?;
            while !cursor.take("]") {
                if !list.is_empty() {
                    cursor.need(",")?;
                }
                list.push(value(cursor, depth + 1)?);
            }
            Ok(Json::List(list))
        }
        Some('{') => {
            let mut entries = Vec::new();
            cursor.need("{")?;
            while !cursor.take("}") {
                if !entries.is_empty() {
                    cursor.need(",")?;
                }
                let key = text(cursor)?;
                cursor.need(":")?;
                entries.push((key, value(cursor, depth + 1)?));
            }
            Ok(Json::Object(entries))
        }
        _ => Ok(Json::Number(cursor.number()?)),
    }
}

fn text(cursor: &mut Cursor<'_>) -> Result<String, TerrainError> {
    cursor.need("\"")?;
    let mut out = String::new();
    let mut letters = cursor.text[cursor.at..].char_indices();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '"' => {
                cursor.at += at + 1;
                return Ok(out);
            }
            '\\' => match letters.next().map(|(_, escaped)| escaped) {
                Some('n') => out.push('\n'),
                Some('t') => out.push('\t'),
                Some('r') => out.push('\r'),
                Some('u') => {
                    let digits: String = letters.by_ref().take(4).map(|(_, digit)| digit).collect();
                    let code = u32::from_str_radix(&digits, 16).ok();
                    // half of a pair is no letter
                    out.push(code.and_then(char::from_u32).unwrap_or(char::REPLACEMENT_CHARACTER));
                }
                Some(other) => out.push(other),
                None => break,
            },
            other => out.push(other),
        }
    }
    cursor.fault("the closing quote of a text")
}

/// A text in quotes.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => out.extend(['\\', letter]),
            control if (control as u32) < 0x20 => out += &format!("\\u{:04x}", control as u32),
            other => out.push(other),
        }
    }
    out.push('"');
    out
}
