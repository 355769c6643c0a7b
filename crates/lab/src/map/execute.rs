//! Making a map: cell after cell, generation after generation, into one folder.
//!
//! Each evaluation ends as one record of an append-only log. Which cells there are follows from the plan and from what was found,
//! so that a stop at any moment loses what is in flight and nothing else, for any number of threads.

use super::measures::{CellResult, Found, PanelMap};
use super::plan::{Panel, Plan};
use super::{report, tables};
use crate::design::plan::TRIAL;
use crate::environment::trial;
use crate::environment::work::{Watch, packed, spread, unpacked};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::job::{File, Job, Kind};
use crate::store::log::{Log, Record};
use measure::statistics::Decision;
use search::refine::{Cell, Refinement};
use serde_json::json;
use space::random::child_seed;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use terrain::Construct;

/// The log of evaluations.
pub const LOG: &str = "evaluations.log";
/// The page.
pub const REPORT: &str = "report.html";
/// Kind of records: an evaluation.
const EVALUATED: u32 = 1;
/// Number that stands for the trials without a construct.
const CONTROL: u64 = u64::MAX;
/// Kind of child seeds: trials without a construct.
const BARE: u32 = 7;
/// Numbers set aside for the trials of one construct.
pub(crate) const TRIALS_OF_ONE: u64 = 100_000;

const KIND: Kind = Kind { name: "map", one: "a map", may_grow: "measures and statements" };

/// Results by panel and evaluation.
type There = BTreeMap<(u64, u64), CellResult>;

/// What became of a map.
#[derive(Clone, Debug)]
pub struct Done {
    /// Its folder.
    pub folder: PathBuf,
    /// Whether it is complete; else it was stopped.
    pub complete: bool,
    /// Evaluations made in this session.
    pub evaluations: usize,
    /// Seconds of this session.
    pub seconds: f64,
    /// Lines that say what came of it.
    pub lines: Vec<String>,
}

/// Reads the map of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    KIND.plan(path, |name, text, sets, quick, load| super::read(name, text, sets, quick, load))
}

/// Runs what is missing of a map.
///
/// # Errors
/// Where the folder is of something else, or the system refuses. What was done before stays.
pub fn run(
    plan: &Plan,
    threads: usize,
    out: Option<&Path>,
    program: &str,
    watch: &mut dyn Watch,
) -> Result<Done, StoreError> {
    let file = File {
        title: &plan.form.title,
        sources: &plan.sources,
        sets: &plan.sets,
        quick: plan.quick,
        identity: plan.identity(),
    };
    let mut job = Job::of_file(KIND, &file, out, (program, threads))?;
    let path = job.folder.path().to_owned();
    let (mut log, mut there) = opened(&job.folder)?;
    let before = there.len();
    watch.begin(&path, "evaluations", 0, before, threads);
    let began = std::time::Instant::now();
    let found = evaluate(plan, threads, &mut there, &mut log, watch);
    let seconds = began.elapsed().as_secs_f64();
    let evaluations = there.len() - before;
    job.note(&[("seconds", json!(seconds)), ("evaluations", json!(evaluations))]);
    job.end(matches!(found, Ok(Some(_))))?;
    let Some(found) = found? else {
        return Ok(Done { folder: path, complete: false, evaluations, seconds, lines: Vec::new() });
    };
    let lines = report::lines(&found);
    finish(&job.folder, &found, program)?;
    Ok(Done { folder: path, complete: true, evaluations, seconds, lines })
}

/// Makes tables and page of a complete folder anew.
///
/// # Errors
/// A folder that holds no complete map, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let (_, there) = opened(&folder)?;
    match replayed(&plan, &there)? {
        Some(found) => finish(&folder, &found, program),
        None => {
            let what = format!("`{}` is not complete; the same run command goes on", path.display());
            Err(StoreError::Refused(what))
        }
    }
}

fn finish(folder: &Folder, found: &Found<'_>, program: &str) -> Result<(), StoreError> {
    tables::write(folder, found)?;
    folder.write_text(REPORT, &crate::report::html(&report::page(found, program)))
}

fn opened(folder: &Folder) -> Result<(Log, There), StoreError> {
    let path = folder.file(LOG);
    let (mut log, records) = Log::resume(&path)?;
    let there = known(&mut log, &records, &path)?;
    Ok((log, there))
}

/// What is known of the map in a folder, as one looks at it: nothing is written.
pub struct Known(There);

impl Known {
    /// What the folder holds.
    ///
    /// # Errors
    /// One that cannot be read.
    pub fn of(path: &Path) -> Result<Self, StoreError> {
        let path = path.join(LOG);
        if !path.exists() {
            return Ok(Self(There::new()));
        }
        let (mut log, records) = Log::open_to_read(&path)?;
        Ok(Self(known(&mut log, &records, &path)?))
    }
    /// The panels, as far as they are refined.
    ///
    /// # Errors
    /// A plan that cannot begin.
    pub fn panels(&self, plan: &Plan) -> Result<Vec<PanelMap>, StoreError> {
        let mut maps = begun(plan)?;
        while missing(&maps, &self.0, false).is_empty() && told(plan, &mut maps, &self.0)? {}
        Ok(found(plan, maps, &self.0).panels)
    }
}

/// What the records of a log hold.
fn known(log: &mut Log, records: &[Record], path: &Path) -> Result<There, StoreError> {
    let mut there = There::new();
    for record in records.iter().filter(|record| record.kind == EVALUATED) {
        let &[panel, number, successes, trials, fitness] = unpacked(&log.read(record)?).as_slice() else {
            return Err(StoreError::Damaged(format!("a record in `{}` is no evaluation", path.display())));
        };
        there.insert((panel, number), CellResult { successes, trials, fitness: f64::from_bits(fitness) });
    }
    Ok(there)
}

fn words((panel, number): (u64, u64), result: CellResult) -> [u64; 5] {
    [panel, number, result.successes, result.trials, result.fitness.to_bits()]
}

/// A unit of work: panel, number of the evaluation, cell; without one the trials without a construct.
type Unit = (u64, u64, Option<Cell>);

fn refused(error: search::SearchError) -> StoreError {
    StoreError::Refused(error.to_string())
}

/// What is to be evaluated next: of each panel its generation, as far as it is not known.
fn missing(maps: &[Refinement], there: &There, control: bool) -> Vec<Unit> {
    let mut units: Vec<Unit> = Vec::new();
    for (panel, map) in maps.iter().enumerate() {
        let panel = panel as u64;
        if control && !there.contains_key(&(panel, CONTROL)) {
            units.push((panel, CONTROL, None));
        }
        let first = first_of(map);
        let new = map.cells().iter().enumerate().map(|(k, cell)| (panel, first + k as u64, Some(cell.clone())));
        units.extend(new.filter(|(panel, number, _)| !there.contains_key(&(*panel, *number))));
    }
    units
}

/// Number of the first evaluation of the present generation.
fn first_of(map: &Refinement) -> u64 {
    (map.evaluations().iter().sum::<usize>() - map.cells().len()) as u64
}

/// Tells each map what is known of its generation; whether any goes on.
fn told(plan: &Plan, maps: &mut [Refinement], there: &There) -> Result<bool, StoreError> {
    let mut goes_on = false;
    for (panel, map) in maps.iter_mut().enumerate() {
        let first = first_of(map);
        let result = |k: usize| there.get(&(panel as u64, first + k as u64)).copied().unwrap_or_default();
        let found = |k: usize| {
            let result = result(k);
            let valid = plan.form.valid.holds(result.successes, result.trials);
            search::refine::Found { valid, rate: result.rate() }
        };
        let all: Vec<search::refine::Found> = (0..map.cells().len()).map(found).collect();
        map.tell(&all).map_err(refused)?;
        goes_on |= !map.cells().is_empty();
    }
    Ok(goes_on)
}

fn begun(plan: &Plan) -> Result<Vec<Refinement>, StoreError> {
    plan.panels.iter().map(|_| plan.begin().map_err(refused)).collect()
}

fn found<'a>(plan: &'a Plan, maps: Vec<Refinement>, there: &There) -> Found<'a> {
    let panel = |(k, map): (usize, Refinement)| {
        let count: usize = map.evaluations().iter().sum();
        let results = (0..count as u64).map(|n| there.get(&(k as u64, n)).copied().unwrap_or_default()).collect();
        let control = there.get(&(k as u64, CONTROL)).copied().unwrap_or_default();
        PanelMap { map, results, control }
    };
    Found { plan, panels: maps.into_iter().enumerate().map(panel).collect() }
}

/// The maps from what is known alone; none where something is missing.
fn replayed<'a>(plan: &'a Plan, there: &There) -> Result<Option<Found<'a>>, StoreError> {
    let mut maps = begun(plan)?;
    loop {
        if !missing(&maps, there, plan.form.control_trials > 0).is_empty() {
            return Ok(None);
        }
        if !told(plan, &mut maps, there)? {
            return Ok(Some(found(plan, maps, there)));
        }
    }
}

/// Makes the maps; none where it was stopped.
fn evaluate<'a>(
    plan: &'a Plan,
    threads: usize,
    there: &mut There,
    log: &mut Log,
    watch: &mut dyn Watch,
) -> Result<Option<Found<'a>>, StoreError> {
    let mut maps = begun(plan)?;
    let stop = watch.stopper();
    loop {
        let units = missing(&maps, there, plan.form.control_trials > 0);
        watch.more(units.len());
        let work = |unit: &Unit, stop: &dyn Fn() -> bool| {
            let panel = &plan.panels[unit.0 as usize];
            match &unit.2 {
                Some(cell) => of_cell(plan, panel, &maps[unit.0 as usize].centre(cell), plan.seed_of(cell), stop),
                None => of_nothing(plan, panel, stop),
            }
        };
        let take = |unit: &Unit, (result, updates): (CellResult, u64)| {
            let key = (unit.0, unit.1);
            log.append(EVALUATED, &packed(words(key, result)))?;
            watch.done(updates);
            there.insert(key, result);
            Ok(())
        };
        if !spread(&units, threads, &stop, work, take)? {
            return Ok(None);
        }
        if !told(plan, &mut maps, there)? {
            return Ok(Some(found(plan, maps, there)));
        }
    }
}

/// The trials of one construct added to what is known; none where it was stopped.
fn tried(
    plan: &Plan,
    panel: &Panel,
    construct: &Construct,
    built: bool,
    trials: impl Iterator<Item = u64>,
    sum: &mut Sum,
    stop: &dyn Fn() -> bool,
) -> Result<Option<()>, String> {
    let behaviour =
        plan.behaviour(panel, construct, built).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?;
    let pieces = if built { construct.pieces.as_slice() } else { &[] };
    let geometry = plan.workspace.workspace.geometry.iter();
    let scenario = panel.population.among(geometry.chain(pieces.iter().flat_map(|piece| &piece.geometry)));
    let behaviours = [behaviour];
    for seed in trials {
        match trial::run(&scenario, &panel.population, &behaviours, seed, stop, &mut |_| ()) {
            // impossible with this seed: it counts as a failure
            Err(_) => sum.trials += 1,
            Ok(None) => return Ok(None),
            Ok(Some(tried)) => {
                sum.trials += 1;
                sum.updates += tried.steps * panel.population.members() as u64;
                for outcome in &tried.outcomes {
                    sum.fitness += outcome.fitness;
                    sum.successes += u64::from(outcome.fitness >= plan.form.success);
                }
            }
        }
        if let Some(test) = plan.sequential.as_ref().filter(|_| built)
            && test.decide(sum.successes as u32, sum.trials as u32) != Decision::Continue
        {
            sum.decided = true;
            break;
        }
    }
    Ok(Some(()))
}

#[derive(Default)]
struct Sum {
    successes: u64,
    trials: u64,
    fitness: f64,
    updates: u64,
    decided: bool,
}

impl Sum {
    fn result(self) -> (CellResult, u64) {
        let fitness = self.fitness / self.trials as f64;
        (CellResult { successes: self.successes, trials: self.trials, fitness }, self.updates)
    }
}

/// What is found at a point.
fn of_cell(
    plan: &Plan,
    panel: &Panel,
    point: &[f64],
    seed: u64,
    stop: &dyn Fn() -> bool,
) -> Result<Option<(CellResult, u64)>, String> {
    let mut sum = Sum::default();
    for attempt in 0..plan.form.constructs as u64 {
        // outside the schema's domain there is nothing to try
        let Ok(construct) = plan.construct(panel, point, seed, attempt) else { break };
        let trials =
            (1..=plan.trials as u64).map(|trial| child_seed(seed, TRIAL, attempt * TRIALS_OF_ONE + trial, 0) >> 1);
        if tried(plan, panel, &construct, true, trials, &mut sum, stop)?.is_none() {
            return Ok(None);
        }
        if sum.decided {
            break;
        }
    }
    Ok(Some(sum.result()))
}

/// What is found without a construct.
fn of_nothing(plan: &Plan, panel: &Panel, stop: &dyn Fn() -> bool) -> Result<Option<(CellResult, u64)>, String> {
    let mut sum = Sum::default();
    let nothing = Construct::new(plan.workspace.workspace.units, Vec::new());
    let trials = (1..=plan.form.control_trials as u64).map(|trial| child_seed(plan.form.seed, BARE, trial, 0) >> 1);
    let done = tried(plan, panel, &nothing, false, trials, &mut sum, stop)?;
    Ok(done.map(|()| sum.result()))
}
