//! `flockworks step`: the state of a case after some steps.

use crate::case::{Case, Cases, names, split};
use crate::fault::{Fault, hint, wrong};
use crate::json::{At, read};
use clap::{Args, ValueEnum};
use serde_json::{Map, Value as Json};
use std::io::Write;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;

/// Number of bits of a real.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Precision {
    /// 32 bits.
    F32,
    /// 64 bits.
    F64,
}

impl Precision {
    /// Its name on the command line and in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

/// Options of `step`.
#[derive(Args, Debug)]
pub struct StepOptions {
    /// A case, or a file with a list `cases` (`-` reads standard input).
    pub file: String,
    /// Number of steps to make.
    #[arg(long, default_value_t = 1)]
    pub steps: u64,
    /// Which case of the file: MODEL/CASE, MODEL, or its index from 0; the first one if not given.
    #[arg(long, value_name = "NAME")]
    pub case: Option<String>,
    /// Precision of reals.
    #[arg(long, value_enum, default_value = "f64")]
    pub precision: Precision,
    /// Number of threads; the result does not depend on it.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
}

/// Prints the state of a case after some steps.
///
/// # Errors
/// A wrong file, a wrong case, or a reader that went away.
pub fn step(options: &StepOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let file = read(&options.file)?;
    let state = split(&file).and_then(|cases| {
        let at = choose(&cases, options.case.as_deref())?;
        after(&Case::read(at)?, options.steps, options.precision, usize::from(options.threads))
    });
    print(&state.map_err(|fault| fault.at(&options.file))?, out)
}

fn choose<'a, 'b>(cases: &'b Cases<'a>, name: Option<&str>) -> Result<&'b At<'a>, Fault> {
    // a file has at least one
    let name = name.unwrap_or("0");
    if let Ok(index) = name.parse::<usize>() {
        let last = cases.list.len();
        return cases
            .list
            .get(index)
            .map_or_else(|| wrong(format!("there is no case {index}; the file has {last}, counted from 0")), Ok);
    }
    let full: Vec<(String, String)> = cases.list.iter().map(|at| slashed(at)).collect();
    match full.iter().position(|(model, full)| full == name || model == name) {
        Some(k) => Ok(&cases.list[k]),
        None => {
            let known: Vec<&str> = full.iter().map(|(_, full)| full.as_str()).collect();
            wrong(format!("there is no case `{name}`{}", hint(name, &known)))
        }
    }
}

fn slashed(at: &At<'_>) -> (String, String) {
    let (model, case) = names(at);
    let full = format!("{model}/{case}");
    (model, full)
}

/// The state of a case after some steps.
///
/// # Errors
/// Whatever in the case cannot be.
pub fn after(case: &Case, steps: u64, precision: Precision, threads: usize) -> Result<Map<String, Json>, Fault> {
    fn run<R: Scalar, const D: usize>(case: &Case, steps: u64, threads: usize) -> Result<Map<String, Json>, Fault>
    where
        Models: Catalogue<R, D>,
    {
        let mut world = case.world::<R, D>(threads)?;
        world.run(steps);
        Ok(case.state(&world))
    }
    match (precision, case.dimension) {
        (Precision::F64, 1) => run::<f64, 1>(case, steps, threads),
        (Precision::F64, 2) => run::<f64, 2>(case, steps, threads),
        (Precision::F64, _) => run::<f64, 3>(case, steps, threads),
        (Precision::F32, 1) => run::<f32, 1>(case, steps, threads),
        (Precision::F32, 2) => run::<f32, 2>(case, steps, threads),
        (Precision::F32, _) => run::<f32, 3>(case, steps, threads),
    }
}

/// A value as JSON; numbers that are not whole have 17 significant digits, so that every one reads back exactly.
fn written(value: &Json) -> String {
    match value {
        Json::Array(list) => format!("[{}]", list.iter().map(written).collect::<Vec<_>>().join(",")),
        Json::Number(number) if number.is_f64() => match number.as_f64() {
            Some(number) => format!("{number:.16e}"),
            None => number.to_string(),
        },
        other => other.to_string(),
    }
}

/// Prints a state as JSON, a line for each agent.
fn print(state: &Map<String, Json>, out: &mut dyn Write) -> Result<(), Fault> {
    let mut text = String::from("{");
    for (k, (key, values)) in state.iter().enumerate() {
        text += if k == 0 { "\n" } else { ",\n" };
        text += &format!("  {}: ", Json::from(key.as_str()));
        match values.as_array() {
            Some(list) if list.first().is_some_and(Json::is_array) => {
                let lines: Vec<String> = list.iter().map(|entry| format!("    {}", written(entry))).collect();
                text += &format!("[\n{}\n  ]", lines.join(",\n"));
            }
            _ => text += &written(values),
        }
    }
    text += "\n}\n";
    out.write_all(text.as_bytes())?;
    Ok(())
}
