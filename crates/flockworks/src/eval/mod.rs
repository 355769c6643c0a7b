//! `flockworks eval`: small exact questions about environments and behaviours, answered one by one.

mod behaviour;
mod construct;
mod map;
mod statistics;
mod walls;

use crate::fault::{Fault, hint, wrong};
use crate::json::{At, read};
use clap::Args;
use serde_json::{Map, Value as Json, json};
use std::io::Write;

/// Options of `eval`.
#[derive(Args, Debug)]
pub struct EvalOptions {
    /// A file `{ "cases": [ { "id", "kind", "input" } ] }` (`-` reads standard input).
    pub file: String,
}

/// A kind of question.
struct Kind {
    /// Its name.
    name: &'static str,
    /// The keys of its input, all of which must be there.
    keys: &'static [&'static str],
    answer: fn(&At<'_>) -> Result<Json, Fault>,
}

macro_rules! kinds {
    ($($file:ident::$name:ident($($key:literal),*);)*) => {
        /// All kinds.
        const KINDS: &[Kind] =
            &[$(Kind { name: stringify!($name), keys: &[$($key),*], answer: $file::$name }),*];
    };
}

kinds! {
    walls::segment_class("a", "b");
    walls::point_segment_distance("p", "s");
    walls::corral_filter("walls", "marker");
    walls::splitting_filter("terminals");
    walls::material_filter("walls", "limit");
    behaviour::group_sizes("points", "threshold");
    behaviour::entropy_ratio("sizes");
    behaviour::is_balanced("sizes", "fraction");
    behaviour::sustained("rle", "k", "horizon");
    behaviour::corral_step("points", "radius", "threshold", "connected_fraction");
    behaviour::gate_events("path", "gate");
    behaviour::turn_right("agents", "crossed_right", "share");
    behaviour::x_sd("x");
    behaviour::mean_fitness("agents", "trials", "agents_done_static", "agents_done_dynamic");
    walls::assignment_cost("cost");
    walls::assignment_cost_posts("robots", "walls", "per_wall", "mode");
    walls::posts("wall", "per_wall", "mode");
    map::orthtree("region", "base", "iterations", "rule", "dims");
    statistics::wilson95("s", "n");
    statistics::sprt("seq", "p0", "p1", "alpha", "beta", "cap");
    construct::splitting_pass("weights");
    construct::dirt("anchor", "angle_deg", "length");
    construct::sirt("anchor", "x_res", "y_res", "rules", "k");
    construct::grid_count("types", "walls");
}

/// Answers every case of a file and prints `{ id: value }`. A case that cannot be answered has `{ "error": ... }` for
/// its value, and the command fails with all such errors.
///
/// # Errors
/// A wrong file, cases that cannot be answered, or a reader that went away.
pub fn eval(options: &EvalOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let file = read(&options.file)?;
    let cases = cases(&file).map_err(|fault| fault.at(&options.file))?;
    let mut answers = Map::new();
    let mut faults: Vec<String> = Vec::new();
    for (id, case) in cases {
        let answer = match answer(&case) {
            Err(Fault::Input(text)) => {
                faults.push(format!("flockworks: {}: {id}: {text}", options.file));
                json!({ "error": text })
            }
            other => other?,
        };
        answers.insert(id, answer);
    }
    writeln!(out, "{}", serde_json::to_string_pretty(&answers).unwrap_or_default())?;
    if faults.is_empty() { Ok(()) } else { Err(Fault::Shown(faults.join("\n"))) }
}

/// The cases by their ids.
fn cases(file: &Json) -> Result<Vec<(String, At<'_>)>, Fault> {
    let root = At::root(file);
    root.only(&["version", "note", "cases"])?;
    let mut cases: Vec<(String, At<'_>)> = Vec::new();
    for case in root.need("cases")?.list()? {
        let id = case.need("id")?;
        let text = id.text()?;
        if cases.iter().any(|(known, _)| known == text) {
            return id.fault(format_args!("the id \"{text}\" comes twice"));
        }
        cases.push((text.to_owned(), case));
    }
    Ok(cases)
}

fn answer(case: &At<'_>) -> Result<Json, Fault> {
    // what is expected, and how closely, is for whoever compares
    case.only(&["id", "kind", "input", "expected", "tol", "note"])?;
    let name = case.need("kind")?;
    let text = name.text()?;
    let Some(kind) = KINDS.iter().find(|kind| kind.name == text) else {
        let names: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
        return name.fault(format_args!("unknown kind `{text}`{}", hint(text, &names)));
    };
    let input = case.need("input")?;
    input.only(kind.keys)?;
    for key in kind.keys {
        input.need(key)?;
    }
    (kind.answer)(&input)
}

/// A whole number of at least one.
fn positive(at: &At<'_>) -> Result<u64, Fault> {
    match at.whole()? {
        0 => at.fault("expected a whole number of 1 or more, found 0"),
        number => Ok(number),
    }
}

/// A number of 0 or more.
fn not_negative(at: &At<'_>) -> Result<f64, Fault> {
    let number = at.number()?;
    if number < 0.0 { at.fault(format_args!("expected 0 or more, found {number}")) } else { Ok(number) }
}

/// A point `[x, y]`.
fn point(at: &At<'_>) -> Result<space::Vector<f64, 2>, Fault> {
    let numbers = at.numbers(Some(2))?;
    let farthest = space::exact::FARTHEST;
    if numbers.iter().any(|c| c.abs() > farthest) {
        return at.fault(format_args!("expected coordinates of at most {farthest:e} in size"));
    }
    Ok(space::Vector([numbers[0], numbers[1]]))
}

/// A list of points.
fn points(at: &At<'_>) -> Result<Vec<space::Vector<f64, 2>>, Fault> {
    at.list()?.iter().map(point).collect()
}

/// A list of whole numbers.
fn sizes(at: &At<'_>) -> Result<Vec<usize>, Fault> {
    at.list()?.iter().map(|size| Ok(size.whole()? as usize)).collect()
}

/// A segment `[x0, y0, x1, y1]`.
fn segment(at: &At<'_>) -> Result<space::Segment, Fault> {
    let numbers = at.numbers(Some(4))?;
    let segment = space::Segment::new([numbers[0], numbers[1]], [numbers[2], numbers[3]]);
    if !segment.exact() {
        return at.fault(format_args!("expected coordinates of at most {:e} in size", space::exact::FARTHEST));
    }
    Ok(segment)
}

/// A list of segments.
fn segments(at: &At<'_>) -> Result<Vec<space::Segment>, Fault> {
    at.list()?.iter().map(segment).collect()
}

/// The place of an error of the room below.
fn refused<T>(at: &At<'_>, answer: Result<T, terrain::TerrainError>) -> Result<T, Fault> {
    answer.or_else(|error| at.fault(error))
}

/// A count as a whole number, where it is one that JSON can hold.
fn count(number: f64) -> Json {
    if number < 9_007_199_254_740_992.0 { json!(number as u64) } else { json!(number) }
}

/// A wrong input, with the numbers that do not fit each other.
fn mismatch<T>(text: core::fmt::Arguments<'_>) -> Result<T, Fault> {
    wrong(text.to_string())
}
