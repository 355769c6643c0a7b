//! A trial of a formation file that runs while one watches, and whose robots go on when one says so.

use super::replayed::shape;
use super::{LiveError, Shown, packed};
use crate::explain;
use crate::formation::plan::Plan;
use crate::formation::task::Wall;
use crate::formation::trial::{self, Underway};
use crate::formation::{Watched, course, report};
use crate::scenario::build;
use crate::study::plan::Load;
use serde_json::{Value as Json, json};

/// What is read off a moment: id, title, and the range where there is one.
const READ: [(&str, &str, Option<[f64; 2]>); 2] = [
    ("arrived", "Share of the targets that did the task", Some([0.0, 1.0])),
    ("dispersion", "Mean distance of the targets from their middle", None),
];

/// A trial of a formation file, step by step.
struct Formed {
    name: String,
    text: String,
    plan: Plan,
    /// Which trial it is: places of task and method, and its number from 1.
    at: (usize, usize, usize),
    seed: u64,
    walls: Vec<Wall>,
    trial: Box<dyn Underway>,
    /// Times at which the formation goes on whatever its rule says, where somebody said so.
    times: Option<Vec<f64>>,
    /// What was said while it ran: step, time, what.
    events: Vec<(u64, f64, String)>,
}

/// The first trial of a formation file, from its name and text, and the files that it names: of the first method that waits for a person,
/// or else of the first task and method that the page plays.
///
/// # Errors
/// What is wrong with the file, or that all its walls are still to be searched.
pub fn form(name: &str, text: &str, load: Load<'_>) -> Result<Box<dyn Shown>, LiveError> {
    let plan = crate::formation::read(name, text, &[], (true, Watched::Somebody), load)?;
    let (tasks, methods) = (0..plan.tasks.len(), 0..plan.methods.len());
    let all = || methods.clone().flat_map(|method| tasks.clone().map(move |task| (task, method)));
    let waiting = all().filter(|&(_, method)| plan.methods[method].form.by.waits());
    let mut wanted = waiting.chain(plan.show.iter().copied()).chain(all());
    let Some((task, method)) = wanted.find(|&(task, method)| plan.given(task, method)) else {
        let what = format!("the walls of `{name}` are still to be searched: run it, and look at its folder");
        return Err(LiveError::Request(what));
    };
    Ok(Box::new(Formed::begun(name.to_owned(), text.to_owned(), plan, (task, method, 1), None)?))
}

/// A trial at its start: its seed, where none is given, its walls, and itself.
fn started(
    plan: &Plan,
    (task, method, number): (usize, usize, usize),
    seed: Option<u64>,
) -> Result<(u64, Vec<Wall>, Box<dyn Underway>), LiveError> {
    if !plan.given(task, method) {
        let (task, method) = (&plan.tasks[task].name, &plan.methods[method].name);
        let what = format!("`{method}` does not try task `{task}`, or needs walls that are still to be searched");
        return Err(LiveError::Request(what));
    }
    let seed = seed.unwrap_or_else(|| plan.seed_of(task, number));
    let given = plan.walls[task].as_deref().unwrap_or_default();
    let arena = plan.arena(task, &plan.methods[method], given);
    let trial = trial::begun(&arena, seed).map_err(LiveError::Request)?;
    Ok((seed, arena.walls, trial))
}

impl Formed {
    fn begun(
        name: String,
        text: String,
        plan: Plan,
        at: (usize, usize, usize),
        seed: Option<u64>,
    ) -> Result<Self, LiveError> {
        let (seed, walls, trial) = started(&plan, at, seed)?;
        Ok(Self { name, text, plan, at, seed, walls, trial, times: None, events: Vec::new() })
    }
    /// Begins anew, with another trial or seed.
    fn begin(&mut self, at: (usize, usize, usize), seed: Option<u64>) -> Result<(), LiveError> {
        (self.seed, self.walls, self.trial) = started(&self.plan, at, seed)?;
        self.at = at;
        self.times = None;
        self.events.clear();
        Ok(())
    }
    fn controls(&self) -> Json {
        let plan = &self.plan;
        let (task, method, number) = self.at;
        let control = |path: &str, about: &str, kind: &str, value: Json| {
            json!({
                "path": path, "group": "Trial", "name": path, "symbol": "", "about": about, "unit": "", "kind": kind,
                "value": value, "words": [], "default": null,
            })
        };
        let mut tasks = control("task", "What the targets are to do.", "word", json!(plan.tasks[task].name));
        tasks["words"] = plan.tasks.iter().map(|task| json!(task.name)).collect();
        let mut methods = control("method", "What brings the targets along.", "word", json!(plan.methods[method].name));
        methods["words"] = plan.methods.iter().map(|method| json!(method.name)).collect();
        let mut trial = control("trial", "Its number, from which its seed follows.", "whole", json!(number));
        (trial["low"], trial["high"], trial["step"]) = (json!(1), json!(plan.form.trials.max(number)), json!(1));
        json!([tasks, methods, trial])
    }
}

impl Shown for Formed {
    fn scene(&self) -> Json {
        let (plan, shown) = (&self.plan, self.trial.shown());
        let (task, method, number) = self.at;
        let own = &plan.methods[method];
        let scenario = &own.population.scenario;
        let everywhere: Vec<_> = shown.targets.iter().chain(shown.robots).copied().collect();
        let (low, high) = course::extent(plan, task, &everywhere);
        let (mut groups, mut first) = (Vec::new(), 0);
        for (name, group) in &scenario.group.0 {
            let title = swarm::models::find(&group.model.id).map_or("", |entry| entry.card.title);
            groups.push(json!({
                "name": name, "model": group.model.id, "title": title,
                "first": first, "count": group.count, "radius": shown.target_radius,
            }));
            first += group.count;
        }
        let robots = shown.robots.len();
        if robots > 0 {
            groups.push(json!({
                "name": course::SHEPHERDS, "model": "", "title": "",
                "first": first, "count": robots, "radius": own.shepherds.radius,
            }));
        }
        let schedule = build::schedule(scenario, false).ok();
        let posts = if self.trial.posts().is_empty() {
            ""
        } else {
            " Small circles are the posts of robots in the places of walls."
        };
        let unit = |id: &str| if id == "dispersion" { scenario.units.length.as_str() } else { "" };
        json!({
            "is": "scene",
            "kind": "live",
            "of": "formation",
            "goes_on": own.form.by.goes_on(),
            "title": format!("{}: task {}, {}, trial {number}", plan.form.title, plan.tasks[task].name, own.name),
            "about": course::about(own) + posts,
            "seed": self.seed,
            "dimensions": 2,
            "units": { "length": scenario.units.length, "time": scenario.units.time },
            "space": { "edges": ["open", "open"], "size": [null, null], "low": low.0, "high": high.0 },
            "groups": groups,
            "labels": [],
            "step": schedule.map_or(1.0, |schedule| schedule.step),
            "steps": own.population.steps,
            "frames": 0,
            "from_step": 0,
            "every_steps": 1,
            "metrics": READ.map(|(id, title, range)| json!({ "id": id, "title": title, "unit": unit(id), "range": range })),
            "controls": self.controls(),
            "events": self.events.iter().map(|(step, t, what)| json!({ "step": step, "t": t, "what": what }))
                .collect::<Vec<_>>(),
        })
    }
    fn obstacles(&self) -> Json {
        let there = course::outlines(&self.plan, &self.walls, self.trial.shown().standing);
        let body = self.plan.methods[self.at.1].shepherds.radius;
        let posts = self.trial.posts().into_iter().map(|post| report::circle(post, body));
        let guides = report::lines_of(&self.plan.tasks[self.at.0]).into_iter().chain(posts);
        let guides = guides.map(|points| json!({ "guide": points }));
        let list: Vec<Json> = there.iter().map(|outline| shape(outline, 2)).chain(guides).collect();
        json!({ "is": "obstacles", "list": list })
    }
    fn items(&self) -> Option<Json> {
        None
    }
    fn obstacles_move(&self) -> bool {
        !self.walls.is_empty()
    }
    fn advance(&mut self, count: i64) -> Result<i64, LiveError> {
        Ok((0..count).take_while(|_| self.trial.go_on()).count() as i64)
    }
    fn moment(&self) -> (u64, f64, Option<u64>) {
        (self.trial.step(), self.trial.shown().time, None)
    }
    fn frame(&self, number: u32) -> Vec<u8> {
        let (shown, ways) = (self.trial.shown(), self.trial.ways());
        let targets = shown.targets.len();
        let at = |k: usize| if k < targets { shown.targets[k] } else { shown.robots[k - targets] };
        let (place, way) = (|k: usize, a: usize| at(k)[a] as f32, |k: usize, a: usize| ways[k][a] as f32);
        packed(number, self.trial.step(), shown.time, 2, ways.len(), place, way, None)
    }
    fn measure(&mut self) -> Option<Json> {
        let (step, t, _) = self.moment();
        let rows = [json!({ "group": build::WHOLE_GROUP, "values": [self.trial.arrived(), self.trial.spread()] })];
        Some(json!({ "is": "metrics", "step": step, "t": t, "rows": rows }))
    }
    fn all_metrics(&self) -> Option<Json> {
        None
    }
    fn explain(&mut self, agent: u32) -> Result<Json, LiveError> {
        let shown = self.trial.shown();
        let (targets, all) = (shown.targets.len(), shown.targets.len() + shown.robots.len());
        if (targets..all).contains(&(agent as usize)) {
            let what = "a shepherd goes where the method wants it; what moves an agent is told of targets";
            return Err(LiveError::Request(what.into()));
        }
        match self.trial.explain(agent) {
            Some(told) => Ok(explain::json(&told, &self.plan.methods[self.at.1].population.scenario)),
            None => Err(LiveError::Request(format!("there is no agent {agent}"))),
        }
    }
    fn seek(&mut self, _: u64) -> Result<(), LiveError> {
        Err(LiveError::Request("a trial goes forward; run its file, and scrub through it in its folder".into()))
    }
    fn reset(&mut self, seed: Option<u64>) -> Result<(), LiveError> {
        self.begin(self.at, Some(seed.unwrap_or(self.seed)))
    }
    fn set(&mut self, path: &str, value: &Json) -> Result<bool, LiveError> {
        let (mut task, mut method, mut number) = self.at;
        let wrong = || LiveError::Request(format!("{value} is no {path} of `{}`", self.name));
        match path {
            "task" => {
                let found = self.plan.tasks.iter().position(|task| value.as_str() == Some(task.name.as_str()));
                task = found.ok_or_else(wrong)?;
            }
            "method" => {
                let found = self.plan.methods.iter().position(|method| value.as_str() == Some(method.name.as_str()));
                method = found.ok_or_else(wrong)?;
            }
            "trial" => {
                let found = value.as_u64().filter(|number| (1..=100_000).contains(number));
                number = found.ok_or_else(wrong)? as usize;
            }
            _ => return Err(LiveError::Request(format!("`{path}` does not change here; change the file"))),
        }
        self.begin((task, method, number), None)?;
        Ok(false)
    }
    fn go_on(&mut self) -> Result<String, LiveError> {
        let (step, time, _) = self.moment();
        let Some(times) = self.trial.switch() else {
            let method = &self.plan.methods[self.at.1].name;
            return Err(LiveError::Request(format!("`{method}` is no formation that goes from wall to wall")));
        };
        self.times = Some(times);
        let what = "next formation".to_owned();
        self.events.push((step, time, what.clone()));
        Ok(what)
    }
    fn file(&self) -> Result<String, LiveError> {
        let path = format!("method.{}.by.formation.switch_at", self.plan.methods[self.at.1].name);
        let sets: Vec<(String, String)> = self.times.iter().map(|times| (path.clone(), format!("{times:?}"))).collect();
        crate::file::edit::with_values(&self.text, &sets).map_err(LiveError::Request)
    }
    fn natural_rate(&self) -> f64 {
        let scenario = &self.plan.methods[self.at.1].population.scenario;
        let step = build::schedule(scenario, false).map_or(1.0, |schedule| schedule.step);
        (1.0 / step).clamp(20.0, 200.0)
    }
}
