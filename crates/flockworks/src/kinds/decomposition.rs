//! `kind = "decomposition"`: which primitives a known construct is made of.

use super::progress::{self, End, Progress};
use super::{Input, Kind, shown};
use crate::fault::Fault;
use crate::run::{self, PROGRAM, RunOptions, text_of};
use lab::decomposition::execute::{self, REPORT};
use lab::decomposition::form::Decomposition as Form;
use lab::decomposition::results::NAMES;
use lab::decomposition::tables::{APPROACHES, CLUSTERS, VARIATIONS};
use lab::decomposition::{self, Plan};
use lab::searched::{Decomposed, Searched};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// A known construct, taken apart.
pub(super) struct Decomposition;

impl Kind for Decomposition {
    fn id(&self) -> &'static str {
        "decomposition"
    }
    fn template(&self) -> &'static str {
        decomposition::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks decomposition")
    }
    fn reference(&self) -> String {
        let names: Vec<String> = NAMES.iter().map(|(name, about)| format!("- `{name}`: {about}")).collect();
        let lead = format!(
            "Every key of a decomposition file, TOML. [How to write one](../how-to/decomposition.md). Candidates are those of [design \
             files](design.md).\n\nWhat statements can ask for:\n\n{}",
            names.join("\n")
        );
        lab::file::reference::reference::<Form>("Decomposition files", &lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let plan = read(input, false)?;
        Ok(format!("{}: {} trials", plan.cost(), plan.all_trials()))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        let threads = progress::begin_or_plan(&mut input, options, "a decomposition")?;
        let plan = read(&input, options.quick)?;
        if options.study.plan {
            return planned(&plan, threads, out).map(|()| 0);
        }
        run::listen()?;
        let mut progress = Progress::new();
        let done = execute::run(&plan, threads, options.out.as_deref(), PROGRAM, &mut progress);
        progress.clear();
        let done = done?;
        let end = End {
            stopped: (!done.complete).then(|| format!("stopped after {} approaches", done.approaches)),
            made: format!("{} approaches", done.approaches),
            title: &plan.form.title,
            lines: &done.lines,
            seconds: done.seconds,
        };
        end.tell(out, |out| progress::told(&done.folder, REPORT, out))
    }
    fn search(&self, folder: &Path) -> Result<Box<dyn Searched>, Fault> {
        Ok(Box::new(Decomposed::open(folder)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        execute::of_folder(folder)?;
        Ok(vec![APPROACHES, CLUSTERS, VARIATIONS])
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        progress::told(folder, REPORT, out)
    }
}

/// What would be run. The time is that of a few approaches, evenly over all.
fn planned(plan: &Plan, threads: usize, out: &mut dyn Write) -> Result<(), Fault> {
    const TIMED: usize = 8;
    writeln!(out, "{}", plan.form.title)?;
    writeln!(out, "parts            {}", plan.cost())?;
    writeln!(out, "trials           {}, {} of them in empty arenas", plan.all_trials(), plan.empty_trials())?;
    writeln!(out, "agent-updates    {:.4} G at most", plan.most_updates() as f64 / 1e9)?;
    let (began, mut timed) = (Instant::now(), 0);
    for k in 0..TIMED.min(plan.approaches()) {
        let probe = plan.probe(k * plan.approaches() / TIMED.min(plan.approaches()), plan.form.offsets / 2);
        // what is impossible with this seed takes no time in the run either
        let _ = execute::once(plan, &probe, plan.seed_of(1), &|| false);
        timed += 1;
    }
    for marked in 0..plan.marked.len().min(TIMED) {
        let _ = plan.vary(marked, 0, &|| false);
        timed += plan.varied_trials() as i32;
    }
    let seconds = began.elapsed().as_secs_f64() / f64::from(timed.max(1)) * plan.all_trials() as f64 / threads as f64;
    writeln!(
        out,
        "time             about {} on {threads} threads",
        indicatif::HumanDuration(std::time::Duration::from_secs_f64(seconds))
    )?;
    Ok(())
}

fn read(input: &Input, quick: bool) -> Result<Plan, Fault> {
    let mut load = |path: &str| text_of(path).map_err(|fault| fault.to_string());
    decomposition::read(&input.name, &input.text, &input.sets, quick, &mut load).map_err(|problems| shown(&problems))
}
