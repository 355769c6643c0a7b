//! Questions about walls, and about robots in their place.

use super::{point, points, positive, refused, segment, segments};
use crate::fault::{Fault, hint};
use crate::json::At;
use serde_json::{Value as Json, json};
use space::Vector;
use terrain::filters::{Filter, Material, Splitting};
use terrain::posts::{Spacing, assign_to_posts, assignment};
use terrain::{Construct, Corral, Units, workspaces};

pub(super) fn segment_class(input: &At<'_>) -> Result<Json, Fault> {
    let (a, b) = (segment(&input.need("a")?)?, segment(&input.need("b")?)?);
    Ok(json!(a.relation(&b).word()))
}

pub(super) fn point_segment_distance(input: &At<'_>) -> Result<Json, Fault> {
    Ok(json!(segment(&input.need("s")?)?.distance(point(&input.need("p")?)?)))
}

pub(super) fn corral_filter(input: &At<'_>) -> Result<Json, Fault> {
    let corral = Corral::of(&segments(&input.need("walls")?)?, point(&input.need("marker")?)?);
    Ok(json!({ "in_hull": corral.in_hull, "escapes": corral.escapes, "pass": corral.pass() }))
}

pub(super) fn splitting_filter(input: &At<'_>) -> Result<Json, Fault> {
    Ok(json!(input.need("terminals")?.whole()? as f64 >= Splitting::default().least))
}

pub(super) fn material_filter(input: &At<'_>) -> Result<Json, Fault> {
    let construct = Construct::of_walls(Units::Field, segments(&input.need("walls")?)?);
    let filter = Material { limit: input.need("limit")?.number()? };
    Ok(json!(filter.check(&construct, &workspaces::empty(Units::Field)).pass))
}

pub(super) fn assignment_cost(input: &At<'_>) -> Result<Json, Fault> {
    let at = input.need("cost")?;
    let rows = at.list()?;
    let cost: Vec<Vec<f64>> = rows.iter().map(|row| row.numbers(None)).collect::<Result<_, _>>()?;
    let columns = cost.first().map_or(0, Vec::len);
    if let Some(k) = cost.iter().position(|row| row.len() != columns) {
        return rows[k].fault(format_args!("expected {columns} numbers as in the first row, found {}", cost[k].len()));
    }
    if cost.len() > columns {
        return at.fault(format_args!("expected no more rows than columns, found {} and {columns}", cost.len()));
    }
    let (least, _) = refused(&at, assignment(&cost))?;
    // whole costs have a whole sum
    let whole = rows.iter().all(|row| row.value.as_array().is_some_and(|row| row.iter().all(|c| !c.is_f64())));
    Ok(if whole && least.abs() < 9e15 { json!(least as i64) } else { json!(least) })
}

pub(super) fn assignment_cost_posts(input: &At<'_>) -> Result<Json, Fault> {
    let robots = points(&input.need("robots")?)?;
    let (per_wall, spacing) = spacing(input)?;
    let walls = segments(&input.need("walls")?)?;
    let places: Vec<_> = walls.iter().flat_map(|wall| terrain::posts::posts(wall, per_wall, spacing)).collect();
    let (distance, _) = refused(input, assign_to_posts(&robots, &places))?;
    Ok(json!(distance))
}

pub(super) fn posts(input: &At<'_>) -> Result<Json, Fault> {
    let (per_wall, spacing) = spacing(input)?;
    let places = terrain::posts::posts(&segment(&input.need("wall")?)?, per_wall, spacing);
    Ok(json!(coordinates(&places)))
}

/// How many posts stand for a wall, and where.
fn spacing(input: &At<'_>) -> Result<(usize, Spacing), Fault> {
    let per_wall = input.need("per_wall")?;
    let count = positive(&per_wall)?;
    if count > 1_000_000 {
        return per_wall.fault(format_args!("expected at most 1000000, found {count}"));
    }
    let mode = input.need("mode")?;
    let spacing = match mode.text()? {
        "cells" => Spacing::Cells,
        "ends" => Spacing::Ends,
        other => {
            return mode
                .fault(format_args!("expected cells or ends, found \"{other}\"{}", hint(other, &["cells", "ends"])));
        }
    };
    Ok((count as usize, spacing))
}

/// Points as lists of two numbers.
pub(super) fn coordinates(points: &[Vector<f64, 2>]) -> Vec<[f64; 2]> {
    points.iter().map(|p| p.0).collect()
}
