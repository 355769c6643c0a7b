//! Running a design: candidate after candidate, into one folder.
//!
//! Each feasible candidate ends as one record of an append-only log, known by its attempt. So a stop at any moment loses what is
//! in flight and nothing else, and the tables are the same for any number of threads and stops.

use super::inverse::{self, Streams, Telling};
use super::plan::Plan;
use super::results::{Results, Trials};
use super::robustness::{self, Copies};
use super::{export, report, tables};
use crate::environment::trial::{self, Outcome, Population, Told, Tried, Wanted};
use crate::environment::work::{Watch, packed, spread, unpacked};
use crate::scenario::Scenario;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::job::{File, Job, Kind};
use crate::store::log::{Log, Record};
use measure::statistics::Decision;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use terrain::Construct;

/// The log of candidates.
pub const LOG: &str = "candidates.log";
/// The page.
pub const REPORT: &str = "report.html";
/// Kinds of records: a candidate that was tried, a changed copy of one, what an unknown group did in one.
const TRIED: u32 = 1;
const CHANGED: u32 = 2;
const SEEN: u32 = 3;

/// What the folder of a design holds, and what may be added to it.
const KIND: Kind = Kind { name: "design", one: "a design", may_grow: "candidates and statements" };

/// What became of a design.
#[derive(Clone, Debug)]
pub struct Done {
    /// Its folder.
    pub folder: PathBuf,
    /// Candidates that are left, where it was stopped.
    pub left: usize,
    /// Candidates tried in this session.
    pub candidates: usize,
    /// Seconds of this session.
    pub seconds: f64,
    /// Lines that say what came of it.
    pub lines: Vec<String>,
}

/// Reads the design of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    KIND.plan(path, |name, text, sets, quick, load| super::read(name, text, sets, quick, load))
}

/// Runs what is missing of a design.
///
/// # Errors
/// Where the folder is of something else, the system refuses, or a candidate is impossible. What was done before stays.
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
    let survey = plan.survey().map_err(StoreError::Refused)?;
    let (mut log, Known { trials: mut there, mut copies, mut streams }) = opened(&job.folder, plan)?;
    let missing: Vec<&(u64, Construct)> =
        survey.feasible.iter().filter(|(attempt, _)| !there.contains_key(attempt)).collect();
    watch.begin(&path, "candidates", missing.len(), survey.feasible.len() - missing.len(), threads);
    let began = std::time::Instant::now();
    let stop = watch.stopper();
    let done = spread(
        &missing,
        threads,
        &stop,
        |(attempt, construct), stop| candidate(plan, *attempt, construct, stop),
        |(attempt, _), trials| {
            log.append(TRIED, &packed(words(*attempt, &trials)))?;
            watch.done(updates(plan, &trials));
            there.insert(*attempt, trials);
            Ok(())
        },
    );
    let mut left = survey.feasible.iter().filter(|(attempt, _)| !there.contains_key(attempt)).count();
    let candidates = missing.len() - left;
    done.map_err(|error| job.fail(error))?;
    let mut lines = Vec::new();
    if left == 0 {
        let results = Results::new(plan, survey, there);
        let all = robustness::copies(&results);
        let missing: Vec<&robustness::Changed> = all.iter().filter(|copy| !copies.contains_key(*copy)).collect();
        watch.more(missing.len());
        let done = spread(
            &missing,
            threads,
            &stop,
            |copy, stop| robustness::tried(&results, copy, stop),
            |copy, fitness| {
                log.append(CHANGED, &packed([copy.0, copy.1, copy.2, copy.3, fitness.to_bits()]))?;
                watch.done(0);
                copies.insert(**copy, fitness);
                Ok(())
            },
        );
        done.map_err(|error| job.fail(error))?;
        left = all.iter().filter(|copy| !copies.contains_key(*copy)).count();
        if left == 0 {
            left = identify(&results, threads, &mut streams, &mut log, watch).map_err(|error| job.fail(error))?;
        }
        if left == 0 {
            lines = report::lines(&results);
            lines.extend(inverse::lines(&results, &streams));
            finish(&job.folder, &results, &copies, &streams, program)?;
        }
    }
    let seconds = began.elapsed().as_secs_f64();
    job.note(&[("seconds", json!(seconds)), ("candidates", json!(candidates))]);
    job.end(left == 0)?;
    Ok(Done { folder: path, left, candidates, seconds, lines })
}

/// Sees what is missing of unknown groups; the answer is how many are left.
fn identify(
    results: &Results<'_>,
    threads: usize,
    streams: &mut Streams,
    log: &mut Log,
    watch: &mut dyn Watch,
) -> Result<usize, StoreError> {
    let plan = results.plan;
    let Some(asked) = &plan.inverse else { return Ok(0) };
    let telling = Telling::of(results, asked).map_err(StoreError::Refused)?;
    let missing = inverse::missing(plan, asked, &telling, streams);
    watch.more(missing.len());
    let (stop, known) = (watch.stopper(), streams.clone());
    let mut left = missing.len();
    spread(
        &missing,
        threads,
        &stop,
        |unknown, stop| inverse::observe(results, asked, &telling, &known, *unknown, stop),
        |(group, number), new| {
            let mut updates = 0;
            for (attempt, trials) in new {
                let own = streams.entry((*group, *number, attempt)).or_default();
                let mut words = vec![*group, *number, attempt, own.len() as u64];
                trials.iter().for_each(|tried| put(&mut words, tried));
                log.append(SEEN, &packed(words))?;
                let steps: u64 = trials.iter().map(|tried| tried.steps).sum();
                updates += plan.populations[*group as usize].members() as u64 * steps;
                own.extend(trials);
            }
            watch.done(updates);
            left -= 1;
            Ok(())
        },
    )?;
    Ok(left)
}

/// Makes tables and page of a complete folder anew.
///
/// # Errors
/// A folder that holds no complete design, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let (_, Known { trials: there, copies, streams }) = opened(&folder, &plan)?;
    let survey = plan.survey().map_err(StoreError::Refused)?;
    let missing = survey.feasible.iter().any(|(attempt, _)| !there.contains_key(attempt));
    let results = Results::new(&plan, survey, there);
    let unseen = || plan.inverse.is_some() && inverse::Found::of(&results, &streams).is_none();
    if missing || robustness::copies(&results).iter().any(|copy| !copies.contains_key(copy)) || unseen() {
        return Err(StoreError::Refused(format!("`{}` is not complete; the same run command goes on", path.display())));
    }
    finish(&folder, &results, &copies, &streams, program)
}

fn finish(
    folder: &Folder,
    results: &Results<'_>,
    copies: &Copies,
    streams: &Streams,
    program: &str,
) -> Result<(), StoreError> {
    tables::write(folder, results)?;
    // copies of environments that were the best of fewer candidates are left out
    let wanted = robustness::copies(results);
    let copies: Copies = wanted.into_iter().filter_map(|copy| Some((copy, *copies.get(&copy)?))).collect();
    robustness::write(folder, results, &copies)?;
    inverse::write(folder, results, streams)?;
    export::write(folder, results)?;
    folder.write_text(REPORT, &crate::report::html(&report::page(results, &copies, streams, program)))
}

/// What a log holds.
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// Trials by candidate.
    pub trials: BTreeMap<u64, Vec<Trials>>,
    /// Changed copies.
    pub copies: Copies,
    /// What unknown groups did.
    pub streams: Streams,
}

fn opened(folder: &Folder, plan: &Plan) -> Result<(Log, Known), StoreError> {
    let path = folder.file(LOG);
    let (mut log, records) = Log::resume(&path)?;
    let known = known(&mut log, &records, &path, plan)?;
    Ok((log, known))
}

/// The design in a folder with what is known of its candidates, as one looks at it: nothing is written.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn look(path: &Path) -> Result<(Plan, Known), StoreError> {
    let plan = of_folder(path)?;
    let path = path.join(LOG);
    if !path.exists() {
        return Ok((plan, Known::default()));
    }
    let (mut log, records) = Log::open_to_read(&path)?;
    let known = known(&mut log, &records, &path, &plan)?;
    Ok((plan, known))
}

/// What the records of a log hold.
fn known(log: &mut Log, records: &[Record], path: &Path, plan: &Plan) -> Result<Known, StoreError> {
    let mut there = Known::default();
    for record in records {
        let words = unpacked(&log.read(record)?);
        let damaged = || StoreError::Damaged(format!("a record in `{}` is no candidate", path.display()));
        match (record.kind, words.as_slice()) {
            (TRIED, words) => {
                let (attempt, trials) = trials_of(plan, words).ok_or_else(damaged)?;
                there.trials.insert(attempt, trials);
            }
            (CHANGED, &[attempt, perturbation, size, copy, fitness]) => {
                there.copies.insert((attempt, perturbation, size, copy), f64::from_bits(fitness));
            }
            (SEEN, &[group, number, attempt, from, ref words @ ..]) => {
                let stream = there.streams.entry((group, number, attempt)).or_default();
                let mut words = words.iter().copied();
                if stream.len() as u64 != from {
                    return Err(damaged());
                }
                while words.len() > 0 {
                    stream.push(next_trial(plan.behaviour_names().len(), &mut words).ok_or_else(damaged)?);
                }
            }
            _ => return Err(damaged()),
        }
    }
    Ok(there)
}

/// The words of a trial: its steps, and fitness and value of each behaviour.
fn put(words: &mut Vec<u64>, tried: &Tried) {
    words.push(tried.steps);
    words.extend(tried.outcomes.iter().flat_map(|one| [one.fitness.to_bits(), one.value.to_bits()]));
}

fn next_trial(behaviours: usize, words: &mut dyn Iterator<Item = u64>) -> Option<Tried> {
    let steps = words.next()?;
    let mut number = || words.next().map(f64::from_bits);
    let mut outcome = |_| Some(Outcome { fitness: number()?, value: number()? });
    Some(Tried { steps, outcomes: (0..behaviours).map(&mut outcome).collect::<Option<_>>()? })
}

/// A record: the attempt, then for each group the numbers of trials with the construct, without it, and of each stage by itself;
/// then trial by trial in this order what [`put`] says (of a stage by itself, of its behaviour alone).
fn words(attempt: u64, trials: &[Trials]) -> Vec<u64> {
    let mut words = vec![attempt];
    for trials in trials {
        let all = || [&trials.built, &trials.control].into_iter().chain(&trials.alone);
        words.extend(all().map(|list| list.len() as u64));
        all().flatten().for_each(|tried| put(&mut words, tried));
    }
    words
}

fn trials_of(plan: &Plan, words: &[u64]) -> Option<(u64, Vec<Trials>)> {
    let behaviours = plan.behaviour_names().len();
    let mut words = words.iter().copied();
    let attempt = words.next()?;
    let mut all = Vec::with_capacity(plan.populations.len());
    for _ in &plan.populations {
        let counts: Vec<u64> = (0..2 + plan.stages()).map(|_| words.next()).collect::<Option<_>>()?;
        let mut next = |count: u64, behaviours: usize| -> Option<Vec<Tried>> {
            (0..count).map(|_| next_trial(behaviours, &mut words)).collect()
        };
        let (built, control) = (next(counts[0], behaviours)?, next(counts[1], behaviours)?);
        let alone = counts[2..].iter().map(|count| next(*count, 1)).collect::<Option<_>>()?;
        all.push(Trials { built, control, alone });
    }
    words.next().is_none().then_some((attempt, all))
}

/// Updates of agents in the trials of a candidate.
fn updates(plan: &Plan, trials: &[Trials]) -> u64 {
    let of = |(population, trials): (&Population, &Trials)| {
        let all = trials.built.iter().chain(&trials.control).chain(trials.alone.iter().flatten());
        let steps: u64 = all.map(|tried| tried.steps).sum();
        population.members() as u64 * steps
    };
    plan.populations.iter().zip(trials).map(of).sum()
}

/// Tries a candidate with all groups; none where it was stopped.
fn candidate(
    plan: &Plan,
    attempt: u64,
    construct: &Construct,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Vec<Trials>>, String> {
    let mut all = Vec::with_capacity(plan.populations.len());
    for population in &plan.populations {
        let arm = |built: bool| {
            let pieces = if built { construct.pieces.as_slice() } else { &[] };
            let geometry = plan.workspace.workspace.geometry.iter();
            let scenario = population.among(geometry.chain(pieces.iter().flat_map(|piece| &piece.geometry)));
            plan.behaviours(population, construct, built)
                .map(|wanted| (scenario, wanted))
                .map_err(|wrong| format!("candidate {attempt}, {}: {}", wrong.path, wrong.what))
        };
        let with = arm(true)?;
        let without = if plan.form.control { Some(arm(false)?) } else { None };
        let mut trials = Trials::default();
        for trial in 1..=plan.form.trials {
            let seed = plan.seed_of(attempt, trial);
            let run =
                |(scenario, wanted): &(Scenario, Wanted)| Some(tried(scenario, population, wanted, seed, stop)?.tried);
            let Some(tried) = run(&with) else { return Ok(None) };
            trials.built.push(tried);
            if let Some(without) = &without {
                let Some(tried) = run(without) else { return Ok(None) };
                trials.control.push(tried);
            }
            if decided(plan, &trials.built) {
                break;
            }
        }
        let stages = plan.alone(population, construct);
        let stages = stages.map_err(|wrong| format!("candidate {attempt}, {}: {}", wrong.path, wrong.what))?;
        let Some(alone) = alone(plan, attempt, population, &stages, stop) else { return Ok(None) };
        trials.alone = alone;
        all.push(trials);
    }
    Ok(Some(all))
}

/// A trial; none where it was stopped.
pub(super) fn tried(
    scenario: &Scenario,
    population: &Population,
    wanted: &Wanted,
    seed: u64,
    stop: &dyn Fn() -> bool,
) -> Option<Told> {
    match trial::relayed(scenario, population, wanted, seed, stop, &mut |_| ()) {
        // impossible with this seed: no room for the group, for one
        Err(_) => {
            let nothing = Outcome { fitness: f64::NAN, value: f64::NAN };
            let stages = wanted.relay.as_ref().map_or(0, |relay| relay.legs.len() + 1);
            let outcomes = vec![nothing; stages + wanted.behaviours.len()];
            Some(Told { tried: Tried { steps: 0, outcomes }, handed: Vec::new(), moved: Vec::new() })
        }
        Ok(tried) => tried,
    }
}

/// The trials of each stage by itself, `[stages]`; none where it was stopped. The first begins as the scenario says. The others begin
/// with places and velocities of the group where it was handed over in trials of the stage before, taken in turns; where it never was,
/// they are not tried.
fn alone(
    plan: &Plan,
    attempt: u64,
    population: &Population,
    stages: &[(Construct, Wanted)],
    stop: &dyn Fn() -> bool,
) -> Option<Vec<Vec<Tried>>> {
    let mut all = Vec::with_capacity(stages.len());
    let mut starts = vec![population.clone()];
    for (stage, (part, wanted)) in stages.iter().enumerate() {
        let geometry = || plan.workspace.workspace.geometry.iter().chain(part.geometry());
        let (mut trials, mut handed) = (Vec::new(), Vec::new());
        for trial in 1..=if starts.is_empty() { 0 } else { plan.form.trials } {
            let start = &starts[(trial - 1) % starts.len()];
            let seed = plan.seed_alone(attempt, trial, stage);
            let mut told = tried(&start.among(geometry()), start, wanted, seed, stop)?;
            told.tried.outcomes.truncate(1);
            trials.push(told.tried);
            handed.extend(told.handed.iter().filter_map(|state| population.from_state(state)));
        }
        all.push(trials);
        starts = handed;
    }
    Some(all)
}

/// Whether the sequential test has decided for every behaviour.
fn decided(plan: &Plan, trials: &[Tried]) -> bool {
    let Some(test) = &plan.sequential else { return false };
    (0..plan.behaviour_names().len()).all(|behaviour| {
        let share = super::results::Share::of(trials, behaviour, plan.form.success);
        test.decide(share.successes as u32, share.trials as u32) != Decision::Continue
    })
}
