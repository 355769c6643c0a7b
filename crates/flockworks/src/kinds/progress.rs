//! The progress of units of work: a bar on a terminal, quiet lines elsewhere.

use crate::run::{self, QUIET, rate};
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use lab::environment::work::Watch;
use std::io::IsTerminal;
use std::path::Path;
use std::time::{Duration, Instant};

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
            self.bar = ProgressBar::with_draw_target(Some(units as u64), ProgressDrawTarget::stderr());
            let template = "{bar:30} {percent:>3} %  {msg}  {eta} left";
            self.bar.set_style(ProgressStyle::with_template(template).unwrap_or(ProgressStyle::default_bar()));
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
            let left = Duration::from_secs_f64((seconds * (all as f64 / done as f64 - 1.0)).max(0.0));
            eprintln!("{done} of {all} {what}, {speed}, about {} left", HumanDuration(left));
        }
    }
    fn stopper(&self) -> fn() -> bool {
        run::stopped
    }
}
