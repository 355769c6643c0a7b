//! A formation file: its tasks with every method, and any trial played again, with robots and walls.

use super::{At, Searched, Watched, drawing, rounded};
use crate::formation::execute::{self, Trials};
use crate::formation::results::{NAMES, Results, reading};
use crate::formation::task::Wall;
use crate::formation::trial::Tried;
use crate::formation::{Plan, course, report};
use crate::live::{Course, LiveError};
use crate::report::{Page, Stroke};
use crate::store::StoreError;
use serde_json::{Value as Json, json};
use std::path::Path;

/// What is told of each trial, by the names of statements; the share of targets comes first.
const READ: [(&str, &str); 6] = [
    ("fitness", "1"),
    ("time", "time"),
    ("path_length", "length"),
    ("dispersion", "length"),
    ("held", "1"),
    ("robots", "1"),
];
/// Frames of a trial that is played.
const FRAMES: u64 = 2000;

/// A formation file in its folder.
pub struct Formed {
    plan: Plan,
    walls: Vec<Vec<Wall>>,
    trials: Trials,
}

impl Formed {
    /// The formation file in a folder.
    ///
    /// # Errors
    /// A folder that holds none, or one that cannot be read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let (plan, walls, trials) = execute::look(path)?;
        Ok(Self { plan, walls, trials })
    }
    /// Places of a task and a method that tries it.
    fn place(&self, at: &At) -> Result<(usize, usize), LiveError> {
        let task = at.below("task", self.plan.tasks.len())?;
        let method = at.below("method", self.plan.methods.len())?;
        if !self.plan.methods[method].tasks.contains(&task) {
            let (task, method) = (&self.plan.tasks[task].name, &self.plan.methods[method].name);
            return Err(LiveError::Request(format!("`{method}` does not try task `{task}`")));
        }
        Ok((task, method))
    }
}

impl Searched for Formed {
    fn overview(&self) -> Json {
        let plan = &self.plan;
        let units = &plan.targets.scenario.units;
        let unit = |unit: &str| match unit {
            "length" => units.length.clone(),
            "time" => units.time.clone(),
            other => other.to_owned(),
        };
        let readings = READ.iter().map(|&(name, of)| {
            let about = NAMES.iter().find(|(known, _)| *known == name).map_or("", |(_, about)| about);
            json!({ "name": name, "about": about, "unit": unit(of) })
        });
        let task = |task: usize| {
            let mut picture = report::of_task(plan, task, String::new());
            let walls = self.walls[task].iter();
            picture.strokes.extend(walls.map(|wall| (Stroke::Built, vec![wall.at.from.0, wall.at.to.0])));
            json!({ "name": plan.tasks[task].name, "drawing": drawing(&picture), "walls": self.walls[task].len(), "timed": plan.tasks[task].timed })
        };
        let methods = plan
            .methods
            .iter()
            .map(|method| json!({ "name": method.name, "about": method.form.about, "tasks": method.tasks }));
        let cells = self.trials.iter().map(|(&(task, method), trials)| {
            let values = |(number, tried): &(usize, Tried)| {
                let read = READ.iter().map(|(name, _)| reading(name).map_or(Json::Null, |of| rounded(of(tried))));
                json!({ "trial": number, "values": read.collect::<Vec<_>>() })
            };
            json!({ "task": task, "method": method, "trials": trials.iter().map(values).collect::<Vec<_>>() })
        });
        json!({
            "kind": "formation",
            "title": plan.form.title,
            "about": plan.form.about,
            "targets": plan.targets.members(),
            "trials": plan.trials,
            "readings": readings.collect::<Vec<_>>(),
            "tasks": (0..plan.tasks.len()).map(task).collect::<Vec<_>>(),
            "methods": methods.collect::<Vec<_>>(),
            "cells": cells.collect::<Vec<_>>(),
        })
    }
    fn part(&self, _: &At) -> Result<Json, LiveError> {
        Err(LiveError::Request("the overview of a formation file tells all of it".into()))
    }
    fn watched(&self, at: &At) -> Result<Watched, LiveError> {
        let plan = &self.plan;
        let (task, method) = self.place(at)?;
        let number = at.perhaps("trial").unwrap_or(1).max(1);
        if plan.searched(task) && self.walls[task].is_empty() && plan.methods[method].form.by.needs_walls() {
            let what = format!("walls for task `{}` were not searched yet", plan.tasks[task].name);
            return Err(LiveError::Request(what));
        }
        let every = plan.methods[method].population.steps.div_ceil(FRAMES).max(1);
        let replay =
            course::replay(plan, &self.walls[task], (task, method, number), every).map_err(LiveError::Request)?;
        let own = &plan.methods[method];
        Ok(Watched::Course(Box::new(Course {
            title: format!("{}: task {}, {}, trial {number}", plan.form.title, plan.tasks[task].name, own.name),
            about: course::about(own),
            source: plan.sources.text(0).to_owned(),
            seed: Some(plan.seed_of(task, number)),
            guides: report::lines_of(&plan.tasks[task]),
            replay,
        })))
    }
    fn page(&self, program: &str) -> Page {
        let numbers = |trials: &Vec<(usize, Tried)>| trials.iter().map(|(_, tried)| *tried).collect();
        let trials = self.trials.iter().map(|(&at, trials)| (at, numbers(trials))).collect();
        report::page(&Results { plan: &self.plan, walls: self.walls.clone(), trials }, program)
    }
    fn telling(&self) -> Vec<At> {
        let place = |(task, method): (usize, usize)| {
            At::new(&[("task", task as f64), ("method", method as f64), ("trial", 1.0)])
        };
        let shown: Vec<(usize, usize)> =
            self.plan.show.iter().copied().filter(|at| self.trials.contains_key(at)).collect();
        // where the file names none, the first task with each method
        let first = || self.trials.keys().copied().filter(|&(task, _)| task == 0).collect();
        let chosen: Vec<(usize, usize)> = if shown.is_empty() { first() } else { shown };
        chosen.into_iter().map(place).collect()
    }
    fn words(&self) -> Vec<String> {
        ["task", "method", "trial"].map(str::to_owned).to_vec()
    }
}
