//! An optimisation: scores over evaluations, archives of kinds, and any candidate with the group about it.

use super::{At, Searched, Watched, all_rounded, drawing, rounded};
use crate::environment::trial;
use crate::live::LiveError;
use crate::optimisation::execute::{self, Looked};
use crate::optimisation::form::Search;
use crate::optimisation::plan::KINDS;
use crate::optimisation::report;
use crate::optimisation::results::{Results, Run};
use crate::optimisation::searcher::Searcher;
use crate::optimisation::trials::{Found, Purpose, seed_of};
use crate::report::Page;
use crate::store::StoreError;
use serde_json::{Value as Json, json};
use std::path::Path;
use terrain::Construct;

/// Scores of a run that the page is told; of more evaluations, only some are.
const TOLD: usize = 2000;
/// Places along each axis at which an archive is asked for its cell.
const PLACES: usize = 48;

/// An optimisation in its folder.
pub struct Optimised(Looked);

/// A candidate with what it is called.
struct Candidate {
    name: String,
    construct: Construct,
    /// Its values by axis, where it is a point of the box.
    point: Vec<f64>,
    found: Option<Found>,
    score: f64,
    /// What its first trial is for, with the number of that.
    trial: (Purpose, u64),
}

impl Optimised {
    /// The optimisation in a folder.
    ///
    /// # Errors
    /// A folder that holds none, or one that cannot be read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        execute::look(path).map(Self)
    }
    /// The candidate at a place: an evaluation or an elite of a run, its best where neither is named, or the one made lighter.
    fn candidate(&self, at: &At) -> Result<Candidate, LiveError> {
        let Looked { plan, runs, lighter, .. } = &self.0;
        if at.perhaps("lighter").is_some() {
            let lighter = lighter.as_ref().ok_or_else(|| LiveError::Request("nothing was made lighter".into()))?;
            let (construct, found) = &lighter.after;
            return Ok(Candidate {
                name: "made lighter".into(),
                construct: construct.clone(),
                point: Vec::new(),
                found: Some(*found),
                score: found.score,
                trial: (Purpose::Lighten, 0),
            });
        }
        let method = at.below("method", runs.len())?;
        let number = at.below("run", runs[method].len())?;
        let run = &runs[method][number];
        let called = format!("{}, run {}", plan.methods()[method], number + 1);
        let (name, point, found, score, trial) = if at.perhaps("elite").is_some() {
            let elite = &run.elites[at.below("elite", run.elites.len())?];
            (
                format!("{called}, kind {}", elite.cell),
                &elite.point,
                None,
                elite.score,
                (Purpose::Report, number as u64),
            )
        } else if at.perhaps("evaluation").is_some() {
            let place = at.below("evaluation", run.evaluations.len())?;
            let (point, found) = &run.evaluations[place];
            let trial = (Purpose::Search, run.generation(place) as u64);
            (format!("{called}, evaluation {place}"), point, Some(*found), found.score, trial)
        } else {
            let none = || LiveError::Request(format!("{called} has no best yet"));
            let (place, found) = run.best.ok_or_else(none)?;
            let name = format!("{called}, the best");
            (name, &run.evaluations[place].0, Some(found), found.score, (Purpose::Report, number as u64))
        };
        let construct = plan.construct(point);
        let construct =
            construct.map_err(|error| LiveError::Request(format!("there is no construct there: {error}")))?;
        Ok(Candidate { name, construct, point: point.clone(), found, score, trial })
    }
    fn told(&self, one: &Candidate) -> Json {
        let plan = &self.0.plan;
        let found = one.found.map(|found| {
            json!({ "successes": found.successes, "trials": found.trials, "fitness": rounded(found.fitness), "steps": rounded(found.steps) })
        });
        json!({
            "name": one.name,
            "drawing": drawing(&report::drawing(plan, &one.construct, String::new())),
            "point": all_rounded(one.point.iter().copied()),
            "found": found,
            "score": rounded(one.score),
            "material": rounded(one.construct.material()),
        })
    }
    /// The cells of the archive of a run over its first two kinds, row by row from the least values.
    fn cells(&self, method: usize, run: usize) -> Result<Json, LiveError> {
        let plan = &self.0.plan;
        let Search::MapElites(archive) = &plan.form.method.0[method].1 else { return Ok(Json::Null) };
        let kinds = &archive.kind.0;
        if kinds.len() > 2 {
            return Ok(Json::Null);
        }
        let searcher = Searcher::new(plan, method, run).map_err(|error| LiveError::Request(error.to_string()))?;
        let place = |axis: usize, k: usize| {
            let ends = &kinds[axis].1;
            ends.low + (ends.high - ends.low) * (k as f64 + 0.5) / PLACES as f64
        };
        let rows = if kinds.len() == 2 { PLACES } else { 1 };
        let cell = |(row, column): (usize, usize)| {
            let kind: Vec<f64> =
                (0..kinds.len()).map(|axis| place(axis, if axis == 0 { column } else { row })).collect();
            searcher.cell_of(&kind)
        };
        let all = (0..rows).flat_map(|row| (0..PLACES).map(move |column| (row, column)));
        Ok(json!({ "columns": PLACES, "rows": rows, "cells": all.map(cell).collect::<Vec<_>>() }))
    }
}

impl Searched for Optimised {
    fn overview(&self) -> Json {
        let Looked { plan, runs, control, lighter } = &self.0;
        let axis = |axis: &crate::optimisation::plan::SearchAxis| {
            let unit = axis.unit.replace("length", &plan.population.scenario.units.length);
            json!({ "name": axis.name, "unit": unit, "low": axis.axis.low, "high": axis.axis.high })
        };
        let method = |(name, search): &(String, Search)| {
            let Search::MapElites(archive) = search else { return json!({ "name": name }) };
            let kinds = archive.kind.0.iter().map(|(kind, ends)| {
                let known = KINDS.iter().find(|(known, _)| known == kind).map(|(_, unit)| (*unit).to_owned());
                let of_axis = || plan.axes.iter().find(|axis| axis.name == *kind).map(|axis| axis.unit.clone());
                let unit = known.or_else(of_axis).unwrap_or_default();
                let unit = unit.replace("length", &plan.population.scenario.units.length);
                json!({ "name": kind, "unit": unit, "low": ends.low, "high": ends.high })
            });
            json!({ "name": name, "kinds": kinds.collect::<Vec<_>>(), "cells": archive.cells })
        };
        let run = |run: &Run| {
            let every = run.evaluations.len().div_ceil(TOLD).max(1);
            // of those between, the best one is told
            let scores = run.evaluations.chunks(every).map(|some| {
                let there = some.iter().filter(|(_, found)| found.trials > 0).map(|(_, found)| found.score);
                rounded(there.fold(f64::NAN, f64::max))
            });
            let elites = run.elites.iter().map(|elite| {
                json!({ "cell": elite.cell, "kind": all_rounded(elite.descriptors.iter().copied()), "score": rounded(elite.score) })
            });
            let best = run.best.map(|(place, found)| {
                json!({ "evaluation": place, "successes": found.successes, "trials": found.trials, "score": rounded(found.score), "material": rounded(found.material) })
            });
            json!({
                "every": every, "evaluations": run.evaluations.len(), "scores": scores.collect::<Vec<_>>(),
                "best": best, "elites": elites.collect::<Vec<_>>(),
            })
        };
        json!({
            "kind": "optimisation",
            "title": plan.form.title,
            "about": plan.form.about,
            "schema": plan.schema.card().id,
            "unit": if plan.workspace.workspace.units == terrain::Units::Metres { "m" } else { "unit" },
            "evaluations": plan.evaluations,
            "axes": plan.axes.iter().map(axis).collect::<Vec<_>>(),
            "methods": plan.form.method.0.iter().map(method).collect::<Vec<_>>(),
            "runs": runs.iter().map(|runs| runs.iter().map(run).collect::<Vec<_>>()).collect::<Vec<_>>(),
            "control": control.map(|found| [found.successes, found.trials]),
            "lighter": lighter.as_ref().map(|lighter| json!({
                "before": rounded(lighter.before.1.material), "after": rounded(lighter.after.1.material), "tried": lighter.tried,
            })),
        })
    }
    /// A candidate with its drawing; or, with `cells`, the cells of the archive of a run.
    fn part(&self, at: &At) -> Result<Json, LiveError> {
        if at.perhaps("cells").is_some() {
            let method = at.below("method", self.0.runs.len())?;
            return self.cells(method, at.below("run", self.0.runs[method].len())?);
        }
        self.candidate(at).map(|one| self.told(&one))
    }
    fn watched(&self, at: &At) -> Result<Watched, LiveError> {
        let plan = &self.0.plan;
        let one = self.candidate(at)?;
        let number = at.perhaps("trial").unwrap_or(1).max(1);
        let seed = seed_of(plan, one.trial.0, one.trial.1, number - 1);
        let geometry = plan.workspace.workspace.geometry.iter().chain(one.construct.geometry());
        let title = format!("{}: {}, trial {number}", plan.form.title, one.name);
        let text = trial::file(&plan.population, geometry, Vec::new(), seed, &title);
        let name = format!("{}.toml", one.name.replace([',', ' '], "-").replace("--", "-"));
        Ok(Watched::Scenario { name, text, seed: None })
    }
    fn page(&self, program: &str) -> Page {
        let Looked { plan, runs, control, lighter } = &self.0;
        report::page(&Results { plan, runs: runs.clone(), control: *control, lighter: lighter.clone() }, program)
    }
    fn telling(&self) -> Vec<At> {
        let Looked { runs, lighter, .. } = &self.0;
        let best = |(method, runs): (usize, &Vec<Run>)| {
            let scored = runs.iter().enumerate().filter_map(|(run, own)| Some((run, own.best?.1.score)));
            let (run, score) = scored.reduce(|best, other| if other.1 > best.1 { other } else { best })?;
            Some((score, At::new(&[("method", method as f64), ("run", run as f64), ("trial", 1.0)])))
        };
        let mut found: Vec<(f64, At)> = runs.iter().enumerate().filter_map(best).collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut places: Vec<At> = found.into_iter().map(|(_, at)| at).collect();
        places.truncate(2);
        places.extend(lighter.as_ref().map(|_| At::new(&[("lighter", 1.0), ("trial", 1.0)])));
        places
    }
    fn words(&self) -> Vec<String> {
        ["method", "run", "elite", "evaluation", "lighter", "trial"].map(str::to_owned).to_vec()
    }
}
