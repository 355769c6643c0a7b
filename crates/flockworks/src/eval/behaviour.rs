//! Questions about what a group did.

use super::{mismatch, not_negative, points, positive, segment, sizes};
use crate::fault::Fault;
use crate::json::At;
use measure::behaviours::{Membership, blocks};
use serde_json::{Value as Json, json};
use space::Vector;

/// Sizes of the groups, the largest first.
fn groups(places: &[Vector<f64, 2>], threshold: f64) -> Vec<usize> {
    let mut sizes = Membership::within(threshold).sizes(places);
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    sizes
}

pub(super) fn group_sizes(input: &At<'_>) -> Result<Json, Fault> {
    Ok(json!(groups(&points(&input.need("points")?)?, not_negative(&input.need("threshold")?)?)))
}

pub(super) fn entropy_ratio(input: &At<'_>) -> Result<Json, Fault> {
    Ok(json!(blocks::entropy_ratio(&sizes(&input.need("sizes")?)?)))
}

pub(super) fn is_balanced(input: &At<'_>) -> Result<Json, Fault> {
    Ok(json!(blocks::is_balanced(&sizes(&input.need("sizes")?)?, input.need("fraction")?.number()?)))
}

pub(super) fn sustained(input: &At<'_>) -> Result<Json, Fault> {
    let mut runs = Vec::new();
    for run in input.need("rle")?.list()? {
        match run.list()?.as_slice() {
            [holds, length] => match holds.value {
                Json::Bool(holds) => runs.push((*holds, length.whole()?)),
                _ => return holds.fault("expected true or false"),
            },
            _ => return run.fault("expected a pair of true or false and a count"),
        }
    }
    Ok(json!(blocks::sustained(&runs, positive(&input.need("k")?)?, input.need("horizon")?.whole()?)))
}

pub(super) fn corral_step(input: &At<'_>) -> Result<Json, Fault> {
    let places = points(&input.need("points")?)?;
    let (radius, threshold) = (not_negative(&input.need("radius")?)?, not_negative(&input.need("threshold")?)?);
    let at = input.need("connected_fraction")?;
    let connected = match at.value {
        Json::Null => None,
        _ => match at.list()?.as_slice() {
            [share, all] => Some((share.whole()?, positive(all)?)),
            _ => return at.fault("expected null or a pair of whole numbers"),
        },
    };
    let near = blocks::centroid(&places).is_some_and(|centre| centre.length() <= radius);
    let sizes = groups(&places, threshold);
    let largest = sizes.first().copied().unwrap_or(0) as u128;
    let together = match connected {
        None => sizes.len() == 1,
        Some((share, all)) => largest * u128::from(all) >= u128::from(share) * places.len() as u128,
    };
    Ok(json!(near && together))
}

pub(super) fn gate_events(input: &At<'_>) -> Result<Json, Fault> {
    let gate = segment(&input.need("gate")?)?;
    let passages = gate.passages(&points(&input.need("path")?)?);
    Ok(passages.into_iter().map(|(step, passage)| json!([step, passage.sign()])).collect())
}

pub(super) fn turn_right(input: &At<'_>) -> Result<Json, Fault> {
    let (agents, crossed) = (input.need("agents")?.whole()?, input.need("crossed_right")?.whole()?);
    if crossed > agents {
        return mismatch(format_args!("{crossed} of {agents} agents cannot have crossed"));
    }
    Ok(json!(blocks::has_share(crossed as usize, agents as usize, input.need("share")?.number()?)))
}

pub(super) fn x_sd(input: &At<'_>) -> Result<Json, Fault> {
    Ok(json!(blocks::sample_deviation(&input.need("x")?.numbers(None)?)))
}

pub(super) fn mean_fitness(input: &At<'_>) -> Result<Json, Fault> {
    let all = positive(&input.need("agents")?)?.saturating_mul(positive(&input.need("trials")?)?);
    let share = |key: &str| -> Result<f64, Fault> {
        let done = input.need(key)?.whole()?;
        if done > all {
            return mismatch(format_args!("{key}: {done} are more than the {all} agents of all trials"));
        }
        Ok(done as f64 / all as f64)
    };
    Ok(json!([share("agents_done_static")?, share("agents_done_dynamic")?]))
}
