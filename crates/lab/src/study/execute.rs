//! Running a study: what is missing, on all cores, into one folder.
//!
//! Each trial runs on one thread and ends as one record of an append-only log. So a stop at any moment loses the trials in
//! flight and nothing else, and a study has five files however many trials it has. Tables and page are made from the log
//! alone, in the order of the plan: they have the same bytes for any number of threads, stops and shards.

use super::claims::Judgement;
use super::plan::{self, Plan};
use super::{report, tables, trial};
use crate::store::StoreError;
use crate::store::folder::{self, Folder};
use crate::store::job::{Job, Kind};
use crate::store::log::{Log, Record};
use crate::store::texts::Texts;
use serde_json::{Value as Json, json};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::channel;

/// The log of trials.
pub const RESULTS: &str = "trials.log";
/// A row for each trial of each condition.
pub const TRIALS: &str = "trials.parquet";
/// A row for each cell.
pub const CELLS: &str = "cells.parquet";
/// The page.
pub const REPORT: &str = "report.html";
/// Kind of a record that holds a trial.
const TRIAL: u32 = 1;

/// Which trials are wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Cells, by index; none for all.
    pub cells: Option<Vec<usize>>,
    /// Trials, from 1; none for as many as the study says.
    pub trials: Option<Vec<usize>>,
    /// The part of the work that is done here: i of n.
    pub shard: Option<(usize, usize)>,
}

impl Selection {
    /// The trials wanted, by condition and number: first trials first, so that a study that is stopped has as many of each
    /// condition.
    pub fn units(&self, plan: &Plan) -> Vec<(usize, usize)> {
        let mut trials: Vec<usize> = vec![0; plan.conditions.len()];
        for (index, cell) in plan.cells.iter().enumerate() {
            if self.cells.as_ref().is_none_or(|cells| cells.contains(&index)) {
                trials[cell.condition] = trials[cell.condition].max(cell.trials);
            }
        }
        let wanted = |condition: usize, trial: usize| match &self.trials {
            Some(list) => trials[condition] > 0 && list.contains(&trial),
            None => trial <= trials[condition],
        };
        let listed = self.trials.iter().flatten().copied();
        let most = trials.iter().copied().chain(listed).max().unwrap_or(0);
        let mut units = Vec::new();
        for trial in 1..=most {
            for condition in 0..plan.conditions.len() {
                let here = self.shard.is_none_or(|(i, n)| (condition + trial) % n == i - 1);
                if here && wanted(condition, trial) {
                    units.push((condition, trial));
                }
            }
        }
        units
    }
}

/// What was read off the trials of each condition, `[conditions]`, by trial.
pub type Results = Vec<BTreeMap<usize, Vec<f64>>>;

/// Who watches.
pub trait Watch: Sync {
    /// It begins or goes on: so many trials and updates of agents are to be done, so many trials are there already.
    fn begin(&mut self, folder: &Path, trials: usize, updates: u64, there: usize, threads: usize);
    /// A trial is done.
    fn done(&mut self, updates: u64);
    /// Whether to stop.
    fn stopper(&self) -> fn() -> bool;
}

/// How it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Everything that was wanted is there.
    Complete,
    /// It was stopped with so many trials left.
    Stopped(usize),
}

/// What became of a study.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its folder.
    pub folder: PathBuf,
    /// How it ended.
    pub end: End,
    /// Trials done in this session.
    pub trials: usize,
    /// Updates of agents in this session.
    pub updates: u64,
    /// Seconds of this session.
    pub seconds: f64,
    /// The statements with what came of them; none where it was stopped.
    pub judgements: Vec<Judgement>,
}

/// What the folder of a study holds, and what may be added to it.
const KIND: Kind = Kind { name: "study", one: "a study", may_grow: "cells and trials" };

/// The folder of a study: the one asked for, or one below `runs` that is free or holds the same study.
fn place(plan: &Plan, selection: &Selection, out: Option<&Path>) -> Result<PathBuf, StoreError> {
    let stem = plan.sources.stem(0).unwrap_or("study");
    let stem = match selection.shard {
        Some((i, n)) => format!("{stem}-shard-{i}-of-{n}"),
        None => stem.to_owned(),
    };
    folder::place(out, &stem, (KIND.name, KIND.may_grow), &|manifest| differences(plan, manifest))
}

fn refused(path: &Path, lines: Vec<String>) -> StoreError {
    folder::other(path, (KIND.name, KIND.may_grow), lines)
}

/// Where the study in a folder differs from this one, apart from cells and trials that were added.
fn differences(plan: &Plan, manifest: &Json) -> Vec<String> {
    if let Some(lines) = KIND.foreign(manifest) {
        return lines;
    }
    if manifest.get("files") == Some(&files(plan)) {
        return Vec::new();
    }
    let before = match read_back(manifest) {
        Ok(before) => before,
        Err(what) => return vec![format!("what is there cannot be read any more: {what}")],
    };
    let mut lines = folder::differences(&before.identity(), &plan.identity());
    let now: HashMap<String, &Json> = plan.identities().into_iter().collect();
    for (name, there) in before.identities() {
        match now.get(&name) {
            None => lines.push(format!("the cell {name}: there, not now")),
            Some(identity) => {
                let changed = folder::differences(there, identity);
                lines.extend(changed.into_iter().map(|line| format!("the cell {name}: {line}")));
            }
        }
    }
    lines
}

/// The texts that make up a study, as a manifest keeps them.
fn files(plan: &Plan) -> Json {
    Texts::json(&plan.sources, &plan.sets, plan.quick)
}

/// The study that a manifest keeps.
///
/// # Errors
/// Why it cannot be read.
pub fn read_back(manifest: &Json) -> Result<Plan, String> {
    let texts = Texts::of(manifest).ok_or("the manifest lacks what it should hold")?;
    let (name, first) = texts.file();
    plan::read(name, first, &texts.sets, texts.quick, &mut |path| texts.text(path))
        .map_err(|problems| problems.to_string())
}

/// The study in a folder.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    let manifest = folder::manifest(path)?;
    let Some(manifest) = manifest.filter(|m| m.get("kind").and_then(Json::as_str) == Some("study")) else {
        return Err(StoreError::Refused(format!("`{}` is not the folder of a study", path.display())));
    };
    read_back(&manifest).map_err(|what| StoreError::Damaged(format!("`{}`: {what}", path.display())))
}

/// Runs what is missing of a study.
///
/// # Errors
/// Where the folder is of something else, the system refuses, or a trial is impossible. What was done before stays.
pub fn run(
    plan: &Plan,
    selection: &Selection,
    threads: usize,
    out: Option<&Path>,
    program: &str,
    watch: &mut dyn Watch,
) -> Result<Outcome, StoreError> {
    let path = place(plan, selection, out)?;
    let about = [("title", json!(plan.title)), ("files", files(plan))];
    let mut job = Job::begin(KIND, &path, &about, &|manifest| differences(plan, manifest), (program, threads))?;
    let (mut log, mut results) = opened(&job.folder, plan)?;
    let there: usize = results.iter().map(BTreeMap::len).sum();
    let units: Vec<(usize, usize)> = selection
        .units(plan)
        .into_iter()
        .filter(|(condition, trial)| !results[*condition].contains_key(trial))
        .collect();
    let updates = units.iter().map(|&(condition, _)| plan.conditions[condition].updates()).sum();
    watch.begin(&path, units.len(), updates, there, threads);
    let began = std::time::Instant::now();
    let session = Session { plan, units: &units, threads };
    let done = session.work(&mut log, &mut results, watch);
    let seconds = began.elapsed().as_secs_f64();
    let (trials, made) = done.map_err(|error| job.fail(error))?;
    job.note(&[
        ("seconds", json!(seconds)),
        ("trials", json!(trials)),
        ("agent_updates_per_second", json!(made as f64 / seconds.max(1e-9))),
    ]);
    let left = units.len() - trials;
    let whole = Selection::default().units(plan).iter().all(|(c, trial)| results[*c].contains_key(trial));
    let outcome = |end, judgements| Outcome { folder: path.clone(), end, trials, updates: made, seconds, judgements };
    if left > 0 {
        job.end(whole)?;
        return Ok(outcome(End::Stopped(left), Vec::new()));
    }
    let judgements = finish(&job.folder, plan, &results, program)?;
    job.end(whole)?;
    Ok(outcome(End::Complete, judgements))
}

/// Joins the results of several folders of one study, as shards leave them, into another.
///
/// # Errors
/// Where they are of different studies, or contradict each other, or the system refuses.
pub fn merge(from: &[PathBuf], out: &Path, program: &str) -> Result<(Plan, usize, usize), StoreError> {
    let mut folders = Vec::new();
    for path in from {
        let manifest = folder::manifest(path)?.unwrap_or(Json::Null);
        let plan = of_folder(path)?;
        let results = logged(&path.join(RESULTS), &plan)?;
        folders.push((path, manifest, plan, results));
    }
    // cells and trials may have been added to some: the others' are among those of the largest, whatever the order
    let size = |plan: &Plan| (plan.cells.len(), Selection::default().units(plan).len());
    let largest = (0..folders.len()).rev().max_by_key(|&k| size(&folders[k].2));
    let Some(plan) = largest.map(|k| folders[k].2.clone()) else {
        return Err(StoreError::Refused("nothing to merge".into()));
    };
    let places: HashMap<[u64; 2], usize> = plan.conditions.iter().enumerate().map(|(k, c)| (c.key, k)).collect();
    let mut joined: Results = vec![BTreeMap::new(); plan.conditions.len()];
    for (path, manifest, own, results) in folders {
        let lines = differences(&plan, &manifest);
        if !lines.is_empty() {
            return Err(refused(path, lines));
        }
        for (condition, trials) in own.conditions.iter().zip(results) {
            let Some(&at) = places.get(&condition.key) else { continue };
            for (trial, values) in trials {
                match joined[at].get(&trial) {
                    Some(there) if !same(there, &values) => {
                        let what = "two folders differ in what they read off one trial: other program versions?";
                        return Err(StoreError::Damaged(format!("{what} (`{}`, trial {trial})", path.display())));
                    }
                    _ => drop(joined[at].insert(trial, values)),
                }
            }
        }
    }
    let folder = Folder::claim(out)?;
    if let Some(manifest) = folder::manifest(out)? {
        let lines = differences(&plan, &manifest);
        if !lines.is_empty() {
            return Err(refused(out, lines));
        }
    }
    let whole = Selection::default().units(&plan).iter().all(|(c, trial)| joined[*c].contains_key(trial));
    let manifest = json!({
        "format": 1,
        "kind": "study",
        "title": plan.title,
        "files": files(&plan),
        "status": if whole { "complete" } else { "stopped" },
        "merged": from.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
        "sessions": [],
    });
    folder.write_manifest(&manifest)?;
    let (mut log, there) = opened(&folder, &plan)?;
    for (condition, trials) in joined.iter().enumerate() {
        for (&trial, values) in trials {
            if !there[condition].contains_key(&trial) {
                log.append(TRIAL, &packed(plan.conditions[condition].key, trial, values))?;
            }
        }
    }
    drop(log);
    let results = logged(&folder.file(RESULTS), &plan)?;
    finish(&folder, &plan, &results, program)?;
    let trials = results.iter().map(BTreeMap::len).sum();
    let left = Selection::default().units(&plan).iter().filter(|(c, trial)| !results[*c].contains_key(trial)).count();
    Ok((plan, trials, left))
}

/// Makes the page of a folder anew.
///
/// # Errors
/// A folder that holds no study, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    // without its log there is nothing to make it from, and what was made is better than nothing
    let results = logged(&folder.file(RESULTS), &plan)?;
    finish(&folder, &plan, &results, program).map(|_| ())
}

/// Tables and page from what is there; the statements with what came of them.
fn finish(folder: &Folder, plan: &Plan, results: &Results, program: &str) -> Result<Vec<Judgement>, StoreError> {
    tables::write(folder, plan, results)?;
    let judgements = report::judgements(plan, results);
    folder.write_text(REPORT, &crate::report::html(&report::page(plan, results, &judgements, program)))?;
    Ok(judgements)
}

fn opened(folder: &Folder, plan: &Plan) -> Result<(Log, Results), StoreError> {
    let path = folder.file(RESULTS);
    let (mut log, records) = Log::resume(&path)?;
    let results = known(&mut log, &records, &path, plan)?;
    Ok((log, results))
}

/// What a log, which is only read, holds of the plan's conditions.
fn logged(path: &Path, plan: &Plan) -> Result<Results, StoreError> {
    let (mut log, records) = Log::open_to_read(path)?;
    known(&mut log, &records, path, plan)
}

/// The study in a folder with what is known of its trials, as one looks at it: nothing is written.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn look(path: &Path) -> Result<(Plan, Results), StoreError> {
    let plan = of_folder(path)?;
    let path = path.join(RESULTS);
    if !path.exists() {
        let nothing = vec![BTreeMap::new(); plan.conditions.len()];
        return Ok((plan, nothing));
    }
    let results = logged(&path, &plan)?;
    Ok((plan, results))
}

/// What the records of a log hold of the plan's conditions.
fn known(log: &mut Log, records: &[Record], path: &Path, plan: &Plan) -> Result<Results, StoreError> {
    let place: HashMap<[u64; 2], usize> = plan.conditions.iter().enumerate().map(|(k, c)| (c.key, k)).collect();
    let mut results = vec![BTreeMap::new(); plan.conditions.len()];
    for record in records.iter().filter(|record| record.kind == TRIAL) {
        let (key, trial, values) = unpacked(&log.read(record)?)
            .ok_or_else(|| StoreError::Damaged(format!("a record in `{}` is no trial", path.display())))?;
        if let Some(&condition) = place.get(&key)
            && values.len() == plan.readings.len()
        {
            results[condition].insert(trial, values);
        }
    }
    Ok(results)
}

fn packed(key: [u64; 2], trial: usize, values: &[f64]) -> Vec<u8> {
    let head = [key[0], key[1], trial as u64];
    let words = head.into_iter().chain(values.iter().map(|value| value.to_bits()));
    words.flat_map(u64::to_le_bytes).collect()
}

fn unpacked(bytes: &[u8]) -> Option<([u64; 2], usize, Vec<f64>)> {
    let words: Vec<u64> = bytes.chunks_exact(8).map(|w| u64::from_le_bytes(core::array::from_fn(|k| w[k]))).collect();
    let [first, second, trial, values @ ..] = words.as_slice() else { return None };
    Some(([*first, *second], usize::try_from(*trial).ok()?, values.iter().map(|&bits| f64::from_bits(bits)).collect()))
}

/// Whether two trials read the same, missing values included.
fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// The work of one session.
struct Session<'a> {
    plan: &'a Plan,
    units: &'a [(usize, usize)],
    threads: usize,
}

impl Session<'_> {
    /// Does the units, on so many threads; how many were done, with their updates of agents.
    fn work(&self, log: &mut Log, results: &mut Results, watch: &mut dyn Watch) -> Result<(usize, u64), StoreError> {
        let (next, over) = (AtomicUsize::new(0), AtomicBool::new(false));
        let asked = watch.stopper();
        let stop = || over.load(Ordering::Relaxed) || asked();
        let (to, from) = channel();
        std::thread::scope(|scope| {
            for _ in 0..self.threads.min(self.units.len()) {
                let to = to.clone();
                let (next, stop) = (&next, &stop);
                scope.spawn(move || {
                    while !stop() {
                        let Some(&(condition, trial)) = self.units.get(next.fetch_add(1, Ordering::Relaxed)) else {
                            return;
                        };
                        let seed = self.plan.seed_of(trial);
                        let read = trial::run(self.plan, &self.plan.conditions[condition], seed, stop);
                        let ended = matches!(read, Ok(None));
                        if to.send((condition, trial, read)).is_err() || ended {
                            return;
                        }
                    }
                });
            }
            drop(to);
            let (mut done, mut updates) = (0, 0);
            let mut failure = None;
            for (condition, trial, read) in from {
                let kept = match read {
                    Ok(None) => continue,
                    Ok(Some(values)) => {
                        let bytes = packed(self.plan.conditions[condition].key, trial, &values);
                        log.append(TRIAL, &bytes).map(|_| values)
                    }
                    Err(what) => {
                        let cell = self.plan.cells.iter().find(|cell| cell.condition == condition);
                        let cell = cell.map_or_else(String::new, |cell| self.plan.name_of(cell));
                        Err(StoreError::Refused(format!("trial {trial} of the cell {cell}: {what}")))
                    }
                };
                match kept {
                    Ok(values) => {
                        results[condition].insert(trial, values);
                        done += 1;
                        let made = self.plan.conditions[condition].updates();
                        updates += made;
                        watch.done(made);
                    }
                    Err(error) => {
                        // the others stop; what they have done is kept
                        over.store(true, Ordering::Relaxed);
                        failure.get_or_insert(error);
                    }
                }
            }
            failure.map_or(Ok((done, updates)), Err)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trial_is_packed_and_unpacked() {
        let values = [1.5, f64::NAN, -0.0];
        let (key, trial, read) = unpacked(&packed([3, u64::MAX], 7, &values)).unwrap_or_default();
        assert_eq!((key, trial), ([3, u64::MAX], 7));
        assert!(same(&read, &values) && !same(&read, &[1.5, f64::NAN, 0.0]));
        assert!(unpacked(&[0; 16]).is_none());
    }
}
