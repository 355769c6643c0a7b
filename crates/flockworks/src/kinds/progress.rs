//! What kinds have in common whose units of work are spread over threads: how a run begins, its progress (a bar on a terminal,
//! quiet lines elsewhere), and how it ends.

use super::Input;
use crate::fault::{Fault, wrong};
use crate::run::{self, INTERRUPTED, QUIET, RunOptions, rate};
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget};
use lab::environment::work::Watch;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// Options of a run of `one` ("a map"): those of studies are refused, a seed is put over the file. The answer is the number of
/// threads.
pub(super) fn begin(input: &mut Input, options: &RunOptions, one: &str) -> Result<usize, Fault> {
    if let Some(option) = options.study.given() {
        return wrong(format!("`{}` is {one}, and {option} is for studies", input.name));
    }
    Ok(seeded(input, options))
}

/// As [`begin`], where `--plan` is known.
pub(super) fn begin_or_plan(input: &mut Input, options: &RunOptions, one: &str) -> Result<usize, Fault> {
    if let Some(option) = options.study.beside_plan() {
        return wrong(format!("`{}` is {one}, and {option} is for studies", input.name));
    }
    Ok(seeded(input, options))
}

/// Puts a seed over the file; the number of threads.
fn seeded(input: &mut Input, options: &RunOptions) -> usize {
    if let Some(seed) = options.seed {
        input.sets.push(format!("seed={seed}"));
    }
    options.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
}

/// Where tables and page of a folder are.
pub(super) fn told(folder: &Path, page: &str, out: &mut dyn Write) -> Result<(), Fault> {
    writeln!(out, "tables  {}", folder.display())?;
    writeln!(out, "page    {}", folder.join(page).display())?;
    Ok(())
}

/// What became of a run, and its exit code: where it was stopped, what is said of that; else what was `made`, with its lines.
pub(super) struct End<'a> {
    pub(super) stopped: Option<String>,
    pub(super) title: &'a str,
    pub(super) lines: &'a [String],
    pub(super) made: String,
    pub(super) seconds: f64,
}

impl End<'_> {
    pub(super) fn tell(
        &self,
        out: &mut dyn Write,
        told: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
    ) -> Result<u8, Fault> {
        if let Some(stopped) = &self.stopped {
            writeln!(out, "{stopped}; the same command continues it")?;
            return Ok(INTERRUPTED);
        }
        writeln!(out, "{}", self.title)?;
        for line in self.lines {
            writeln!(out, "  {line}")?;
        }
        writeln!(out, "{} in {:.1} s", self.made, self.seconds)?;
        told(out)?;
        Ok(0)
    }
}

/// What is told while units are worked on.
pub(super) struct Progress {
    bar: ProgressBar,
    quiet: bool,
    began: Instant,
    told: Instant,
    what: String,
    done: usize,
    all: usize,
    updates: u64,
}

impl Progress {
    pub(super) fn new() -> Self {
        let now = Instant::now();
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let quiet = !std::io::stderr().is_terminal();
        Self { bar, quiet, began: now, told: now, what: String::new(), done: 0, all: 0, updates: 0 }
    }
    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

#[allow(clippy::print_stderr, reason = "progress is told on standard error")]
impl Watch for Progress {
    fn begin(&mut self, folder: &Path, what: &str, units: usize, there: usize, threads: usize) {
        (self.what, self.all, self.began) = (what.to_owned(), units, Instant::now());
        let kept = if there > 0 { format!(", {there} are there already") } else { String::new() };
        eprintln!("{}: {units} {what} on {threads} threads{kept}", folder.display());
        if !self.quiet {
            self.bar = run::bar(units as u64, 0, run::OF_UNITS);
            self.bar.enable_steady_tick(Duration::from_millis(500));
        }
    }
    fn more(&mut self, units: usize) {
        self.all += units;
        self.bar.set_length(self.all as u64);
    }
    fn done(&mut self, updates: u64) {
        self.done += 1;
        self.updates += updates;
        let (done, all, what) = (self.done, self.all, &self.what);
        let seconds = self.began.elapsed().as_secs_f64().max(1e-9);
        let speed = rate(self.updates as f64 / seconds);
        if !self.quiet {
            self.bar.set_position(done as u64);
            self.bar.set_message(format!("{done}/{all} {what}  {speed}"));
        } else if self.told.elapsed() > QUIET {
            self.told = Instant::now();
            let to_do = all.saturating_sub(done) as u64;
            let left = run::time_left(self.began.elapsed(), done as u64, to_do).unwrap_or_default();
            eprintln!("{done} of {all} {what}, {speed}, about {} left", HumanDuration(left));
        }
    }
    fn stopper(&self) -> fn() -> bool {
        run::stopped
    }
}
