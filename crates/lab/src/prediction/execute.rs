//! Running a prediction: construct after construct is simulated, models are fitted to those of the first lot that are not held out, and
//! construct after construct is predicted, into one folder.
//!
//! Each construct ends as one record of an append-only log when it was simulated, and as one for each model when it was predicted. So a stop
//! at any moment loses what is in flight and nothing else, for any number of threads; and another model simulates nothing again.

use super::course::{self, Course};
use super::model::{Fit, Model, Transition};
use super::plan::Plan;
use super::results::{Predicted, Results};
use super::state::{Members, State, WORDS};
use super::surroundings::Wall;
use super::{report, tables};
use crate::design::results::Share;
use crate::environment::work::{Watch, packed, spread, unpacked};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::job::{File, Job, Kind};
use crate::store::log::{Log, Record};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The log of constructs.
pub const LOG: &str = "constructs.log";
/// The page.
pub const REPORT: &str = "report.html";
/// Kinds of records: simulated trials of a construct, predicted ones.
const SIMULATED: u32 = 1;
const PREDICTED: u32 = 2;
/// Number that stands for no construct.
const BARE: u64 = u64::MAX;

const KIND: Kind = Kind { name: "prediction", one: "a prediction", may_grow: "constructs, models and statements" };

/// What is there: simulated trials by lot and number, predicted ones by model, lot and number.
#[derive(Debug, Default)]
pub(super) struct There {
    simulated: BTreeMap<(usize, u64), Vec<Course>>,
    predicted: BTreeMap<(u64, usize, u64), Predicted>,
}

/// What became of a prediction.
#[derive(Clone, Debug)]
pub struct Done {
    /// Its folder.
    pub folder: PathBuf,
    /// Whether it is complete; else it was stopped.
    pub complete: bool,
    /// Constructs simulated in this session.
    pub constructs: usize,
    /// Seconds of this session.
    pub seconds: f64,
    /// Lines that say what came of it.
    pub lines: Vec<String>,
}

/// Reads the prediction of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    KIND.plan(path, |name, text, sets, quick, load| super::read(name, text, sets, quick, load))
}

/// Runs what is missing of a prediction.
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
    let before = there.constructs();
    let (simulate, predict) = (unsimulated(plan, &there), unpredicted(plan, &there));
    watch.begin(
        &path,
        "constructs",
        simulate.len() + predict.len(),
        there.simulated.len() + there.predicted.len(),
        threads,
    );
    let began = Instant::now();
    let mut times = Times::default();
    let complete = simulated(plan, &simulate, threads, &mut there, &mut log, watch, &mut times);
    let models = match complete {
        Ok(true) => Some(fitted(plan, &there)),
        _ => None,
    };
    let complete = match (&models, complete) {
        (Some(models), Ok(_)) => predicted(plan, models, &predict, threads, &mut there, &mut log, watch, &mut times),
        (_, other) => other,
    };
    let seconds = began.elapsed().as_secs_f64();
    let constructs = there.constructs() - before;
    job.note(&[("seconds", json!(seconds)), ("constructs", json!(constructs)), ("trial_seconds", times.json())]);
    job.end(matches!(complete, Ok(true)))?;
    let (true, Some(models)) = (complete?, models) else {
        return Ok(Done { folder: path, complete: false, constructs, seconds, lines: Vec::new() });
    };
    let results = results(plan, &there, &models);
    finish(&job.folder, &results, &there, &models, program)?;
    let lines = report::lines(&results).into_iter().chain(times.line()).collect();
    Ok(Done { folder: path, complete: true, constructs, seconds, lines })
}

/// Makes tables and page of a complete folder anew.
///
/// # Errors
/// A folder that holds no complete prediction, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let (_, there) = opened(&folder)?;
    if !unsimulated(&plan, &there).is_empty() || !unpredicted(&plan, &there).is_empty() {
        let what = format!("`{}` is not complete; the same run command goes on", path.display());
        return Err(StoreError::Refused(what));
    }
    let models = fitted(&plan, &there);
    finish(&folder, &results(&plan, &there, &models), &there, &models, program)
}

fn finish(
    folder: &Folder,
    results: &Results<'_>,
    there: &There,
    models: &[Option<Model>],
    program: &str,
) -> Result<(), StoreError> {
    tables::write(folder, results, &|lot, number| there.courses(lot, number))?;
    let page = report::page(results, &|lot, number| there.courses(lot, number), models, program);
    folder.write_text(REPORT, &crate::report::html(&page))
}

impl There {
    /// How many constructs were simulated.
    fn constructs(&self) -> usize {
        self.simulated.keys().filter(|(_, number)| *number != BARE).count()
    }
    /// The simulated trials of a construct.
    fn courses(&self, lot: usize, number: u64) -> &[Course] {
        self.simulated.get(&(lot, number)).map_or(&[], Vec::as_slice)
    }
}

fn opened(folder: &Folder) -> Result<(Log, There), StoreError> {
    let path = folder.file(LOG);
    let (mut log, records) = Log::resume(&path)?;
    let there = known(&mut log, &records, &path)?;
    Ok((log, there))
}

/// What the records of a log hold.
fn known(log: &mut Log, records: &[Record], path: &Path) -> Result<There, StoreError> {
    let damaged = || StoreError::Damaged(format!("a record in `{}` is no construct", path.display()));
    let mut there = There::default();
    for record in records {
        let words = unpacked(&log.read(record)?);
        match (record.kind, words.as_slice()) {
            (SIMULATED, [lot, number, rest @ ..]) => {
                let courses = courses(rest).ok_or_else(damaged)?;
                there.simulated.insert((*lot as usize, *number), courses);
            }
            (PREDICTED, &[model, lot, number, successes, trials, transitions]) => {
                let found = Predicted { share: Share { successes, trials }, transitions };
                there.predicted.insert((model, lot as usize, number), found);
            }
            (SIMULATED | PREDICTED, _) => return Err(damaged()),
            _ => {}
        }
    }
    Ok(there)
}

/// Courses as words: of each its fitness, its steps and its looks.
fn words(courses: &[Course]) -> Vec<u64> {
    let one = |course: &Course| {
        let head = [course.fitness.to_bits(), course.steps, course.looks.len() as u64];
        head.into_iter().chain(course.looks.iter().flat_map(State::words)).collect::<Vec<u64>>()
    };
    courses.iter().flat_map(one).collect()
}

fn courses(mut words: &[u64]) -> Option<Vec<Course>> {
    let mut courses = Vec::new();
    while let [fitness, steps, looks, rest @ ..] = words {
        let own = rest.get(..usize::try_from(*looks).ok()?.checked_mul(WORDS)?)?;
        let (states, _) = own.as_chunks::<WORDS>();
        let looks = states.iter().map(State::from_words).collect();
        courses.push(Course { fitness: f64::from_bits(*fitness), steps: *steps, looks });
        words = &rest[own.len()..];
    }
    words.is_empty().then_some(courses)
}

/// Seconds of all threads, and trials.
#[derive(Clone, Copy, Debug, Default)]
struct Times {
    simulated: (f64, usize),
    predicted: (f64, usize),
}

impl Times {
    fn json(self) -> serde_json::Value {
        let of = |(seconds, trials): (f64, usize)| json!({ "seconds": seconds, "trials": trials });
        json!({ "simulated": of(self.simulated), "predicted": of(self.predicted) })
    }
    /// What a trial took, where both were made in this session.
    fn line(self) -> Option<String> {
        let each = |(seconds, trials): (f64, usize)| (trials > 0).then(|| seconds / trials as f64 * 1e3);
        let (simulated, predicted) = (each(self.simulated)?, each(self.predicted)?);
        Some(format!("a simulated trial took {simulated:.3} ms of a thread, a predicted one {predicted:.3} ms"))
    }
}

/// A construct of a lot; none without one.
type Unit = (usize, u64);

fn unsimulated(plan: &Plan, there: &There) -> Vec<Unit> {
    let lots = plan.lots.iter().enumerate();
    let all = lots.flat_map(|(k, lot)| (0..lot.constructs).map(move |number| (k, number)));
    let bare = (plan.form.control_trials > 0).then_some((0, BARE));
    all.chain(bare).filter(|unit| !there.simulated.contains_key(unit)).collect()
}

/// Which model predicts what: its place, its fingerprint, a lot and a number.
fn unpredicted(plan: &Plan, there: &There) -> Vec<(usize, u64, Unit)> {
    let mut units: Vec<Unit> = Vec::new();
    for (lot, _) in plan.tests() {
        units.extend(plan.numbers(lot, true).into_iter().map(|number| (lot, number)));
    }
    units.extend((plan.form.control_trials > 0).then_some((0, BARE)));
    let mut all = Vec::new();
    for (k, (_, model)) in plan.form.model.0.iter().enumerate() {
        let mark = plan.fingerprint(model);
        all.extend(units.iter().map(|&unit| (k, mark, unit)));
    }
    all.retain(|(_, mark, unit)| !there.predicted.contains_key(&(*mark, unit.0, unit.1)));
    all
}

/// Simulates; whether all is done.
fn simulated(
    plan: &Plan,
    units: &[Unit],
    threads: usize,
    there: &mut There,
    log: &mut Log,
    watch: &mut dyn Watch,
    times: &mut Times,
) -> Result<bool, StoreError> {
    let stop = watch.stopper();
    let work = |&(lot, number): &Unit, stop: &dyn Fn() -> bool| {
        let began = Instant::now();
        let courses = tried(plan, lot, number, stop)?;
        Ok(courses.map(|courses| (courses, began.elapsed().as_secs_f64())))
    };
    let take = |&(lot, number): &Unit, (courses, seconds): (Vec<Course>, f64)| {
        log.append(SIMULATED, &packed([lot as u64, number].into_iter().chain(words(&courses))))?;
        let members = plan.lots[lot].population.members() as u64;
        watch.done(courses.iter().map(|course| course.steps * members).sum());
        times.simulated.0 += seconds;
        times.simulated.1 += courses.len();
        there.simulated.insert((lot, number), courses);
        Ok(())
    };
    spread(units, threads, &stop, work, take)
}

/// The simulated trials of a construct; none where it was stopped.
fn tried(plan: &Plan, lot: usize, number: u64, stop: &dyn Fn() -> bool) -> Result<Option<Vec<Course>>, String> {
    let built = if number == BARE { None } else { Some(plan.built(lot, number)?.construct) };
    let behaviour = plan.behaviour(lot, built.as_ref()).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?;
    let (scenario, _) = plan.among(lot, built.as_ref());
    let seeds: Vec<u64> = match number {
        BARE => (1..=plan.form.control_trials as u64).map(|trial| plan.bare(trial)).collect(),
        _ => (1..=plan.trials as u64).map(|trial| plan.trial(lot, number, trial)).collect(),
    };
    let asked = plan.asked(lot, &behaviour);
    Ok(seeds.into_iter().map(|seed| course::simulated(asked, &scenario, seed, stop)).collect())
}

/// The models, fitted to what was simulated of the constructs that are not held out.
fn fitted(plan: &Plan, there: &There) -> Vec<Option<Model>> {
    let training: Vec<(Vec<Wall>, &[Course])> = plan
        .numbers(0, false)
        .into_iter()
        .map(|number| {
            // what was tried once can be built again
            let built = plan.built(0, number).ok();
            (plan.among(0, built.as_ref().map(|built| &built.construct)).1, there.courses(0, number))
        })
        .collect();
    let transitions = || {
        training.iter().flat_map(|(walls, courses)| {
            courses.iter().flat_map(move |course| {
                course.looks.windows(2).map(move |pair| Transition { from: &pair[0], walls, to: &pair[1] })
            })
        })
    };
    plan.form.model.0.iter().map(|(_, form)| Model::fitted(form, transitions())).collect()
}

/// The states in which predicted trials begin; none where the seed makes a start impossible.
pub(super) fn starts(plan: &Plan, lot: usize, count: usize) -> Result<Vec<Option<State>>, String> {
    let behaviour = plan.behaviour(lot, None).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?;
    let (scenario, _) = plan.among(lot, None);
    let asked = plan.asked(lot, &behaviour);
    Ok((1..=count as u64).map(|trial| course::start(asked, &scenario, plan.start(trial))).collect())
}

/// Predicts; whether all is done.
fn predicted(
    plan: &Plan,
    models: &[Option<Model>],
    units: &[(usize, u64, Unit)],
    threads: usize,
    there: &mut There,
    log: &mut Log,
    watch: &mut dyn Watch,
    times: &mut Times,
) -> Result<bool, StoreError> {
    let stop = watch.stopper();
    let mut begun: Vec<Vec<Option<State>>> = Vec::new();
    for lot in 0..plan.lots.len() {
        // no start is drawn for what is there already
        let wanted = units.iter().any(|(_, _, unit)| unit.0 == lot);
        let count = if wanted { plan.predicted } else { 0 };
        begun.push(starts(plan, lot, count).map_err(StoreError::Refused)?);
    }
    let work = |&(model, _, (lot, number)): &(usize, u64, Unit), stop: &dyn Fn() -> bool| {
        let began = Instant::now();
        let Some(model) = &models[model] else { return Ok(Some((Predicted::default(), 0.0))) };
        let number = (number != BARE).then_some(number);
        let Some(courses) = foretold(plan, model, lot, number, &begun[lot], stop)? else { return Ok(None) };
        let transitions = courses.iter().map(|course| course.looks.len() as u64 - 1).sum();
        Ok(Some((Predicted { share: share(plan, &courses), transitions }, began.elapsed().as_secs_f64())))
    };
    let take = |&(_, mark, (lot, number)): &(usize, u64, Unit), (found, seconds): (Predicted, f64)| {
        let Predicted { share: Share { successes, trials }, transitions } = found;
        log.append(PREDICTED, &packed([mark, lot as u64, number, successes, trials, transitions]))?;
        watch.done(0);
        times.predicted.0 += seconds;
        times.predicted.1 += trials as usize;
        there.predicted.insert((mark, lot, number), found);
        Ok(())
    };
    spread(units, threads, &stop, work, take)
}

/// Predicted trials of a construct of a lot (of none where there is no number), from starts that were possible; none where it was stopped.
pub(super) fn foretold(
    plan: &Plan,
    model: &Model,
    lot: usize,
    number: Option<u64>,
    starts: &[Option<State>],
    stop: &dyn Fn() -> bool,
) -> Result<Option<Vec<Course>>, String> {
    let built = number.map(|number| plan.built(lot, number)).transpose()?.map(|built| built.construct);
    let behaviour = plan.behaviour(lot, built.as_ref()).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?;
    let (_, walls) = plan.among(lot, built.as_ref());
    let members = Members::new(plan.lots[lot].population.members());
    let asked = plan.asked(lot, &behaviour);
    let possible = starts.iter().enumerate().filter_map(|(k, start)| Some((k as u64 + 1, start.as_ref()?)));
    let one = |(trial, start): (u64, &State)| {
        let key = plan.key(lot, number, trial);
        (!stop()).then(|| course::predicted(asked, model, &members, start, &walls, key))
    };
    Ok(possible.map(one).collect())
}

fn share(plan: &Plan, courses: &[Course]) -> Share {
    let mut share = Share::default();
    for course in courses.iter().filter(|course| course.fitness.is_finite()) {
        share.trials += 1;
        share.successes += u64::from(course.fitness >= plan.form.success);
    }
    share
}

fn results<'a>(plan: &'a Plan, there: &There, models: &[Option<Model>]) -> Results<'a> {
    let marks: Vec<u64> = plan.form.model.0.iter().map(|(_, model)| plan.fingerprint(model)).collect();
    let simulated = |lot: usize, number: u64| {
        let courses = there.courses(lot, number);
        let steps: u64 = courses.iter().map(|course| course.steps).sum();
        (share(plan, courses), steps * plan.lots[lot].population.members() as u64)
    };
    let predicted = |model: usize, lot: usize, number: u64| {
        there.predicted.get(&(marks[model], lot, number)).copied().unwrap_or_default()
    };
    let fits: Vec<Fit> =
        models.iter().map(|model| model.as_ref().map_or_else(Fit::default, |one| one.fit.clone())).collect();
    let bare = marks.iter().enumerate().map(|(model, _)| predicted(model, 0, BARE).share).collect();
    Results::new(plan, &simulated, &predicted, fits, (share(plan, there.courses(0, BARE)), bare))
}
