//! `kind = "design"`: environments that are generated, filtered, and tried on groups.

use super::progress::{self, End, Progress};
use super::{Input, Kind, shown};
use crate::fault::{Fault, wrong};
use crate::run::{self, PROGRAM, RunOptions, text_of};
use crate::view::ViewOptions;
use lab::design::execute::{self, REPORT};
use lab::design::export::{self, ENVIRONMENTS};
use lab::design::form::Design as Form;
use lab::design::inverse;
use lab::design::results::NAMES;
use lab::design::robustness::ROBUSTNESS;
use lab::design::tables::{CANDIDATES, RATES, RESULTS, STAGES, TRIALS};
use lab::design::{self, Plan};
use lab::environment::signal::SIGNALS;
use lab::searched::{Designed, Searched};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;

/// Environments that are generated and tried.
pub(super) struct Design;

impl Kind for Design {
    fn id(&self) -> &'static str {
        "design"
    }
    fn template(&self) -> &'static str {
        design::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks design")
    }
    fn reference(&self) -> String {
        let signals: Vec<String> = SIGNALS.iter().map(|(_, usage, about)| format!("- `{usage}`: {about}")).collect();
        let filters: Vec<String> = terrain::filters::all()
            .iter()
            .map(|filter| {
                let card = filter.card();
                let numbers: Vec<String> =
                    card.parameters.iter().map(|(name, about)| format!(" `{name}`: {about}")).collect();
                format!("- `{}`: {}{}", card.id, card.about, numbers.concat())
            })
            .collect();
        let behaviours: Vec<String> = measure::behaviours::LIST
            .iter()
            .map(|card| {
                let numbers: Vec<String> =
                    card.parameters.iter().map(|one| format!("`{}` {}", one.name, one.default)).collect();
                let needs =
                    if card.needs.is_empty() { String::new() } else { format!(" Needs {}.", card.needs.join(", ")) };
                let numbers =
                    if numbers.is_empty() { String::new() } else { format!(" Numbers: {}.", numbers.join(", ")) };
                format!("- `{}`: {}.{needs}{numbers}", card.id, card.definition)
            })
            .collect();
        let primitives: Vec<String> = terrain::primitives::all()
            .iter()
            .map(|kind| {
                let names: Vec<String> = kind.attributes.iter().map(|one| format!("`{}`", one.name)).collect();
                format!("- `{}`: {} Attributes: {}.", kind.id, kind.about, names.join(", "))
            })
            .collect();
        let lead = format!(
            "Every key of a design file, TOML. [How to write one](../how-to/design.md). Schemas are listed with [map \
             files](map.md).\n\nShipped grammars: {}.\n\nFilters:\n\n{}\n\nPrimitives:\n\n{}\n\nBehaviours:\n\n{}\n\n\
             Signals that behaviours read:\n\n{}\n\nWhat statements can ask for, with `[behaviour = ..., population = ...]` \
             where there are several:\n\n{}\n\nWhat statements about identifications (`inverse.claim`) can ask for, with \
             `[by = ..., population = ...]`:\n\n{}\n\nWays to choose environments (`by`):\n\n{}",
            terrain::grammars::LIST.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
            filters.join("\n"),
            primitives.join("\n"),
            behaviours.join("\n"),
            signals.join("\n"),
            listed(NAMES.iter().map(|(name, about)| (*name, *about))),
            listed(inverse::NAMES.iter().map(|(name, about)| (*name, *about))),
            listed(inverse::Way::ALL.iter().map(|(_, word, about)| (*word, *about)))
        );
        lab::file::reference::reference::<Form>("Design files", &lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let plan = read(input, false)?;
        let most = plan.source.count().map_or(plan.attempts as f64, |count| count.min(plan.attempts as f64));
        Ok(format!(
            "{}: {most} candidates at most, {} groups, {} behaviours, {} trials",
            plan.source.name(),
            plan.populations.len(),
            plan.behaviour_names().len(),
            plan.form.trials
        ))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        let threads = progress::begin(&mut input, options, "a design")?;
        let plan = read(&input, options.quick)?;
        run::listen()?;
        let mut progress = Progress::new();
        let done = execute::run(&plan, threads, options.out.as_deref(), PROGRAM, &mut progress);
        progress.clear();
        let done = done?;
        let end = End {
            stopped: (done.left > 0).then(|| format!("stopped, {} units of work are left", done.left)),
            made: format!("{} candidates", done.candidates),
            title: &plan.form.title,
            lines: &done.lines,
            seconds: done.seconds,
        };
        end.tell(out, |out| told(&done.folder, out))
    }
    fn view(&self, input: &Input, _: &ViewOptions) -> Result<(String, String), Fault> {
        // the first feasible environment with the first group: others are files of their own in the folder
        let plan = read(input, true)?;
        let survey = plan.survey().map_err(Fault::Input)?;
        match (survey.feasible.first(), plan.populations.first()) {
            (Some((attempt, construct)), Some(population)) => {
                let title = format!("{}: candidate {attempt}", plan.form.title);
                let seed = plan.seed_of(*attempt, 1);
                Ok((input.name.clone(), export::scenario(&plan, population, construct, seed, &title)))
            }
            _ => wrong(format!("`{}` has no feasible environment among the first", input.name)),
        }
    }
    fn search(&self, folder: &Path) -> Result<Box<dyn Searched>, Fault> {
        Ok(Box::new(Designed::open(folder)?))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        let mut tables = vec![RATES, CANDIDATES, RESULTS, TRIALS];
        let plan = execute::of_folder(folder)?;
        if plan.form.robustness.is_some() {
            tables.push(ROBUSTNESS);
        }
        if plan.stages() > 0 {
            tables.push(STAGES);
        }
        if plan.form.inverse.is_some() {
            tables.extend([inverse::OUTCOMES, inverse::INFORMATION, inverse::IDENTIFICATIONS, inverse::COURSES]);
        }
        Ok(tables)
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        told(folder, out)
    }
}

/// Names with what they are, as a list.
fn listed<'a>(all: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    all.map(|(name, about)| format!("- `{name}`: {about}")).collect::<Vec<_>>().join("\n")
}

fn told(folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
    writeln!(out, "tables        {}", folder.display())?;
    if folder.join(ENVIRONMENTS).exists() {
        writeln!(out, "environments  {}", folder.join(ENVIRONMENTS).display())?;
    }
    writeln!(out, "page          {}", folder.join(REPORT).display())?;
    Ok(())
}

fn read(input: &Input, quick: bool) -> Result<Plan, Fault> {
    let mut load = |path: &str| text_of(path).map_err(|fault| fault.to_string());
    design::read(&input.name, &input.text, &input.sets, quick, &mut load).map_err(|problems| shown(&problems))
}
