//! Running an evolution: generation after generation, each run on its own, into one folder.
//!
//! Each generation ends as one record of an append-only log, and the search goes on from its records: a stop at any moment
//! loses the generation in work and nothing else, and the history is the same for any number of threads and stops.

use super::contest::{self, Contest, Tried};
use super::evaluate::{self, Evaluated, Stage};
use super::form::Search;
use super::plan::Plan;
use super::variants::Variants;
use super::{report, tables};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::job::{File, Job, Kind};
use crate::store::log::{Log, Record};
use crate::study::claims::Judgement;
use core::ops::{ControlFlow, Range};
use search::elites::{Elites, Told};
use search::evolution_strategy::EvolutionStrategy;
use search::genetic::Genetic;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};

/// The log of generations.
pub const HISTORY: &str = "generations.log";
/// The page.
pub const REPORT: &str = "report.html";
/// The champion, as a scenario.
pub const CHAMPION: &str = "champion.toml";
/// Kinds of records: a generation, the last candidates tried again, a contender's worlds.
const GENERATION: u32 = 1;
const CONFIRMED: u32 = 2;
const CHOSEN: u32 = 3;
const CONTENDED: u32 = 4;
/// What the search of a rival gets its seed by.
const RIVAL: u32 = 7;

/// A generation of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Generation {
    /// Its candidates, `[candidates][genes]`.
    pub candidates: Vec<Vec<f64>>,
    /// What was found out of them.
    pub evaluated: Evaluated,
}

/// What is known of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Its generations, in order.
    pub generations: Vec<Generation>,
    /// Scores of the last candidates in worlds of a confirmation, `[candidates][worlds]`.
    pub confirmed: Option<Vec<Vec<f64>>>,
}

impl Run {
    /// Genes and score of its champion: of the last candidates the best on the average of all worlds in which they were tried
    /// again. Where they were not, the best of all candidates that were tried in the same worlds: those of the last
    /// generation of a shared world, which is new every time, else those of all generations. None where none has a score.
    pub fn champion(&self, plan: &Plan) -> Option<(&[f64], f64)> {
        let last = self.generations.last()?;
        let tried: Vec<(&Vec<f64>, f64)> = match &self.confirmed {
            Some(worlds) => {
                let averages: Vec<f64> = worlds.iter().map(|own| own.iter().sum::<f64>() / own.len() as f64).collect();
                last.candidates.iter().zip(averages).collect()
            }
            None => {
                let same = if plan.shared.is_some() { core::slice::from_ref(last) } else { &self.generations[..] };
                let scored = |generation: &'_ Generation| generation.evaluated.scores.clone();
                same.iter().flat_map(|one| plan.own(&one.candidates).iter().zip(scored(one))).collect()
            }
        };
        let finite = tried.into_iter().filter(|(_, score)| score.is_finite());
        let best = finite.reduce(|best, other| if other.1 > best.1 { other } else { best })?;
        Some((best.0, best.1))
    }
}

/// Who watches.
pub trait Watch: Sync {
    /// It begins or goes on: so many generations are to be done, so many are there already.
    fn begin(&mut self, folder: &Path, generations: usize, there: usize, threads: usize);
    /// A generation is done, with so many updates of agents and this best score.
    fn done(&mut self, updates: u64, best: f64);
    /// Whether to stop.
    fn stopper(&self) -> fn() -> bool;
}

/// What became of an evolution.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its folder.
    pub folder: PathBuf,
    /// Generations that are left, where it was stopped.
    pub left: usize,
    /// Generations done in this session.
    pub generations: usize,
    /// Updates of agents in this session.
    pub updates: u64,
    /// Seconds of this session.
    pub seconds: f64,
    /// Scores of the champions, by run and its name.
    pub champions: Vec<(String, Option<f64>)>,
    /// The statements of a complete evolution with what the data say of them.
    pub judgements: Vec<Judgement>,
}

/// What the folder of an evolution holds, and what may be added to it.
const KIND: Kind = Kind { name: "evolution", one: "an evolution", may_grow: "runs and generations" };

/// Reads the evolution of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Variants, StoreError> {
    KIND.plan(path, |name, text, sets, quick, load| super::read(name, text, sets, quick, load))
}

/// Runs what is missing of an evolution.
///
/// # Errors
/// Where the folder is of something else, the system refuses, or a world is impossible. What was done before stays.
pub fn run(
    variants: &Variants,
    threads: usize,
    out: Option<&Path>,
    program: &str,
    watch: &mut dyn Watch,
) -> Result<Outcome, StoreError> {
    let plan = variants.first();
    let file = File {
        title: &plan.form.title,
        sources: &plan.sources,
        sets: &plan.sets,
        quick: plan.quick,
        identity: variants.identity(),
    };
    let mut job = Job::of_file(KIND, &file, out, (program, threads))?;
    let path = job.folder.path().to_owned();
    let mut history = opened(&job.folder, variants)?;
    let there: usize = history.runs.iter().map(|run| run.generations.len()).sum();
    watch.begin(&path, variants.generations() - there, there, threads);
    let began = std::time::Instant::now();
    let done = work(variants, threads, &mut history, watch);
    let left = || -> usize {
        let missing = |(k, run): (usize, &Run)| {
            let plan = &variants.plans[variants.of_run(k).0];
            plan.generations.saturating_sub(run.generations.len())
        };
        history.runs.iter().enumerate().map(missing).sum::<usize>()
    };
    let left = left();
    let confirmed = plan.form.confirm == 0 || history.runs.iter().all(|run| run.confirmed.is_some());
    let contests = match &done {
        Ok(_) if left == 0 && confirmed => contests(variants, threads, &mut history, watch.stopper()),
        _ => Ok(None),
    };
    let seconds = began.elapsed().as_secs_f64();
    let complete = matches!(contests, Ok(Some(_)));
    let done = done.and_then(|done| Ok((done, contests?)));
    let ((generations, updates), contests) = done.map_err(|error| job.fail(error))?;
    job.note(&[("seconds", json!(seconds)), ("generations", json!(generations))]);
    let mut judgements = Vec::new();
    if let Some(contests) = &contests {
        let asked = report::Asked::of(variants, &history.runs, contests);
        finish(&job.folder, variants, &history.runs, (contests, &asked), program)?;
        judgements = asked.judgements;
    }
    job.end(complete)?;
    let score = |(k, run): (usize, &Run)| {
        let (variant, own) = variants.of_run(k);
        let name = format!("run {}", own + 1);
        let name = if variants.plans.len() > 1 { format!("{}, {name}", variants.name(variant)) } else { name };
        (name, run.champion(&variants.plans[variant]).map(|(_, score)| score))
    };
    let champions = history.runs.iter().enumerate().map(score).collect();
    let left = if contests.is_some() { 0 } else { left.max(1) };
    Ok(Outcome { folder: path, left, generations, updates, seconds, champions, judgements })
}

/// Makes the page of a complete folder anew.
///
/// # Errors
/// A folder that holds no complete evolution, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let variants = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let mut history = opened(&folder, &variants)?;
    let there: usize = history.runs.iter().map(|run| run.generations.len()).sum();
    let complete = there == variants.generations();
    // what is missing of a contest is not made here
    let contests = if complete { contests(&variants, 1, &mut history, || true)? } else { None };
    match contests {
        Some(contests) => {
            let asked = report::Asked::of(&variants, &history.runs, &contests);
            finish(&folder, &variants, &history.runs, (&contests, &asked), program)
        }
        None => Err(StoreError::Refused(format!("`{}` is not complete; the same run command goes on", path.display()))),
    }
}

/// Tables, champions and page.
fn finish(
    folder: &Folder,
    variants: &Variants,
    runs: &[Run],
    (contests, asked): (&[Contest], &report::Asked),
    program: &str,
) -> Result<(), StoreError> {
    tables::write(folder, variants, runs, contests)?;
    for (variant, (plan, own)) in variants.plans.iter().zip(runs.chunks(variants.runs())).enumerate() {
        if let Some(text) = champion(plan, own) {
            folder.write_text(&champion_file(variant), &text)?;
        }
    }
    folder.write_text(REPORT, &crate::report::html(&report::page(variants, runs, (contests, asked), program)))
}

/// Name of the champion's file of a variant, which counts from 0.
fn champion_file(variant: usize) -> String {
    match variant {
        0 => CHAMPION.to_owned(),
        other => CHAMPION.replace(".toml", &format!("-{}.toml", other + 1)),
    }
}

/// The best champion of all runs as a scenario file; who shared a world has the whole group.
pub fn champion(plan: &Plan, runs: &[Run]) -> Option<String> {
    let champions = runs.iter().enumerate().filter_map(|(k, run)| run.champion(plan).map(|found| (k, found)));
    let (run, (genes, score)) = champions.reduce(|best, other| if other.1.1 > best.1.1 { other } else { best })?;
    let mut tree = match plan.shared {
        Some(_) => {
            let mut tree = plan.tree.clone();
            for ((_, gene), value) in plan.form.gene.0.iter().zip(plan.values(genes)) {
                let node = crate::file::Node { tree: value, span: tree.span.clone() };
                tree.set(gene.path.as_deref()?, node).ok()?;
            }
            tree
        }
        None => evaluate::condition(plan, genes).ok()?.tree,
    };
    let title = format!("{}: the champion of run {}, with a fitness of {score:.6}", plan.form.title, run + 1);
    let node = crate::file::Node { tree: crate::file::Tree::Text(title), span: tree.span.clone() };
    tree.set("title", node).ok()?;
    Some(crate::file::write::toml(&tree))
}

/// What is known of an evolution, and the log that keeps it.
struct History {
    log: Log,
    /// Runs, variant by variant.
    runs: Vec<Run>,
    /// What was found out of contenders, by variant.
    tried: Vec<Tried>,
}

fn opened(folder: &Folder, variants: &Variants) -> Result<History, StoreError> {
    let path = folder.file(HISTORY);
    let (mut log, records) = Log::resume(&path)?;
    let (runs, tried) = known(&mut log, &records, &path, variants)?;
    Ok(History { log, runs, tried })
}

/// The evolution in a folder with what is known of its runs, variant by variant, as one looks at it: nothing is written.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn look(path: &Path) -> Result<(Variants, Vec<Run>, Vec<Contest>), StoreError> {
    let variants = of_folder(path)?;
    let path = path.join(HISTORY);
    if !path.exists() {
        let (runs, _) = nothing(&variants);
        return Ok((variants, runs, Vec::new()));
    }
    let (mut log, records) = Log::open_to_read(&path)?;
    let (runs, mut tried) = known(&mut log, &records, &path, &variants)?;
    let contests = held_before(&variants, &runs, &mut tried);
    Ok((variants, runs, contests))
}

/// The contests of which everything is known; none where anything is missing.
fn held_before(variants: &Variants, runs: &[Run], tried: &mut [Tried]) -> Vec<Contest> {
    let complete = |(k, run): (usize, &Run)| run.generations.len() == variants.plans[variants.of_run(k).0].generations;
    if !runs.iter().enumerate().all(complete) {
        return Vec::new();
    }
    let runs = runs.chunks(variants.runs());
    let held = variants.plans.iter().zip(runs).zip(tried).filter(|((plan, _), _)| plan.form.contest.is_some());
    let one = |((plan, runs), tried): ((&Plan, &[Run]), &mut Tried)| {
        // nothing is tried anew: what is missing stops it
        contest::held(plan, runs, tried, 1, &|| true, &mut |_, _, _| ControlFlow::Break(())).ok().flatten()
    };
    held.map(one).collect::<Option<Vec<Contest>>>().unwrap_or_default()
}

/// Runs and contenders of which nothing is known.
fn nothing(variants: &Variants) -> (Vec<Run>, Vec<Tried>) {
    let count = variants.plans.len();
    (vec![Run::default(); variants.runs() * count], vec![Tried::new(); count])
}

/// What the records of a log hold of the runs and of contenders.
fn known(
    log: &mut Log,
    records: &[Record],
    path: &Path,
    variants: &Variants,
) -> Result<(Vec<Run>, Vec<Tried>), StoreError> {
    let each = variants.runs();
    let (mut runs, mut tried) = nothing(variants);
    let damaged = || StoreError::Damaged(format!("a record in `{}` is no generation", path.display()));
    for record in records {
        let bytes = log.read(record)?;
        let (variant, run, number, words) = unpacked(&bytes).ok_or_else(damaged)?;
        let plan = variants.plans.get(variant).ok_or_else(damaged)?;
        if let CHOSEN | CONTENDED = record.kind {
            let (genes, rows) = words.split_at_checked(plan.axes.len()).ok_or_else(damaged)?;
            let rows = rows.chunks(1 + plan.kept().len()).map(<[f64]>::to_vec).collect();
            let stage = if record.kind == CHOSEN { Stage::Choose } else { Stage::Contest };
            tried[variant].insert((stage, contest::key(genes)), rows);
            continue;
        }
        // runs may have been fewer since
        let Some(run) = (run < each).then(|| &mut runs[variant * each + run]) else { continue };
        match record.kind {
            GENERATION if number == run.generations.len() => {
                run.generations.push(generation_of(plan, &words).ok_or_else(damaged)?);
            }
            // a record of the last generation of a shorter evolution is of no use to a longer one
            CONFIRMED if number == plan.generations && plan.form.confirm > 0 => {
                run.confirmed = Some(words.chunks(plan.form.confirm).map(<[f64]>::to_vec).collect());
            }
            _ => {}
        }
    }
    for (k, run) in runs.iter_mut().enumerate() {
        run.generations.truncate(variants.plans[k / each].generations);
    }
    Ok((runs, tried))
}

/// Holds what is missing of the contests. None where it was stopped; empty where there are none.
fn contests(
    variants: &Variants,
    threads: usize,
    history: &mut History,
    stop: fn() -> bool,
) -> Result<Option<Vec<Contest>>, StoreError> {
    let mut contests = Vec::new();
    let runs = history.runs.chunks(variants.runs());
    for (variant, ((plan, runs), tried)) in variants.plans.iter().zip(runs).zip(&mut history.tried).enumerate() {
        if plan.form.contest.is_none() {
            continue;
        }
        let (log, mut failed) = (&mut history.log, None);
        let mut note = |stage: Stage, genes: &[f64], rows: &[Vec<f64>]| {
            let numbers = genes.iter().chain(rows.iter().flatten()).copied();
            let kind = if stage == Stage::Choose { CHOSEN } else { CONTENDED };
            match log.append(kind, &packed(variant, 0, 0, numbers)) {
                Ok(_) => ControlFlow::Continue(()),
                Err(error) => {
                    failed = Some(error);
                    ControlFlow::Break(())
                }
            }
        };
        let held = contest::held(plan, runs, tried, threads, &stop, &mut note);
        if let Some(error) = failed {
            return Err(error);
        }
        match held.map_err(|what| StoreError::Refused(format!("the contest: {what}")))? {
            Some(contest) => contests.push(contest),
            None => return Ok(None),
        }
    }
    Ok(Some(contests))
}

/// A record: variant and run, number of the generation, numbers.
fn packed(variant: usize, run: usize, number: usize, numbers: impl Iterator<Item = f64>) -> Vec<u8> {
    let head = [(variant as u64) << 32 | run as u64, number as u64];
    head.into_iter().chain(numbers.map(f64::to_bits)).flat_map(u64::to_le_bytes).collect()
}

fn unpacked(bytes: &[u8]) -> Option<(usize, usize, usize, Vec<f64>)> {
    let words: Vec<u64> = bytes.chunks_exact(8).map(|w| u64::from_le_bytes(core::array::from_fn(|k| w[k]))).collect();
    let [run, number, numbers @ ..] = words.as_slice() else { return None };
    Some((
        (run >> 32) as usize,
        (run & u64::from(u32::MAX)) as usize,
        usize::try_from(*number).ok()?,
        numbers.iter().map(|&bits| f64::from_bits(bits)).collect(),
    ))
}

/// The numbers of a generation: how many candidates, then candidate by candidate genes, score, kinds; then what is kept.
fn numbers(generation: &Generation) -> impl Iterator<Item = f64> + '_ {
    let Evaluated { scores, kept, kinds } = &generation.evaluated;
    let own = generation.candidates.iter().enumerate().flat_map(move |(k, genes)| {
        let kinds = kinds.get(k).into_iter().flatten().copied();
        genes.iter().copied().chain([scores[k]]).chain(kinds)
    });
    [generation.candidates.len() as f64].into_iter().chain(own).chain(kept.iter().flatten().copied())
}

fn generation_of(plan: &Plan, numbers: &[f64]) -> Option<Generation> {
    let (&count, numbers) = numbers.split_first()?;
    let (count, genes, kinds, kept) = (count as usize, plan.axes.len(), plan.kinds.len(), plan.kept().len());
    let own = genes + 1 + kinds;
    let rows = if plan.shared.is_some() { 1 } else { count };
    if numbers.len() != count * own + rows * kept {
        return None;
    }
    let (candidates, rest) = numbers.split_at(count * own);
    let rows: Vec<&[f64]> = candidates.chunks_exact(own).collect();
    Some(Generation {
        candidates: rows.iter().map(|row| row[..genes].to_vec()).collect(),
        evaluated: Evaluated {
            scores: rows.iter().map(|row| row[genes]).collect(),
            kinds: if kinds > 0 { rows.iter().map(|row| row[genes + 1..].to_vec()).collect() } else { Vec::new() },
            kept: if kept > 0 { rest.chunks_exact(kept).map(<[f64]>::to_vec).collect() } else { vec![Vec::new()] },
        },
    })
}

/// A search of any kind.
enum Searching {
    Genetic(Genetic),
    /// Two groups that evolve against each other, with the candidates of both, those of the first group first.
    Rivals(Box<[Genetic; 2]>, Vec<Vec<f64>>),
    Strategy(Box<EvolutionStrategy>),
    Elites(Box<Elites>),
}

impl Searching {
    /// The search of a run, as it is after its generations.
    fn of(plan: &Plan, run: usize, there: &[Generation]) -> Result<Self, search::SearchError> {
        let (domain, seed) = (plan.domain()?, plan.seed_of(run));
        let told = |generation: &Generation| -> Vec<Told> {
            let Evaluated { scores, kinds, .. } = &generation.evaluated;
            let one = |k: usize| Told { score: scores[k], descriptors: kinds.get(k).cloned().unwrap_or_default() };
            (0..scores.len()).map(one).collect()
        };
        Ok(match &plan.form.search {
            Search::Genetic(form) => {
                // the candidates of the group, or of its rival, which stand behind them
                let genetic = |seed: u64, part: Range<usize>| {
                    let operators = form.operators();
                    let Some(last) = there.last() else {
                        return Genetic::new(domain.clone(), operators, seed, 0, plan.first(form, seed)?);
                    };
                    let (number, candidates) = (there.len() as u64 - 1, last.candidates[part.clone()].to_vec());
                    let mut genetic = Genetic::new(domain.clone(), operators, seed, number, candidates)?;
                    genetic.tell(&last.evaluated.scores[part])?;
                    Ok(genetic)
                };
                let each = plan.candidates(form);
                match plan.shared.as_ref().and_then(|shared| shared.rival) {
                    None => Self::Genetic(genetic(seed, 0..each)?),
                    Some(_) => {
                        let rival = space::random::child_seed(seed, RIVAL, 0, 0);
                        Self::rivals([genetic(seed, 0..each)?, genetic(rival, each..2 * each)?])
                    }
                }
            }
            Search::CmaEs(form) => {
                let scores: Vec<Vec<f64>> =
                    there.iter().map(|generation| generation.evaluated.scores.clone()).collect();
                Self::Strategy(Box::new(EvolutionStrategy::resume(domain, plan.strategy(form), seed, &scores)?))
            }
            Search::MapElites(form) => {
                let (options, kinds) = plan.elites(form)?;
                let rounds: Vec<Vec<Told>> = there.iter().map(told).collect();
                Self::Elites(Box::new(Elites::resume(domain, &kinds, options, seed, &rounds)?))
            }
        })
    }
    fn rivals(both: [Genetic; 2]) -> Self {
        let candidates = both.iter().flat_map(|one| one.candidates().iter().cloned()).collect();
        Self::Rivals(Box::new(both), candidates)
    }
    fn candidates(&self) -> &[Vec<f64>] {
        match self {
            Self::Genetic(search) => search.candidates(),
            Self::Rivals(_, candidates) => candidates,
            Self::Strategy(search) => search.candidates(),
            Self::Elites(search) => search.candidates(),
        }
    }
    fn tell(&mut self, evaluated: &Evaluated) -> Result<(), search::SearchError> {
        match self {
            Self::Genetic(search) => search.tell(&evaluated.scores),
            Self::Rivals(both, candidates) => {
                for (one, scores) in both.iter_mut().zip(evaluated.scores.chunks(candidates.len() / 2)) {
                    one.tell(scores)?;
                }
                *candidates = both.iter().flat_map(|one| one.candidates().iter().cloned()).collect();
                Ok(())
            }
            Self::Strategy(search) => search.tell(&evaluated.scores),
            Self::Elites(search) => {
                let one = |(&score, kinds): (&f64, &Vec<f64>)| Told { score, descriptors: kinds.clone() };
                let told: Vec<Told> = evaluated.scores.iter().zip(&evaluated.kinds).map(one).collect();
                search.tell(&told)
            }
        }
    }
}

/// What a run tells the writer.
enum News {
    Generation(usize, Generation),
    Confirmed(usize, Vec<Vec<f64>>),
    Failed(usize, String),
}

/// News that wait to be written, at most.
const WAITING: usize = 256;

/// Does what is missing; how many generations were done, with their updates of agents.
fn work(
    variants: &Variants,
    threads: usize,
    history: &mut History,
    watch: &mut dyn Watch,
) -> Result<(usize, u64), StoreError> {
    let History { log, runs, .. } = history;
    // runs are independent of each other: one thread each as long as there are as many, else more threads for each
    let workers = threads.clamp(1, runs.len().max(1));
    let inside = (threads / workers).max(1);
    let (next, over) = (AtomicUsize::new(0), AtomicBool::new(false));
    let asked = watch.stopper();
    let stop = || over.load(Ordering::Relaxed) || asked();
    let begun: Vec<Run> = runs.to_vec();
    let (to, from) = sync_channel(WAITING);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            let to = to.clone();
            let (next, stop, begun) = (&next, &stop, &begun);
            scope.spawn(move || {
                while !stop() {
                    let run = next.fetch_add(1, Ordering::Relaxed);
                    let Some(there) = begun.get(run) else { return };
                    if let Err(what) = evolve(variants, run, there, inside, stop, &to) {
                        // nobody listens any more where this fails
                        let _ = to.send(News::Failed(run, what));
                        return;
                    }
                }
            });
        }
        drop(to);
        let (mut done, mut updates) = (0, 0);
        let mut failure = None;
        for news in from {
            let written = match news {
                News::Generation(run, generation) => {
                    let (variant, own) = variants.of_run(run);
                    let record = packed(variant, own, runs[run].generations.len(), numbers(&generation));
                    log.append(GENERATION, &record).map(|_| {
                        let made = variants.plans[variant].updates(generation.candidates.len());
                        let scores = generation.evaluated.scores.iter().copied();
                        watch.done(made, scores.filter(|score| score.is_finite()).fold(f64::NEG_INFINITY, f64::max));
                        (done, updates) = (done + 1, updates + made);
                        runs[run].generations.push(generation);
                    })
                }
                News::Confirmed(run, scores) => {
                    let (variant, own) = variants.of_run(run);
                    let number = variants.plans[variant].generations;
                    let record = packed(variant, own, number, scores.iter().flatten().copied());
                    log.append(CONFIRMED, &record).map(|_| runs[run].confirmed = Some(scores))
                }
                News::Failed(run, what) => Err(StoreError::Refused(format!("run {}: {what}", run + 1))),
            };
            if let Err(error) = written {
                // the others stop; what they have done is kept
                over.store(true, Ordering::Relaxed);
                failure.get_or_insert(error);
            }
        }
        failure.map_or(Ok((done, updates)), Err)
    })
}

/// Does what is missing of a run.
fn evolve(
    variants: &Variants,
    run: usize,
    there: &Run,
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
    to: &SyncSender<News>,
) -> Result<(), String> {
    let (variant, own) = variants.of_run(run);
    let (plan, number) = (&variants.plans[variant], own + 1);
    let mut last = there.generations.last().map(|generation| generation.candidates.clone());
    if there.generations.len() < plan.generations {
        let mut search = Searching::of(plan, number, &there.generations).map_err(|error| error.to_string())?;
        for generation in there.generations.len()..plan.generations {
            let candidates = search.candidates().to_vec();
            let found = evaluate::generation(plan, number, generation as u64, &candidates, threads, stop)?;
            let Some(evaluated) = found else { return Ok(()) };
            search.tell(&evaluated).map_err(|error| error.to_string())?;
            last = Some(candidates.clone());
            if stop() || to.send(News::Generation(run, Generation { candidates, evaluated })).is_err() {
                return Ok(());
            }
        }
    }
    if plan.form.confirm > 0
        && there.confirmed.is_none()
        && let Some(tried) = {
            let (last, worlds) = (last.unwrap_or_default(), plan.form.confirm);
            evaluate::tried(plan, (Stage::Confirm, number), plan.own(&last), worlds, threads, stop)?
        }
    {
        let scores = tried.iter().map(|worlds| worlds.iter().map(|row| row[0]).collect()).collect();
        let _ = to.send(News::Confirmed(run, scores));
    }
    Ok(())
}
