//! Running a decomposition: fragment after fragment at heading after heading, into one folder.
//!
//! Each approach ends as one record of an append-only log, under its number in the plan. So a stop at any moment loses what is in
//! flight and nothing else, for any number of threads.

use super::directed::{Found, variations};
use super::plan::{Plan, Probe};
use super::probe::{Descriptor, NUMBERS, Sum, Watch};
use super::results::Results;
use super::{primitives, report, tables};
use crate::environment::trial;
use crate::environment::work::{self, packed, spread, unpacked};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::job::{File, Job, Kind};
use crate::store::log::{Log, Record};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The log of approaches.
pub const LOG: &str = "approaches.log";
/// The page.
pub const REPORT: &str = "report.html";
/// Kinds of records: an approach, a variation.
const TRIED: u32 = 1;
const VARIED: u32 = 2;

const KIND: Kind =
    Kind { name: "decomposition", one: "a decomposition", may_grow: "statements, and how clusters are made and named" };

/// What is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Unit {
    /// An approach by its number; the empty arena of each window comes after them.
    Approach(usize),
    /// A stretch, and the number of the variation.
    Variation(usize, usize),
}

/// What was found of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    /// None where nobody came into the arena.
    Approach(Option<Descriptor>),
    Variation(Found),
}

type There = BTreeMap<Unit, Of>;

/// What became of a decomposition.
#[derive(Clone, Debug)]
pub struct Done {
    /// Its folder.
    pub folder: PathBuf,
    /// Whether it is complete; else it was stopped.
    pub complete: bool,
    /// Approaches tried in this session.
    pub approaches: usize,
    /// Seconds of this session.
    pub seconds: f64,
    /// Lines that say what came of it.
    pub lines: Vec<String>,
}

/// Reads the decomposition of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    KIND.plan(path, |name, text, sets, quick, load| super::read(name, text, sets, quick, load))
}

/// What is known of a decomposition, complete or not.
pub struct Known(There);

impl Known {
    /// What can be told of it so far.
    pub fn results<'a>(&self, plan: &'a Plan) -> Results<'a> {
        results(plan, &self.0)
    }
    /// How many approaches were tried.
    pub fn tried(&self, plan: &Plan) -> usize {
        (0..plan.approaches()).filter(|&number| self.0.contains_key(&Unit::Approach(number))).count()
    }
}

/// What is known of a decomposition in its folder, complete or not, as one looks at it.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn look(path: &Path) -> Result<(Plan, Known), StoreError> {
    let plan = of_folder(path)?;
    let path = path.join(LOG);
    let mut there = There::new();
    if path.exists() {
        let (mut log, records) = Log::open_to_read(&path)?;
        there = known(&mut log, &records, &path)?;
    }
    Ok((plan, Known(there)))
}

/// Runs what is missing of a decomposition.
///
/// # Errors
/// Where the folder is of something else, or the system refuses. What was done before stays.
pub fn run(
    plan: &Plan,
    threads: usize,
    out: Option<&Path>,
    program: &str,
    watch: &mut dyn work::Watch,
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
    let units = missing(plan, &there);
    watch.begin(&path, "approaches", units.len(), before, threads);
    let began = std::time::Instant::now();
    let stop = watch.stopper();
    let work = |unit: &Unit, stop: &dyn Fn() -> bool| match *unit {
        Unit::Approach(number) => Ok(tried(plan, number, stop)?.map(|(found, updates)| (Of::Approach(found), updates))),
        Unit::Variation(marked, number) => {
            Ok(plan.vary(marked, number, stop)?.map(|(found, updates)| (Of::Variation(found), updates)))
        }
    };
    let take = |unit: &Unit, (found, updates): (Of, u64)| {
        let (kind, words) = words(*unit, found);
        log.append(kind, &packed(words))?;
        watch.done(updates);
        there.insert(*unit, found);
        Ok(())
    };
    let complete = spread(&units, threads, &stop, work, take);
    let seconds = began.elapsed().as_secs_f64();
    let approaches = there.len() - before;
    job.note(&[("seconds", json!(seconds)), ("approaches", json!(approaches))]);
    job.end(matches!(complete, Ok(true)))?;
    if !complete? {
        return Ok(Done { folder: path, complete: false, approaches, seconds, lines: Vec::new() });
    }
    let results = results(plan, &there);
    finish(&job.folder, &results, program)?;
    Ok(Done { folder: path, complete: true, approaches, seconds, lines: report::lines(&results) })
}

/// Makes tables and page of a complete folder anew.
///
/// # Errors
/// A folder that holds no complete decomposition, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let (_, there) = opened(&folder)?;
    if !missing(&plan, &there).is_empty() {
        let what = format!("`{}` is not complete; the same run command goes on", path.display());
        return Err(StoreError::Refused(what));
    }
    finish(&folder, &results(&plan, &there), program)
}

fn finish(folder: &Folder, results: &Results<'_>, program: &str) -> Result<(), StoreError> {
    tables::write(folder, results)?;
    primitives::write(folder, results)?;
    folder.write_text(REPORT, &crate::report::html(&report::page(results, program)))
}

fn opened(folder: &Folder) -> Result<(Log, There), StoreError> {
    let path = folder.file(LOG);
    let (mut log, records) = Log::resume(&path)?;
    let there = known(&mut log, &records, &path)?;
    Ok((log, there))
}

/// What the records of a log hold.
fn known(log: &mut Log, records: &[Record], path: &Path) -> Result<There, StoreError> {
    let damaged = || StoreError::Damaged(format!("a record in `{}` is no approach", path.display()));
    let mut there = There::new();
    for record in records {
        let words = unpacked(&log.read(record)?);
        let (unit, found) = match (record.kind, words.as_slice()) {
            (TRIED, &[number]) => (Unit::Approach(number as usize), Of::Approach(None)),
            (TRIED, [number, numbers @ ..]) if numbers.len() == NUMBERS.len() => {
                let descriptor = core::array::from_fn(|k| f64::from_bits(numbers[k]));
                (Unit::Approach(*number as usize), Of::Approach(Some(descriptor)))
            }
            (VARIED, &[marked, number, successes, trials]) => {
                let unit = Unit::Variation(marked as usize, number as usize);
                (unit, Of::Variation(Found { successes, trials }))
            }
            (TRIED | VARIED, _) => return Err(damaged()),
            _ => continue,
        };
        there.insert(unit, found);
    }
    Ok(there)
}

fn words(unit: Unit, found: Of) -> (u32, Vec<u64>) {
    let mut words = match unit {
        Unit::Approach(number) => vec![number as u64],
        Unit::Variation(marked, number) => vec![marked as u64, number as u64],
    };
    match found {
        Of::Approach(found) => words.extend(found.into_iter().flatten().map(f64::to_bits)),
        Of::Variation(found) => words.extend([found.successes, found.trials]),
    }
    (if matches!(unit, Unit::Approach(_)) { TRIED } else { VARIED }, words)
}

fn missing(plan: &Plan, there: &There) -> Vec<Unit> {
    let approaches = (0..plan.approaches() + plan.form.windows.len()).map(Unit::Approach);
    let count = variations(&plan.form.vary);
    let varied =
        (0..plan.marked.len()).flat_map(|marked| (0..count).map(move |number| Unit::Variation(marked, number)));
    approaches.chain(varied).filter(|unit| !there.contains_key(unit)).collect()
}

fn results<'a>(plan: &'a Plan, there: &There) -> Results<'a> {
    let of = |number: usize| match there.get(&Unit::Approach(number)) {
        Some(Of::Approach(found)) => *found,
        _ => None,
    };
    let varied = |marked: usize, number: usize| match there.get(&Unit::Variation(marked, number)) {
        Some(Of::Variation(found)) => *found,
        _ => Found::default(),
    };
    let controls = (0..plan.form.windows.len()).map(|k| of(plan.approaches() + k)).collect();
    let count = variations(&plan.form.vary);
    let varied =
        (0..plan.marked.len()).map(|marked| (0..count).map(|number| varied(marked, number)).collect()).collect();
    Results::new(plan, (0..plan.approaches()).map(of).collect(), controls, varied)
}

/// One trial, with the steps it took; none where it was stopped.
///
/// # Errors
/// What its seed makes impossible.
pub fn once(plan: &Plan, probe: &Probe, seed: u64, stop: &dyn Fn() -> bool) -> Result<Option<(Watch, u64)>, String> {
    let scenario = plan.population.among(&probe.geometry);
    let mut watch = Watch::new(probe.arena, plan.population.members());
    let steps = trial::follow(&scenario, &plan.population, seed, stop, &mut |moment| watch.step(moment.positions))?;
    Ok(steps.map(|steps| (watch, steps)))
}

/// All trials of an approach, or of an empty arena.
fn tried(plan: &Plan, unit: usize, stop: &dyn Fn() -> bool) -> Result<Option<(Option<Descriptor>, u64)>, String> {
    let mut sum = Sum::default();
    let mut updates = 0;
    let mut one = |probe: &Probe, trial: usize| {
        match once(plan, probe, plan.seed_of(trial), stop) {
            // impossible with this seed: it tells nothing
            Err(_) => {}
            Ok(None) => return false,
            Ok(Some((watch, steps))) => {
                watch.add_to(&mut sum);
                updates += steps * plan.population.members() as u64;
            }
        }
        true
    };
    let complete = match unit.checked_sub(plan.approaches()) {
        None => (0..plan.form.offsets).all(|offset| {
            let probe = plan.probe(unit, offset);
            (1..=plan.trials).all(|trial| one(&probe, trial))
        }),
        Some(window) => {
            let probe = plan.empty(plan.form.windows[window]);
            (1..=plan.control_trials()).all(|trial| one(&probe, trial))
        }
    };
    Ok(complete.then(|| (sum.descriptor(), updates)))
}
