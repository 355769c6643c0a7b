//! JSON read with the place of every value known, so that errors can name it.

use crate::fault::{Fault, hint, wrong};
use serde_json::{Map, Value};
use std::io::Read;

/// Reads a file and parses it.
///
/// # Errors
/// A file that cannot be read, is empty, or is not JSON (with line and column).
pub fn read(path: &str) -> Result<Value, Fault> {
    let text = if path == "-" {
        let mut text = String::new();
        std::io::stdin()
            .read_to_string(&mut text)
            .map_err(|error| Fault::Input(format!("cannot read standard input: {error}")))?;
        text
    } else {
        match std::fs::read(path) {
            Ok(bytes) => String::from_utf8(bytes)
                .map_err(|error| Fault::Input(format!("{path}: not text in UTF-8: {}", error.utf8_error())))?,
            Err(error) => return wrong(format!("cannot read `{path}`: {error}")),
        }
    };
    if text.trim().is_empty() {
        return wrong(format!("{path}: the file is empty; expected a JSON object"));
    }
    serde_json::from_str(&text).map_err(|error| {
        let full = error.to_string();
        let what = full.split(" at line ").next().unwrap_or(&full);
        Fault::Input(format!("{path}:{}:{}: not JSON: {what}", error.line(), error.column()))
    })
}

/// A value and where it stands, as in `cases[3].params.radius`.
#[derive(Clone, Debug)]
pub struct At<'a> {
    /// The value.
    pub value: &'a Value,
    /// Its place; empty for the whole file.
    pub place: String,
}

impl<'a> At<'a> {
    /// The whole file.
    pub fn root(value: &'a Value) -> Self {
        Self { value, place: String::new() }
    }
    /// An error at this place.
    ///
    /// # Errors
    /// Always.
    pub fn fault<T>(&self, text: impl core::fmt::Display) -> Result<T, Fault> {
        if self.place.is_empty() { wrong(text.to_string()) } else { wrong(format!("{}: {text}", self.place)) }
    }
    fn expected<T>(&self, what: &str) -> Result<T, Fault> {
        self.fault(format_args!("expected {what}, found {}", describe(self.value)))
    }
    /// The place of a key below this one.
    pub fn below(&self, key: &str) -> String {
        if self.place.is_empty() { key.to_owned() } else { format!("{}.{key}", self.place) }
    }
    /// An object.
    ///
    /// # Errors
    /// Any other kind of value.
    pub fn object(&self) -> Result<&'a Map<String, Value>, Fault> {
        match self.value {
            Value::Object(map) => Ok(map),
            _ => self.expected("an object"),
        }
    }
    /// The value of a key, if it is there.
    ///
    /// # Errors
    /// When this is no object.
    pub fn get(&self, key: &str) -> Result<Option<At<'a>>, Fault> {
        Ok(self.object()?.get(key).map(|value| At { value, place: self.below(key) }))
    }
    /// The value of a key that must be there.
    ///
    /// # Errors
    /// When it is not, or this is no object.
    pub fn need(&self, key: &str) -> Result<At<'a>, Fault> {
        match self.get(key)? {
            Some(found) => Ok(found),
            None => self.fault(format_args!("`{key}` is missing")),
        }
    }
    /// All keys with their values.
    ///
    /// # Errors
    /// When this is no object.
    pub fn entries(&self) -> Result<Vec<(&'a str, At<'a>)>, Fault> {
        let entry = |(key, value): (&'a String, &'a Value)| (key.as_str(), At { value, place: self.below(key) });
        Ok(self.object()?.iter().map(entry).collect())
    }
    /// Refuses keys that are not among those known.
    ///
    /// # Errors
    /// The first unknown key, with the nearest known one.
    pub fn only(&self, known: &[&str]) -> Result<(), Fault> {
        for key in self.object()?.keys() {
            if !known.contains(&key.as_str()) {
                return self.fault(format_args!("unknown key `{key}`{}", hint(key, known)));
            }
        }
        Ok(())
    }
    /// A list with places.
    ///
    /// # Errors
    /// Any other kind of value.
    pub fn list(&self) -> Result<Vec<At<'a>>, Fault> {
        match self.value {
            Value::Array(list) => {
                let entry = |(k, value)| At { value, place: format!("{}[{k}]", self.place) };
                Ok(list.iter().enumerate().map(entry).collect())
            }
            _ => self.expected("a list"),
        }
    }
    /// A number.
    ///
    /// # Errors
    /// Any other kind of value.
    pub fn number(&self) -> Result<f64, Fault> {
        match self.value.as_f64() {
            Some(number) if number.is_finite() => Ok(number),
            _ => self.expected("a finite number"),
        }
    }
    /// A whole number of 0 or more.
    ///
    /// # Errors
    /// Any other value.
    pub fn whole(&self) -> Result<u64, Fault> {
        match self.value.as_u64() {
            Some(number) => Ok(number),
            None => self.expected("a whole number of 0 or more"),
        }
    }
    /// A text.
    ///
    /// # Errors
    /// Any other kind of value.
    pub fn text(&self) -> Result<&'a str, Fault> {
        match self.value {
            Value::String(text) => Ok(text),
            _ => self.expected("a text in quotes"),
        }
    }
    /// A list of numbers, of a given length if one is given.
    ///
    /// # Errors
    /// Anything else.
    pub fn numbers(&self, count: Option<usize>) -> Result<Vec<f64>, Fault> {
        let list = self.list()?;
        if let Some(count) = count
            && list.len() != count
        {
            return self.fault(format_args!("expected {count} numbers, found {}", list.len()));
        }
        list.iter().map(At::number).collect()
    }
}

/// What kind of value it is, in words.
pub fn describe(value: &Value) -> String {
    match value {
        Value::Null => "null".into(),
        Value::Bool(truth) => truth.to_string(),
        Value::Number(number) => number.to_string(),
        Value::String(text) if text.chars().count() > 40 => "a long text".into(),
        Value::String(text) => format!("\"{text}\""),
        Value::Array(list) => format!("a list of {}", list.len()),
        Value::Object(_) => "an object".into(),
    }
}
