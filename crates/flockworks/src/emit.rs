//! `flockworks conformance --emit MODEL`: new cases of a model, with the states that this program expects.

use crate::case::{Case, model};
use crate::fault::Fault;
use crate::json::At;
use crate::models::{json_of, pretty};
use crate::step::{Precision, after};
use serde_json::{Map, Value as Json, json};
use space::random::{Purpose, uniform, unit_vector};
use std::io::Write;
use swarm::models::{Catalogue, Entry, Models, Prepared};
use swarm::parameters::Values;

/// Members of a case.
const MEMBERS: usize = 8;

/// The cases of each dimension: their name, whether the box is sized by the farthest set or by the nearest, and whether two members
/// coincide and one of them rests.
const CASES: [(&str, bool, bool); 3] = [("far", true, false), ("near", false, false), ("edge", false, true)];

/// Writes new cases of a model in every dimension it works in. Random quantities take their neutral values.
///
/// # Errors
/// An unknown model, a model whose defaults cannot be run, or a reader that went away.
pub fn emit(id: &str, seed: u64, out: &mut dyn Write) -> Result<(), Fault> {
    let entry = model(id)?;
    let mut cases = Vec::new();
    for &dimension in entry.dimensions {
        for (k, (name, far, edge)) in CASES.into_iter().enumerate() {
            let side = side(entry, dimension, far);
            let start = start(entry, dimension, seed.wrapping_add(k as u64), side, edge);
            cases.push(case(entry, &format!("{name}-{dimension}d"), dimension, start)?);
        }
    }
    let note = "params are the full set; aux are supplied random quantities (none: all take their neutral values); \
                expected is the state after one synchronous update";
    out.write_all(pretty(&json!({ "tolerance": 1e-9, "note": note, "cases": cases })).as_bytes())?;
    Ok(())
}

/// A model with its defaults; `None` where they do not go with so many members.
fn prepared<const D: usize>(entry: &Entry) -> Option<Prepared<f64, D>>
where
    Models: Catalogue<f64, D>,
{
    Models::prepare(entry.card.id, &Values::new(), MEMBERS)?.ok()
}

/// Distances at which the model's sets end, and the speed at which its members begin.
fn scales(entry: &Entry, dimension: usize) -> (Vec<f64>, f64) {
    fn of<const D: usize>(prepared: Option<Prepared<f64, D>>) -> (Vec<f64>, f64) {
        prepared.map_or((Vec::new(), 1.0), |prepared| {
            (prepared.set_ends(), prepared.initial_speeds().first().copied().unwrap_or(1.0))
        })
    }
    match dimension {
        1 => of(prepared::<1>(entry)),
        2 => of(prepared::<2>(entry)),
        _ => of(prepared::<3>(entry)),
    }
}

/// Side of the box in which members are put: about the size of the farthest or of the nearest set.
fn side(entry: &Entry, dimension: usize, far: bool) -> f64 {
    let ends: Vec<f64> = scales(entry, dimension).0.into_iter().filter(|end| *end > 1e-6 && *end < 1e3).collect();
    let end = if far { ends.iter().copied().reduce(f64::max) } else { ends.iter().copied().reduce(f64::min) };
    end.map_or(if far { 12.0 } else { 3.0 }, |end| if far { 1.25 * end } else { 2.0 * end })
}

/// To so many decimals, so that a case is easy to read and to copy.
fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    (value * scale).round() / scale
}

/// Positions and velocities, drawn; in an edge case the second member stands where the first is, and the third rests.
fn start(entry: &Entry, dimension: usize, seed: u64, side: f64, edge: bool) -> Map<String, Json> {
    let speed = scales(entry, dimension).1;
    let draw = |member: usize, slot: u32| uniform(seed, Purpose::Init, member as u64, slot);
    let mut position: Vec<Vec<f64>> =
        (0..MEMBERS).map(|i| (0..dimension as u32).map(|axis| rounded(side * draw(i, axis), 3)).collect()).collect();
    let direction = |i: usize| -> Vec<f64> {
        match dimension {
            1 => unit_vector::<f64, 1>(draw(i, 4), 0.0).0.to_vec(),
            2 => unit_vector::<f64, 2>(draw(i, 4), 0.0).0.to_vec(),
            _ => unit_vector::<f64, 3>(draw(i, 4), draw(i, 5)).0.to_vec(),
        }
    };
    let mut velocity: Vec<Vec<f64>> =
        (0..MEMBERS).map(|i| direction(i).into_iter().map(|part| rounded(speed * part, 6)).collect()).collect();
    if edge {
        position[1] = position[0].clone();
        velocity[2] = vec![0.0; dimension];
    } else if dimension == 1 {
        // laws of a line may know their members by their order
        position.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    Map::from_iter([("pos".to_owned(), json!(position)), ("vel".to_owned(), json!(velocity))])
}

/// A case with the state after one step.
fn case(entry: &Entry, name: &str, dimension: usize, start: Map<String, Json>) -> Result<Json, Fault> {
    let parameters: Map<String, Json> =
        (entry.parameters)().iter().map(|p| (p.alias.unwrap_or(p.name).to_owned(), json_of(&p.default))).collect();
    let mut case = json!({
        "model": entry.card.id, "case": name, "dim": dimension, "space": { "kind": "unbounded" },
        "params": parameters, "aux": {}, "state": start,
    });
    // what the model completes of a state belongs to it
    let complete = after(&Case::read(&At::root(&case))?, 0, Precision::F64, 1)?;
    case["state"] = Json::Object(complete);
    case["expected"] = Json::Object(after(&Case::read(&At::root(&case))?, 1, Precision::F64, 1)?);
    Ok(case)
}
