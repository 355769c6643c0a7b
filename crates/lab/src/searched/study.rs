//! A study: its cells with the trials of each, and any trial computed again.

use super::{At, Searched, Watched, rounded};
use crate::file::write::toml;
use crate::file::{Node, Tree};
use crate::live::LiveError;
use crate::report::Page;
use crate::store::StoreError;
use crate::study::execute::{self, Results};
use crate::study::tables::of_cell;
use crate::study::{Plan, report};
use serde_json::{Value as Json, json};
use std::path::Path;

/// A study in its folder.
pub struct Studied {
    plan: Plan,
    results: Results,
}

impl Studied {
    /// The study in a folder.
    ///
    /// # Errors
    /// A folder that holds none, or one that cannot be read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let (plan, results) = execute::look(path)?;
        Ok(Self { plan, results })
    }
}

/// A trial of a cell (by index) as a scenario file: name and text.
///
/// # Errors
/// None for a plan that was read.
pub fn trial(plan: &Plan, cell: usize, trial: usize) -> Result<(String, String), String> {
    let own = plan.cells.get(cell).ok_or_else(|| format!("there is no cell {}", cell + 1))?;
    let mut tree = plan.conditions[own.condition].tree.clone();
    let title = format!("{}: {}, trial {trial}", plan.title, plan.name_of(own));
    let values = [("title", Tree::Text(title)), ("seed", Tree::Whole(plan.seed_of(trial) as i64))];
    for (key, value) in values {
        let node = Node { tree: value, span: tree.span.clone() };
        tree.set(key, node)?;
    }
    let stem = plan.sources.stem(0).unwrap_or("study");
    Ok((format!("{stem}-cell-{}-trial-{trial}.toml", cell + 1), toml(&tree)))
}

impl Searched for Studied {
    fn overview(&self) -> Json {
        let plan = &self.plan;
        let part = |part: &crate::study::plan::Part| {
            let factors = part.factors.iter().map(|factor| {
                let levels: Vec<&str> = factor.levels.iter().map(|level| level.text.as_str()).collect();
                json!({
                    "name": factor.name, "about": factor.about, "unit": unit(plan, &factor.unit),
                    "levels": levels, "numeric": factor.numeric(),
                })
            });
            json!({
                "name": part.name, "title": part.title, "factors": factors.collect::<Vec<_>>(),
                "cells": [part.cells.start, part.cells.end],
            })
        };
        let readings = plan
            .readings
            .iter()
            .map(|(name, reading)| json!({ "name": name, "about": reading.about, "unit": unit(plan, &reading.unit) }));
        json!({
            "kind": "study",
            "title": plan.title,
            "about": plan.about,
            "seed": plan.seed,
            "parts": plan.parts.iter().map(part).collect::<Vec<_>>(),
            "levels": plan.cells.iter().map(|cell| &cell.levels).collect::<Vec<_>>(),
            "readings": readings.collect::<Vec<_>>(),
            "trials": self.results.iter().map(|trials| trials.len()).sum::<usize>(),
        })
    }
    /// A reading in all trials of all cells: numbers of trials where they are not 1, 2, 3, ..., and values.
    fn part(&self, at: &At) -> Result<Json, LiveError> {
        let reading = at.below("reading", self.plan.readings.len())?;
        let cell = |cell: usize| {
            let (mut numbers, mut values) = (Vec::new(), Vec::new());
            for (trial, read) in of_cell(&self.plan, &self.results, cell) {
                numbers.push(trial);
                values.push(rounded(read.get(reading).copied().unwrap_or(f64::NAN)));
            }
            let gaps = numbers.iter().enumerate().any(|(k, &number)| number != k + 1);
            json!({ "trials": gaps.then_some(numbers), "values": values })
        };
        Ok(json!({ "cells": (0..self.plan.cells.len()).map(cell).collect::<Vec<_>>() }))
    }
    fn watched(&self, at: &At) -> Result<Watched, LiveError> {
        let cell = at.below("cell", self.plan.cells.len())?;
        let number = at.whole("trial")?;
        if number == 0 {
            return Err(LiveError::Request("trials count from 1".into()));
        }
        let (name, text) = trial(&self.plan, cell, number).map_err(LiveError::Request)?;
        Ok(Watched::Scenario { name, text, seed: None })
    }
    fn page(&self, program: &str) -> Page {
        let judgements = report::judgements(&self.plan, &self.results);
        report::page(&self.plan, &self.results, &judgements, program)
    }
    fn telling(&self) -> Vec<At> {
        // the first cell, the one in the middle and the last, each in its first trial
        let last = self.plan.cells.len().saturating_sub(1);
        let mut chosen = vec![0, last / 2, last];
        chosen.dedup();
        let first = |&cell: &usize| {
            let trial = of_cell(&self.plan, &self.results, cell).map(|(trial, _)| trial).next()?;
            Some(At::new(&[("cell", cell as f64), ("trial", trial as f64)]))
        };
        chosen.iter().filter_map(first).collect()
    }
    fn words(&self) -> Vec<String> {
        ["cell", "trial"].map(str::to_owned).to_vec()
    }
}

fn unit(plan: &Plan, unit: &str) -> String {
    unit.replace("length", &plan.units.0).replace("time", &plan.units.1)
}
