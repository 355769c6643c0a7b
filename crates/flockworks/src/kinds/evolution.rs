//! `kind = "evolution"`: a search over values of a scenario.

use super::study::{MUST_HOLD, held, stated};
use super::{Input, Kind, shown};
use crate::fault::{Fault, wrong};
use crate::run::{self, INTERRUPTED, PROGRAM, QUIET, RunOptions, rate, text_of};
use crate::view::ViewOptions;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget};
use lab::evolution::execute::{self, CHAMPION, REPORT};
use lab::evolution::form::Evolution as Form;
use lab::evolution::tables::{CANDIDATES, CHAMPIONS, CONTEST, GENERATIONS};
use lab::evolution::{self, Variants};
use lab::file::write::toml;
use lab::searched::{Evolved, Searched};
use serde_json::Value as Json;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// A search over values of a scenario.
pub(super) struct Evolution;

impl Kind for Evolution {
    fn id(&self) -> &'static str {
        "evolution"
    }
    fn template(&self) -> &'static str {
        evolution::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks evolution")
    }
    fn reference(&self) -> String {
        let list = |list: &[(&str, &str)]| {
            list.iter().map(|(id, about)| format!("- `{id}`: {about}")).collect::<Vec<_>>().join("\n")
        };
        let lead = format!(
            "Every key of an evolution file, TOML. [How to write one](../how-to/evolution.md). Expressions are those of \
             [study files](study.md).\n\n\
             Selection:\n\n{}\n\nCrossover:\n\n{}\n\nMutation:\n\n{}",
            list(search::selection::LIST),
            list(search::crossover::LIST),
            list(search::mutation::LIST)
        );
        lab::file::reference::reference::<Form>("Evolution files", &lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let variants = read(input, false)?;
        let plan = variants.first();
        let (runs, genes) = (plan.form.runs, plan.axes.len());
        let runs = format!("{runs} {}", if runs == 1 { "run" } else { "runs" });
        let each = match variants.plans.len() {
            1 => runs,
            several => format!("{several} variants of {runs}"),
        };
        Ok(format!("{genes} genes, {} generations, {each}", plan.generations))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        let others = options.study.given().filter(|&option| option != MUST_HOLD);
        if let Some(option) = others {
            return wrong(format!("`{}` is an evolution, and {option} is for studies", input.name));
        }
        if let Some(seed) = options.seed {
            input.sets.push(format!("seed={seed}"));
        }
        let variants = read(&input, options.quick)?;
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = options.threads.unwrap_or(cores);
        run::listen()?;
        let mut progress = Progress::new();
        let outcome = execute::run(&variants, threads, options.out.as_deref(), PROGRAM, &mut progress);
        progress.bar.finish_and_clear();
        let outcome = outcome?;
        if outcome.left > 0 {
            writeln!(out, "stopped, {} generations are left; the same command continues it", outcome.left)?;
            return Ok(INTERRUPTED);
        }
        writeln!(out, "{}", variants.first().form.title)?;
        for (run, score) in &outcome.champions {
            match score {
                Some(score) => writeln!(out, "  {run}: champion with a fitness of {score:.6}")?,
                None => writeln!(out, "  {run}: no candidate had a fitness")?,
            }
        }
        if outcome.generations > 0 {
            let speed = rate(outcome.updates as f64 / outcome.seconds.max(1e-9));
            writeln!(out, "{} generations in {:.1} s, {speed}", outcome.generations, outcome.seconds)?;
        } else {
            writeln!(out, "all generations were there already")?;
        }
        stated(&outcome.judgements, out)?;
        told(&outcome.folder, out)?;
        Ok(u8::from(options.study.must_hold && !held(&outcome.judgements)))
    }
    fn view(&self, input: &Input, _: &ViewOptions) -> Result<(String, String), Fault> {
        // the world as it is with the references: a champion's is a scenario file of its own
        let variants = read(input, false)?;
        Ok((input.name.clone(), toml(&variants.first().tree)))
    }
    fn search(&self, folder: &Path) -> Result<Box<dyn Searched>, Fault> {
        Ok(Box::new(Evolved::open(folder)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        let variants = execute::of_folder(folder)?;
        let contest = variants.first().form.contest.is_some().then_some(CONTEST);
        Ok([GENERATIONS, CANDIDATES, CHAMPIONS].into_iter().chain(contest).collect())
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        told(folder, out)
    }
}

fn told(folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
    writeln!(out, "tables    {}", folder.display())?;
    if folder.join(CHAMPION).exists() {
        writeln!(out, "champion  {}", folder.join(CHAMPION).display())?;
    }
    writeln!(out, "page      {}", folder.join(REPORT).display())?;
    Ok(())
}

fn read(input: &Input, quick: bool) -> Result<Variants, Fault> {
    let mut load = |path: &str| text_of(path).map_err(|fault| fault.to_string());
    evolution::read(&input.name, &input.text, &input.sets, quick, &mut load).map_err(|problems| shown(&problems))
}

/// A bar on a terminal, quiet lines elsewhere.
struct Progress {
    bar: ProgressBar,
    quiet: bool,
    began: Instant,
    told: Instant,
    generations: (usize, usize),
    best: f64,
}

impl Progress {
    fn new() -> Self {
        let now = Instant::now();
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let quiet = !std::io::stderr().is_terminal();
        Self { bar, quiet, began: now, told: now, generations: (0, 0), best: f64::NEG_INFINITY }
    }
}

#[allow(clippy::print_stderr, reason = "progress is told on standard error")]
impl execute::Watch for Progress {
    fn begin(&mut self, folder: &Path, generations: usize, there: usize, threads: usize) {
        (self.generations, self.began) = ((0, generations), Instant::now());
        let kept = if there > 0 { format!(", {there} are there already") } else { String::new() };
        eprintln!("{}: {generations} generations on {threads} threads{kept}", folder.display());
        if !self.quiet && generations > 0 {
            self.bar = run::bar(generations as u64, 0, run::OF_UNITS);
            self.bar.enable_steady_tick(Duration::from_millis(500));
        }
    }
    fn done(&mut self, _: u64, best: f64) {
        self.generations.0 += 1;
        self.best = self.best.max(best);
        let (done, all) = self.generations;
        if !self.quiet {
            self.bar.set_position(done as u64);
            self.bar.set_message(format!("{done}/{all} generations  best {:.4}", self.best));
        } else if self.told.elapsed() > QUIET {
            self.told = Instant::now();
            let left = run::time_left(self.began.elapsed(), done as u64, all.saturating_sub(done) as u64);
            let left = HumanDuration(left.unwrap_or_default());
            eprintln!("generation {done} of {all}, best so far {:.4}, about {left} left", self.best);
        }
    }
    fn stopper(&self) -> fn() -> bool {
        run::stopped
    }
}
