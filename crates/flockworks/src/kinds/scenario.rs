//! `kind = "scenario"`: one world, run once.

use super::{Input, Kind};
use crate::fault::{Fault, wrong};
use crate::run::{self, RunOptions};
use crate::view::ViewOptions;
use lab::live::{LiveError, Recorded, Shown};
use lab::run::{EVENTS, METRICS, OBSTACLES, TRAJECTORY};
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
    fn view(&self, input: &Input, options: &ViewOptions) -> Result<(String, String), Fault> {
        if options.cell.is_some() || options.trial.is_some() {
            return wrong(format!("--cell and --trial are for studies; `{}` is a scenario", input.name));
        }
        let read = run::scenario(input)?;
        Ok((input.name.clone(), read.sources.text(0).to_owned()))
    }
    fn records(&self) -> bool {
        true
    }
    fn recordings(&self, folder: &Path) -> Result<usize, Fault> {
        run::read_back(folder).map(|_| 1)
    }
    fn show(&self, folder: &Path, _: usize) -> Result<Box<dyn Shown>, LiveError> {
        let (read, seed, quick) = run::read_back(folder).map_err(|fault| LiveError::Request(fault.to_string()))?;
        Ok(Box::new(Recorded::open(folder, read, seed, quick)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        run::read_back(folder)?;
        Ok(vec![TRAJECTORY, METRICS, EVENTS, OBSTACLES])
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        run::report_of_run(folder, out)
    }
}
