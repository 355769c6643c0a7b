//! `kind = "prediction"`: what constructs will do to a group, predicted by macroscopic models.

use super::progress::{self, End, Progress};
use super::{Input, Kind, shown};
use crate::fault::Fault;
use crate::run::{self, PROGRAM, RunOptions, text_of};
use lab::prediction::execute::{self, REPORT};
use lab::prediction::form::Prediction as Form;
use lab::prediction::model::OUTPUTS;
use lab::prediction::results::NAMES;
use lab::prediction::tables::{CONSTRUCTS, SCORES, STATES};
use lab::prediction::{self, Plan};
use serde_json::Value as Json;
use std::io::Write;
use std::path::Path;

/// What constructs will do, predicted.
pub(super) struct Prediction;

impl Kind for Prediction {
    fn id(&self) -> &'static str {
        "prediction"
    }
    fn template(&self) -> &'static str {
        prediction::TEMPLATE
    }
    fn schema(&self) -> Json {
        lab::file::schema::schema::<Form>("flockworks prediction")
    }
    fn reference(&self) -> String {
        let names: Vec<String> = NAMES.iter().map(|(name, about)| format!("- `{name}`: {about}")).collect();
        let outputs: Vec<String> =
            OUTPUTS.iter().map(|(name, unit, about)| format!("- `{name}` ({unit}): {about}")).collect();
        let lead = format!(
            "Every key of a prediction file, TOML. [How to write one](../how-to/prediction.md). Schemas are listed with [map \
             files](map.md); behaviours and workspaces are those of [design files](design.md).\n\nWhat a model tells of the next look, in \
             the frame of the group's heading:\n\n{}\n\nWhat statements can ask for, with `[by = ..., test = ...]` (predictors are `mean`, \
             `parameters` and the models; without a test, what is held out is meant):\n\n{}",
            outputs.join("\n"),
            names.join("\n")
        );
        lab::file::reference::reference::<Form>("Prediction files", &lead)
    }
    fn check(&self, input: &Input) -> Result<String, Fault> {
        let plan = read(input, false)?;
        let tests: Vec<String> = plan
            .tests()
            .into_iter()
            .map(|(lot, name)| format!("{} of {name}", plan.numbers(lot, true).len()))
            .collect();
        Ok(format!(
            "{}: {} constructs to fit to, tests: {}; {} trials each",
            plan.schema.card().id,
            plan.numbers(0, false).len(),
            tests.join(", "),
            plan.trials
        ))
    }
    fn run(&self, mut input: Input, options: &RunOptions, out: &mut dyn Write) -> Result<u8, Fault> {
        let threads = progress::begin(&mut input, options, "a prediction")?;
        let plan = read(&input, options.quick)?;
        run::listen()?;
        let mut progress = Progress::new();
        let done = execute::run(&plan, threads, options.out.as_deref(), PROGRAM, &mut progress);
        progress.clear();
        let done = done?;
        let end = End {
            stopped: (!done.complete).then(|| format!("stopped after {} constructs", done.constructs)),
            made: format!("{} constructs", done.constructs),
            title: &plan.form.title,
            lines: &done.lines,
            seconds: done.seconds,
        };
        end.tell(out, |out| progress::told(&done.folder, REPORT, out))
    }
    fn tables(&self, folder: &Path) -> Result<Vec<&'static str>, Fault> {
        execute::of_folder(folder)?;
        Ok(vec![CONSTRUCTS, SCORES, STATES])
    }
    fn report(&self, folder: &Path, out: &mut dyn Write) -> Result<(), Fault> {
        execute::report_again(folder, PROGRAM)?;
        progress::told(folder, REPORT, out)
    }
}

fn read(input: &Input, quick: bool) -> Result<Plan, Fault> {
    let mut load = |path: &str| text_of(path).map_err(|fault| fault.to_string());
    prediction::read(&input.name, &input.text, &input.sets, quick, &mut load).map_err(|problems| shown(&problems))
}
