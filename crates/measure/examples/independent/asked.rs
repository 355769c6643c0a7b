//! What a question holds, read with a word about what is missing.

use serde_json::Value;

/// An answer, or why there is none.
pub(crate) type Answer = Result<Value, String>;

/// The part of a question that is asked about.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a>(pub(crate) &'a Value);

impl<'a> Asked<'a> {
    /// A value by its name, where there is one.
    pub(crate) fn maybe(self, name: &str) -> Option<&'a Value> {
        self.0.get(name).filter(|value| !value.is_null())
    }
    /// A part by its name.
    pub(crate) fn part(self, name: &str) -> Result<Self, String> {
        self.maybe(name).map(Self).ok_or_else(|| format!("`{name}` is missing"))
    }
    fn read<T>(self, name: &str, what: &str, of: impl Fn(&'a Value) -> Option<T>) -> Result<T, String> {
        of(self.part(name)?.0).ok_or_else(|| format!("`{name}` is not {what}"))
    }
    pub(crate) fn text(self, name: &str) -> Result<&'a str, String> {
        self.read(name, "a text", Value::as_str)
    }
    pub(crate) fn number(self, name: &str) -> Result<f64, String> {
        self.read(name, "a number", Value::as_f64)
    }
    pub(crate) fn count(self, name: &str) -> Result<u64, String> {
        self.read(name, "a count", Value::as_u64)
    }
    pub(crate) fn truth(self, name: &str) -> Result<bool, String> {
        self.read(name, "true or false", Value::as_bool)
    }
    pub(crate) fn numbers(self, name: &str) -> Result<Vec<f64>, String> {
        self.read(name, "a list of numbers", numbers)
    }
    pub(crate) fn lists(self, name: &str) -> Result<Vec<Vec<f64>>, String> {
        self.read(name, "a list of lists of numbers", |value| value.as_array()?.iter().map(numbers).collect())
    }
    pub(crate) fn counts(self, name: &str) -> Result<Vec<Vec<usize>>, String> {
        let lists = self.lists(name)?;
        Ok(lists.iter().map(|list| list.iter().map(|&count| count as usize).collect()).collect())
    }
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(Value::as_f64).collect()
}
