//! From a study file to cells and conditions.
//!
//! A *cell* is a combination of levels; a *condition* is a scenario as resolved, with every default filled in. Cells
//! that come to the same condition share its trials. A condition is known by what it is, never by its place in a list,
//! so that cells can be added without changing any other.

use super::expression::{Expression, Mistake, Names, Selector, Value};
use super::form::{
    Claim, ContactReading, Design, Factor, Figure, MetricReading, Partner, Quantity, Reading, ShareReading, Statistic,
    Study, Test, Whose, Window,
};
use crate::file::tree::parse;
use crate::file::{Anything, Desk, Form, Named, Node, Problems, Rule, Sources, Span, Tree};
use crate::scenario::build::{self, Schedule};
use crate::scenario::{Record, Scenario};
use core::ops::Range;
use serde_json::{Value as Json, json};
use space::random::{Purpose, uniform};
use space::spelling::nearest;
use std::collections::{HashMap, HashSet};
use twox_hash::XxHash64;

/// A level of a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// As it is written.
    pub text: String,
    /// As a number, where it is one.
    pub number: Option<f64>,
}

/// A factor of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// Its name.
    pub name: String,
    /// What it is, for axes and tables.
    pub about: String,
    /// Its unit.
    pub unit: String,
    /// Its levels in the cells, in the order in which they first appear.
    pub levels: Vec<Level>,
}

impl Level {
    /// What it is, to be looked up by.
    fn key(&self) -> (String, Option<u64>) {
        (self.text.clone(), self.number.map(f64::to_bits))
    }
}

impl Varied {
    /// Whether every level is a number.
    pub fn numeric(&self) -> bool {
        self.levels.iter().all(|level| level.number.is_some())
    }
}

/// A part of a study: one file, one set of factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name: that of its file.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What it is and what it asks.
    pub about: String,
    /// Its factors.
    pub factors: Vec<Varied>,
    /// Its cells, among those of the study.
    pub cells: Range<usize>,
    /// Figures.
    pub figures: Vec<Figure>,
    /// Tests.
    pub tests: Vec<Test>,
    /// Statements.
    pub claims: Vec<Claim>,
}

/// A combination of levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Its part, by index.
    pub part: usize,
    /// The level of each factor of the part, by index among its levels.
    pub levels: Vec<usize>,
    /// Its condition, by index.
    pub condition: usize,
    /// Number of its trials.
    pub trials: usize,
}

/// A scenario as resolved.
#[derive(Clone, Debug)]
pub struct Condition {
    /// The scenario, without title, seed, and what is recorded.
    pub scenario: Scenario,
    /// Its tree, from which it can be read again.
    pub tree: Node,
    /// What it is: the scenario with every default filled in.
    pub identity: Json,
    /// Its key: a hash of the identity.
    pub key: [u64; 2],
    /// Its steps.
    pub schedule: Schedule,
    /// Number of its agents.
    pub agents: u64,
    /// Number of its trials: the most that any of its cells has.
    pub trials: usize,
}

impl Condition {
    /// Updates of agents in a trial.
    pub fn updates(&self) -> u64 {
        self.agents * self.schedule.steps
    }
}

/// A study as resolved.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Title.
    pub title: String,
    /// What it is and what it asks.
    pub about: String,
    /// Trial t has this seed plus t.
    pub seed: u64,
    /// Parts, in order.
    pub parts: Vec<Part>,
    /// Cells, part by part.
    pub cells: Vec<Cell>,
    /// Conditions, in the order of the first cell of each.
    pub conditions: Vec<Condition>,
    /// Statements about several parts together.
    pub claims: Vec<Claim>,
    /// What is read off each trial.
    pub readings: Vec<(String, Reading)>,
    /// When trials are looked at.
    pub looks: Window,
    /// Name of the unit of length and of time.
    pub units: (String, String),
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

impl Plan {
    /// The seed of a trial.
    pub fn seed_of(&self, trial: usize) -> u64 {
        self.seed.wrapping_add(trial as u64)
    }
    /// A cell in words: `variant = prob, N = 6`.
    pub fn name_of(&self, cell: &Cell) -> String {
        let part = &self.parts[cell.part];
        let levels: Vec<String> = part
            .factors
            .iter()
            .zip(&cell.levels)
            .map(|(factor, &level)| format!("{} = {}", factor.name, factor.levels[level].text))
            .collect();
        let levels = if levels.is_empty() { "the scenario as it is".to_owned() } else { levels.join(", ") };
        if self.parts.len() > 1 { format!("{}: {levels}", part.name) } else { levels }
    }
    /// What the results depend on, apart from cells and trials, which may be added.
    pub fn identity(&self) -> Json {
        let readings = self.readings.iter().map(|(name, reading)| (name.clone(), reading.of.write().json()));
        json!({
            "seed": self.seed,
            "looks": self.looks.write().json(),
            "readings": Json::Object(readings.collect()),
        })
    }
    /// What each cell is: name and condition.
    pub fn identities(&self) -> Vec<(String, &Json)> {
        self.cells.iter().map(|cell| (self.name_of(cell), &self.conditions[cell.condition].identity)).collect()
    }
}

/// The loader of files beside the study: their text by their name.
pub type Load<'a> = &'a mut dyn FnMut(&str) -> Result<String, String>;

/// Reads a study from its text, the values put over it, and the files it names.
///
/// # Errors
/// Everything that is wrong with it, at its place.
pub fn read(name: &str, text: &str, sets: &[String], quick: bool, load: Load<'_>) -> Result<Plan, Problems> {
    let files = Files { sources: Sources::default(), desk: Desk::default(), load };
    let mut reader = Reader { files, quick, conditions: HashMap::new() };
    let plan = reader.plan(name, text, sets);
    match plan {
        Some(mut plan) if reader.files.desk.problems.is_empty() => {
            plan.sources = reader.files.sources;
            Ok(plan)
        }
        _ => Err(Problems::new(reader.files.sources, reader.files.desk.problems)),
    }
}

/// Cells, at most: a mistyped step must not fill the memory.
const MOST_CELLS: usize = 100_000;
/// Files that extend one another, at most.
const CHAIN: usize = 10;

/// The texts that a file is made of, what is wrong with them, and who loads those it names.
pub(crate) struct Files<'a> {
    pub(crate) sources: Sources,
    pub(crate) desk: Desk,
    pub(crate) load: Load<'a>,
}

impl<'a> Files<'a> {
    /// What is read of a file and those it names, with their texts.
    ///
    /// # Errors
    /// Everything that was found wrong.
    pub(crate) fn read<P>(load: Load<'a>, read: impl FnOnce(&mut Self) -> Option<P>) -> Result<(P, Sources), Problems> {
        let mut files = Self { sources: Sources::default(), desk: Desk::default(), load };
        match read(&mut files) {
            Some(plan) if files.desk.problems.is_empty() => Ok((plan, files.sources)),
            _ => Err(Problems::new(files.sources, files.desk.problems)),
        }
    }
    /// Path and text of a file beside another.
    pub(crate) fn loaded(&mut self, beside: &str, file: &str, place: &Span) -> Option<(String, String)> {
        let path = std::path::Path::new(beside).parent().map_or_else(|| file.into(), |folder| folder.join(file));
        let path = path.to_string_lossy().into_owned();
        match (self.load)(&path) {
            Ok(text) => Some((path, text)),
            Err(what) => {
                self.desk.problem(place, what, "the name of a file beside this one", "");
                None
            }
        }
    }
    /// The scenario that a file is about: a table in it or the name of a file beside it, with values put over it.
    /// `start` is where it would be missing, `what` what kind of file it is.
    pub(crate) fn scenario(
        &mut self,
        given: Option<&Anything>,
        title: &str,
        set: &Node,
        start: &Span,
        what: &str,
    ) -> Option<Node> {
        let Some(given) = given else {
            let help = "give the name of a file, scenario = \"tank.toml\", or a table [scenario]";
            self.desk.problem(start, format!("the {what} has no scenario"), "`scenario` is missing", help);
            return None;
        };
        let mut base = match &given.0.tree {
            Tree::Table(_) => given.0.clone(),
            Tree::Text(file) => {
                // beside the file that names it
                let beside = self.sources.name(given.0.span.source).to_owned();
                let (path, text) = self.loaded(&beside, file, &given.0.span)?;
                let source = self.sources.add(&path, &text);
                let tree = parse(&self.sources, source, &mut self.desk.problems);
                if !self.desk.problems.is_empty() {
                    return None;
                }
                tree
            }
            other => {
                let what = format!("`scenario` takes a file name or a table, found {}", other.describe());
                self.desk.problem(&given.0.span, what, "expected a file name or a table", "");
                return None;
            }
        };
        for (key, value) in [("kind", "scenario"), ("title", title)] {
            if base.get(key).is_none() {
                let node = Node { tree: value.into(), span: base.span.clone() };
                // a table takes any key
                let _ = base.set(key, node);
            }
        }
        self.put(&mut base, set)?;
        Some(base)
    }
    /// A file with the keys of those it extends, where it has none of its own. `depth` counts them.
    pub(crate) fn extended(&mut self, name: &str, mut tree: Node, depth: usize) -> Option<Node> {
        let Some(node) = tree.get("extends").cloned() else { return Some(tree) };
        let Tree::Text(file) = &node.tree else { return Some(tree) };
        if depth == CHAIN {
            self.desk.problem(&node.span, "too many files extend one another", "a circle?", "");
            return None;
        }
        let (path, text) = self.loaded(name, file, &node.span)?;
        let source = self.sources.add(&path, &text);
        let under = parse(&self.sources, source, &mut self.desk.problems);
        if !self.desk.problems.is_empty() {
            return None;
        }
        let under = self.extended(&path, under, depth + 1)?;
        if let Tree::Table(entries) = &mut tree.tree {
            entries.retain(|entry| entry.key != "extends");
        }
        let mut joined = under;
        join(&mut joined, &tree);
        joined.span = tree.span;
        Some(joined)
    }
    /// Puts a table of values over a tree; a key with dots is a path, whose value is put as it is.
    pub(crate) fn put(&mut self, tree: &mut Node, patch: &Node) -> Option<()> {
        let Tree::Table(entries) = &patch.tree else {
            let what = format!("a table of paths and values is needed here, found {}", patch.tree.describe());
            self.desk.problem(&patch.span, what, "expected a table", "");
            return None;
        };
        for entry in entries {
            if entry.key.contains('.') {
                if let Err(what) = tree.set(&entry.key, entry.node.clone()) {
                    self.desk.problem(&entry.span, what, "names no place in the scenario", "");
                    return None;
                }
            } else {
                let one = Tree::Table(vec![entry.clone()]);
                join(tree, &Node { tree: one, span: patch.span.clone() });
            }
        }
        Some(())
    }
}

struct Reader<'a> {
    files: Files<'a>,
    quick: bool,
    /// The place of each condition of the plan, by its key.
    conditions: HashMap<[u64; 2], usize>,
}

/// What a cell cannot vary, as no trial depends on it, and what is meant instead.
const SAME_FOR_ALL: [(&str, &str); 5] = [
    ("seed", "trial t has the seed of the study plus t, in every cell"),
    ("title", ""),
    ("about", ""),
    ("record", "trials are not recorded; `--cell CELL --trial T` runs one and records it"),
    ("measure", "what is read off a trial is said by [reading.NAME], which takes parameters"),
];

/// A part while it is read: its file, and what can be said of it before its cells are made.
struct Raw {
    name: String,
    study: Study,
    tree: Node,
}

impl Reader<'_> {
    fn plan(&mut self, name: &str, text: &str, sets: &[String]) -> Option<Plan> {
        let top = self.raw(name, text, sets)?;
        let mut raws = Vec::new();
        for (k, file) in top.study.parts.iter().enumerate() {
            let place = top.tree.place(&format!("parts.{k}"));
            let (path, text) = self.files.loaded(name, file, &place)?;
            let raw = self.raw(&path, &text, &[])?;
            if !raw.study.parts.is_empty() {
                self.files.desk.problem(&place, format!("`{file}` has parts itself"), "a part has no parts", "");
                return None;
            }
            raws.push(raw);
        }
        let alone = raws.is_empty();
        let given = |key: &str| top.tree.get(key).is_some();
        if !alone && (given("factor") || given("scenario")) {
            let place = top.tree.place(if given("factor") { "factor" } else { "scenario" });
            let what = "a study of parts has no factors and no scenario of its own";
            self.files.desk.problem(&place, what, "leave it out", "make it a part");
            return None;
        }
        let mut plan = Plan {
            title: top.study.title.clone(),
            about: top.study.about.clone(),
            seed: top.study.seed,
            parts: Vec::new(),
            cells: Vec::new(),
            conditions: Vec::new(),
            claims: Vec::new(),
            readings: Vec::new(),
            looks: Window { from: None, interval: 1.0 },
            units: (String::new(), String::new()),
            sources: Sources::default(),
            sets: sets.to_vec(),
            quick: self.quick,
        };
        let (given_trials, given_quick, given_seed) = (given("trials"), given("quick_trials"), given("seed"));
        let over = top.study.clone();
        let whole = (!alone).then(|| top.tree.clone());
        for raw in if alone { vec![top] } else { raws } {
            let study = &raw.study;
            // what the study of all parts says goes for every part
            let trials = match self.quick {
                true if given_quick && !alone => over.quick_trials,
                true => study.quick_trials,
                false if given_trials && !alone => over.trials,
                false => study.trials,
            };
            if !alone && !given_seed {
                if plan.parts.is_empty() {
                    plan.seed = study.seed;
                } else if study.seed != plan.seed {
                    let what = format!("this part has the seed {}, those before it {}", study.seed, plan.seed);
                    self.files.desk.problem(&raw.tree.place("seed"), what, "one seed for all", "");
                }
            }
            self.part(&mut plan, &raw, trials)?;
        }
        if let Some(tree) = whole {
            plan.claims = over.claim;
            super::claims::check_claims(
                &plan,
                &plan.parts[0],
                &plan.claims,
                &tree,
                &self.files.sources,
                &mut self.files.desk,
            );
        }
        (self.files.desk.problems.is_empty()).then_some(plan)
    }

    /// A file as a study, with what it extends.
    fn raw(&mut self, name: &str, text: &str, sets: &[String]) -> Option<Raw> {
        let source = self.files.sources.add(name, text);
        let mut tree = parse(&self.files.sources, source, &mut self.files.desk.problems);
        build::put(&mut tree, sets, &mut self.files.sources, &mut self.files.desk);
        if !self.files.desk.problems.is_empty() {
            return None;
        }
        let tree = self.files.extended(name, tree, 0)?;
        let before = self.files.desk.problems.len();
        let study = Study::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut self.files.desk)?;
        if self.files.desk.problems.len() > before {
            return None;
        }
        let stem = std::path::Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("study");
        Some(Raw { name: stem.to_owned(), study, tree })
    }
    fn part(&mut self, plan: &mut Plan, raw: &Raw, trials: usize) -> Option<()> {
        let study = &raw.study;
        let start = Span { source: raw.tree.span.source, bytes: 0..0 };
        let base = self.files.scenario(study.scenario.as_ref(), &study.title, &study.set.0, &start, "study")?;
        let defines = self.expressions("define", &study.define, raw)?;
        let derives = self.expressions("derive", &study.derive, raw)?;
        self.vary(study, raw)?;
        let rows = self.rows(study, raw, plan.seed)?;
        let mut factors: Vec<Varied> = Vec::new();
        for (name, factor) in &study.factor.0 {
            let about = if factor.about.is_empty() { name.clone() } else { factor.about.clone() };
            factors.push(Varied { name: name.clone(), about, unit: factor.unit.clone(), levels: Vec::new() });
        }
        let first = plan.cells.len();
        let mut places: Vec<HashMap<(String, Option<u64>), usize>> = vec![HashMap::new(); factors.len()];
        // what the scenario says of itself with every default filled in, for expressions that name a path
        let defaults = build::read_tree(&base, &mut Desk::default())
            .map_or_else(|| base.clone(), |scenario| Node { tree: scenario.write(), span: base.span.clone() });
        for row in rows {
            let mut tree = base.clone();
            let mut levels = Vec::new();
            for (((put, varied), (_, factor)), places) in
                row.iter().zip(&mut factors).zip(&study.factor.0).zip(&mut places)
            {
                self.put_level(&mut tree, put, factor, raw)?;
                levels.push(*places.entry(put.level.key()).or_insert_with(|| {
                    varied.levels.push(put.level.clone());
                    varied.levels.len() - 1
                }));
            }
            let mut known: Vec<(String, Value)> = row.iter().map(|put| (put.factor.clone(), put.value())).collect();
            for (name, expression, place) in &defines {
                let names = Surroundings { known: &known, tree: &tree, defaults: &defaults };
                let value = self.evaluated(expression, &names, place)?;
                known.push((name.clone(), value));
            }
            for (path, expression, place) in &derives {
                let names = Surroundings { known: &known, tree: &tree, defaults: &defaults };
                let value = self.evaluated(expression, &names, place)?;
                let node = Node { tree: tree_of(&value), span: place.clone() };
                if let Err(what) = tree.set(path, node) {
                    self.files.desk.problem(place, what, "names no place in the scenario", "");
                    return None;
                }
            }
            let cell = Cell { part: plan.parts.len(), levels, condition: 0, trials };
            let condition = self.condition(plan, raw, &tree, trials, &row)?;
            plan.cells.push(Cell { condition, ..cell });
        }
        let part = Part {
            name: raw.name.clone(),
            title: study.title.clone(),
            about: study.about.clone(),
            factors,
            cells: first..plan.cells.len(),
            figures: study.figure.clone(),
            tests: study.test.clone(),
            claims: study.claim.clone(),
        };
        if plan.parts.iter().any(|other| other.name == part.name) {
            let what = format!("two parts are called `{}`", part.name);
            self.files.desk.problem(&raw.tree.span, what, "files of different names", "");
        }
        plan.parts.push(part);
        super::claims::check(plan, plan.parts.len() - 1, &raw.tree, &self.files.sources, &mut self.files.desk);
        self.files.desk.problems.is_empty().then_some(())
    }

    /// The condition of a cell, which may be there already.
    fn condition(&mut self, plan: &mut Plan, raw: &Raw, tree: &Node, trials: usize, row: &[Put]) -> Option<usize> {
        let before = self.files.desk.problems.len();
        let read = build::read_tree(tree, &mut self.files.desk);
        let found = read.and_then(|scenario| {
            if plan.cells.is_empty() {
                self.readings(plan, raw, &scenario)?;
            } else {
                self.same_readings(plan, raw)?;
            }
            let mut scenario = scenario;
            scenario.title = String::new();
            scenario.about = String::new();
            scenario.seed = None;
            scenario.record = Record::default();
            scenario.measure = crate::scenario::Measure { metrics: None, interval: None, parameters: Named::default() };
            let identity = scenario.write().json();
            let text = identity.to_string();
            let key = [0, 1].map(|seed| XxHash64::oneshot(seed, text.as_bytes()));
            if let Some(&at) = self.conditions.get(&key) {
                let condition = &mut plan.conditions[at];
                condition.trials = condition.trials.max(trials);
                return Some(at);
            }
            if !build::possible(&scenario, tree, &mut self.files.desk) {
                return None;
            }
            let schedule = build::schedule(&scenario, false).ok()?;
            let agents = scenario.group.0.iter().map(|(_, group)| group.count as u64).sum();
            let condition = Condition { scenario, tree: tree.clone(), identity, key, schedule, agents, trials };
            super::trial::check(&condition, plan, &raw.tree, &mut self.files.desk);
            self.conditions.insert(key, plan.conditions.len());
            plan.conditions.push(condition);
            (self.files.desk.problems.len() == before).then(|| plan.conditions.len() - 1)
        });
        if found.is_none() && !row.is_empty() {
            // where the same text stands in many cells, which one is it?
            let cell: Vec<String> = row.iter().map(|put| format!("{} = {}", put.factor, put.level.text)).collect();
            for problem in self.files.desk.problems[before..].iter_mut().filter(|problem| problem.help.is_empty()) {
                problem.help = format!("in the cell {}", cell.join(", "));
            }
        }
        found
    }
    /// What is read off each trial.
    fn readings(&mut self, plan: &mut Plan, raw: &Raw, scenario: &Scenario) -> Option<()> {
        plan.units = (scenario.units.length.clone(), scenario.units.time.clone());
        let schedule = match build::schedule(scenario, false) {
            Ok(schedule) => schedule,
            Err(wrong) => {
                self.files.desk.problem(&raw.tree.span, wrong.what, wrong.expected, wrong.help);
                return None;
            }
        };
        let usual = Window { from: None, interval: schedule.measure as f64 * schedule.step };
        plan.looks = raw.study.looks.clone().unwrap_or(usual);
        plan.readings = raw.study.reading.0.clone();
        if plan.readings.is_empty() {
            plan.readings = usual_readings(scenario);
        }
        Some(())
    }
    fn same_readings(&mut self, plan: &Plan, raw: &Raw) -> Option<()> {
        let given = &raw.study.reading.0;
        let same = (given.is_empty() || *given == plan.readings)
            && raw.study.looks.as_ref().is_none_or(|looks| *looks == plan.looks);
        if !same {
            let place = raw.tree.place("reading");
            let what = format!("`{}` reads other numbers than the parts before it", raw.name);
            self.files.desk.problem(&place, what, "the same readings", "put them into a file that all parts extend");
        }
        same.then_some(())
    }

    fn expressions(&mut self, key: &str, given: &Named<String>, raw: &Raw) -> Option<Vec<(String, Expression, Span)>> {
        let mut read = Vec::new();
        for (name, text) in &given.0 {
            let place = entry_place(&raw.tree, key, name);
            match Expression::parse(text) {
                Ok(expression) => read.push((name.clone(), expression, place)),
                Err(mistake) => self.mistaken(&mistake, &place),
            }
        }
        (read.len() == given.0.len()).then_some(read)
    }
    fn evaluated(&mut self, expression: &Expression, names: &Surroundings<'_>, place: &Span) -> Option<Value> {
        match expression.value(names) {
            Ok(value) => match infinite(&value) {
                Some(number) => {
                    self.files.desk.problem(place, format!("the expression gives {number}"), "a finite number", "");
                    None
                }
                None => Some(value),
            },
            Err(mistake) => {
                self.mistaken(&mistake, place);
                None
            }
        }
    }
    fn mistaken(&mut self, mistake: &Mistake, place: &Span) {
        let span = within(&self.files.sources, place, &mistake.bytes);
        self.files.desk.problem(&span, mistake.what.clone(), "", mistake.help.clone());
    }

    /// Whether factors and derived values name what can differ from cell to cell.
    fn vary(&mut self, study: &Study, raw: &Raw) -> Option<()> {
        let mut named: Vec<(&str, Span)> = Vec::new();
        for (name, factor) in &study.factor.0 {
            named
                .extend(factor.path.iter().map(|path| (path.as_str(), raw.tree.place(&format!("factor.{name}.path")))));
            for (_, patch) in &factor.level.0 {
                if let Tree::Table(entries) = &patch.0.tree {
                    named.extend(entries.iter().map(|entry| (entry.key.as_str(), entry.span.clone())));
                }
            }
        }
        named.extend(study.derive.0.iter().map(|(path, _)| (path.as_str(), entry_place(&raw.tree, "derive", path))));
        let before = self.files.desk.problems.len();
        for (path, place) in named {
            let head = path.split('.').next().unwrap_or(path);
            if let Some((key, help)) = SAME_FOR_ALL.iter().find(|(key, _)| *key == head) {
                let what = format!("`{key}` cannot differ between cells: no result of a trial depends on it");
                self.files.desk.problem(&place, what, "not what varies", *help);
            }
        }
        (self.files.desk.problems.len() == before).then_some(())
    }

    /// Puts a level into the scenario of a cell.
    fn put_level(&mut self, tree: &mut Node, put: &Put, factor: &Factor, raw: &Raw) -> Option<()> {
        if let Some((_, patch)) = factor.level.0.iter().find(|(name, _)| *name == put.level.text) {
            return self.files.put(tree, &patch.0);
        }
        let Some(path) = &factor.path else { return Some(()) };
        if let Err(what) = tree.set(path, put.node.clone()) {
            let place = raw.tree.place(&format!("factor.{}.path", put.factor));
            self.files.desk.problem(&place, format!("`{path}`: {what}"), "names no place in the scenario", "");
            return None;
        }
        Some(())
    }
    /// The levels of each cell.
    fn rows(&mut self, study: &Study, raw: &Raw, seed: u64) -> Option<Vec<Vec<Put>>> {
        let factors = &study.factor.0;
        let count = factors.len();
        let place = |name: &str| raw.tree.place(&format!("factor.{name}"));
        if let Design::Table(table) = &study.design {
            let mut rows = Vec::new();
            for (k, row) in table.iter().enumerate() {
                let at = raw.tree.place(&format!("design.table.{k}"));
                let mut puts = Vec::new();
                for (name, _) in factors {
                    match row.0.iter().find(|(key, _)| key == name) {
                        Some((_, value)) => puts.push(Put::of(name, &value.0)),
                        None => self.files.desk.problem(
                            &at,
                            format!("the row has no `{name}`"),
                            "a value for every factor",
                            "",
                        ),
                    }
                }
                if let Some((other, _)) = row.0.iter().find(|(key, _)| factors.iter().all(|(name, _)| name != key)) {
                    let near = nearest(other, factors.iter().map(|(name, _)| name.as_str()));
                    let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
                    self.files.desk.problem(&at, format!("no factor is called `{other}`"), "not a factor", help);
                }
                rows.push(puts);
            }
            return self.files.desk.problems.is_empty().then_some(rows);
        }
        let drawn = match &study.design {
            Design::LatinHypercube(samples) | Design::Random(samples) => Some(samples.samples),
            _ => None,
        };
        let mut levels: Vec<Vec<Put>> = Vec::new();
        for (name, factor) in factors {
            let shares = |samples| draws(seed, name, samples, matches!(study.design, Design::LatinHypercube(_)));
            let own = match (drawn, &factor.range) {
                (_, Some(range))
                    if range.len() != 2 || !(range[0] <= range[1] && (range[1] - range[0]).is_finite()) =>
                {
                    let place = raw.tree.place(&format!("factor.{name}.range"));
                    self.files.desk.problem(&place, "`range` takes [least, greatest]", "two numbers in order", "");
                    continue;
                }
                (None, Some(_)) => {
                    let place = raw.tree.place(&format!("factor.{name}.range"));
                    let help = "give `values` or `steps`, or [design] random = { samples = 20 }";
                    self.files.desk.problem(&place, "a range is for designs that draw", "nothing is drawn here", help);
                    continue;
                }
                (Some(samples), Some(range)) => shares(samples)
                    .into_iter()
                    .map(|share| Put::drawn(name, factor, (range[0], range[1]), share, &place(name)))
                    .collect(),
                (drawn, None) => {
                    let own = self.levels(name, factor, &place(name))?;
                    let pick = |share: f64| own[((share * own.len() as f64) as usize).min(own.len() - 1)].clone();
                    match drawn {
                        None => own,
                        Some(samples) => shares(samples).into_iter().map(pick).collect(),
                    }
                }
            };
            levels.push(own);
        }
        if !self.files.desk.problems.is_empty() {
            return None;
        }
        let number: usize = match &study.design {
            Design::Full(_) => levels.iter().map(Vec::len).fold(1usize, usize::saturating_mul),
            _ => levels.first().map_or(1, Vec::len),
        };
        if number > MOST_CELLS {
            let what = format!("that would be {number} cells");
            self.files.desk.problem(&raw.tree.place("factor"), what, format!("at most {MOST_CELLS}"), "");
            return None;
        }
        if let Some(at) =
            (0..levels.len()).find(|&k| !matches!(study.design, Design::Full(_)) && levels[k].len() != number)
        {
            let what = format!("`{}` has {} levels and `{}` {number}", factors[at].0, levels[at].len(), factors[0].0);
            self.files.desk.problem(&place(&factors[at].0), what, "as many levels each", "");
            return None;
        }
        let full = matches!(study.design, Design::Full(_));
        // a level that is there twice would count its trials twice
        let twice = |own: &[Put]| {
            let mut there = HashSet::new();
            own.iter().position(|put| !there.insert(put.level.key()))
        };
        if let Some((at, k)) = (0..levels.len()).find_map(|at| Some((at, twice(&levels[at])?))).filter(|_| full) {
            let what = format!("`{}` has the level {} twice", factors[at].0, levels[at][k].level.text);
            self.files.desk.problem(&place(&factors[at].0), what, "each level once", "");
            return None;
        }
        let row = |k: usize| {
            let mut left = k;
            let mut row: Vec<Put> = Vec::with_capacity(count);
            // the last factor changes fastest
            for own in levels.iter().rev() {
                row.push(own[if full { left % own.len() } else { k }].clone());
                left /= own.len();
            }
            row.reverse();
            row
        };
        Some((0..number).map(row).collect())
    }
    /// The levels that a factor names.
    fn levels(&mut self, name: &str, factor: &Factor, place: &Span) -> Option<Vec<Put>> {
        let mut levels = Vec::new();
        match (&factor.values, &factor.steps) {
            (Some(values), None) => levels.extend(values.iter().map(|value| Put::of(name, &value.0))),
            (None, Some(steps)) => {
                let count = ((steps.to - steps.from) / steps.by + 1e-9).floor();
                if !(0.0..1e6).contains(&count) {
                    self.files.desk.problem(
                        place,
                        "the steps lead nowhere",
                        "`to` not below `from`, and not too far",
                        "",
                    );
                    return None;
                }
                let value = |k: usize| {
                    let value = steps.from + k as f64 * steps.by;
                    // 0.1 + 0.2 is meant to be 0.3
                    Put::number(name, (value * 1e12).round() / 1e12, place)
                };
                levels.extend((0..=count as usize).map(value));
            }
            (None, None) => {
                let level = |(text, _): &(String, crate::file::Anything)| {
                    let node = Node { tree: Tree::Text(text.clone()), span: place.clone() };
                    Put {
                        factor: name.to_owned(),
                        level: Level {
                            text: text.clone(),
                            number: text.parse().ok().filter(|number: &f64| number.is_finite()),
                        },
                        node,
                    }
                };
                levels.extend(factor.level.0.iter().map(level));
            }
            (Some(_), Some(_)) => {
                self.files.desk.problem(place, format!("`{name}` has values and steps"), "one of the two", "");
                return None;
            }
        }
        for (other, _) in &factor.level.0 {
            if levels.iter().all(|put: &Put| put.level.text != *other) {
                let texts = || levels.iter().map(|put| put.level.text.as_str());
                let help = match nearest(other, texts()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("its levels are {}", texts().collect::<Vec<_>>().join(", ")),
                };
                let what = format!("the factor `{name}` has no level `{other}`");
                self.files.desk.problem(place, what, "not one of its values or steps", help);
                return None;
            }
        }
        if let Some(put) = levels.iter().find(|put| put.level.number.is_some_and(|number| !number.is_finite())) {
            let what = format!("the factor `{name}` has the level {}", put.level.text);
            self.files.desk.problem(&put.node.span, what, "a finite number", "");
            return None;
        }
        if levels.is_empty() {
            let what = format!("the factor `{name}` has no levels");
            self.files.desk.problem(place, what, "needs `values`, `steps` or [factor.NAME.level.LEVEL] tables", "");
            return None;
        }
        Some(levels)
    }
}

/// A level on its way into a scenario.
#[derive(Clone, Debug)]
struct Put {
    factor: String,
    level: Level,
    node: Node,
}

impl Put {
    fn of(factor: &str, node: &Node) -> Self {
        let text = match &node.tree {
            Tree::Text(text) => text.clone(),
            tree @ (Tree::Number(_) | Tree::Whole(_) | Tree::Truth(_)) => tree.describe(),
            tree => tree.json().to_string(),
        };
        Self { factor: factor.to_owned(), level: Level { text, number: node.tree.number() }, node: node.clone() }
    }
    fn number(factor: &str, number: f64, place: &Span) -> Self {
        let node = Node { tree: tree_of(&Value::Number(number)), span: place.clone() };
        Self::of(factor, &node)
    }
    fn drawn(factor: &str, form: &Factor, (low, high): (f64, f64), share: f64, place: &Span) -> Self {
        let value = low + (high - low) * share;
        Self::number(factor, if form.whole { (value + 0.5).floor() } else { value }, place)
    }
    fn value(&self) -> Value {
        self.level.number.map_or_else(|| Value::Text(self.level.text.clone()), Value::Number)
    }
}

/// The number in a value that is not finite.
fn infinite(value: &Value) -> Option<f64> {
    match value {
        Value::Number(number) => (!number.is_finite()).then_some(*number),
        Value::List(list) => list.iter().find_map(infinite),
        Value::Truth(_) | Value::Text(_) => None,
    }
}

/// A share of a factor's range for each sample; `stratified`: of as many equal parts of the range, each sample has one to
/// itself.
fn draws(seed: u64, factor: &str, samples: usize, stratified: bool) -> Vec<f64> {
    let stream = XxHash64::oneshot(seed, factor.as_bytes());
    let within = (0..samples).map(|k| uniform(stream, Purpose::Search, k as u64, 0));
    if !stratified {
        return within.collect();
    }
    // the part whose draw has the rank of the sample: a random order of the parts
    let order: Vec<f64> = (0..samples).map(|k| uniform(stream, Purpose::Search, k as u64, 1)).collect();
    let mut ranked: Vec<usize> = (0..samples).collect();
    ranked.sort_by(|&a, &b| order[a].total_cmp(&order[b]));
    let mut shares: Vec<f64> = within.collect();
    for (rank, &sample) in ranked.iter().enumerate() {
        shares[sample] = (rank as f64 + shares[sample]) / samples as f64;
    }
    shares
}

/// What expressions of a cell may name: factors, definitions, paths of its scenario.
struct Surroundings<'a> {
    known: &'a [(String, Value)],
    tree: &'a Node,
    defaults: &'a Node,
}

impl Names for Surroundings<'_> {
    fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake> {
        if let Some(selector) = selectors.first() {
            let what = "levels are chosen in claims only; here every name has one value";
            return Err(Mistake::new(selector.bytes.clone(), what));
        }
        if let Some((_, value)) = self.known.iter().find(|(known, _)| known == name) {
            return Ok(value.clone());
        }
        let at = |tree: &Node| name.split('.').try_fold(tree.clone(), |node, part| node.get(part).cloned());
        if let Some(value) = at(self.tree).or_else(|| at(self.defaults)).and_then(|node| value_of(&node.tree)) {
            return Ok(value);
        }
        let near = nearest(name, self.known.iter().map(|(known, _)| known.as_str()));
        let help = near.map_or_else(
            || "names are factors, definitions and paths of the scenario, as group.fish.count".to_owned(),
            |near| format!("did you mean `{near}`?"),
        );
        Err(Mistake { help, ..Mistake::new(bytes.clone(), format!("unknown name `{name}`")) })
    }
}

fn value_of(tree: &Tree) -> Option<Value> {
    Some(match tree {
        Tree::Number(_) | Tree::Whole(_) => Value::Number(tree.number()?),
        Tree::Truth(truth) => Value::Truth(*truth),
        Tree::Text(text) => Value::Text(text.clone()),
        Tree::List(list) => Value::List(list.iter().map(|node| value_of(&node.tree)).collect::<Option<_>>()?),
        Tree::Table(_) => return None,
    })
}

pub(crate) fn tree_of(value: &Value) -> Tree {
    match value {
        Value::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => Tree::Whole(*number as i64),
        Value::Number(number) => Tree::Number(*number),
        Value::Truth(truth) => Tree::Truth(*truth),
        Value::Text(text) => Tree::Text(text.clone()),
        Value::List(list) => Tree::list(list.iter().map(tree_of)),
    }
}

/// Joins a table into another: what it says wins, tables are joined key by key.
fn join(under: &mut Node, over: &Node) {
    let (Tree::Table(entries), Tree::Table(own)) = (&mut under.tree, &over.tree) else {
        *under = over.clone();
        return;
    };
    for entry in own {
        match entries.iter_mut().find(|e| e.key == entry.key) {
            Some(there) => {
                there.span = entry.span.clone();
                // a choice written as a word stands for a table with that key
                if let (Tree::Text(word), Tree::Table(_)) = (&there.node.tree, &entry.node.tree) {
                    let empty = Node { tree: Tree::Table(Vec::new()), span: there.node.span.clone() };
                    let key = crate::file::tree::Entry { key: word.clone(), span: there.span.clone(), node: empty };
                    let alone = entry.node.get(word).is_some();
                    if alone {
                        there.node.tree = Tree::Table(vec![key]);
                    }
                }
                join(&mut there.node, &entry.node);
            }
            None => entries.push(entry.clone()),
        }
    }
}

/// Where the value of a key stands whose name may have dots.
pub(crate) fn entry_place(tree: &Node, table: &str, key: &str) -> Span {
    tree.get(table).and_then(|node| node.get(key)).map_or_else(|| tree.place(table), |node| node.span.clone())
}

/// The place of some bytes of a text that stands, in quotes, at a place.
pub(crate) fn within(sources: &Sources, place: &Span, bytes: &Range<usize>) -> Span {
    let written = sources.text(place.source).get(place.bytes.clone()).unwrap_or("");
    let quotes = if written.starts_with("\"\"\"") || written.starts_with("'''") { 3 } else { 1 };
    // an escape would shift the place; expressions have none
    let from = place.bytes.start + quotes + bytes.start;
    let end = (place.bytes.start + quotes + bytes.end).max(from + 1);
    if written.contains('\\') || end > place.bytes.end {
        return place.clone();
    }
    Span { source: place.source, bytes: from..end }
}

/// What is read where a study does not say: what the scenario measures, states, and contacts.
pub(crate) fn usual_readings(scenario: &Scenario) -> Vec<(String, Reading)> {
    let mut readings: Vec<(String, Reading)> = Vec::new();
    let mut add = |name: String, about: &str, unit: String, of: Quantity| {
        // groups of one model share its columns
        if readings.iter().all(|(other, _)| *other != name) {
            readings.push((name, Reading { about: about.to_owned(), unit, of }));
        }
    };
    for id in scenario.metrics() {
        let Some(card) = measure::metrics::LIST.iter().find(|card| card.id == id) else { continue };
        let known = |(name, _): &&(String, f64)| card.parameters.iter().any(|parameter| parameter.name == name);
        let parameters = Named(scenario.measure.parameters.0.iter().filter(known).cloned().collect());
        let statistic = Statistic::Mean;
        let of = MetricReading {
            id: id.clone(),
            parameters,
            scale: 1.0,
            group: None,
            statistic,
            at_least: None,
            at_most: None,
        };
        let of = Quantity::Metric(of);
        add(id, card.title, scenario.units.of(card.unit), of);
    }
    for (_, group) in &scenario.group.0 {
        let columns = swarm::models::find(&group.model.id).map_or(&[][..], |entry| (entry.columns)());
        for column in columns {
            let space::ColumnKind::Label(labels) = column.kind else { continue };
            for label in labels {
                let name = crate::run::tables::share_name(column.name, label);
                let of = Quantity::Share(ShareReading {
                    column: column.name.to_owned(),
                    state: (*label).to_owned(),
                    scale: 1.0,
                    of: Whose::Everyone,
                    group: None,
                    linking_distance: 25.0,
                });
                add(name, &format!("Share of members whose {} is {label}", column.name), String::new(), of);
            }
        }
    }
    let of = Quantity::Contacts(ContactReading { with: Partner::Anything, events: false, per_updates: None });
    add("contacts".to_owned(), "Contacts", String::new(), of);
    readings
}
