//! `kind = "scenario"`: one world, run once.

use super::{Input, Kind};
use crate::fault::{Fault, wrong};
use crate::run::{self, RunOptions};
use crate::view::ViewOptions;
use lab::scenario::{self, build};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;

/// One world, run once.
pub(super) struct Scenario;

impl Kind for Scenario {
    fn id(&self) -> &'static str {
        "scenario"
    }
    fn template(&self) -> &'static str {
        scenario::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<scenario::Scenario>("flockworks scenario")
    }
    fn reference(&self) -> String {
        let lead = "Every key of a scenario file, TOML. A choice is a table with one of its keys, as in \
                    `driver.sequential = { order = \"random\" }`; where nothing more must be said its name in quotes \
                    is enough, as in `driver = \"synchronous\"`. Angles are in degrees.";
        lab::file::reference::reference::<scenario::Scenario>("Scenario files", lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let read = run::scenario(input)?;
        let schedule = build::schedule(&read.scenario, false).map_err(|wrong| Fault::Input(wrong.what))?;
        let agents: usize = read.scenario.group.0.iter().map(|(_, group)| group.count).sum();
        Ok(format!("{agents} agents, {} steps of {}", schedule.steps, schedule.step))
    }
    fn run(&self, input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        if let Some(option) = options.study.given() {
            return wrong(format!("{option} is for studies; `{}` is a scenario", input.name));
        }
        run::run_scenario(run::scenario(&input)?, options, out)
    }
    fn view(&self, input: &Input, _: &ViewOptions) -> Result<(String, String), Fault> {
        let read = run::scenario(input)?;
        Ok((input.name.clone(), read.sources.text(0).to_owned()))
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        run::report_of_run(folder, out)
    }
}
