//! How good candidates are: worlds of their own, or one that they share.

use super::plan::{Plan, SharedWorld};
use crate::file::{Desk, Node, Tree};
use crate::scenario::Scenario;
use crate::scenario::agents::Given;
use crate::scenario::build;
use crate::study::expression::{Expression, Mistake, Names, Selector, Value};
use crate::study::plan::{Condition, tree_of};
use crate::study::trial;
use crate::with_types;
use core::ops::Range;
use space::random::child_seed;
use space::spelling::nearest;
use std::sync::atomic::{AtomicUsize, Ordering};
use swarm::World;
use swarm::models::{Catalogue, Models};
use swarm::parameters::{Scalar, Value as Parameter};

/// Kinds of child seeds, beside those that `search` derives: the world of a generation, the worlds of the stages.
const WORLD: u32 = 2;
const CONFIRM: u32 = 3;
const CHOOSE: u32 = 4;
const CONTEST: u32 = 5;

/// Steps between two questions whether to stop.
const ASKED: u64 = 64;

/// What was found out of a generation.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// How good each candidate is, `[candidates]`; not a number where its world is impossible.
    pub scores: Vec<f64>,
    /// What is kept: `[candidates][readings]` of worlds of their own, one row of a shared world.
    pub kept: Vec<Vec<f64>>,
    /// Of what kind each candidate is, `[candidates][kinds]`.
    pub kinds: Vec<Vec<f64>>,
}

/// Finds out how good the candidates of a generation are. None where it was stopped.
///
/// # Errors
/// What makes a shared world impossible with its seed; and a fitness that has no value.
pub fn generation(
    plan: &Plan,
    run: usize,
    number: u64,
    candidates: &[Vec<f64>],
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Evaluated>, String> {
    let seed = plan.seed_of(run);
    match &plan.shared {
        Some(shared) => {
            let scenario = owned(plan, shared, candidates);
            let end = ended(plan, &scenario, world_seed(seed, number), stop)?;
            end.map(|end| {
                let mut evaluated = of_shared(plan, shared, &end)?;
                if shared.rival.is_some() {
                    evaluated.scores.extend(scores_of(plan, shared, &Ended::rival(shared, &end))?);
                }
                Ok(evaluated)
            })
            .transpose()
        }
        None => own_worlds(plan, candidates, plan.form.trials, threads, stop, |trial| seed.wrapping_add(trial as u64)),
    }
}

/// The seed of the world that the candidates of a generation share.
pub fn world_seed(seed: u64, generation: u64) -> u64 {
    child_seed(seed, WORLD, generation, 0)
}

/// For what candidates are tried again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// The last candidates, to find the champion of a run.
    Confirm,
    /// Candidates that no search found, to choose the best.
    Choose,
    /// Contenders, to compare them.
    Contest,
}

impl Stage {
    /// Key of its child seeds.
    fn key(self) -> u32 {
        match self {
            Self::Confirm => CONFIRM,
            Self::Choose => CHOOSE,
            Self::Contest => CONTEST,
        }
    }
}

/// Tries candidates in worlds with seeds that nothing else had, the same for all; who shared a world has the whole group.
/// Score and what is kept, `[candidates][worlds][1 + kept]`; none where it was stopped. `run` counts from 1.
///
/// # Errors
/// As [`generation`].
pub fn tried(
    plan: &Plan,
    (stage, run): (Stage, usize),
    candidates: &[Vec<f64>],
    worlds: usize,
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<Vec<Vec<f64>>>>, String> {
    let seed = |world: usize| child_seed(plan.seed_of(run), stage.key(), world as u64, 0);
    let one = |candidate: &Vec<f64>, world: usize| {
        let evaluated = match &plan.shared {
            Some(shared) => {
                let scenario = owned(plan, shared, &vec![candidate.clone(); shared.candidates]);
                let Some(end) = ended(plan, &scenario, seed(world), stop)? else { return Ok(None) };
                of_shared(plan, shared, &end)?
            }
            None => match own_worlds(plan, core::slice::from_ref(candidate), 1, 1, stop, |_| seed(world))? {
                Some(evaluated) => evaluated,
                None => return Ok(None),
            },
        };
        let score = evaluated.scores.iter().sum::<f64>() / evaluated.scores.len() as f64;
        Ok(Some([&[score][..], &evaluated.kept[0]].concat()))
    };
    let units = candidates.len() * worlds;
    let done = in_parallel(units, threads, |unit| one(&candidates[unit / worlds], unit % worlds))?;
    Ok(done.map(|rows| rows.chunks(worlds).map(<[Vec<f64>]>::to_vec).collect()))
}

/// The numbers that are followed, of a candidate; not a number where one has no value.
pub fn followed(plan: &Plan, genes: &[f64]) -> Vec<f64> {
    plan.follow.iter().map(|(_, expression)| number(expression, &Genes { plan, genes })).collect()
}

/// Does so many units on some threads; their results in order, none where one has none.
///
/// # Errors
/// That of the first unit that has one.
fn in_parallel<T: Send>(
    units: usize,
    threads: usize,
    work: impl Fn(usize) -> Result<Option<T>, String> + Sync,
) -> Result<Option<Vec<T>>, String> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut done = Vec::new();
        loop {
            let unit = next.fetch_add(1, Ordering::Relaxed);
            if unit >= units {
                return done;
            }
            let result = work(unit);
            let last = !matches!(result, Ok(Some(_)));
            done.push((unit, result));
            if last {
                // one that failed or was stopped ends it for all
                next.store(units, Ordering::Relaxed);
                return done;
            }
        }
    };
    let mut done = if threads.min(units) < 2 {
        worker()
    } else {
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads.min(units)).map(|_| scope.spawn(worker)).collect();
            workers.into_iter().flat_map(|worker| worker.join().unwrap_or_default()).collect()
        })
    };
    done.sort_by_key(|(unit, _)| *unit);
    let mut results = Vec::with_capacity(units);
    let mut stopped = false;
    for (_, result) in done {
        match result? {
            Some(result) => results.push(result),
            None => stopped = true,
        }
    }
    Ok((!stopped && results.len() == units).then_some(results))
}

/// The condition of a candidate: its genes put into the scenario.
///
/// # Errors
/// What makes it impossible, in a sentence.
pub fn condition(plan: &Plan, genes: &[f64]) -> Result<Condition, String> {
    let mut tree = plan.tree.clone();
    let put = |tree: &mut Node, path: &str, value: Tree| {
        let node = Node { tree: value, span: tree.span.clone() };
        tree.set(path, node).map_err(|what| format!("{path}: {what}"))
    };
    for ((_, gene), value) in plan.form.gene.0.iter().zip(plan.values(genes)) {
        if let Some(path) = &gene.path {
            put(&mut tree, path, value)?;
        }
    }
    for (path, expression) in &plan.derive {
        let value = expression.value(&Genes { plan, genes }).map_err(|mistake| format!("{path}: {}", mistake.what))?;
        put(&mut tree, path, tree_of(&value))?;
    }
    let mut desk = Desk::default();
    let Some(scenario) = build::read_tree(&tree, &mut desk) else {
        return Err(desk.problems.first().map_or_else(|| "impossible".to_owned(), |problem| problem.what.clone()));
    };
    let schedule = build::schedule(&scenario, false).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?;
    let agents = scenario.group.0.iter().map(|(_, group)| group.count as u64).sum();
    // a candidate is known by its place in its generation: it needs no identity
    Ok(Condition { scenario, tree, identity: serde_json::Value::Null, key: [0; 2], schedule, agents, trials: 1 })
}

/// Worlds of each candidate's own. A candidate whose world is impossible has no score.
fn own_worlds(
    plan: &Plan,
    candidates: &[Vec<f64>],
    trials: usize,
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
    seed: impl Fn(usize) -> u64 + Sync,
) -> Result<Option<Evaluated>, String> {
    let conditions: Vec<Option<Condition>> = candidates.iter().map(|genes| condition(plan, genes).ok()).collect();
    let missing = || vec![f64::NAN; plan.readings.readings.len()];
    let read = in_parallel(candidates.len() * trials, threads, |unit| {
        let Some(condition) = &conditions[unit / trials] else { return Ok(Some(missing())) };
        match trial::run(&plan.readings, condition, seed(unit % trials + 1), &|| stop()) {
            // impossible with this seed
            Err(_) => Ok(Some(missing())),
            read => read,
        }
    })?;
    let Some(read) = read else { return Ok(None) };
    let mut evaluated = Evaluated { scores: Vec::new(), kept: Vec::new(), kinds: Vec::new() };
    for (genes, trials) in candidates.iter().zip(read.chunks(trials)) {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let of = |expression: &Expression| {
            let values: Vec<f64> =
                trials.iter().map(|read| number(expression, &Readings { plan, genes, read })).collect();
            mean(&values)
        };
        evaluated.scores.push(of(&plan.fitness));
        evaluated.kinds.push(plan.kinds.iter().map(|(_, expression)| of(expression)).collect());
        let reading = |k: usize| mean(&trials.iter().map(|read| read[k]).collect::<Vec<_>>());
        evaluated.kept.push((0..plan.readings.readings.len()).map(reading).collect());
    }
    Ok(Some(evaluated))
}

/// The number that an expression gives; not a number where it gives none.
fn number(expression: &Expression, names: &dyn Names) -> f64 {
    expression.value(names).ok().and_then(|value| value.number()).unwrap_or(f64::NAN)
}

/// What is wrong with fitness, kinds and what is kept, by key of the file.
pub fn check(plan: &Plan) -> Vec<(String, Mistake)> {
    let mut mistakes = Vec::new();
    let genes = plan.reference();
    for (name, expression) in &plan.follow {
        match expression.value(&Genes { plan, genes: &genes }) {
            Ok(Value::Number(_)) => {}
            Ok(other) => {
                let what = format!("it gives {}, not a number", other.describe());
                mistakes.push((format!("follow.{name}"), Mistake::new(0..0, what)));
            }
            Err(mistake) => mistakes.push((format!("follow.{name}"), mistake)),
        }
    }
    let Some(shared) = &plan.shared else {
        let read = vec![1.0; plan.readings.readings.len()];
        let mut ask = |key: String, expression: &Expression| match expression.value(&Readings {
            plan,
            genes: &genes,
            read: &read,
        }) {
            Ok(Value::Number(_)) => {}
            Ok(other) => {
                mistakes.push((key, Mistake::new(0..0, format!("it gives {}, not a number", other.describe()))))
            }
            Err(mistake) => mistakes.push((key, mistake)),
        };
        ask("fitness".to_owned(), &plan.fitness);
        for (name, expression) in &plan.kinds {
            ask(format!("search.map_elites.kind.{name}.of"), expression);
        }
        if let Err(what) = condition(plan, &genes) {
            mistakes.push(("gene".to_owned(), Mistake::new(0..0, format!("with the references: {what}"))));
        }
        return mistakes;
    };
    let scenario = owned(plan, shared, &vec![plan.reference(); shared.candidates]);
    // the columns are there from the start
    let start = with_types!(scenario, R, D => begun::<R, D>(&scenario, plan.seed_of(1)).map(|(end, _)| end));
    let end = match start {
        Ok(end) => end,
        Err(what) => return vec![("gene".to_owned(), Mistake::new(0..0, format!("with the references: {what}")))],
    };
    if let Err(mistake) = member_scores(plan, shared, &Ended::own(shared, &end)) {
        mistakes.push(("fitness".to_owned(), mistake));
    }
    for (name, expression) in &plan.keep {
        match expression.value(&Ended::own(shared, &end)) {
            Ok(Value::Number(_)) => {}
            Ok(other) => {
                let what = format!("it gives {}, not a number", other.describe());
                mistakes.push((format!("keep.{name}"), Mistake::new(0..0, what)));
            }
            Err(mistake) => mistakes.push((format!("keep.{name}"), mistake)),
        }
    }
    mistakes
}

/// The scenario of a shared world, in which the members of each candidate have its genes. Candidates beyond those of the group
/// are those of its rival, which stays as it is without them.
pub fn owned(plan: &Plan, shared: &SharedWorld, candidates: &[Vec<f64>]) -> Scenario {
    let mut scenario = plan.scenario.clone();
    let groups = core::iter::once(shared.group).chain(shared.rival);
    for (group, candidates) in groups.zip(candidates.chunks(shared.candidates)) {
        let model = &mut scenario.group.0[group].1.model;
        let values: Vec<Vec<Tree>> = candidates.iter().map(|genes| plan.values(genes)).collect();
        for (k, name) in shared.parameters.iter().enumerate() {
            model.parameters.retain(|(other, _)| other != name);
            let each = values.iter().flat_map(|own| std::iter::repeat_n(parameter(&own[k]), shared.members));
            model.parameters.push((name.clone(), Given::Value(Parameter::List(each.collect()))));
        }
    }
    scenario
}

fn parameter(tree: &Tree) -> Parameter {
    match tree {
        Tree::List(list) => Parameter::List(list.iter().map(|node| parameter(&node.tree)).collect()),
        tree => Parameter::Number(tree.number().unwrap_or(f64::NAN)),
    }
}

/// What is known of a world at its end, by member.
#[derive(Clone, Debug)]
struct End {
    /// Name, first member and number of each group.
    groups: Vec<(String, usize, usize)>,
    /// Columns by name, `[agents]`; a group that does not have one has what is not a number.
    columns: Vec<(String, Vec<f64>)>,
}

/// Name of the number of items that a member has consumed.
const MEALS: &str = "meals";

fn begun<R: Scalar, const D: usize>(scenario: &Scenario, seed: u64) -> Result<(End, World<R, D>), String>
where
    Models: Catalogue<R, D>,
{
    let world = build::world::<R, D>(scenario, seed, 1)?;
    Ok((end_of(&world, vec![0.0; world.frame().columns.len()]), world))
}

/// Runs a world to its end. None where it was stopped.
fn ended(plan: &Plan, scenario: &Scenario, seed: u64, stop: &dyn Fn() -> bool) -> Result<Option<End>, String> {
    fn run<R: Scalar, const D: usize>(
        scenario: &Scenario,
        steps: u64,
        seed: u64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<End>, String>
    where
        Models: Catalogue<R, D>,
    {
        let (_, mut world) = begun::<R, D>(scenario, seed)?;
        let mut meals = vec![0.0; world.frame().columns.len()];
        for step in 0..steps {
            if step % ASKED == 0 && stop() {
                return Ok(None);
            }
            world.step();
            for &eater in world.resources().iter().flat_map(|resources| resources.consumer.iter().flatten()) {
                meals[eater as usize] += 1.0;
            }
        }
        Ok(Some(end_of(&world, meals)))
    }
    with_types!(scenario, R, D => run::<R, D>(scenario, plan.schedule.steps, seed, stop))
}

fn end_of<R: Scalar, const D: usize>(world: &World<R, D>, meals: Vec<f64>) -> End {
    let frame = world.frame();
    let rows = frame.rows_by_id();
    let column = |k: usize| rows.iter().map(|&row| frame.columns.state[k][row].to_f64()).collect();
    let mut columns: Vec<(String, Vec<f64>)> =
        frame.declared.iter().enumerate().map(|(k, declared)| (declared.name.to_owned(), column(k))).collect();
    columns.push((MEALS.to_owned(), meals));
    let group = |group: &space::GroupRange| (group.name.clone(), group.first as usize, group.count as usize);
    End { groups: frame.groups.iter().map(group).collect(), columns }
}

/// Scores of the members of a group, from its side.
fn member_scores(plan: &Plan, shared: &SharedWorld, names: &Ended<'_>) -> Result<Vec<f64>, Mistake> {
    let value = plan.fitness.value(names)?;
    let numbers = match &value {
        Value::Number(number) => Some(vec![*number; shared.count]),
        Value::List(list) => list.iter().map(Value::number).collect::<Option<Vec<f64>>>(),
        _ => None,
    };
    numbers.filter(|numbers| numbers.len() == shared.count).ok_or_else(|| {
        let what = format!("it gives {}, not a number for each of {} members", value.describe(), shared.count);
        Mistake::new(0..0, what)
    })
}

/// Scores of the candidates of a group, from its side.
fn scores_of(plan: &Plan, shared: &SharedWorld, names: &Ended<'_>) -> Result<Vec<f64>, String> {
    let scores = member_scores(plan, shared, names).map_err(|mistake| format!("fitness: {}", mistake.what))?;
    Ok(scores.chunks(shared.members).map(|own| own.iter().sum::<f64>() / own.len() as f64).collect())
}

fn of_shared(plan: &Plan, shared: &SharedWorld, end: &End) -> Result<Evaluated, String> {
    let names = Ended::own(shared, end);
    Ok(Evaluated {
        scores: scores_of(plan, shared, &names)?,
        kept: vec![plan.keep.iter().map(|(_, expression)| number(expression, &names)).collect()],
        kinds: Vec::new(),
    })
}

/// Names of the genes.
struct Genes<'a> {
    plan: &'a Plan,
    genes: &'a [f64],
}

impl Names for Genes<'_> {
    fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake> {
        if let Some(selector) = selectors.first() {
            return Err(Mistake::new(selector.bytes.clone(), "a gene has one value"));
        }
        let known = self.plan.form.gene.0.iter().position(|(other, _)| other == name);
        let of = |tree: Tree| match tree {
            Tree::List(list) => Value::List(list.iter().filter_map(|n| n.tree.number()).map(Value::Number).collect()),
            tree => Value::Number(tree.number().unwrap_or(f64::NAN)),
        };
        // an entry of a list of genes has a name of its own
        let axis = self.plan.axes.iter().position(|axis| axis.name == name);
        match (known, axis) {
            (Some(gene), _) => Ok(of(self.plan.values(self.genes).swap_remove(gene))),
            (None, Some(axis)) => Ok(Value::Number(self.genes[axis])),
            (None, None) => {
                let genes = self.plan.form.gene.0.iter().map(|(name, _)| name.as_str());
                let axes = self.plan.axes.iter().filter(|axis| axis.place.is_some()).map(|axis| axis.name.as_str());
                Err(unknown(name, genes.chain(axes), bytes))
            }
        }
    }
}

/// Names of what was read off a world, and of genes.
struct Readings<'a> {
    plan: &'a Plan,
    genes: &'a [f64],
    read: &'a [f64],
}

impl Names for Readings<'_> {
    fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake> {
        let readings = &self.plan.readings.readings;
        match readings.iter().position(|(other, _)| other == name) {
            Some(_) if !selectors.is_empty() => {
                Err(Mistake::new(selectors[0].bytes.clone(), "a reading of one world has one value"))
            }
            Some(at) => Ok(Value::Number(self.read[at])),
            None => Genes { plan: self.plan, genes: self.genes }.value(name, selectors, bytes).map_err(|mistake| {
                let genes = self.plan.form.gene.0.iter().map(|(name, _)| name.as_str());
                let known = readings.iter().map(|(name, _)| name.as_str()).chain(genes);
                if mistake.bytes == *bytes { unknown(name, known, bytes) } else { mistake }
            }),
        }
    }
}

/// Names of what is known of a shared world at its end.
struct Ended<'a> {
    end: &'a End,
    /// The group whose members are meant where none is named.
    group: usize,
    /// Groups whose names are exchanged.
    exchanged: Option<(usize, usize)>,
}

impl<'a> Ended<'a> {
    /// As the group sees it.
    fn own(shared: &SharedWorld, end: &'a End) -> Self {
        Self { end, group: shared.group, exchanged: None }
    }
    /// As its rival sees it.
    fn rival(shared: &SharedWorld, end: &'a End) -> Self {
        let rival = shared.rival.unwrap_or(shared.group);
        Self { end, group: rival, exchanged: Some((shared.group, rival)) }
    }
}

impl Names for Ended<'_> {
    fn value(&self, name: &str, selectors: &[Selector], bytes: &Range<usize>) -> Result<Value, Mistake> {
        let Some((_, column)) = self.end.columns.iter().find(|(other, _)| other == name) else {
            return Err(unknown(name, self.end.columns.iter().map(|(name, _)| name.as_str()), bytes));
        };
        let group = match selectors {
            [] => self.group,
            [Selector { factor, level: Value::Text(wanted), bytes }] if factor == "group" => {
                let groups = &self.end.groups;
                let named = groups
                    .iter()
                    .position(|(other, ..)| other == wanted)
                    .ok_or_else(|| unknown(wanted, groups.iter().map(|(name, ..)| name.as_str()), bytes))?;
                match self.exchanged {
                    Some((own, rival)) if named == own => rival,
                    Some((own, rival)) if named == rival => own,
                    _ => named,
                }
            }
            [selector, ..] => {
                let what = "members are chosen by their group alone, as in health[group = red]";
                return Err(Mistake::new(selector.bytes.clone(), what));
            }
        };
        let (_, first, count) = &self.end.groups[group];
        Ok(Value::List(column[*first..first + count].iter().map(|&value| Value::Number(value)).collect()))
    }
}

fn unknown<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone, bytes: &Range<usize>) -> Mistake {
    let help = match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known are {}", known.collect::<Vec<_>>().join(", ")),
    };
    Mistake { help, ..Mistake::new(bytes.clone(), format!("unknown name `{name}`")) }
}
