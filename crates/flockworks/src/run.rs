//! `flockworks run`, `check`, `report`: files from text to page.

use crate::fault::{Fault, wrong};
use crate::kinds::study::StudyOptions;
use crate::kinds::{self, Input};
use clap::Args;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use lab::report::of_run;
use lab::run::{self, End, Outcome, Request, Watch};
use lab::scenario::build::{self, Read};
use lab::store::{StoreError, folder};
use serde_json::Value as Json;
use space::parallel::MOST_THREADS;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Name and version of the program.
pub const PROGRAM: &str = concat!("flockworks ", env!("CARGO_PKG_VERSION"));
/// Time between two lines where no terminal shows a bar.
pub(crate) const QUIET: Duration = Duration::from_secs(10);
/// Exit code of a run that was interrupted, as shells count it.
pub(crate) const INTERRUPTED: u8 = 130;

/// Options of `run`.
#[derive(Args, Debug)]
pub struct RunOptions {
    /// The file: TOML that begins with its kind, as in `kind = "scenario"`.
    pub file: String,
    /// Folder for the results. The same command again continues an unfinished run.
    ///
    /// Left out: `runs/NAME`, after the file, or `runs/NAME-2` and so on where that holds another run.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Seed of all random draws, in place of the file's.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Number of threads. The results are the same for any. Left out: as many as pay.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// Put a value over the file's: a path, `=`, a value as in TOML, as in `group.fish.count=50`.
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Run a tenth of the time; of a study, few trials.
    #[arg(long)]
    pub quick: bool,
    /// Options of studies.
    #[command(flatten)]
    pub study: StudyOptions,
}

impl RunOptions {
    /// As they go for a single trial of a study, which has its own seed and length.
    pub(crate) fn of_trial(&self) -> Self {
        Self {
            file: self.file.clone(),
            out: self.out.clone(),
            seed: None,
            threads: self.threads,
            set: Vec::new(),
            quick: false,
            study: StudyOptions::default(),
        }
    }
}

/// Options of `check`.
#[derive(Args, Debug)]
pub struct CheckOptions {
    /// The files.
    #[arg(required = true)]
    pub files: Vec<String>,
    /// Put a value over the file's, as for `run`.
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

/// Options of `report`.
#[derive(Args, Debug)]
pub struct ReportOptions {
    /// Folder of a complete run.
    pub folder: PathBuf,
}

impl From<StoreError> for Fault {
    fn from(error: StoreError) -> Self {
        Self::Input(error.to_string())
    }
}

/// A file's text. `-` is standard input.
pub(crate) fn text_of(file: &str) -> Result<String, Fault> {
    let bytes = if file == "-" {
        let mut bytes = Vec::new();
        std::io::Read::read_to_end(&mut std::io::stdin(), &mut bytes).map(|_| bytes)
    } else {
        std::fs::read(file)
    };
    let bytes = bytes.map_err(|error| {
        let text = error.to_string();
        let near = near_file(file).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        Fault::Input(format!("cannot read `{file}`: {}{near}", text.split(" (os error").next().unwrap_or(&text)))
    })?;
    String::from_utf8(bytes)
        .map_err(|error| Fault::Input(format!("`{file}` is not text in UTF-8: {}", error.utf8_error())))
}

/// A file beside the one named whose name may have been meant.
fn near_file(file: &str) -> Option<String> {
    let path = Path::new(file);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names: Vec<String> =
        std::fs::read_dir(folder).ok()?.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
    let wanted = path.file_name()?.to_str()?;
    let near = space::spelling::nearest(wanted, names.iter().map(String::as_str).filter(|name| *name != wanted))?;
    Some(path.with_file_name(near).display().to_string())
}

/// Reads a scenario with all that is wrong in it shown at once.
pub(crate) fn scenario(input: &Input) -> Result<Read, Fault> {
    build::read(&input.name, &input.text, &input.sets).map_err(|problems| kinds::shown(&problems))
}

static STOP: AtomicBool = AtomicBool::new(false);

/// A bar on a terminal, quiet lines elsewhere.
struct Progress {
    bar: ProgressBar,
    quiet: bool,
    began: Instant,
    told: Instant,
    from: u64,
    steps: u64,
    agents: u64,
    /// Steps between two looks at the clock.
    stride: u64,
}

impl Progress {
    fn new(agents: u64) -> Self {
        let now = Instant::now();
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        Self {
            bar,
            quiet: !std::io::stderr().is_terminal(),
            began: now,
            told: now,
            from: 0,
            steps: 0,
            agents,
            stride: 1,
        }
    }
    /// Updates of agents per second, written short.
    fn rate(&self, step: u64) -> String {
        let updates = (self.agents * (step - self.from)) as f64;
        rate(updates / self.began.elapsed().as_secs_f64().max(1e-9))
    }
}

/// Time that is left for so many things to do, from how long the others took in this session; none before one was done. What
/// earlier sessions did took none of this time, and must not be counted among the others.
pub(crate) fn time_left(elapsed: Duration, done: u64, to_do: u64) -> Option<Duration> {
    (done > 0).then(|| Duration::from_secs_f64(elapsed.as_secs_f64() * to_do as f64 / done as f64))
}

/// A bar over units of work, of which the message tells.
pub(crate) const OF_UNITS: &str = "{bar:30} {percent:>3} %  {msg}  {left}";

/// A bar on a terminal over `all` things, of which `from` were done before. Where `{left}` stands in the template is how long it
/// will take at the mean pace of this session: that of `indicatif` takes what was there already for work of the first moment.
pub(crate) fn bar(all: u64, from: u64, template: &str) -> ProgressBar {
    let left = move |state: &ProgressState, out: &mut dyn core::fmt::Write| {
        let to_do = state.len().unwrap_or(0).saturating_sub(state.pos());
        // a terminal that cannot be written to has nobody to tell
        let _ = match time_left(state.elapsed(), state.pos().saturating_sub(from), to_do) {
            Some(left) => write!(out, "{left:#} left", left = HumanDuration(left)),
            None => Ok(()),
        };
    };
    let bar = ProgressBar::with_draw_target(Some(all), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template(template).unwrap_or(ProgressStyle::default_bar());
    bar.set_style(style.with_key("left", left));
    bar.set_position(from);
    bar
}

pub(crate) fn rate(per_second: f64) -> String {
    match per_second {
        r if r >= 1e6 => format!("{:.1} M agent-updates/s", r / 1e6),
        r if r >= 1e3 => format!("{:.0} k agent-updates/s", r / 1e3),
        r => format!("{r:.0} agent-updates/s"),
    }
}

#[allow(clippy::print_stderr, reason = "progress is told on standard error")]
impl Watch for Progress {
    fn begin(&mut self, folder: &Path, seed: u64, from: u64, steps: u64) {
        (self.from, self.steps, self.began) = (from, steps, Instant::now());
        let verb = if from > 0 { format!("continues after step {from}") } else { "begins".to_owned() };
        eprintln!("{}: {verb}; {steps} steps, {} agents, seed {seed}", folder.display(), self.agents);
        self.stride = (20_000 / self.agents.max(1)).max(1);
        if !self.quiet {
            self.bar = bar(steps, from, "{bar:30} {percent:>3} %  {pos}/{len} steps  {msg}  {left}");
        }
    }
    fn at(&mut self, step: u64) {
        if !step.is_multiple_of(self.stride) {
            return;
        }
        if !self.quiet {
            self.bar.set_position(step);
            if self.told.elapsed() > Duration::from_millis(500) {
                self.told = Instant::now();
                self.bar.set_message(self.rate(step));
            }
        } else if self.told.elapsed() > QUIET {
            self.told = Instant::now();
            let left = time_left(self.began.elapsed(), step - self.from, self.steps - step).unwrap_or_default();
            eprintln!("step {step} of {}, {}, about {} left", self.steps, self.rate(step), HumanDuration(left));
        }
    }
    fn stop(&self) -> bool {
        stopped()
    }
}

/// Runs a file; the answer is the exit code.
///
/// # Errors
/// What is wrong with the input, the folder or the system.
pub fn run(options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
    check_threads(options.threads)?;
    if let Some(seed) = options.seed.filter(|&seed| i64::try_from(seed).is_err()) {
        return wrong(format!("--seed must be below 2^63, found {seed}"));
    }
    let gives_seed = |set: &&String| set.split_once('=').is_some_and(|(path, _)| path.trim() == "seed");
    if let (Some(seed), Some(set)) = (options.seed, options.set.iter().find(gives_seed)) {
        return wrong(format!("`--seed {seed}` and `--set {set}` both give the seed; leave one of them out"));
    }
    let (kind, input) = kinds::read(&options.file, &options.set)?;
    kind.run(input, options, out)
}

/// Refuses a number of threads that no machine has.
pub(crate) fn check_threads(threads: Option<usize>) -> Result<(), Fault> {
    match threads {
        Some(threads) if !(1..=MOST_THREADS).contains(&threads) => {
            wrong(format!("--threads must be from 1 to {MOST_THREADS}, found {threads}"))
        }
        _ => Ok(()),
    }
}

/// Listens for Ctrl-C: the first one asks to stop, which [`stopped`] tells; a second one ends at once, and what was
/// written stays whole either way.
pub(crate) fn listen() -> Result<(), Fault> {
    let handler = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
    handler.map_err(|error| Fault::Ours(format!("cannot listen for Ctrl-C: {error}")))
}

/// Whether Ctrl-C was pressed.
pub(crate) fn stopped() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// Runs a scenario; the answer is the exit code.
pub(crate) fn run_scenario(read: Read, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
    let agents = read.scenario.group.0.iter().map(|(_, group)| group.count as u64).sum();
    let request = Request {
        read,
        seed: options.seed,
        quick: options.quick,
        threads: options.threads,
        out: options.out.clone(),
        program: PROGRAM.to_owned(),
    };
    listen()?;
    let mut progress = Progress::new(agents);
    let outcome = run::run(&request, &mut progress);
    progress.bar.finish_and_clear();
    let outcome = outcome?;
    match outcome.end {
        End::Stopped(step) => {
            writeln!(out, "stopped after step {step}; the same command continues it")?;
            Ok(INTERRUPTED)
        }
        End::Complete | End::Already => {
            told(&request, &outcome, out)?;
            Ok(0)
        }
    }
}

/// The summary of a complete run.
fn told(request: &Request, outcome: &Outcome, out: &mut dyn Write) -> Result<(), Fault> {
    let folder = &outcome.folder;
    let summary = of_run::summary_of(folder, &request.read, outcome.seed, request.quick)?;
    writeln!(out, "{}", request.read.scenario.title)?;
    let widest = summary.iter().map(|fact| fact.label.chars().count()).max().unwrap_or(0);
    for fact in &summary {
        writeln!(out, "  {:<widest$}  {}", fact.label, fact.value)?;
    }
    if outcome.end == End::Already {
        writeln!(out, "complete already; --seed or --out makes another run")?;
    } else if outcome.seconds > 0.0 {
        let speed = rate(outcome.updates as f64 / outcome.seconds);
        writeln!(out, "done in {:.1} s, {speed}", outcome.seconds)?;
    }
    writeln!(out, "tables  {}", folder.display())?;
    writeln!(out, "page    {}", folder.join(run::REPORT).display())?;
    Ok(())
}

/// Checks files and runs nothing.
///
/// # Errors
/// What is wrong with them.
pub fn check(options: &CheckOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let mut faults = String::new();
    for file in &options.files {
        match kinds::read(file, &options.set).and_then(|(kind, input)| kind.check(&input)) {
            Ok(line) => writeln!(out, "{file}: {line}")?,
            Err(Fault::Shown(text)) => faults.push_str(&text),
            Err(other) => {
                faults.push_str(&other.to_string());
                faults.push('\n');
            }
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(Fault::Shown(faults)) }
}

/// What a run folder holds, read back.
pub(crate) fn read_back(path: &Path) -> Result<(Read, u64, bool), Fault> {
    let Some(manifest) = folder::manifest(path)? else {
        return wrong(format!("`{}` is not the folder of a run: it has no {}", path.display(), folder::MANIFEST));
    };
    if manifest.get("status").and_then(Json::as_str) != Some("complete") {
        return wrong(format!(
            "the run in `{}` is not complete; `flockworks run` with the same file continues it",
            path.display()
        ));
    }
    let damaged = || Fault::Input(format!("`{}` lacks what a manifest holds", path.join(folder::MANIFEST).display()));
    let file = manifest.get("file").ok_or_else(damaged)?;
    let text = file.get("text").and_then(Json::as_str).ok_or_else(damaged)?;
    let name = file.get("name").and_then(Json::as_str).ok_or_else(damaged)?;
    let sets = file.get("set").and_then(Json::as_array).ok_or_else(damaged)?;
    let sets: Vec<String> = sets.iter().filter_map(Json::as_str).map(str::to_owned).collect();
    let seed = manifest.get("seed").and_then(Json::as_u64).ok_or_else(damaged)?;
    let quick = manifest.get("identity").and_then(|i| i.get("quick")).and_then(Json::as_bool).ok_or_else(damaged)?;
    let read = build::read(name, text, &sets).map_err(|problems| Fault::Shown(problems.to_string()))?;
    Ok((read, seed, quick))
}

/// Makes the page of a complete run anew.
///
/// # Errors
/// A folder that is of no complete run, or cannot be written to.
pub fn report(options: &ReportOptions, out: &mut dyn Write) -> Result<(), Fault> {
    kinds::of_folder(&options.folder)?.report(&options.folder, out)
}

/// Makes the page of a complete run of a scenario anew.
pub(crate) fn report_of_run(path: &Path, out: &mut dyn Write) -> Result<(), Fault> {
    let (read, seed, quick) = read_back(path)?;
    let page = of_run::page(path, &read, seed, quick, PROGRAM)?;
    let html = lab::report::html(&page);
    let claimed = folder::Folder::claim(path)?;
    claimed.write(run::REPORT, |file| {
        file.write_all(html.as_bytes()).map_err(|error| StoreError::io("write", &path.join(run::REPORT), error))
    })?;
    writeln!(out, "page    {}", path.join(run::REPORT).display())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_there_before_makes_nothing_look_faster() {
        let second = Duration::from_secs(1);
        assert_eq!(time_left(second, 0, 100), None);
        assert_eq!(time_left(10 * second, 5, 20), Some(40 * second));
        assert_eq!(time_left(10 * second, 5, 0), Some(Duration::ZERO));
        let mut progress = Progress { agents: 10, from: 900, steps: 1000, ..Progress::new(10) };
        progress.began = Instant::now().checked_sub(10 * second).unwrap_or_else(Instant::now);
        // 50 steps of 10 agents in 10 s, and not 950
        assert_eq!(progress.rate(950), "50 agent-updates/s");
    }
}
