//! `kind = "map"`: which parameters of a schema make a group do what is wanted.

use super::progress::{self, End, Progress};
use super::{Input, Kind, shown};
use crate::fault::Fault;
use crate::run::{self, PROGRAM, RunOptions, text_of};
use lab::map::execute::{self, REPORT};
use lab::map::form::Map as Form;
use lab::map::tables::{LEAVES, MEASURES};
use lab::map::{self, Plan};
use lab::searched::{Mapped, Searched};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;

/// A map of a parameter space.
pub(super) struct Map;

impl Kind for Map {
    fn id(&self) -> &'static str {
        "map"
    }
    fn template(&self) -> &'static str {
        map::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks map")
    }
    fn reference(&self) -> String {
        let schemas: Vec<String> = terrain::schemas::all()
            .iter()
            .map(|schema| {
                let card = schema.card();
                let names: Vec<String> = card.parameters.iter().map(|one| format!("`{}`", one.name)).collect();
                format!("- `{}`: {} Parameters: {}.", card.id, card.about, names.join(", "))
            })
            .collect();
        let lead = format!(
            "Every key of a map file, TOML. [How to write one](../how-to/map.md). Behaviours and workspaces are those of [design \
             files](design.md).\n\nSchemas:\n\n{}",
            schemas.join("\n")
        );
        lab::file::reference::reference::<Form>("Map files", &lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let plan = read(input, false)?;
        let cells: u64 = plan.axes.iter().map(|axis| u64::from(axis.cells)).product();
        let (panels, iterations) = (plan.panels.len(), plan.refinement.iterations);
        let names: Vec<&str> = plan.axes.iter().map(|axis| axis.name.as_str()).collect();
        Ok(format!(
            "{} over {}: {panels} panels of {cells} cells, {iterations} iterations",
            plan.schema.card().id,
            names.join(", ")
        ))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        let threads = progress::begin(&mut input, options, "a map")?;
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
        Ok(Box::new(Mapped::open(folder)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        execute::of_folder(folder)?;
        Ok(vec![LEAVES, MEASURES])
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        progress::told(folder, REPORT, out)
    }
}

fn read(input: &Input, quick: bool) -> Result<Plan, Fault> {
    let mut load = |path: &str| text_of(path).map_err(|fault| fault.to_string());
    map::read(&input.name, &input.text, &input.sets, quick, &mut load).map_err(|problems| shown(&problems))
}
