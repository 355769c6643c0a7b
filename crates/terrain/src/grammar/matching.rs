//! Finding the left side of a rule among the instances.

use super::{Grammar, Instance, Pattern, Rule};
use crate::TerrainError;
use crate::expression::Names;
use crate::geometry::Point;
use space::{Real, Vector};

/// Positions (length) and angles (degrees) that agree this well are the same.
const TOLERANCE: f64 = 1e-6;

/// A left side found: the instances of its patterns, in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Match {
    /// Index of each instance in the list of all.
    pub(super) instances: Vec<usize>,
    /// Whether the arrangement was found mirrored.
    pub(super) mirrored: bool,
}

/// What expressions see: the drawn variables, the matched instance, and how many shapes there are.
pub(super) struct Seen<'a> {
    pub(super) grammar: &'a Grammar,
    pub(super) variables: &'a [(String, f64)],
    pub(super) left: Option<&'a Instance>,
    pub(super) instances: &'a [Instance],
}

impl Names for Seen<'_> {
    fn value(&self, name: &str) -> Option<f64> {
        if let Some((_, value)) = self.variables.iter().rev().find(|(known, _)| known == name) {
            return Some(*value);
        }
        let left = self.left?;
        match name.strip_prefix("left.").unwrap_or(name) {
            "length" => Some(left.length),
            "scale" => Some(left.scale),
            "level" => Some(f64::from(left.level)),
            attribute => left.attributes.iter().find(|(known, _)| known == attribute).map(|&(_, value)| value),
        }
    }
    fn count(&self, shape: &str) -> Option<usize> {
        let shape = self.grammar.shape(shape).ok()?;
        Some(self.instances.iter().filter(|instance| instance.shape == shape && instance.ends.is_none()).count())
    }
}

/// Every match of a rule whose first pattern is the instance `first`.
pub(super) fn matches(
    grammar: &Grammar,
    rule: &Rule,
    first: usize,
    seen: &Seen<'_>,
) -> Result<Vec<Match>, TerrainError> {
    let instances = seen.instances;
    let Some(pattern) = rule.left.first() else { return Ok(Vec::new()) };
    if !agrees(grammar, pattern, &instances[first]) {
        return Ok(Vec::new());
    }
    let seen = Seen { left: Some(&instances[first]), ..*seen };
    for condition in &rule.when {
        if !condition.holds(&seen)? {
            return Ok(Vec::new());
        }
    }
    let mut found = Vec::new();
    for mirrored in [false, true] {
        if mirrored && !rule.mirror {
            break;
        }
        let mut chosen = vec![first];
        extend(grammar, rule, instances, mirrored, None, &mut chosen, &mut found);
    }
    // a symmetric arrangement is found twice
    found.dedup_by(|a, b| a.instances == b.instances);
    Ok(found)
}

/// Whether an instance is there and has the shape and label that a pattern asks for.
fn agrees(grammar: &Grammar, pattern: &Pattern, instance: &Instance) -> bool {
    instance.ends.is_none()
        && grammar.shapes.get(instance.shape).is_some_and(|shape| shape.name == pattern.shape)
        && pattern.label.as_ref().is_none_or(|label| *label == instance.label)
}

/// Adds an instance for the next pattern to those chosen, in every way there is, in the order of creation.
fn extend(
    grammar: &Grammar,
    rule: &Rule,
    instances: &[Instance],
    mirrored: bool,
    scale: Option<f64>,
    chosen: &mut Vec<usize>,
    found: &mut Vec<Match>,
) {
    let Some(pattern) = rule.left.get(chosen.len()) else {
        found.push(Match { instances: chosen.clone(), mirrored });
        return;
    };
    for k in 0..instances.len() {
        let other = &instances[k];
        if chosen.contains(&k) || !agrees(grammar, pattern, other) {
            continue;
        }
        let first = &instances[chosen[0]];
        let Some(scale) = fits(rule, pattern, first, other, mirrored, scale) else { continue };
        chosen.push(k);
        extend(grammar, rule, instances, mirrored, Some(scale), chosen, found);
        chosen.pop();
    }
}

/// The scale at which an instance stands where a pattern wants it, relative to the first; `None` where it does not.
fn fits(
    rule: &Rule,
    pattern: &Pattern,
    first: &Instance,
    other: &Instance,
    mirrored: bool,
    scale: Option<f64>,
) -> Option<f64> {
    let hand = if mirrored { -1.0 } else { 1.0 };
    let wanted: Point = Vector([pattern.at[0], hand * pattern.at[1]]);
    let there = first.pose.inverse().place(other.pose.at);
    let scale = match scale {
        Some(known) => known,
        // the first pattern away from the origin tells the scale
        None if rule.scale_free && wanted.length() > TOLERANCE => there.length() / wanted.length(),
        None => 1.0,
    };
    let turn = (other.pose.heading - first.pose.heading - hand * pattern.turn).radians().wrapped();
    let near = (there - wanted * scale).length() <= TOLERANCE && turn.abs() <= TOLERANCE.radians();
    near.then_some(scale)
}
