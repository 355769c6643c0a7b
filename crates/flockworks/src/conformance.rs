//! `flockworks conformance`: every case of a file, one step each, beside the state it expects; or new cases.

use crate::case::{Case, names, split};
use crate::emit::emit;
use crate::fault::{Fault, hint, wrong};
use crate::json::{At, describe, read};
use crate::step::{Precision, after};
use crate::table::Table;
use clap::Args;
use serde_json::Value as Json;
use std::io::Write;

/// What 32-bit reals are compared at, at least.
const TOLERANCE_F32: f64 = 1e-4;

/// Options of `conformance`.
#[derive(Args, Debug)]
pub struct ConformanceOptions {
    /// A file with a list `cases`, or a single case (`-` reads standard input).
    #[arg(required_unless_present = "emit")]
    pub file: Option<String>,
    /// Print new cases of this model, in every dimension it works in, with the states that this program expects.
    #[arg(long, value_name = "MODEL", conflicts_with_all = ["file", "only", "precision"])]
    pub emit: Option<String>,
    /// Seed of the states of new cases.
    #[arg(long, default_value_t = 1, requires = "emit")]
    pub seed: u64,
    /// Only the cases of this model.
    #[arg(long, value_name = "MODEL")]
    pub only: Option<String>,
    /// Precision of reals; with f32 the tolerance is at least 1e-4.
    #[arg(long, value_enum, default_value = "f64")]
    pub precision: Precision,
}

/// What came of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Values compared.
    pub compared: usize,
    /// Largest difference between two reals.
    pub largest: f64,
    /// The first value that is not as expected.
    pub mismatch: Option<String>,
}

impl Comparison {
    /// Compares what was found with what is expected: reals at a tolerance (absolute and relative), everything else exactly.
    pub fn values(&mut self, place: &str, expected: &Json, found: &Json, tolerance: f64) {
        let close = match (expected, found) {
            (Json::Array(expected), Json::Array(found)) => {
                if expected.len() != found.len() {
                    self.note(place, format_args!("expected {} entries, found {}", expected.len(), found.len()));
                    return;
                }
                for (k, (expected, found)) in expected.iter().zip(found).enumerate() {
                    self.values(&format!("{place}[{k}]"), expected, found, tolerance);
                }
                return;
            }
            (Json::Number(e), Json::Number(f)) => {
                let whole = e.is_f64() || f.is_f64();
                let (e, f) = (e.as_f64().unwrap_or(f64::NAN), f.as_f64().unwrap_or(f64::NAN));
                let difference = (e - f).abs();
                self.largest = self.largest.max(difference);
                if whole { difference <= tolerance * (1.0 + e.abs()) } else { difference == 0.0 }
            }
            (Json::Bool(truth), Json::Number(number)) => number.as_f64() == Some(f64::from(u8::from(*truth))),
            (expected, found) => expected == found,
        };
        self.compared += 1;
        if !close {
            self.note(place, format_args!("expected {}, found {}", describe(expected), describe(found)));
        }
    }
    fn note(&mut self, place: &str, text: core::fmt::Arguments<'_>) {
        if self.mismatch.is_none() {
            self.mismatch = Some(format!("{place}: {text}"));
        }
    }
}

enum Verdict {
    Compared(Comparison),
    UnknownModel(String),
    Refused(String),
}

/// Runs the cases and prints a table, or prints new cases; the answer is whether all passed.
///
/// # Errors
/// A wrong file, an unknown model, or a reader that went away.
pub fn conformance(options: &ConformanceOptions, out: &mut dyn Write) -> Result<bool, Fault> {
    if let Some(model) = &options.emit {
        emit(model, options.seed, out)?;
        return Ok(true);
    }
    let name = options.file.as_deref().unwrap_or("-");
    let file = read(name)?;
    let cases = split(&file).map_err(|fault| fault.at(name))?;
    let all: Vec<(String, String)> = cases.list.iter().map(names).collect();
    let chosen: Vec<usize> = (0..all.len()).filter(|&k| options.only.as_ref().is_none_or(|m| *m == all[k].0)).collect();
    if let Some(model) = &options.only
        && chosen.is_empty()
    {
        let models: Vec<&str> = all.iter().map(|(model, _)| model.as_str()).collect();
        return wrong(format!("{name}: no case of the model `{model}`{}", hint(model, &models)));
    }
    let tolerance = match options.precision {
        Precision::F64 => cases.tolerance,
        Precision::F32 => cases.tolerance.max(TOLERANCE_F32),
    };
    let mut table = Table::new(&["model", "case", "dim", "compared", "largest", "result", "reason"]);
    table.right(&[2, 3, 4]);
    let mut passed = 0;
    for &k in &chosen {
        let (model, case) = all[k].clone();
        let at = &cases.list[k];
        let dimension = at.value.get("dim").map_or_else(String::new, Json::to_string);
        let mut row = vec![model, case, dimension];
        match judge(at, tolerance, options.precision)? {
            Verdict::Compared(comparison) => {
                let good = comparison.mismatch.is_none();
                passed += usize::from(good);
                row.push(comparison.compared.to_string());
                row.push(format!("{:.1e}", comparison.largest));
                row.push(if good { "pass" } else { "fail" }.into());
                row.push(comparison.mismatch.unwrap_or_default());
            }
            Verdict::UnknownModel(reason) => row.extend(["0".into(), "-".into(), "unknown model".into(), reason]),
            Verdict::Refused(reason) => row.extend(["0".into(), "-".into(), "fail".into(), reason]),
        }
        table.row(row);
    }
    out.write_all(table.text().as_bytes())?;
    writeln!(out, "tolerance {tolerance:e}, absolute and relative; {}", options.precision.word())?;
    writeln!(out, "{passed} of {}", chosen.len())?;
    Ok(passed == chosen.len())
}

fn judge(at: &At<'_>, tolerance: f64, precision: Precision) -> Result<Verdict, Fault> {
    if let Some(id) = at.value.get("model").and_then(Json::as_str)
        && let Err(fault) = crate::case::model(id)
    {
        return Ok(Verdict::UnknownModel(fault.to_string()));
    }
    let state = Case::read(at).and_then(|case| {
        let state = after(&case, 1, precision, 1)?;
        Ok((case, state))
    });
    let (case, state) = match state {
        Ok(done) => done,
        Err(Fault::Input(text)) => return Ok(Verdict::Refused(text)),
        Err(other) => return Err(other),
    };
    let Some(expected) = &case.expected else {
        return Ok(Verdict::Refused(format!("{} is missing", at.below("expected"))));
    };
    let mut comparison = Comparison::default();
    for (key, expected) in expected {
        match state.get(key) {
            Some(found) => comparison.values(key, expected, found, tolerance),
            None => comparison.note(key, format_args!("the model has no such state")),
        }
    }
    if comparison.compared == 0 && comparison.mismatch.is_none() && case.agents() > 0 {
        comparison.note("expected", format_args!("there is nothing to compare"));
    }
    Ok(Verdict::Compared(comparison))
}
