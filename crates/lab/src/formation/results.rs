//! What came of tasks and methods, and the names by which statements ask for it.

use super::plan::Plan;
use super::task::Wall;
use super::trial::Tried;
use crate::environment::claims::{Data, hint, known};
use crate::study::expression::{Mistake, Selector, Value};
use core::ops::Range;
use std::collections::BTreeMap;

/// The results of a formation file.
pub struct Results<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// The walls of each task.
    pub walls: Vec<Vec<Wall>>,
    /// The trials by places of task and method, in order.
    pub trials: BTreeMap<(usize, usize), Vec<Tried>>,
}

/// What statements can ask for, with what it is.
pub const NAMES: [(&str, &str); 9] = [
    ("fitness", "mean share of targets that passed all gates in order and reached the goal"),
    ("fitnesses", "that share in each trial, a list"),
    ("success", "share of trials in which all targets did"),
    ("time", "mean time at which the last target arrived, where all did"),
    ("path_length", "mean way of all shepherds together"),
    ("dispersion", "mean distance of targets from their middle, over time"),
    ("held", "share of the time in which all targets were inside the hull of the shepherds"),
    ("robots", "number of shepherds"),
    ("walls", "number of walls of the task"),
];

impl<'a> Results<'a> {
    /// Results of made-up trials, to find out whether statements have a meaning.
    pub(super) fn example(plan: &'a Plan) -> Self {
        let tried = Tried {
            steps: 1,
            fitness: 1.0,
            time: 1.0,
            path_length: 1.0,
            dispersion: 1.0,
            held: 1.0,
            robots: 1.0,
            bumps: 0.0,
        };
        let cells = plan.methods.iter().enumerate();
        let cells = cells.flat_map(|(method, own)| own.tasks.iter().map(move |&task| ((task, method), vec![tried])));
        Self { plan, walls: vec![Vec::new(); plan.tasks.len()], trials: cells.collect() }
    }
    /// The trials of a task with a method.
    pub fn of(&self, task: usize, method: usize) -> &[Tried] {
        self.trials.get(&(task, method)).map_or(&[], Vec::as_slice)
    }
    /// Targets that did the task, of all in all possible trials.
    pub fn targets(&self, task: usize, method: usize) -> (u64, u64) {
        let members = self.plan.methods[method].population.members() as u64;
        let possible = self.of(task, method).iter().filter(|tried| tried.fitness.is_finite());
        possible
            .fold((0, 0), |(done, all), tried| (done + (tried.fitness * members as f64).round() as u64, all + members))
    }
    /// The mean of what is read of trials, where it is a number; not a number where it never is.
    pub fn mean(&self, task: usize, method: usize, of: fn(&Tried) -> f64) -> f64 {
        mean(self.of(task, method).iter().map(of))
    }
}

/// The mean of what is a number; not a number where nothing is.
pub(super) fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let numbers: Vec<f64> = numbers.filter(|number| number.is_finite()).collect();
    measure::statistics::mean(&numbers).unwrap_or(f64::NAN)
}

/// What is read of a trial by a name; none for what is not of trials.
pub(crate) fn reading(name: &str) -> Option<fn(&Tried) -> f64> {
    Some(match name {
        "fitness" | "fitnesses" => |tried| tried.fitness,
        "success" => {
            |tried| if tried.fitness.is_finite() { f64::from(u8::from(tried.fitness >= 1.0)) } else { f64::NAN }
        }
        "time" => |tried| tried.time,
        "path_length" => |tried| tried.path_length,
        "dispersion" => |tried| tried.dispersion,
        "held" => |tried| tried.held,
        "robots" => |tried| tried.robots,
        _ => return None,
    })
}

impl Data for Results<'_> {
    /// Trials are drawn again: with the same seeds in all methods, differences stay paired.
    fn items(&self) -> usize {
        self.trials.values().map(Vec::len).min().unwrap_or(0)
    }
    fn value(
        &self,
        name: &str,
        selectors: &[Selector],
        bytes: &Range<usize>,
        drawn: Option<&[usize]>,
    ) -> Result<Value, Mistake> {
        known(name, &NAMES, bytes, "a formation file")?;
        let tasks: Vec<&str> = self.plan.tasks.iter().map(|task| task.name.as_str()).collect();
        let methods: Vec<&str> = self.plan.methods.iter().map(|method| method.name.as_str()).collect();
        let (mut task, mut method) = (None, None);
        for selector in selectors {
            let (list, place) = match selector.factor.as_str() {
                "task" => (&tasks, &mut task),
                "method" => (&methods, &mut method),
                other => {
                    let help = hint(other, &["task", "method"]);
                    return Err(Mistake { help, ..Mistake::new(selector.bytes.clone(), format!("unknown `{other}`")) });
                }
            };
            let level = match &selector.level {
                Value::Text(level) => level.clone(),
                // a name may be a number
                Value::Number(number) => number.to_string(),
                _ => return Err(Mistake::new(selector.bytes.clone(), "a name is needed here")),
            };
            *place = Some(list.iter().position(|known| *known == level).ok_or_else(|| {
                let what = format!("there is no {} `{level}`", selector.factor);
                Mistake { help: hint(&level, list), ..Mistake::new(selector.bytes.clone(), what) }
            })?);
        }
        if name == "walls" {
            let of = |task: usize| self.walls[task].len() as f64;
            return Ok(Value::Number(task.map_or_else(|| mean((0..tasks.len()).map(of)), of)));
        }
        let method = match method {
            Some(method) => method,
            None if methods.len() == 1 => 0,
            None => {
                let text = format!("there are several, so that `{name}` needs [method = ...]");
                let help = format!("one of {}", methods.join(", "));
                return Err(Mistake { help, ..Mistake::new(bytes.clone(), text) });
            }
        };
        let Some(of) = reading(name) else { return Ok(Value::Number(f64::NAN)) };
        let numbers = |task: usize| -> Vec<f64> {
            let trials = self.of(task, method);
            match drawn {
                Some(drawn) => drawn.iter().filter_map(|&k| trials.get(k)).map(of).collect(),
                None => trials.iter().map(of).collect(),
            }
        };
        // without a task: each has the same weight
        let wanted: Vec<usize> = task.map_or_else(|| self.plan.methods[method].tasks.clone(), |task| vec![task]);
        if name == "fitnesses" {
            let all = wanted.into_iter().flat_map(numbers).filter(|number| number.is_finite());
            return Ok(Value::List(all.map(Value::Number).collect()));
        }
        Ok(Value::Number(mean(wanted.into_iter().map(|task| mean(numbers(task).into_iter())))))
    }
}
