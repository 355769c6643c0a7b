//! Questions about what schemas and grammars build.

use super::walls::coordinates;
use super::{count, mismatch, point, positive, refused};
use crate::fault::Fault;
use crate::json::At;
use serde_json::{Value as Json, json};
use terrain::grammars::splitting;
use terrain::schema::grid_points;
use terrain::schemas::{anchored, sirt as steps};

pub(super) fn splitting_pass(input: &At<'_>) -> Result<Json, Fault> {
    let at = input.need("weights")?;
    let weights = at.numbers(Some(3))?;
    Ok(json!(refused(&at, splitting::pass_probability([weights[0], weights[1], weights[2]]))?))
}

pub(super) fn dirt(input: &At<'_>) -> Result<Json, Fault> {
    let anchor = point(&input.need("anchor")?)?;
    let (angle, length) = (input.need("angle_deg")?.number()?, super::not_negative(&input.need("length")?)?);
    Ok(json!(anchored(anchor, angle, length).numbers()))
}

pub(super) fn sirt(input: &At<'_>) -> Result<Json, Fault> {
    let anchor = point(&input.need("anchor")?)?;
    let (x, y) = (input.need("x_res")?.number()?, input.need("y_res")?.number()?);
    let at = input.need("rules")?;
    let rules: Vec<u64> = at.list()?.iter().map(At::whole).collect::<Result<_, _>>()?;
    let k = positive(&input.need("k")?)?;
    if rules.len() as u64 != k - 1 {
        return mismatch(format_args!("k = {k} asks for {} rules, found {}", k - 1, rules.len()));
    }
    Ok(json!(coordinates(&refused(&at, steps::points(anchor, x, y, &rules))?)))
}

pub(super) fn grid_count(input: &At<'_>) -> Result<Json, Fault> {
    let mut all = 0.0;
    for kind in input.need("types")?.list()? {
        let mut values = 1.0;
        for attribute in kind.list()? {
            let numbers = attribute.numbers(Some(3))?;
            values *= refused(&attribute, grid_points(numbers[0], numbers[1], numbers[2]))?;
        }
        all += values;
    }
    let walls = input.need("walls")?.whole()?;
    // exact in whole numbers as far as they reach
    let exact = u32::try_from(walls).ok().and_then(|walls| (all as u64).checked_pow(walls));
    let power = || space::Real::powf(all, walls as f64);
    let tuples = exact.map_or_else(power, |exact| exact as f64);
    if !tuples.is_finite() {
        return mismatch(format_args!("there are too many tuples to be counted"));
    }
    Ok(exact.filter(|_| all < 9e15).map_or_else(|| count(tuples), |exact| json!(exact)))
}
