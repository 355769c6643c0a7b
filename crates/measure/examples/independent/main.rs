//! Answers questions that `tests/independent` asks, to be compared with NumPy, SciPy, statsmodels and scikit-learn.
//!
//! Reads a JSON list of `{"call": NAME, "with": {...}}` from standard input, and writes the list of answers: a JSON value
//! each, or `{"refused": TEXT}`. A new question is a line in the list of [`statistics`] or [`metrics`].

mod asked;
mod metrics;
mod statistics;

use asked::{Answer, Asked};
use serde_json::{Value, json};
use std::io::{Error, Read, Write};

/// A question that can be asked.
type Question = (&'static str, fn(Asked<'_>) -> Answer);

fn main() -> std::io::Result<()> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    let questions: Vec<Value> = serde_json::from_str(&text).map_err(Error::other)?;
    let answers: Vec<Value> =
        questions.iter().map(|question| answer(question).unwrap_or_else(|error| json!({ "refused": error }))).collect();
    writeln!(std::io::stdout(), "{}", Value::from(answers))
}

fn answer(question: &Value) -> Answer {
    let asked = Asked(question);
    let call = asked.text("call")?;
    let known = statistics::QUESTIONS.iter().chain(metrics::QUESTIONS).find(|(name, _)| *name == call);
    let (_, function) = known.ok_or_else(|| format!("there is no question `{call}`"))?;
    function(asked.part("with")?)
}
