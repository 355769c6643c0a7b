//! Variants of an evolution: what of its file is varied, every level with every other.

use super::form::{Evolution, Vary};
use super::plan::Plan;
use crate::file::{Desk, Node, Tree};
use crate::study::plan::{Level, Varied, entry_place};
use serde_json::Value as Json;

/// An evolution with its variants: one where nothing is varied.
#[derive(Clone, Debug)]
pub struct Variants {
    /// The evolution of each, all with the same runs and genes.
    pub plans: Vec<Plan>,
    /// What is varied.
    pub factors: Vec<Varied>,
    /// Level of each factor, `[variants][factors]`.
    pub levels: Vec<Vec<usize>>,
}

impl Variants {
    /// The first, which says what is the same for all.
    pub fn first(&self) -> &Plan {
        &self.plans[0]
    }
    /// Runs of a variant.
    pub fn runs(&self) -> usize {
        self.first().form.runs
    }
    /// The variant to which a run belongs, and its place there from 0. Runs count through the variants.
    pub fn of_run(&self, run: usize) -> (usize, usize) {
        (run / self.runs(), run % self.runs())
    }
    /// Generations of all runs together.
    pub fn generations(&self) -> usize {
        self.plans.iter().map(|plan| plan.generations * self.runs()).sum()
    }
    /// A variant in words; empty where there is only one.
    pub fn name(&self, variant: usize) -> String {
        let of = |(factor, &level): (&Varied, &usize)| {
            let text = &factor.levels[level].text;
            if factor.numeric() { format!("{} = {text}", factor.name) } else { text.clone() }
        };
        self.factors.iter().zip(&self.levels[variant]).map(of).collect::<Vec<_>>().join(", ")
    }
    /// What the results depend on, apart from runs and generations, which may be added.
    pub fn identity(&self) -> Json {
        match self.factors.as_slice() {
            [] => self.first().identity(),
            _ => Json::Object(self.plans.iter().enumerate().map(|(k, plan)| (self.name(k), plan.identity())).collect()),
        }
    }
}

/// What is varied in a file, and the file of each variant.
pub(super) fn of(form: &Evolution, file: &Node, desk: &mut Desk) -> Option<(Vec<Varied>, Vec<(Vec<usize>, Node)>)> {
    let mut factors = Vec::new();
    let mut files = vec![(Vec::new(), file.clone())];
    for (name, vary) in &form.vary.0 {
        let place = entry_place(file, "vary", name);
        let levels = levels(vary);
        let complaint = match (&vary.path, vary.values.is_empty(), vary.level.0.is_empty()) {
            (Some(_), false, true) | (None, true, false) => None,
            (None, false, _) => Some("the values have no path"),
            (Some(_), true, _) => Some("the path has no values"),
            (_, _, false) => Some("it has both values and levels"),
            (None, true, true) => Some("it has no levels"),
        };
        if let Some(what) = complaint {
            let expected = "`path` and `values`, or [vary.NAME.level.LEVEL] tables";
            desk.problem(&place, format!("`{name}`: {what}"), expected, "");
            return None;
        }
        let mut next = Vec::with_capacity(files.len() * levels.len());
        for (before, file) in &files {
            for (k, (_, patch)) in levels.iter().enumerate() {
                let mut file = file.clone();
                for (path, node) in patch {
                    if let Some(key) = ["kind", "runs", "quick_runs", "vary", "seed"]
                        .iter()
                        .find(|key| path.split('.').next() == Some(**key))
                    {
                        desk.problem(&node.span, format!("`{key}` is the same for all variants"), "another path", "");
                        return None;
                    }
                    if let Err(what) = file.set(path, node.clone()) {
                        desk.problem(&node.span, format!("`{path}`: {what}"), "names no place in this file", "");
                        return None;
                    }
                }
                next.push(([before.as_slice(), &[k]].concat(), file));
            }
        }
        files = next;
        let about = if vary.about.is_empty() { name } else { &vary.about };
        let levels = levels.into_iter().map(|(level, _)| level).collect();
        factors.push(Varied { name: name.clone(), about: about.clone(), unit: vary.unit.clone(), levels });
    }
    Some((factors, files))
}

/// The levels of what is varied, with the values that each puts into the file.
fn levels(vary: &Vary) -> Vec<(Level, Vec<(String, Node)>)> {
    let path = vary.path.clone().unwrap_or_default();
    let of_value = |node: &Node| {
        let text = match &node.tree {
            Tree::Text(text) => text.clone(),
            tree => tree.json().to_string(),
        };
        (Level { text, number: node.tree.number() }, vec![(path.clone(), node.clone())])
    };
    let of_level = |(name, patch): &(String, crate::file::Anything)| {
        let entries = match &patch.0.tree {
            Tree::Table(entries) => entries.iter().map(|entry| (entry.key.clone(), entry.node.clone())).collect(),
            _ => Vec::new(),
        };
        (Level { text: name.clone(), number: name.parse().ok() }, entries)
    };
    vary.values.iter().map(|value| of_value(&value.0)).chain(vary.level.0.iter().map(of_level)).collect()
}
