//! Running an evolution: generation after generation, each run on its own, into one folder.
//!
//! Each generation ends as one record of an append-only log, and the search goes on from its records: a stop at any moment
//! loses the generation in work and nothing else, and the history is the same for any number of threads and stops.

use super::evaluate::{self, Evaluated};
use super::form::Search;
use super::plan::Plan;
use super::{report, tables};
use crate::store::StoreError;
use crate::store::folder::{self, Folder};
use crate::store::log::Log;
use crate::store::texts::Texts;
use search::elites::{Elites, Told};
use search::evolution_strategy::EvolutionStrategy;
use search::genetic::Genetic;
use serde_json::{Value as Json, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};

/// The log of generations.
pub const HISTORY: &str = "generations.log";
/// The page.
pub const REPORT: &str = "report.html";
/// The champion, as a scenario.
pub const CHAMPION: &str = "champion.toml";
/// Kinds of records: a generation, and the last candidates tried again.
const GENERATION: u32 = 1;
const CONFIRMED: u32 = 2;

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
                same.iter().flat_map(|one| one.candidates.iter().zip(scored(one))).collect()
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
    /// Scores of the champions, by run.
    pub champions: Vec<Option<f64>>,
}

/// What the folder of an evolution holds, and what may be added to it.
const WHAT: (&str, &str) = ("evolution", "runs and generations");

/// Where the evolution in a folder differs from this one, apart from runs and generations that were added.
fn differences(plan: &Plan, manifest: &Json) -> Vec<String> {
    if manifest.get("kind").and_then(Json::as_str) != Some("evolution") {
        return vec!["it holds no evolution".to_owned()];
    }
    folder::differences(manifest.get("identity").unwrap_or(&Json::Null), &plan.identity())
}

/// Reads the evolution of a folder again.
///
/// # Errors
/// A folder that holds none, or one that cannot be read.
pub fn of_folder(path: &Path) -> Result<Plan, StoreError> {
    let damaged = |what: String| StoreError::Damaged(format!("`{}`: {what}", path.display()));
    let manifest = folder::manifest(path)?
        .filter(|manifest| manifest.get("kind").and_then(Json::as_str) == Some("evolution"))
        .ok_or_else(|| StoreError::Refused(format!("`{}` is not the folder of an evolution", path.display())))?;
    let texts = Texts::of(&manifest).ok_or_else(|| damaged("the manifest lacks what it should hold".to_owned()))?;
    let (name, first) = texts.file();
    super::read(name, first, &texts.sets, texts.quick, &mut |name| texts.text(name))
        .map_err(|problems| damaged(problems.to_string()))
}

/// Runs what is missing of an evolution.
///
/// # Errors
/// Where the folder is of something else, the system refuses, or a world is impossible. What was done before stays.
pub fn run(
    plan: &Plan,
    threads: usize,
    out: Option<&Path>,
    program: &str,
    watch: &mut dyn Watch,
) -> Result<Outcome, StoreError> {
    let stem = plan.sources.stem(0).unwrap_or("evolution");
    let path = folder::place(out, stem, WHAT, &|manifest| differences(plan, manifest))?;
    let folder = Folder::claim(&path)?;
    // another process may have had the folder in the meantime
    let before = folder::manifest(&path)?;
    if let Some(manifest) = &before {
        let lines = differences(plan, manifest);
        if !lines.is_empty() {
            return Err(folder::other(&path, WHAT, lines));
        }
    }
    let mut manifest = before.unwrap_or_else(|| json!({ "format": 1, "kind": "evolution", "sessions": [] }));
    manifest["title"] = json!(plan.form.title);
    manifest["files"] = Texts::json(&plan.sources, &plan.sets, plan.quick);
    manifest["identity"] = plan.identity();
    manifest["status"] = json!("running");
    if let Some(Json::Array(sessions)) = manifest.get_mut("sessions") {
        sessions.push(crate::run::session(program, threads));
    }
    folder.write_manifest(&manifest)?;
    let (mut log, mut runs) = opened(&folder, plan)?;
    let there: usize = runs.iter().map(|run| run.generations.len().min(plan.generations)).sum();
    let wanted = plan.form.runs * plan.generations;
    watch.begin(&path, wanted - there, there, threads);
    let began = std::time::Instant::now();
    let done = work(plan, threads, &mut log, &mut runs, watch);
    let seconds = began.elapsed().as_secs_f64();
    let left = || -> usize {
        let missing = |run: &Run| plan.generations.saturating_sub(run.generations.len());
        runs.iter().map(missing).sum::<usize>()
    };
    let complete = left() == 0 && (plan.form.confirm == 0 || runs.iter().all(|run| run.confirmed.is_some()));
    manifest["status"] = json!(if complete && done.is_ok() { "complete" } else { "stopped" });
    let (generations, updates) = match done {
        Ok(done) => done,
        Err(error) => {
            // the first error is the one to tell
            let _ = folder.write_manifest(&manifest);
            return Err(error);
        }
    };
    if let Some(Json::Object(session)) =
        manifest.get_mut("sessions").and_then(Json::as_array_mut).and_then(|sessions| sessions.last_mut())
    {
        session.insert("seconds".into(), json!(seconds));
        session.insert("generations".into(), json!(generations));
    }
    if complete {
        finish(&folder, plan, &runs, program)?;
    }
    folder.write_manifest(&manifest)?;
    let champions = runs.iter().map(|run| run.champion(plan).map(|(_, score)| score)).collect();
    let left = if complete { 0 } else { left().max(1) };
    Ok(Outcome { folder: path, left, generations, updates, seconds, champions })
}

/// Makes the page of a complete folder anew.
///
/// # Errors
/// A folder that holds no complete evolution, or cannot be written to.
pub fn report_again(path: &Path, program: &str) -> Result<(), StoreError> {
    let plan = of_folder(path)?;
    let folder = Folder::claim(path)?;
    let (_, runs) = opened(&folder, &plan)?;
    if runs.iter().any(|run| run.generations.len() < plan.generations) {
        return Err(StoreError::Refused(format!("`{}` is not complete; the same run command goes on", path.display())));
    }
    finish(&folder, &plan, &runs, program)
}

/// Tables, champion and page.
fn finish(folder: &Folder, plan: &Plan, runs: &[Run], program: &str) -> Result<(), StoreError> {
    tables::write(folder, plan, runs)?;
    if let Some(text) = champion(plan, runs) {
        let path = folder.file(CHAMPION);
        folder.write(CHAMPION, |out| {
            out.write_all(text.as_bytes()).map_err(|error| StoreError::io("write", &path, error))
        })?;
    }
    let html = crate::report::html(&report::page(plan, runs, program));
    let path = folder.file(REPORT);
    folder.write(REPORT, |out| out.write_all(html.as_bytes()).map_err(|error| StoreError::io("write", &path, error)))
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

fn opened(folder: &Folder, plan: &Plan) -> Result<(Log, Vec<Run>), StoreError> {
    let path = folder.file(HISTORY);
    let mut runs = vec![Run::default(); plan.form.runs];
    if !path.exists() {
        return Ok((Log::create(&path)?, runs));
    }
    let (mut log, records) = Log::open(&path)?;
    log.keep_until(records.last())?;
    let damaged = || StoreError::Damaged(format!("a record in `{}` is no generation", path.display()));
    for record in &records {
        let bytes = log.read(record)?;
        let (run, number, words) = unpacked(&bytes).ok_or_else(damaged)?;
        // runs may have been fewer since
        let Some(run) = runs.get_mut(run) else { continue };
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
    for run in &mut runs {
        run.generations.truncate(plan.generations);
    }
    Ok((log, runs))
}

/// A record: run, number of the generation, numbers.
fn packed(run: usize, number: usize, numbers: impl Iterator<Item = f64>) -> Vec<u8> {
    let words = [run as u64, number as u64].into_iter().chain(numbers.map(f64::to_bits));
    words.flat_map(u64::to_le_bytes).collect()
}

fn unpacked(bytes: &[u8]) -> Option<(usize, usize, Vec<f64>)> {
    let words: Vec<u64> = bytes.chunks_exact(8).map(|w| u64::from_le_bytes(core::array::from_fn(|k| w[k]))).collect();
    let [run, number, numbers @ ..] = words.as_slice() else { return None };
    Some((
        usize::try_from(*run).ok()?,
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
                let operators = plan.operators(form);
                Self::Genetic(match there.last() {
                    None => Genetic::new(domain, operators, seed, 0, plan.first(form, seed)?)?,
                    Some(last) => {
                        let number = there.len() as u64 - 1;
                        let mut genetic = Genetic::new(domain, operators, seed, number, last.candidates.clone())?;
                        genetic.tell(&last.evaluated.scores)?;
                        genetic
                    }
                })
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
    fn candidates(&self) -> &[Vec<f64>] {
        match self {
            Self::Genetic(search) => search.candidates(),
            Self::Strategy(search) => search.candidates(),
            Self::Elites(search) => search.candidates(),
        }
    }
    fn tell(&mut self, evaluated: &Evaluated) -> Result<(), search::SearchError> {
        match self {
            Self::Genetic(search) => search.tell(&evaluated.scores),
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
    plan: &Plan,
    threads: usize,
    log: &mut Log,
    runs: &mut [Run],
    watch: &mut dyn Watch,
) -> Result<(usize, u64), StoreError> {
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
                    if let Err(what) = evolve(plan, run, there, inside, stop, &to) {
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
                    let record = packed(run, runs[run].generations.len(), numbers(&generation));
                    log.append(GENERATION, &record).map(|_| {
                        let made = plan.updates(generation.candidates.len());
                        let scores = generation.evaluated.scores.iter().copied();
                        watch.done(made, scores.filter(|score| score.is_finite()).fold(f64::NEG_INFINITY, f64::max));
                        (done, updates) = (done + 1, updates + made);
                        runs[run].generations.push(generation);
                    })
                }
                News::Confirmed(run, scores) => {
                    let record = packed(run, plan.generations, scores.iter().flatten().copied());
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
    plan: &Plan,
    run: usize,
    there: &Run,
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
    to: &SyncSender<News>,
) -> Result<(), String> {
    let number = run + 1;
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
        && let Some(scores) = evaluate::confirmed(plan, number, &last.unwrap_or_default(), threads, stop)?
    {
        let _ = to.send(News::Confirmed(run, scores));
    }
    Ok(())
}
