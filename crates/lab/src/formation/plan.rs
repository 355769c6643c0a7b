//! From a formation file to tasks, methods and arenas.

use super::controllers::By;
use super::form::{Formation, MethodForm, Shepherds, TaskForm};
use super::results::Results;
use super::solver::Problem;
use super::task::{Task, Wall};
use super::trial::{self, Arena};
use crate::design::plan::{TRIAL, opened, workspace};
use crate::environment::claims;
use crate::environment::trial::Population;
use crate::environment::workspace::Resolved;
use crate::file::{Form, Node, Problems, Rule, Sources, Span};
use crate::scenario::Scenario;
use crate::scenario::build::{self, Wrong};
use crate::study::plan::{Files, Load};
use serde_json::{Value as Json, json};
use space::random::child_seed;
use space::spelling::nearest;
use space::{Segment, Vector};
use terrain::{Draws, Point};

/// Kinds of child seeds, beside those of searches and designs: a task, a trial of the search for its walls.
const TASK: u32 = 8;
const SEARCH: u32 = 9;

/// A method as resolved.
#[derive(Clone, Debug)]
pub struct Method {
    /// Its name.
    pub name: String,
    /// What was written.
    pub form: MethodForm,
    /// The targets.
    pub population: Population,
    /// The shepherds' bodies.
    pub shepherds: Shepherds,
    /// Places of the tasks that are tried.
    pub tasks: Vec<usize>,
}

/// A formation file as resolved.
pub struct Plan {
    /// What was written.
    pub form: Formation,
    /// What is there already.
    pub workspace: Resolved,
    /// The tasks.
    pub tasks: Vec<Task>,
    /// The walls that each task gives; none where they are searched.
    pub walls: Vec<Option<Vec<Wall>>>,
    /// The methods.
    pub methods: Vec<Method>,
    /// The targets of the search.
    pub targets: Population,
    /// Places of task and method of the trials that the page plays.
    pub show: Vec<(usize, usize)>,
    /// Trials of each task with each method.
    pub trials: usize,
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

impl Plan {
    fn task_seed(&self, task: usize) -> u64 {
        // keyed by its name, so that tasks can be added anywhere
        let name = Draws::new(self.form.seed, 0, 0).uniform(&format!("task {}", self.tasks[task].name), 0);
        child_seed(self.form.seed, TASK, name.to_bits(), 0)
    }
    /// The seed of a trial of a task: the same for all methods. It has 63 bits, so that a file can give it.
    pub fn seed_of(&self, task: usize, trial: usize) -> u64 {
        child_seed(self.task_seed(task), TRIAL, trial as u64, 0) >> 1
    }
    /// The box in which shepherds stay.
    fn bounds(&self) -> Option<(Point, Point)> {
        let corners = self.workspace.workspace.boundary.as_ref()?;
        let axis = |axis: usize, of: fn(f64, f64) -> f64, from: f64| corners.iter().map(|p| p[axis]).fold(from, of);
        let (inf, least, most) = (f64::INFINITY, f64::min as fn(f64, f64) -> f64, f64::max as fn(f64, f64) -> f64);
        Some((Vector([axis(0, least, inf), axis(1, least, inf)]), Vector([axis(0, most, -inf), axis(1, most, -inf)])))
    }
    fn scenario(&self, population: &Population, task: usize) -> Scenario {
        let deviation = self.form.task.0[task].1.heading_deviation;
        trial::at_start(&population.among(&self.workspace.workspace.geometry), &self.tasks[task], deviation)
    }
    /// The arena of a task with a method; `walls` are those of the task.
    pub fn arena<'a>(&'a self, task: usize, method: &'a Method, walls: &[Wall]) -> Arena<'a> {
        let by = &method.form.by;
        Arena {
            scenario: self.scenario(&method.population, task),
            task: &self.tasks[task],
            walls: by.walls(&self.tasks[task], walls),
            by,
            timed: self.tasks[task].timed,
            shepherds: &method.shepherds,
            bounds: self.bounds(),
            steps: method.population.steps,
            step: step_of(&method.population),
            parts: None,
        }
    }
    /// Searches walls for a task; none where it was stopped.
    ///
    /// # Errors
    /// A task that cannot be tried, in a sentence.
    pub fn solve(&self, task: usize, stop: &dyn Fn() -> bool) -> Result<Option<super::solver::Solution>, String> {
        let by = By::Walls(super::controllers::walls::Walls::default());
        let bare = Arena {
            scenario: self.scenario(&self.targets, task),
            task: &self.tasks[task],
            walls: Vec::new(),
            by: &by,
            timed: self.tasks[task].timed,
            shepherds: &self.form.shepherds,
            bounds: self.bounds(),
            steps: self.targets.steps,
            step: step_of(&self.targets),
            parts: None,
        };
        let seed = self.task_seed(task);
        let trial_seed = |trial: usize| child_seed(seed, SEARCH, trial as u64, 0) >> 1;
        let problem =
            Problem { solver: &self.form.solver, task: &self.tasks[task], seed, bare, trial_seed: &trial_seed };
        problem.solve(stop).map_err(|what| format!("task `{}`: {what}", self.tasks[task].name))
    }
    /// Names of the methods that wait for a person to say when they go on.
    pub fn waiting(&self) -> impl Iterator<Item = &str> {
        self.methods.iter().filter(|method| method.form.by.waits()).map(|method| method.name.as_str())
    }
    /// Whether a task can be tried with a method before anything was searched.
    pub fn given(&self, task: usize, method: usize) -> bool {
        let own = &self.methods[method];
        own.tasks.contains(&task) && (self.walls[task].is_some() || !own.form.by.needs_walls())
    }
    /// Whether some method needs walls of a task that gives none.
    pub fn searched(&self, task: usize) -> bool {
        self.walls[task].is_none()
            && self.methods.iter().any(|method| method.form.by.needs_walls() && method.tasks.contains(&task))
    }
    /// What the results of a trial depend on: trials may be added, and statements are made afterwards.
    pub fn identity(&self) -> Json {
        let mut form = self.form.clone();
        (form.title, form.about) = (String::new(), String::new());
        (form.trials, form.quick_trials) = (1, 1);
        (form.claim, form.show) = (Vec::new(), Vec::new());
        form.scenario = None;
        let scenario = |population: &Population| {
            let mut scenario = population.scenario.clone();
            (scenario.title, scenario.about, scenario.seed) = (String::new(), String::new(), None);
            scenario.write().json()
        };
        let scenarios: Vec<Json> = self.methods.iter().map(|method| scenario(&method.population)).collect();
        let there = terrain::text::wkt::write(&self.workspace.workspace.geometry);
        json!({ "formation": form.write().json(), "targets": scenario(&self.targets), "scenarios": scenarios, "workspace": there })
    }
}

/// Time of a step of a population's scenario.
fn step_of(population: &Population) -> f64 {
    population.scenario.time.duration / population.steps.max(1) as f64
}

/// Whether somebody looks on, who can say when robots go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watched {
    /// Nobody: what the file leaves to a person is wrong.
    Nobody,
    /// Somebody.
    Somebody,
}

/// Reads a formation file from its text, the values put over it, and the files it names.
///
/// # Errors
/// Everything that is wrong with it, at its place.
pub fn read(
    name: &str,
    text: &str,
    sets: &[String],
    (quick, watched): (bool, Watched),
    load: Load<'_>,
) -> Result<Plan, Problems> {
    let (mut plan, sources) = Files::read(load, |files| planned(files, name, text, sets, (quick, watched)))?;
    plan.sources = sources;
    Ok(plan)
}

fn planned(
    files: &mut Files<'_>,
    name: &str,
    text: &str,
    sets: &[String],
    (quick, watched): (bool, Watched),
) -> Option<Plan> {
    let tree = opened(files, name, text, sets)?;
    let form = Formation::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut files.desk)
        .filter(|_| files.desk.problems.is_empty())?;
    let workspace = workspace(files, &form.workspace, name, &tree)?;
    let (mut tasks, mut walls) = (Vec::new(), Vec::new());
    for (name, written) in &form.task.0 {
        match task(name, written) {
            Ok((task, own)) => {
                tasks.push(task);
                walls.push(own);
            }
            Err(wrong) => problem(files, &tree, wrong.below(&format!("task.{name}"))),
        }
    }
    for (key, empty) in [("task", form.task.0.is_empty()), ("method", form.method.0.is_empty())] {
        if empty {
            files.desk.problem(
                &tree.place(key),
                format!("there is no {key}"),
                format!("at least one [{key}.NAME]"),
                "",
            );
        }
    }
    if !files.desk.problems.is_empty() {
        return None;
    }
    let start = Span { source: tree.span.source, bytes: 0..0 };
    let base = files.scenario(form.scenario.as_ref(), &form.title, &form.set.0, &start, "formation")?;
    let units = workspace.workspace.units;
    let targets = population(files, "targets", base.clone(), units)?;
    let mut methods = Vec::new();
    for (name, written) in &form.method.0 {
        let mut own = base.clone();
        files.put(&mut own, &written.set.0)?;
        let Some(population) = population(files, name, own, units) else { continue };
        let mut chosen = Vec::new();
        for (k, wanted) in written.tasks.iter().flatten().enumerate() {
            match place(wanted, tasks.iter().map(|task| task.name.as_str()), "task") {
                Ok(task) => chosen.push(task),
                Err(wrong) => problem(files, &tree, wrong.below(&format!("method.{name}.tasks.{k}"))),
            }
        }
        if written.tasks.is_none() {
            chosen = (0..tasks.len()).collect();
        }
        if watched == Watched::Nobody && written.by.waits() {
            let place = tree.place(&format!("method.{name}.by.formation.switch"));
            let what = format!("`{name}` waits for a person who says when to go on, and here nobody looks on");
            let help = "`flockworks view` lets you say so, and saves when you did";
            files.desk.problem(&place, what, "`switch_at`, the times at which it goes on", help);
        }
        let shepherds = written.shepherds.clone().unwrap_or_else(|| form.shepherds.clone());
        methods.push(Method { name: name.clone(), form: written.clone(), population, shepherds, tasks: chosen });
    }
    let mut show = Vec::new();
    for (k, pair) in form.show.iter().enumerate() {
        let (task, method) =
            pair.split_once(',').map_or((pair.as_str(), ""), |(task, method)| (task.trim(), method.trim()));
        let found = place(task, tasks.iter().map(|task| task.name.as_str()), "task")
            .and_then(|task| Ok((task, place(method, methods.iter().map(|method| method.name.as_str()), "method")?)));
        match found {
            Ok(found) => show.push(found),
            Err(wrong) => problem(files, &tree, wrong.below(&format!("show.{k}"))),
        }
    }
    let trials = if quick { form.quick_trials.min(form.trials) } else { form.trials };
    let plan = Plan {
        form,
        workspace,
        tasks,
        walls,
        methods,
        targets,
        show,
        trials,
        sources: Sources::default(),
        sets: sets.to_vec(),
        quick,
    };
    if files.desk.problems.is_empty() {
        for task in 0..plan.tasks.len() {
            for method in plan.methods.iter().filter(|method| method.tasks.contains(&task)) {
                let given = plan.walls[task].clone().unwrap_or_default();
                if let Err(wrong) = trial::possible(&plan.arena(task, method, &given), plan.seed_of(task, 1)) {
                    let what =
                        format!("task `{}` with `{}` cannot begin: {}", plan.tasks[task].name, method.name, wrong.what);
                    let place = tree.place(&format!("task.{}", plan.tasks[task].name));
                    files.desk.problem(&place, what, "not possible", "");
                }
            }
        }
        claims::check(&plan.form.claim, &Results::example(&plan), "claim", &tree, &mut files.desk);
    }
    Some(plan)
}

fn problem(files: &mut Files<'_>, tree: &Node, wrong: Wrong) {
    files.desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help);
}

fn population(files: &mut Files<'_>, name: &str, tree: Node, units: terrain::Units) -> Option<Population> {
    let scenario = build::resolved(&tree, &mut files.desk)?;
    match Population::new(name, "", tree.clone(), scenario, units) {
        Ok(population) => Some(population),
        Err(wrong) => {
            files.desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help);
            None
        }
    }
}

/// The place of a name in a list.
fn place<'a>(name: &str, known: impl Iterator<Item = &'a str>, what: &str) -> Result<usize, Wrong> {
    let known: Vec<&str> = known.collect();
    known.iter().position(|other| *other == name).ok_or_else(|| {
        let near = nearest(name, known.iter().copied());
        let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
        Wrong::new("", format!("there is no {what} `{name}`"), format!("one of {}", known.join(", "))).help(&help)
    })
}

fn task(name: &str, form: &TaskForm) -> Result<(Task, Option<Vec<Wall>>), Wrong> {
    let mut path: Vec<Point> = Vec::new();
    for (k, numbers) in form.path.iter().enumerate() {
        let point =
            build::vector::<f64, 2>(numbers).map_err(|what| Wrong::new(format!("path.{k}"), what, "2 numbers"))?;
        if path.last().is_some_and(|before| *before == point) {
            return Err(Wrong::new(format!("path.{k}"), "it is where the point before it is", "another point"));
        }
        path.push(point);
    }
    if path.len() < 2 {
        return Err(Wrong::new("path", "a path has a start and an end", "two points at least"));
    }
    let task = Task {
        name: name.to_owned(),
        path,
        half_width: form.half_width,
        start_radius: form.start_radius,
        goal_radius: form.goal_radius,
        timed: form.timed,
    };
    let Some(written) = &form.wall else { return Ok((task, None)) };
    let mut walls = Vec::new();
    for (k, wall) in written.iter().enumerate() {
        let &[x0, y0, x1, y1] = wall.at.as_slice() else {
            let what = format!("{} numbers for a wall", wall.at.len());
            return Err(Wrong::new(format!("wall.{k}.at"), what, "[x0, y0, x1, y1]"));
        };
        if x0 == x1 && y0 == y1 {
            return Err(Wrong::new(format!("wall.{k}.at"), "the wall has no length", "two different ends"));
        }
        if wall.leg > task.legs() {
            let what = format!("the path has {} legs", task.legs());
            return Err(Wrong::new(format!("wall.{k}.leg"), what, "one of them, from 1"));
        }
        walls.push(Wall { at: Segment::new([x0, y0], [x1, y1]), leg: wall.leg - 1 });
    }
    Ok((task, Some(walls)))
}
