//! Running a formation file: walls are searched where none are given, then trial after trial, into one folder.
//!
//! What is found for a task, and each trial, ends as one record of an append-only log. So a stop at any moment loses what is in flight
//! and nothing else, and the tables are the same for any number of threads and stops.

use super::plan::{Plan, Watched};
use super::results::Results;
use super::task::Wall;
use super::trial::{self, Tried};
use super::{report, tables};
use crate::environment::work::{Watch, packed, spread, unpacked};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::job::{File, Job, Kind};
use crate::store::log::{Log, Record};
use serde_json::json;
use space::Segment;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The log.
pub const LOG: &str = "trials.log";
/// The page.
pub const REPORT: &str = "report.html";
/// Kinds of records: the walls found for a task, a trial.
const SOLVED: u32 = 1;
const TRIED: u32 = 2;

const KIND: Kind = Kind { name: "formation", one: "a formation file", may_grow: "trials and statements" };

/// What became of a formation file.
#[derive(Clone, Debug)]
pub struct Done {
    /// Its folder.
    pub folder: PathBuf,
    /// Searches and trials that are left, where it was stopped.
    pub left: usize,
    /// Trials made in this session.
    pub trials: usize,
    /// Seconds of this session.
    pub seconds: f64,
    /// Lines that say what came of it.
    pub lines: Vec<String>,
}

/// What is there already: walls by task, trials by task, method and number.
#[derive(Default)]
struct There {
    walls: BTreeMap<usize, Vec<Wall>>,
    trials: BTreeMap<(usize, usize, usize), Tried>,
}

impl There {
    fn walls(&self, plan: &Plan, task: usize) -> Vec<Wall> {
        plan.walls[task].clone().or_else(|| self.walls.get(&task).cloned()).unwrap_or_default()
    }
    fn results<'a>(&self, plan: &'a Plan) -> Results<'a> {
        let mut trials: BTreeMap<(usize, usize), Vec<Tried>> = BTreeMap::new();
        for (&(task, method, number), &tried) in &self.trials {
            // trials of a larger run before are left out
            if number <= plan.trials {
                trials.entry((task, method)).or_default().push(tried);
            }
        }
        let walls = (0..plan.tasks.len()).map(|task| plan.tasks[task].ordered(&self.walls(plan, task))).collect();
        Results { plan, walls, trials }
    }
}

/// Reads the formation file of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    KIND.plan(path, |name, text, sets, quick, load| super::read(name, text, sets, (quick, Watched::Nobody), load))
}

/// Runs what is missing.
///
/// # Errors
/// Where the folder is of something else, the system refuses, or a task is impossible. What was done before stays.
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
    let began = std::time::Instant::now();
    let stop = watch.stopper();
    let unsolved: Vec<usize> =
        (0..plan.tasks.len()).filter(|task| plan.searched(*task) && !there.walls.contains_key(task)).collect();
    let missing: Vec<(usize, usize, usize)> =
        units(plan).into_iter().filter(|unit| !there.trials.contains_key(unit)).collect();
    let all = units(plan).len();
    watch.begin(&path, "searches and trials", unsolved.len() + missing.len(), all - missing.len(), threads);
    let done = spread(
        &unsolved,
        threads,
        &stop,
        |task, stop| plan.solve(*task, stop),
        |task, solution| {
            let words = solution
                .walls
                .iter()
                .flat_map(|wall| std::iter::once(wall.leg as u64).chain(wall.at.numbers().map(f64::to_bits)));
            log.append(SOLVED, &packed(std::iter::once(*task as u64).chain(words)))?;
            watch.done(solution.trials);
            there.walls.insert(*task, solution.walls);
            Ok(())
        },
    );
    let solved = done.map_err(|error| job.fail(error))?;
    let mut made = 0;
    if solved {
        let walls: Vec<Vec<Wall>> = (0..plan.tasks.len()).map(|task| there.walls(plan, task)).collect();
        let done = spread(
            &missing,
            threads,
            &stop,
            |&(task, method, number), stop| {
                let arena = plan.arena(task, &plan.methods[method], &walls[task]);
                // impossible with this seed: no room for the targets, for one
                Ok(trial::run(&arena, plan.seed_of(task, number), stop, &mut |_| ()).unwrap_or(Some(Tried::NONE)))
            },
            |&unit, tried| {
                log.append(TRIED, &packed(words(unit, &tried)))?;
                watch.done(tried.steps * plan.methods[unit.1].population.members() as u64);
                there.trials.insert(unit, tried);
                made += 1;
                Ok(())
            },
        );
        done.map_err(|error| job.fail(error))?;
    }
    let left = units(plan).iter().filter(|unit| !there.trials.contains_key(*unit)).count()
        + (0..plan.tasks.len()).filter(|task| plan.searched(*task) && !there.walls.contains_key(task)).count();
    let mut lines = Vec::new();
    if left == 0 {
        let results = there.results(plan);
        lines = report::lines(&results);
        finish(&job.folder, &results, program)?;
    }
    let seconds = began.elapsed().as_secs_f64();
    job.note(&[("seconds", json!(seconds)), ("trials", json!(made))]);
    job.end(left == 0)?;
    Ok(Done { folder: path, left, trials: made, seconds, lines })
}

/// Task, method and number of every trial.
fn units(plan: &Plan) -> Vec<(usize, usize, usize)> {
    let mut units = Vec::new();
    for (method, own) in plan.methods.iter().enumerate() {
        for &task in &own.tasks {
            units.extend((1..=plan.trials).map(|number| (task, method, number)));
        }
    }
    units
}

/// Makes tables and page of a complete folder anew.
///
/// # Errors
/// A folder that is not complete, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let (_, there) = opened(&folder)?;
    if units(&plan).iter().any(|unit| !there.trials.contains_key(unit)) {
        return Err(StoreError::Refused(format!("`{}` is not complete; the same run command goes on", path.display())));
    }
    finish(&folder, &there.results(&plan), program)
}

fn finish(folder: &Folder, results: &Results<'_>, program: &str) -> Result<(), StoreError> {
    tables::write(folder, results)?;
    folder.write_text(REPORT, &crate::report::html(&report::page(results, program)))
}

fn opened(folder: &Folder) -> Result<(Log, There), StoreError> {
    let path = folder.file(LOG);
    let (mut log, records) = Log::resume(&path)?;
    let there = known(&mut log, &records, &path)?;
    Ok((log, there))
}

/// Trials by places of task and method, with their numbers.
pub type Trials = BTreeMap<(usize, usize), Vec<(usize, Tried)>>;

/// What is known of a formation file in its folder, complete or not, as one looks at it: the walls of each task and the trials.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn look(path: &Path) -> Result<(Plan, Vec<Vec<Wall>>, Trials), StoreError> {
    let plan = of_folder(path)?;
    let path = path.join(LOG);
    let mut there = There::default();
    if path.exists() {
        let (mut log, records) = Log::open_to_read(&path)?;
        there = known(&mut log, &records, &path)?;
    }
    let walls = (0..plan.tasks.len()).map(|task| plan.tasks[task].ordered(&there.walls(&plan, task))).collect();
    let mut trials = Trials::new();
    for ((task, method, number), tried) in there.trials {
        if number <= plan.trials && task < plan.tasks.len() && method < plan.methods.len() {
            trials.entry((task, method)).or_default().push((number, tried));
        }
    }
    Ok((plan, walls, trials))
}

/// What the records of a log hold.
fn known(log: &mut Log, records: &[Record], path: &Path) -> Result<There, StoreError> {
    let mut there = There::default();
    for record in records {
        let words = unpacked(&log.read(record)?);
        let damaged = || StoreError::Damaged(format!("a record in `{}` is no trial", path.display()));
        match (record.kind, words.as_slice()) {
            (SOLVED, [task, walls @ ..]) if walls.len().is_multiple_of(5) => {
                let wall = |words: &[u64]| {
                    let number = |k: usize| f64::from_bits(words[k]);
                    Wall { leg: words[0] as usize, at: Segment::new([number(1), number(2)], [number(3), number(4)]) }
                };
                there.walls.insert(*task as usize, walls.chunks_exact(5).map(wall).collect());
            }
            (TRIED, &[task, method, number, steps, ref numbers @ ..]) if numbers.len() == 7 => {
                let number_of = |k: usize| f64::from_bits(numbers[k]);
                let tried = Tried {
                    steps,
                    fitness: number_of(0),
                    time: number_of(1),
                    path_length: number_of(2),
                    dispersion: number_of(3),
                    held: number_of(4),
                    robots: number_of(5),
                    bumps: number_of(6),
                };
                there.trials.insert((task as usize, method as usize, number as usize), tried);
            }
            _ => return Err(damaged()),
        }
    }
    Ok(there)
}

/// A record: task, method, number of the trial, steps, and what was read.
fn words((task, method, number): (usize, usize, usize), tried: &Tried) -> Vec<u64> {
    let read = [tried.fitness, tried.time, tried.path_length, tried.dispersion, tried.held, tried.robots, tried.bumps];
    [task as u64, method as u64, number as u64, tried.steps].into_iter().chain(read.map(f64::to_bits)).collect()
}
