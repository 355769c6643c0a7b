//! `kind = "study"`: one scenario, varied and repeated.

use super::{Input, Kind, shown};
use crate::fault::{Fault, wrong};
use crate::run::{self, INTERRUPTED, PROGRAM, QUIET, RunOptions, rate, text_of};
use crate::view::ViewOptions;
use clap::Args;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget};
use lab::searched::{Searched, Studied};
use lab::study::claims::{Judgement, Verdict};
use lab::study::execute::{self, CELLS, End, REPORT, Selection, TRIALS};
use lab::study::form::{Strength, Study as Form};
use lab::study::{self, Plan, claims, trial};
use serde_json::Value as Json;
use space::spelling::nearest;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Options of `run` that concern studies.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Studies")]
pub struct StudyOptions {
    /// Say what would be run, how long it would take and how much disk it needs, and run nothing; also of decompositions.
    #[arg(long)]
    pub plan: bool,
    /// Only these cells: numbers and ranges as `3,5-9`, or levels as `variant=prob,N=6`.
    #[arg(long, value_name = "CELLS")]
    pub cells: Option<String>,
    /// Only these trials: numbers and ranges as `1-20`.
    #[arg(long, value_name = "TRIALS")]
    pub trials: Option<String>,
    /// Only this share of the work, as `2/3`; `flockworks merge` joins the folders.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<String>,
    /// Run one trial of this cell as a scenario, with its trajectory: a number, or levels that only one cell has.
    #[arg(long, value_name = "CELL", conflicts_with_all = ["plan", "cells", "trials", "shard", "must_hold"])]
    pub cell: Option<String>,
    /// The trial of `--cell`.
    #[arg(long, value_name = "N", requires = "cell")]
    pub trial: Option<usize>,
    /// Exit with 1 unless every statement that must hold (strength A) does.
    #[arg(long)]
    pub must_hold: bool,
}

/// An option of all kinds that judge statements as studies do.
pub(super) const MUST_HOLD: &str = "--must-hold";

impl StudyOptions {
    /// The first option that was given, for kinds that have none of them.
    pub(super) fn given(&self) -> Option<&'static str> {
        if self.plan { Some("--plan") } else { self.beside_plan() }
    }
    /// The first option but `--plan` that was given.
    pub(super) fn beside_plan(&self) -> Option<&'static str> {
        let given = [
            (self.cells.is_some(), "--cells"),
            (self.trials.is_some(), "--trials"),
            (self.shard.is_some(), "--shard"),
            (self.cell.is_some(), "--cell"),
            (self.trial.is_some(), "--trial"),
            (self.must_hold, MUST_HOLD),
        ];
        given.into_iter().find(|(given, _)| *given).map(|(_, name)| name)
    }
}

/// Options of `merge`.
#[derive(Args, Debug)]
pub struct MergeOptions {
    /// Folders of one study, as runs with `--shard` leave them.
    #[arg(required = true)]
    pub folders: Vec<PathBuf>,
    /// Folder for all of them together.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// One scenario, varied and repeated.
pub(super) struct Study;

impl Kind for Study {
    fn id(&self) -> &'static str {
        "study"
    }
    fn template(&self) -> &'static str {
        study::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks study")
    }
    fn reference(&self) -> String {
        let functions: Vec<String> =
            study::expression::FUNCTIONS.iter().map(|(_, use_)| format!("- `{use_}`")).collect();
        let lead = format!(
            "Every key of a study file, TOML. [How to write one](../how-to/study.md).\n\n\
             Expressions have numbers, texts in single quotes, lists in brackets, `+ - * / ^`, comparisons, `and`, `or`, \
             `not`, `pi`, `e`, and these functions:\n\n{}\n\n\
             In `define` and `derive`, names are factors, definitions and paths of the scenario. In statements, names are \
             readings (their means over trials) and factors, with levels in brackets: `coverage[variant = prob, N = 6]` is \
             one number where one cell has these levels, and a list where several have them.",
            functions.join("\n")
        );
        lab::file::reference::reference::<Form>("Study files", &lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let plan = read(input, false)?;
        let trials = Selection::default().units(&plan).len();
        Ok(format!("{} cells, {} different conditions, {trials} trials", plan.cells.len(), plan.conditions.len()))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        if let Some(seed) = options.seed {
            input.sets.push(format!("seed={seed}"));
        }
        let own = &options.study;
        let plan = read(&input, options.quick)?;
        if let Some(cell) = &own.cell {
            let (name, text) = scenario_of(&plan, cell, own.trial.unwrap_or(1))?;
            let single = Input { name, text, sets: Vec::new() };
            // seed and length are those of the trial, whatever chose it
            return run::run_scenario(run::scenario(&single)?, &options.of_trial(), out);
        }
        let selection = Selection {
            cells: own.cells.as_ref().map(|text| cells(&plan, text)).transpose()?,
            trials: own.trials.as_ref().map(|text| numbers(text, "--trials", 1_000_000)).transpose()?,
            shard: own.shard.as_ref().map(|text| shard(text)).transpose()?,
        };
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = options.threads.unwrap_or(cores);
        if own.plan {
            return planned(&plan, &selection, threads, out).map(|()| 0);
        }
        run::listen()?;
        let mut progress = Progress::new();
        let outcome = execute::run(&plan, &selection, threads, options.out.as_deref(), PROGRAM, &mut progress);
        progress.bar.finish_and_clear();
        let outcome = outcome?;
        if let End::Stopped(left) = outcome.end {
            writeln!(out, "stopped, {left} trials are left; the same command continues it")?;
            return Ok(INTERRUPTED);
        }
        writeln!(out, "{}", plan.title)?;
        if outcome.trials > 0 {
            let speed = rate(outcome.updates as f64 / outcome.seconds.max(1e-9));
            writeln!(out, "{} trials in {:.1} s, {speed}", outcome.trials, outcome.seconds)?;
        } else {
            writeln!(out, "all trials were there already")?;
        }
        stated(&outcome.judgements, out)?;
        told(&outcome.folder, out)?;
        Ok(u8::from(own.must_hold && !held(&outcome.judgements)))
    }
    fn view(&self, input: &Input, options: &ViewOptions) -> Result<(String, String), Fault> {
        let plan = read(input, false)?;
        scenario_of(&plan, options.cell.as_deref().unwrap_or("1"), options.trial.unwrap_or(1))
    }
    fn search(&self, folder: &Path) -> Result<Box<dyn Searched>, Fault> {
        Ok(Box::new(Studied::open(folder)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        execute::of_folder(folder)?;
        if !folder.join(CELLS).exists() {
            return wrong(format!("`{}` has no tables yet; `flockworks run` continues it", folder.display()));
        }
        Ok(vec![TRIALS, CELLS])
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        told(folder, out).map(|_| ())
    }
}

/// Whether every statement that must hold does.
pub(super) fn held(judgements: &[Judgement]) -> bool {
    let must = |own: &&Judgement| own.claim.strength == Strength::A && own.claim.holds.is_some();
    judgements.iter().filter(must).all(|own| own.judged.verdict == Verdict::Holds)
}

/// The statements, each with its verdict.
pub(super) fn stated(judgements: &[Judgement], out: &mut dyn Write) -> Result<(), Fault> {
    for Judgement { part, claim, judged } in judgements {
        let part = if part.is_empty() { String::new() } else { format!("{part}.") };
        writeln!(out, "{:17}{part}{}: {}", judged.verdict.words(), claim.id, claim.text)?;
    }
    Ok(())
}

fn told(folder: &Path, out: &mut dyn Write) -> Result<u8, Fault> {
    writeln!(out, "tables  {}", folder.display())?;
    writeln!(out, "page    {}", folder.join(REPORT).display())?;
    Ok(0)
}

fn read(input: &Input, quick: bool) -> Result<Plan, Fault> {
    let mut load = |path: &str| text_of(path).map_err(|fault| fault.to_string());
    study::read(&input.name, &input.text, &input.sets, quick, &mut load).map_err(|problems| shown(&problems))
}

/// Joins the folders of shards.
///
/// # Errors
/// Folders that are of different studies, or cannot be read or written.
pub fn merge(options: &MergeOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let (plan, trials, left) = execute::merge(&options.folders, &options.out, PROGRAM)?;
    writeln!(out, "{}", plan.title)?;
    writeln!(out, "{trials} trials of {} folders", options.folders.len())?;
    if left > 0 {
        writeln!(out, "{left} trials are left; `flockworks run` with the same file and --out makes them")?;
    }
    told(&options.out, out).map(|_| ())
}

/// Numbers and ranges, as `3,5-9`.
fn numbers(text: &str, option: &str, most: usize) -> Result<Vec<usize>, Fault> {
    let mut list = Vec::new();
    for part in text.split(',') {
        let part = part.trim();
        let (from, to) = part.split_once('-').unwrap_or((part, part));
        match (from.trim().parse::<usize>(), to.trim().parse::<usize>()) {
            (Ok(from), Ok(to)) if 1 <= from && from <= to && to <= most => list.extend(from..=to),
            _ => return wrong(format!("{option} takes numbers from 1 to {most} and ranges, as 1,4-6; found `{part}`")),
        }
    }
    Ok(list)
}

/// Cells by number or by levels, as indices.
fn cells(plan: &Plan, text: &str) -> Result<Vec<usize>, Fault> {
    if !text.contains('=') {
        return Ok(numbers(text, "--cells", plan.cells.len())?.into_iter().map(|number| number - 1).collect());
    }
    let mut only = Vec::new();
    for part in text.split(',') {
        let Some((name, level)) = part.split_once('=') else {
            return wrong(format!("--cells takes levels as FACTOR=LEVEL; found `{part}`"));
        };
        let (name, level) = (name.trim(), level.trim().trim_matches('\''));
        let number = level.parse().ok().filter(|number: &f64| number.is_finite());
        let level = number.map_or_else(|| claims::Level::Text(level.to_owned()), claims::Level::Number);
        known(plan, name, &level)?;
        only.push((name.to_owned(), level));
    }
    let found: Vec<usize> = plan.parts.iter().flat_map(|part| claims::matching(plan, part, &only)).collect();
    if found.is_empty() {
        let factors = plan.parts.iter().flat_map(|part| &part.factors);
        let mut known: Vec<String> = Vec::new();
        for factor in factors {
            let levels: Vec<&str> = factor.levels.iter().map(|level| level.text.as_str()).collect();
            known.push(format!("{} = {}", factor.name, levels.join(", ")));
        }
        return wrong(format!("no cell has `{text}`; the factors and their levels are\n  {}", known.join("\n  ")));
    }
    Ok(found)
}

/// Refuses a factor that no part has, and a level that it has in none.
fn known(plan: &Plan, name: &str, level: &claims::Level) -> Result<(), Fault> {
    let factors = || plan.parts.iter().flat_map(|part| &part.factors);
    let levels: Vec<_> = factors().filter(|factor| factor.name == name).flat_map(|factor| &factor.levels).collect();
    if levels.is_empty() {
        let near = nearest(name, factors().map(|factor| factor.name.as_str()));
        let help = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        return wrong(format!("--cells: no factor is called `{name}`{help}"));
    }
    if levels.iter().any(|own| level.is(own)) {
        return Ok(());
    }
    let texts = || levels.iter().map(|own| own.text.as_str());
    // a number is nobody's slip of a key
    let near = if let claims::Level::Text(text) = level { nearest(text, texts()) } else { None };
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("it has {}", texts().collect::<Vec<_>>().join(", ")),
    };
    wrong(format!("--cells: `{name}` has no level `{}`; {help}", level.words()))
}

fn shard(text: &str) -> Result<(usize, usize), Fault> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
    match parts {
        Some((i, n)) if 1 <= i && i <= n => Ok((i, n)),
        _ => wrong(format!("--shard takes I/N with 1 <= I <= N, as 2/3; found `{text}`")),
    }
}

/// A trial of a cell as a scenario: name and text.
fn scenario_of(plan: &Plan, cell: &str, trial: usize) -> Result<(String, String), Fault> {
    let found = cells(plan, cell)?;
    let [index] = found.as_slice() else {
        return wrong(format!("{} cells have `{cell}`; name one", found.len()));
    };
    if trial == 0 {
        return wrong("trials count from 1");
    }
    lab::searched::trial(plan, *index, trial).map_err(Fault::Ours)
}

/// Seconds for which the speed of a condition is measured.
const MEASURED: f64 = 0.25;
/// Conditions whose speed is measured, at most.
const CONDITIONS: usize = 8;

/// Says what would be done.
fn planned(plan: &Plan, selection: &Selection, threads: usize, out: &mut dyn Write) -> Result<(), Fault> {
    let units = selection.units(plan);
    let updates: u64 = units.iter().map(|&(condition, _)| plan.conditions[condition].updates()).sum();
    writeln!(out, "{}", plan.title)?;
    for part in &plan.parts {
        let cells = part.cells.len();
        writeln!(out, "  {}: {cells} {}", part.name, if cells == 1 { "cell" } else { "cells" })?;
        for factor in &part.factors {
            let levels: Vec<&str> = factor.levels.iter().map(|level| level.text.as_str()).collect();
            let shown = if levels.len() > 12 {
                format!("{}, ..., {}", levels[..6].join(", "), levels[levels.len() - 1])
            } else {
                levels.join(", ")
            };
            writeln!(out, "    {} ({}): {shown}", factor.name, levels.len())?;
        }
    }
    writeln!(out, "cells            {}", plan.cells.len())?;
    writeln!(out, "conditions       {} different ones", plan.conditions.len())?;
    writeln!(out, "trials           {}", units.len())?;
    writeln!(out, "agent-updates    {:.4} G", updates as f64 / 1e9)?;
    // a few conditions, evenly over those wanted
    let mut wanted: Vec<usize> = units.iter().map(|&(condition, _)| condition).collect();
    wanted.sort_unstable();
    wanted.dedup();
    let mut rates = Vec::new();
    for k in 0..wanted.len().min(CONDITIONS) {
        let condition = &plan.conditions[wanted[k * wanted.len() / wanted.len().min(CONDITIONS)]];
        rates.push(trial::rate(plan, condition, MEASURED).map_err(Fault::Input)?);
    }
    // times add up, so that the slow count for more
    let mean = rates.len() as f64 / rates.iter().map(|rate| 1.0 / rate).sum::<f64>();
    let workers = threads.min(std::thread::available_parallelism().map_or(1, usize::from));
    if updates > 0 {
        let seconds = updates as f64 / mean / workers as f64;
        writeln!(
            out,
            "expected time    about {} on {workers} threads, at {} a thread, measured just now in {} conditions",
            HumanDuration(Duration::from_secs_f64(seconds)),
            rate(mean),
            rates.len()
        )?;
    }
    // head of a record, key, trial, values; then once more in the table
    let bytes = units.len() * (20 + 24 + 16 * plan.readings.len()) + 2_000 * plan.cells.len();
    writeln!(out, "disk             about {:.1} MB, in five files", bytes as f64 / 1e6)?;
    Ok(())
}

/// A bar on a terminal, quiet lines elsewhere.
struct Progress {
    bar: ProgressBar,
    quiet: bool,
    began: Instant,
    told: Instant,
    trials: (usize, usize),
    updates: (u64, u64),
}

impl Progress {
    fn new() -> Self {
        let now = Instant::now();
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        Self { bar, quiet: !std::io::stderr().is_terminal(), began: now, told: now, trials: (0, 0), updates: (0, 0) }
    }
}

#[allow(clippy::print_stderr, reason = "progress is told on standard error")]
impl execute::Watch for Progress {
    fn begin(&mut self, folder: &Path, trials: usize, updates: u64, there: usize, threads: usize) {
        (self.trials, self.updates, self.began) = ((0, trials), (0, updates), Instant::now());
        let kept = if there > 0 { format!(", {there} are there already") } else { String::new() };
        eprintln!("{}: {trials} trials on {threads} threads{kept}", folder.display());
        if !self.quiet && trials > 0 {
            // in thousands of updates, since trials differ in length
            self.bar = run::bar(updates / 1000, 0, run::OF_UNITS);
            self.bar.enable_steady_tick(Duration::from_millis(500));
        }
    }
    fn done(&mut self, updates: u64) {
        self.trials.0 += 1;
        self.updates.0 += updates;
        let speed = rate(self.updates.0 as f64 / self.began.elapsed().as_secs_f64().max(1e-9));
        let (done, all) = self.trials;
        if !self.quiet {
            self.bar.set_position(self.updates.0 / 1000);
            self.bar.set_message(format!("{done}/{all} trials  {speed}"));
        } else if self.told.elapsed() > QUIET {
            self.told = Instant::now();
            let (made, to_make) = (self.updates.0, self.updates.1.saturating_sub(self.updates.0));
            let left = run::time_left(self.began.elapsed(), made, to_make).unwrap_or_default();
            eprintln!("trial {done} of {all}, {speed}, about {} left", HumanDuration(left));
        }
    }
    fn stopper(&self) -> fn() -> bool {
        run::stopped
    }
}
