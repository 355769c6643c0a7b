//! Questions about maps of a parameter space.

use super::positive;
use crate::fault::{Fault, hint};
use crate::json::At;
use search::refine::{Division, Found, Refinement, RefinementPlan, Rule};
use search::{Axis, Domain, SearchError};
use serde_json::{Value as Json, json};

/// A region of the unit box by name, and in how many dimensions it is one.
type Region = (&'static str, Option<usize>, fn(&[f64]) -> bool);

/// Whether a point is in a ball.
fn in_ball(x: &[f64], centre: &[f64], radius: f64) -> bool {
    x.iter().zip(centre).map(|(x, c)| (x - c) * (x - c)).sum::<f64>() <= radius * radius
}

const REGIONS: [Region; 6] = [
    ("rect", Some(2), |x| (0.3..=0.7).contains(&x[0]) && (0.2..=0.6).contains(&x[1])),
    ("disc", Some(2), |x| in_ball(x, &[0.5, 0.5], 0.31)),
    ("two", Some(2), |x| in_ball(x, &[0.22, 0.3], 0.13) || in_ball(x, &[0.77, 0.71], 0.17)),
    ("thin", Some(2), |x| (x[0] - x[1]).abs() <= 0.04),
    ("empty", None, |_| false),
    ("ball3", Some(3), |x| in_ball(x, &[0.5; 3], 0.33)),
];

pub(super) fn orthtree(input: &At<'_>) -> Result<Json, Fault> {
    let name = input.need("region")?;
    let text = name.text()?;
    let Some((_, dimensions, valid)) = REGIONS.iter().find(|(known, ..)| *known == text) else {
        let names = REGIONS.map(|(name, ..)| name);
        return name.fault(format_args!(
            "expected one of {}, found \"{text}\"{}",
            names.join(", "),
            hint(text, &names)
        ));
    };
    let dims = input.need("dims")?;
    let count = positive(&dims)? as usize;
    if dimensions.is_some_and(|dimensions| dimensions != count) {
        return dims.fault(format_args!("`{text}` is no region of {count} dimensions"));
    }
    let rule = input.need("rule")?;
    let rule = match rule.text()? {
        "success" => Rule::Success,
        "boundary" => Rule::Boundary,
        other => {
            let hint = hint(other, &["success", "boundary"]);
            return rule.fault(format_args!("expected success or boundary, found \"{other}\"{hint}"));
        }
    };
    let whole = |at: &At<'_>| Ok(u32::try_from(at.whole()?).unwrap_or(u32::MAX));
    let base = input.need("base")?.list()?.iter().map(whole).collect::<Result<Vec<u32>, Fault>>()?;
    let map = mapped(base, count, whole(&input.need("iterations")?)?, rule, valid);
    let map = map.or_else(|error| input.fault(error))?;
    let (valid, all) = map.region().valid_volume();
    Ok(json!({
        "evaluations": map.evaluations().iter().sum::<usize>(),
        "per_generation": map.evaluations(),
        "leaves": map.leaves().len(),
        "valid_leaves": map.leaves().iter().filter(|leaf| leaf.found.valid).count(),
        "valid_volume": [valid as u64, all as u64],
        "components": map.region().components().len(),
    }))
}

/// The map of a region of the unit box.
fn mapped(
    base: Vec<u32>,
    dimensions: usize,
    iterations: u32,
    rule: Rule,
    valid: &fn(&[f64]) -> bool,
) -> Result<Refinement, SearchError> {
    let domain = Domain::new(vec![Axis::new(0.0, 1.0); dimensions])?;
    // a question is to be small
    let budget = Some(4_000_000);
    let plan = RefinementPlan { domain, base, rule, division: Division::Orthtree, iterations, budget };
    let mut map = Refinement::new(plan)?;
    while !map.cells().is_empty() {
        let found = map.cells().iter().map(|cell| valid(&map.centre(cell)));
        let found: Vec<Found> = found.map(|valid| Found { valid, rate: f64::from(u8::from(valid)) }).collect();
        map.tell(&found)?;
    }
    Ok(map)
}
