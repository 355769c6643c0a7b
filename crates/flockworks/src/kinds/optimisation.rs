//! `kind = "optimisation"`: the best construct of a schema, by several methods.

use super::progress::{self, End, Progress};
use super::{Input, Kind, shown};
use crate::fault::Fault;
use crate::run::{self, PROGRAM, RunOptions, text_of};
use lab::optimisation::execute::{self, REPORT};
use lab::optimisation::form::Optimisation as Form;
use lab::optimisation::tables::{BEST, ELITES, EVALUATIONS};
use lab::optimisation::{self, Plan};
use lab::searched::{Optimised, Searched};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;

/// The search for the best construct of a schema.
pub(super) struct Optimisation;

impl Kind for Optimisation {
    fn id(&self) -> &'static str {
        "optimisation"
    }
    fn template(&self) -> &'static str {
        optimisation::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks optimisation")
    }
    fn reference(&self) -> String {
        let lead = "Every key of an optimisation file, TOML. [How to write one](../how-to/optimisation.md). Schemas are those of [map \
                    files](map.md), behaviours and workspaces those of [design files](design.md).";
        lab::file::reference::reference::<Form>("Optimisation files", lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let plan = read(input, false)?;
        Ok(format!(
            "{} over {} by {}: {} runs of {} evaluations each",
            plan.schema.card().id,
            plan.over(&|axis| axis.name.clone()),
            plan.methods().join(", "),
            plan.runs,
            plan.evaluations
        ))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        let threads = progress::begin(&mut input, options, "an optimisation")?;
        let plan = read(&input, options.quick)?;
        run::listen()?;
        let mut progress = Progress::new();
        let done = execute::run(&plan, threads, options.out.as_deref(), PROGRAM, &mut progress);
        progress.clear();
        let done = done?;
        let end = End {
            stopped: (!done.complete).then(|| format!("stopped after {} evaluations", done.evaluations)),
            made: format!("{} evaluations", done.evaluations),
            title: &plan.form.title,
            lines: &done.lines,
            seconds: done.seconds,
        };
        end.tell(out, |out| progress::told(&done.folder, REPORT, out))
    }
    fn search(&self, folder: &Path) -> Result<Box<dyn Searched>, Fault> {
        Ok(Box::new(Optimised::open(folder)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        execute::of_folder(folder)?;
        Ok(vec![BEST, EVALUATIONS, ELITES])
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        progress::told(folder, REPORT, out)
    }
}

fn read(input: &Input, quick: bool) -> Result<Plan, Fault> {
    let mut load = |path: &str| text_of(path).map_err(|fault| fault.to_string());
    optimisation::read(&input.name, &input.text, &input.sets, quick, &mut load).map_err(|problems| shown(&problems))
}
