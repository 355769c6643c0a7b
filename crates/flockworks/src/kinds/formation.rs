//! `kind = "formation"`: targets that are brought along by walls, by robots in their places, or by herding.

use super::progress::{self, End, Progress};
use super::{Input, Kind, shown};
use crate::fault::Fault;
use crate::run::{self, PROGRAM, RunOptions, text_of};
use crate::view::ViewOptions;
use lab::formation::execute::{self, REPORT};
use lab::formation::form::Formation as Form;
use lab::formation::results::NAMES;
use lab::formation::tables::{OUTCOMES, TRIALS, WALLS};
use lab::formation::{self, Plan, Watched};
use lab::live::{self, LiveError, Shown};
use lab::searched::{Formed, Searched};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;

/// Robots in the places of walls.
pub(super) struct Formation;

impl Kind for Formation {
    fn id(&self) -> &'static str {
        "formation"
    }
    fn template(&self) -> &'static str {
        formation::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks formation")
    }
    fn reference(&self) -> String {
        let names: Vec<String> = NAMES.iter().map(|(name, about)| format!("- `{name}`: {about}")).collect();
        let lead = format!(
            "Every key of a formation file, TOML. [How to write one](../how-to/formation.md). Workspaces are those of [design \
             files](design.md).\n\nWhat statements can ask for, with `[task = ..., method = ...]`; without a task it is the mean over \
             tasks:\n\n{}",
            names.join("\n")
        );
        lab::file::reference::reference::<Form>("Formation files", &lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let plan = read(input, false, Watched::Somebody)?;
        let searched = (0..plan.tasks.len()).filter(|&task| plan.searched(task)).count();
        let waiting: Vec<String> = plan.waiting().map(|name| format!("`{name}`")).collect();
        let waiting = match waiting.as_slice() {
            [] => String::new(),
            names => format!("; without `switch_at` it can be viewed and not run, for {}", names.join(", ")),
        };
        Ok(format!(
            "{} tasks ({searched} whose walls are searched), {} methods, {} trials of each{waiting}",
            plan.tasks.len(),
            plan.methods.len(),
            plan.trials
        ))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        let threads = progress::begin(&mut input, options, "a formation")?;
        let plan = read(&input, options.quick, Watched::Nobody)?;
        run::listen()?;
        let mut progress = Progress::new();
        let done = execute::run(&plan, threads, options.out.as_deref(), PROGRAM, &mut progress);
        progress.clear();
        let done = done?;
        let end = End {
            stopped: (done.left > 0).then(|| format!("stopped, {} searches and trials are left", done.left)),
            made: format!("{} trials", done.trials),
            title: &plan.form.title,
            lines: &done.lines,
            seconds: done.seconds,
        };
        end.tell(out, |out| told(&done.folder, out))
    }
    fn view(&self, input: &Input, _: &ViewOptions) -> Result<(String, String), Fault> {
        let plan = read(input, true, Watched::Somebody)?;
        Ok((input.name.clone(), plan.sources.text(0).to_owned()))
    }
    fn live(&self, input: &Input, _: usize) -> Result<Box<dyn Shown>, LiveError> {
        live::form(&input.name, &input.text, &mut load)
    }
    fn search(&self, folder: &Path) -> Result<Box<dyn Searched>, Fault> {
        Ok(Box::new(Formed::open(folder)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        execute::of_folder(folder)?;
        Ok(vec![OUTCOMES, TRIALS, WALLS])
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        told(folder, out)
    }
}

fn told(folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
    writeln!(out, "tables        {}", folder.display())?;
    writeln!(out, "page          {}", folder.join(REPORT).display())?;
    Ok(())
}

fn load(path: &str) -> Result<String, String> {
    text_of(path).map_err(|fault| fault.to_string())
}

fn read(input: &Input, quick: bool, watched: Watched) -> Result<Plan, Fault> {
    let read = formation::read(&input.name, &input.text, &input.sets, (quick, watched), &mut load);
    read.map_err(|problems| shown(&problems))
}
