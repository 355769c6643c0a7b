//! Running an optimisation: generation after generation of every run, into one folder.
//!
//! Each evaluation ends as one record of an append-only log. Which candidates there are follows from the plan and from what was
//! found, so that a stop at any moment loses what is in flight and nothing else, for any number of threads.

use super::form::{Lighten, Search};
use super::plan::Plan;
use super::results::{Lighter, Results, Run};
use super::searcher::Searcher;
use super::trials::{self, Found, Purpose};
use super::{report, tables};
use crate::design::export::environment_files;
use crate::environment::trial;
use crate::environment::work::{Watch, packed, spread, unpacked};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::job::{File, Job, Kind};
use crate::store::log::{Log, Record};
use measure::statistics::wilson;
use search::elites::Told;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use terrain::{Construct, Environment};

/// The log of evaluations.
pub const LOG: &str = "evaluations.log";
/// The page.
pub const REPORT: &str = "report.html";
/// Kind of records: an evaluation.
const EVALUATED: u32 = 1;
/// Times that all reductions of a construct are gone through, at most.
const PASSES: usize = 10;

const KIND: Kind = Kind { name: "optimisation", one: "an optimisation", may_grow: "runs, evaluations and statements" };

/// What an evaluation is of: method, run, purpose, number.
type Key = (u64, u64, u64, u64);
/// Results by what they are of.
type There = BTreeMap<Key, Found>;

/// A unit of work.
struct Unit {
    key: Key,
    what: What,
    purpose: (Purpose, u64),
    trials: usize,
}

enum What {
    Point(Vec<f64>),
    Construct(Construct),
}

/// Sees to it that units are there; false where that was stopped, or where they are not and none can be made.
type See<'a> = dyn FnMut(Vec<Unit>, &mut There) -> Result<bool, StoreError> + 'a;

/// What became of an optimisation.
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

/// Reads the optimisation of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    KIND.plan(path, |name, text, sets, quick, load| super::read(name, text, sets, quick, load))
}

/// Runs what is missing of an optimisation.
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
    let mut see = |units: Vec<Unit>, there: &mut There| made(plan, threads, units, there, &mut log, watch);
    let found = optimised(plan, &mut there, &mut see);
    let seconds = began.elapsed().as_secs_f64();
    let evaluations = there.len() - before;
    job.note(&[("seconds", json!(seconds)), ("evaluations", json!(evaluations))]);
    job.end(matches!(found, Ok(Some(_))))?;
    let Some(results) = found? else {
        return Ok(Done { folder: path, complete: false, evaluations, seconds, lines: Vec::new() });
    };
    finish(&job.folder, &results, program)?;
    Ok(Done { folder: path, complete: true, evaluations, seconds, lines: report::lines(&results) })
}

/// Makes tables and page of a complete folder anew.
///
/// # Errors
/// A folder that holds no complete optimisation, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let (_, mut there) = opened(&folder)?;
    match optimised(&plan, &mut there, &mut |units, _| Ok(units.is_empty()))? {
        Some(results) => finish(&folder, &results, program),
        None => {
            let what = format!("`{}` is not complete; the same run command goes on", path.display());
            Err(StoreError::Refused(what))
        }
    }
}

fn finish(folder: &Folder, results: &Results<'_>, program: &str) -> Result<(), StoreError> {
    tables::write(folder, results)?;
    for (stem, construct, seed, title) in report::exported(results) {
        let workspace = results.plan.workspace.workspace.clone();
        let environment = Environment { workspace, construct, schedule: None };
        let trial = trial::file(&results.plan.population, environment.geometry(), Vec::new(), seed, &title);
        environment_files(folder, &stem, &environment, &trial)?;
    }
    folder.write_text(REPORT, &crate::report::html(&report::page(results, program)))
}

fn opened(folder: &Folder) -> Result<(Log, There), StoreError> {
    let path = folder.file(LOG);
    let (mut log, records) = Log::resume(&path)?;
    let there = known(&mut log, &records, &path)?;
    Ok((log, there))
}

/// What is known of the optimisation in a folder, complete or not, as one looks at it.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn look(path: &Path) -> Result<Looked, StoreError> {
    let plan = of_folder(path)?;
    let path = path.join(LOG);
    let mut there = There::new();
    if path.exists() {
        let (mut log, records) = Log::open_to_read(&path)?;
        there = known(&mut log, &records, &path)?;
    }
    let mut nothing_missing = |units: Vec<Unit>, _: &mut There| Ok(units.is_empty());
    let complete = optimised(&plan, &mut there, &mut nothing_missing)?
        .map(|results| (results.runs, results.control, results.lighter));
    let (runs, control, lighter) = match complete {
        Some(all) => all,
        None => {
            let control = without(&plan, &mut there, &mut nothing_missing)?.flatten();
            (searched(&plan, &mut there, &mut nothing_missing)?.0, control, None)
        }
    };
    Ok(Looked { plan, runs, control, lighter })
}

/// What is known of an optimisation.
pub struct Looked {
    /// The plan.
    pub plan: Plan,
    /// The runs, `[methods][runs]`, as far as they came.
    pub runs: Vec<Vec<Run>>,
    /// What was found without a construct.
    pub control: Option<Found>,
    /// The best construct, made lighter.
    pub lighter: Option<Lighter>,
}

/// What the records of a log hold.
fn known(log: &mut Log, records: &[Record], path: &Path) -> Result<There, StoreError> {
    let mut there = There::new();
    for record in records.iter().filter(|record| record.kind == EVALUATED) {
        let &[method, run, stage, number, score, successes, trials, fitness, steps, material, pieces] =
            unpacked(&log.read(record)?).as_slice()
        else {
            return Err(StoreError::Damaged(format!("a record in `{}` is no evaluation", path.display())));
        };
        let [score, fitness, steps, material] = [score, fitness, steps, material].map(f64::from_bits);
        there
            .insert((method, run, stage, number), Found { score, successes, trials, fitness, steps, material, pieces });
    }
    Ok(there)
}

fn words((method, run, stage, number): Key, found: &Found) -> [u64; 11] {
    let bits = f64::to_bits;
    let &Found { score, successes, trials, fitness, steps, material, pieces } = found;
    [method, run, stage, number, bits(score), successes, trials, bits(fitness), bits(steps), bits(material), pieces]
}

/// Makes what is missing, each as a record of the log.
fn made(
    plan: &Plan,
    threads: usize,
    units: Vec<Unit>,
    there: &mut There,
    log: &mut Log,
    watch: &mut dyn Watch,
) -> Result<bool, StoreError> {
    let stop = watch.stopper();
    watch.more(units.len());
    let work = |unit: &Unit, stop: &dyn Fn() -> bool| match &unit.what {
        What::Point(point) => trials::of_point(plan, point, unit.purpose, unit.trials, stop),
        What::Construct(construct) => trials::of_construct(plan, construct, unit.purpose, unit.trials, stop),
    };
    let take = |unit: &Unit, (found, updates): (Found, u64)| {
        log.append(EVALUATED, &packed(words(unit.key, &found)))?;
        watch.done(updates);
        there.insert(unit.key, found);
        Ok(())
    };
    spread(&units, threads, &stop, work, take)
}

fn refused(error: search::SearchError) -> StoreError {
    StoreError::Refused(error.to_string())
}

/// Sees to it that what is missing of some units is there; what was found of each, or none where it was stopped.
fn found(units: Vec<Unit>, there: &mut There, see: &mut See<'_>) -> Result<Option<Vec<Found>>, StoreError> {
    let keys: Vec<Key> = units.iter().map(|unit| unit.key).collect();
    let missing: Vec<Unit> = units.into_iter().filter(|unit| !there.contains_key(&unit.key)).collect();
    if !see(missing, there)? {
        return Ok(None);
    }
    Ok(keys.iter().map(|key| there.get(key).copied()).collect())
}

/// What kind a candidate is, by the kinds of its method.
fn kind(plan: &Plan, method: usize, point: &[f64], found: &Found) -> Vec<f64> {
    let Search::MapElites(archive) = &plan.form.method.0[method].1 else { return Vec::new() };
    let of = |name: &str| match name {
        "material" => found.material,
        "pieces" => found.pieces as f64,
        "steps" => found.steps,
        other => plan.axes.iter().position(|axis| axis.name == other).map_or(f64::NAN, |k| point[k]),
    };
    archive.kind.0.iter().map(|(name, _)| of(name)).collect()
}

/// The whole optimisation; none where it was stopped, or something is missing that cannot be made.
fn optimised<'a>(plan: &'a Plan, there: &mut There, see: &mut See<'_>) -> Result<Option<Results<'a>>, StoreError> {
    let Some(control) = without(plan, there, see)? else { return Ok(None) };
    let (mut runs, done) = searched(plan, there, see)?;
    if !done || !confirmed(plan, &mut runs, there, see)? {
        return Ok(None);
    }
    let mut results = Results { plan, runs, control, lighter: None };
    if let (Some(form), Some((method, run))) = (&plan.form.lighten, results.best()) {
        let Some(lighter) = lightened(plan, form, &results.runs[method][run], there, see)? else { return Ok(None) };
        results.lighter = Some(lighter);
    }
    Ok(Some(results))
}

/// The trials without a construct.
fn without(plan: &Plan, there: &mut There, see: &mut See<'_>) -> Result<Option<Option<Found>>, StoreError> {
    if plan.form.control_trials == 0 {
        return Ok(Some(None));
    }
    let unit = Unit {
        key: (0, 0, Purpose::Control as u64, 0),
        what: What::Construct(plan.bare.clone()),
        purpose: (Purpose::Control, 0),
        trials: plan.form.control_trials,
    };
    Ok(found(vec![unit], there, see)?.map(|found| found.first().copied()))
}

/// All runs of all methods, one generation of each at a time, as far as they go; and whether they go to their end.
fn searched(plan: &Plan, there: &mut There, see: &mut See<'_>) -> Result<(Vec<Vec<Run>>, bool), StoreError> {
    let mut complete = true;
    let mut live: Vec<(usize, usize, Searcher, Run)> = Vec::new();
    for method in 0..plan.form.method.0.len() {
        for run in 0..plan.runs {
            live.push((method, run, Searcher::new(plan, method, run).map_err(refused)?, Run::default()));
        }
    }
    for generation in 0.. {
        let mut units = Vec::new();
        for (method, run, searcher, done) in &live {
            let left = plan.evaluations - done.evaluations.len();
            for (k, point) in searcher.candidates().iter().take(left).enumerate() {
                units.push(Unit {
                    key: (*method as u64, *run as u64, Purpose::Search as u64, (done.evaluations.len() + k) as u64),
                    what: What::Point(point.clone()),
                    // candidates of a generation meet in the same trials
                    purpose: (Purpose::Search, generation),
                    trials: plan.form.trials,
                });
            }
        }
        if units.is_empty() {
            break;
        }
        let Some(all) = found(units, there, see)? else {
            complete = false;
            break;
        };
        let mut all = all.into_iter();
        for (method, _, searcher, done) in &mut live {
            let left = plan.evaluations - done.evaluations.len();
            if left == 0 {
                continue;
            }
            let candidates = searcher.candidates().to_vec();
            done.begins.push(done.evaluations.len());
            let mut told = Vec::new();
            for (k, point) in candidates.into_iter().enumerate() {
                // a generation that the number of evaluations cuts short is told to its end
                let found = if k < left { all.next().unwrap_or(Found::NOTHING) } else { Found::NOTHING };
                told.push(Told { score: found.score, descriptors: kind(plan, *method, &point, &found) });
                if k < left {
                    done.evaluations.push((point, found));
                }
            }
            searcher.tell(&told).map_err(refused)?;
        }
    }
    let mut runs: Vec<Vec<Run>> = vec![Vec::new(); plan.form.method.0.len()];
    for (method, _, searcher, mut done) in live {
        done.elites = searcher.elites().into_iter().filter(|elite| elite.score > Found::NOTHING.score).collect();
        runs[method].push(done);
    }
    Ok((runs, complete))
}

/// Tries the best candidates of each run again, and the best of them once more; false where it was stopped.
fn confirmed(plan: &Plan, runs: &mut [Vec<Run>], there: &mut There, see: &mut See<'_>) -> Result<bool, StoreError> {
    let unit = |method: usize, run: usize, place: usize, point: &[f64], purpose: Purpose| Unit {
        key: (method as u64, run as u64, purpose as u64, place as u64),
        what: What::Point(point.to_vec()),
        purpose: (purpose, run as u64),
        trials: plan.form.confirm_trials,
    };
    let mut units = Vec::new();
    for (method, own) in runs.iter_mut().enumerate() {
        for (number, run) in own.iter_mut().enumerate() {
            let mut order: Vec<usize> = (0..run.evaluations.len()).collect();
            order.retain(|&place| run.evaluations[place].1.trials > 0);
            order.sort_by(|&a, &b| run.evaluations[b].1.score.total_cmp(&run.evaluations[a].1.score));
            let mut chosen: Vec<usize> = Vec::new();
            for place in order {
                let new = chosen.iter().all(|&other| run.evaluations[other].0 != run.evaluations[place].0);
                if new && chosen.len() < plan.form.finalists {
                    chosen.push(place);
                    units.push(unit(method, number, place, &run.evaluations[place].0, Purpose::Choice));
                }
            }
            run.finalists = chosen.into_iter().map(|place| (place, Found::NOTHING)).collect();
        }
    }
    let Some(all) = found(units, there, see)? else { return Ok(false) };
    let mut all = all.into_iter();
    let mut units = Vec::new();
    for (method, own) in runs.iter_mut().enumerate() {
        for (number, run) in own.iter_mut().enumerate() {
            run.finalists.iter_mut().zip(&mut all).for_each(|(finalist, found)| finalist.1 = found);
            let best = run.finalists.iter().copied();
            run.best = best.reduce(|best, other| if other.1.score > best.1.score { other } else { best });
            if let Some((place, _)) = run.best {
                units.push(unit(method, number, place, &run.evaluations[place].0, Purpose::Report));
            }
        }
    }
    let Some(all) = found(units, there, see)? else { return Ok(false) };
    let bests = runs.iter_mut().flatten().filter_map(|run| run.best.as_mut());
    bests.zip(all).for_each(|(best, found)| best.1 = found);
    Ok(true)
}

/// Makes a construct lighter, as long as the group still does what is wanted.
fn lightened(
    plan: &Plan,
    form: &Lighten,
    run: &Run,
    there: &mut There,
    see: &mut See<'_>,
) -> Result<Option<Lighter>, StoreError> {
    let point = run.point().unwrap_or_default();
    let first = plan.construct(point).map_err(|error| StoreError::Refused(error.to_string()))?;
    let mut tried = 0;
    let mut trial = |construct: &Construct, there: &mut There| {
        // what a number stands for follows from what was found before
        let unit = Unit {
            key: (construct.hash(), 0, Purpose::Lighten as u64, 0),
            what: What::Construct(construct.clone()),
            purpose: (Purpose::Lighten, 0),
            trials: form.trials,
        };
        tried += 1;
        Ok::<_, StoreError>(found(vec![unit], there, see)?.and_then(|found| found.first().copied()))
    };
    let Some(before) = trial(&first, there)? else { return Ok(None) };
    let (mut lightest, mut after) = (first.clone(), before);
    let holds =
        |found: &Found| wilson(found.successes, found.trials, 0.95).is_ok_and(|interval| interval.low >= form.least);
    for _ in 0..PASSES {
        let mut lighter = false;
        for (piece, share) in trials::reductions(lightest.pieces.len(), &form.shares) {
            let Some(construct) = trials::reduced(&lightest, piece, share) else { continue };
            let Some(found) = trial(&construct, there)? else { return Ok(None) };
            if holds(&found) {
                (lightest, after, lighter) = (construct, found, true);
            }
        }
        if !lighter {
            break;
        }
    }
    Ok(Some(Lighter { before: (first, before), after: (lightest, after), tried }))
}
