//! A map: its cells over any two of its axes, and the environment and the group at any point.

use super::{At, Searched, Watched, all_rounded, drawing, rounded};
use crate::design::plan::TRIAL;
use crate::design::report;
use crate::environment::trial;
use crate::live::LiveError;
use crate::map::Plan;
use crate::map::execute::{self, Known};
use crate::map::measures::{CellResult, Found, PanelMap};
use crate::map::plan::{MapAxis, Panel};
use crate::report::{Drawing, Page, Stroke};
use crate::store::StoreError;
use serde_json::{Value as Json, json};
use space::random::child_seed;
use std::path::Path;
use terrain::Construct;

/// A map in its folder.
pub struct Mapped {
    plan: Plan,
    panels: Vec<PanelMap>,
}

/// A point of a panel with the environment there.
struct Spot<'a> {
    panel: &'a Panel,
    point: Vec<f64>,
    construct: Construct,
    /// The seed of the cell in which it lies.
    seed: u64,
    found: CellResult,
}

impl Mapped {
    /// The map in a folder.
    ///
    /// # Errors
    /// A folder that holds none, or one that cannot be read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let plan = execute::of_folder(path)?;
        let panels = Known::of(path)?.panels(&plan)?;
        Ok(Self { plan, panels })
    }
    /// The environment at a point. It is drawn with the seed of the cell in which the point lies, so that at the centre of a cell it
    /// is the one that was tried.
    fn spot(&self, at: &At) -> Result<Spot<'_>, LiveError> {
        let number = at.below("panel", self.panels.len())?;
        let (panel, map) = (&self.plan.panels[number], &self.panels[number].map);
        let coordinate = |(k, axis): (usize, &MapAxis)| {
            let value = at.number(&format!("x{k}"));
            value.filter(|value| (axis.axis.low..=axis.axis.high).contains(value)).ok_or_else(|| {
                LiveError::Request(format!("`{}` goes from {} to {}", axis.name, axis.axis.low, axis.axis.high))
            })
        };
        let point: Vec<f64> = self.plan.axes.iter().enumerate().map(coordinate).collect::<Result<_, _>>()?;
        let holds = |leaf: &&search::refine::Leaf| {
            let (low, high) = map.bounds(&leaf.cell);
            point.iter().enumerate().all(|(a, &value)| low[a] <= value && value <= high[a])
        };
        let leaf = map.leaves().iter().find(holds);
        let leaf = leaf.ok_or_else(|| LiveError::Request("nothing was tried there".into()))?;
        let seed = self.plan.seed_of(&leaf.cell);
        let found = self.panels[number].result(leaf);
        let construct = self
            .plan
            .construct(panel, &point, seed, at.perhaps("construct").unwrap_or(0) as u64)
            .map_err(|error| LiveError::Request(format!("there is no environment there: {error}")))?;
        Ok(Spot { panel, point, construct, seed, found })
    }
}

impl Searched for Mapped {
    fn overview(&self) -> Json {
        let plan = &self.plan;
        let axis = |axis: &MapAxis| {
            let unit = match (axis.unit.as_str(), plan.workspace.workspace.units) {
                ("length", terrain::Units::Metres) => "m",
                ("length", terrain::Units::Field) => "unit",
                (unit, _) => unit,
            };
            json!({ "name": axis.name, "unit": unit, "low": axis.axis.low, "high": axis.axis.high })
        };
        let panel = |(own, panel): (&Panel, &PanelMap)| {
            // lower corner, upper corner, share of successes, whether it is valid
            let cell = |(leaf, result): (&search::refine::Leaf, CellResult)| {
                let (low, high) = panel.map.bounds(&leaf.cell);
                let rest = [result.rate(), f64::from(u8::from(leaf.found.valid))];
                all_rounded(low.into_iter().chain(high).chain(rest))
            };
            json!({
                "name": own.population.name,
                "about": own.population.about,
                "control": [panel.control.successes, panel.control.trials],
                "cells": panel.leaves().map(cell).collect::<Vec<_>>(),
            })
        };
        json!({
            "kind": "map",
            "title": plan.form.title,
            "about": plan.form.about,
            "schema": plan.schema.card().id,
            "unit": if plan.workspace.workspace.units == terrain::Units::Metres { "m" } else { "unit" },
            "axes": plan.axes.iter().map(axis).collect::<Vec<_>>(),
            "panels": plan.panels.iter().zip(&self.panels).map(panel).collect::<Vec<_>>(),
        })
    }
    /// The environment at a point, with what was found in its cell.
    fn part(&self, at: &At) -> Result<Json, LiveError> {
        let spot = self.spot(at)?;
        let mut picture = Drawing::default();
        report::put(&mut picture, &self.plan.workspace.workspace.geometry, Stroke::There);
        report::put(&mut picture, spot.construct.geometry(), Stroke::Built);
        picture.marks = spot.construct.markers.iter().map(|marker| marker.pose.at.0).collect();
        Ok(json!({
            "drawing": drawing(&picture),
            "successes": spot.found.successes,
            "trials": spot.found.trials,
            "fitness": rounded(spot.found.fitness),
        }))
    }
    fn watched(&self, at: &At) -> Result<Watched, LiveError> {
        let spot = self.spot(at)?;
        let plan = &self.plan;
        let population = &spot.panel.population;
        let number = at.perhaps("trial").unwrap_or(1).max(1);
        let values = plan.axes.iter().zip(&spot.point);
        let values: Vec<String> =
            values.map(|(axis, value)| format!("{} = {}", axis.name, crate::report::short(*value))).collect();
        let title = format!("{}: {}, {}", plan.form.title, population.name, values.join(", "));
        let geometry = plan.workspace.workspace.geometry.iter().chain(spot.construct.geometry());
        let attempt = at.perhaps("construct").unwrap_or(0) as u64;
        let seed = child_seed(spot.seed, TRIAL, attempt * execute::TRIALS_OF_ONE + number as u64, 0) >> 1;
        let text = trial::file(population, geometry, Vec::new(), seed, &title);
        Ok(Watched::Scenario { name: format!("{}.toml", population.name), text, seed: None })
    }
    fn page(&self, program: &str) -> Page {
        let panels = self.panels.clone();
        crate::map::report::page(&Found { plan: &self.plan, panels }, program)
    }
    fn telling(&self) -> Vec<At> {
        // of each panel the middle of the cell that did best; of equals the largest
        let best = |(number, panel): (usize, &PanelMap)| {
            let size = |leaf: &search::refine::Leaf| {
                let (low, high) = panel.map.bounds(&leaf.cell);
                low.iter().zip(&high).map(|(low, high)| high - low).product::<f64>()
            };
            let better = |(leaf, found): &(&search::refine::Leaf, CellResult)| (found.rate(), size(leaf));
            let (leaf, _) = panel
                .leaves()
                .filter(|(_, found)| found.trials > 0)
                .reduce(|best, other| if better(&other) > better(&best) { other } else { best })?;
            let (low, high) = panel.map.bounds(&leaf.cell);
            let names: Vec<String> = (0..low.len()).map(|axis| format!("x{axis}")).collect();
            let middle =
                names.iter().zip(low.iter().zip(&high)).map(|(name, (low, high))| (name.as_str(), (low + high) / 2.0));
            Some(At::new(&[("panel", number as f64), ("trial", 1.0)].into_iter().chain(middle).collect::<Vec<_>>()))
        };
        self.panels.iter().enumerate().filter_map(best).collect()
    }
    fn words(&self) -> Vec<String> {
        let axes = (0..self.plan.axes.len()).map(|axis| format!("x{axis}"));
        ["panel", "trial", "construct"].map(str::to_owned).into_iter().chain(axes).collect()
    }
}
