//! A design: its environments as drawings, how each came about, and the group in it.

use super::{At, Searched, Watched, drawing, rounded};
use crate::design::execute::{self, Known};
use crate::design::export::environment;
use crate::design::results::{Results, Share};
use crate::design::{Plan, export, report, robustness};
use crate::environment::candidates::Source;
use crate::live::LiveError;
use crate::report::{Drawing, Page, Stroke, bounds};
use crate::store::StoreError;
use serde_json::{Value as Json, json};
use std::path::Path;
use terrain::Construct;

/// Drawings in one answer, at most.
const DRAWN: usize = 200;
/// Steps of a derivation, at most.
const STEPS: usize = 200;

/// A design in its folder.
pub struct Designed {
    plan: Plan,
    survey: crate::design::plan::Survey,
    known: Known,
}

impl Designed {
    /// The design in a folder.
    ///
    /// # Errors
    /// A folder that holds none, or one that cannot be read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let (plan, known) = execute::look(path)?;
        let survey = plan.survey().map_err(StoreError::Refused)?;
        Ok(Self { plan, survey, known })
    }
    fn drawn(&self, construct: &Construct) -> Drawing {
        let mut drawing = report::of_environment(&environment(&self.plan, construct), String::new());
        report::put_doors(&mut drawing, &self.plan, construct);
        drawing
    }
    /// The derivation of an environment, step by step; nothing where no grammar made it.
    fn derivation(&self, construct: &Construct) -> Vec<Drawing> {
        let (Source::Grammar(grammar), Some(derivation)) = (&self.plan.source, &construct.provenance.derivation) else {
            return Vec::new();
        };
        let step = |step: usize| {
            let rule = step.checked_sub(1).and_then(|k| derivation.steps.get(k));
            let caption = rule.map_or_else(|| "start".to_owned(), |rule| rule.rule.clone());
            let mut drawing = Drawing { caption, ..Drawing::default() };
            report::put(&mut drawing, &self.plan.workspace.workspace.geometry, Stroke::There);
            for instance in derivation.after(step) {
                let kind = grammar.shapes.get(instance.shape).map(|shape| shape.kind);
                let stroke = match kind {
                    Some(terrain::grammar::Kind::Terminal) => Stroke::Built,
                    _ => Stroke::Structure,
                };
                report::put(&mut drawing, &instance.geometry(grammar), stroke);
            }
            drawing
        };
        (0..=derivation.steps.len().min(STEPS)).map(step).collect()
    }
}

impl Searched for Designed {
    fn overview(&self) -> Json {
        let plan = &self.plan;
        let rates = |attempt: u64| -> Json {
            let of = |behaviour: usize| -> Vec<Json> {
                let share = |group: usize| {
                    let trials = self.known.trials.get(&attempt).and_then(|all| all.get(group));
                    trials.map_or(Json::Null, |trials| {
                        let share = Share::of(&trials.built, behaviour, plan.form.success);
                        json!([share.successes, share.trials])
                    })
                };
                (0..plan.populations.len()).map(share).collect()
            };
            (0..plan.behaviour_names().len()).map(of).collect::<Vec<_>>().into()
        };
        let environments: Vec<Json> = self
            .survey
            .feasible
            .iter()
            .map(|(attempt, _)| json!({ "attempt": attempt, "rates": rates(*attempt) }))
            .collect();
        let mut there = Drawing::default();
        report::put(&mut there, &plan.workspace.workspace.geometry, Stroke::There);
        let populations = plan.populations.iter().map(|one| json!({ "name": one.name, "about": one.about }));
        let counts = &self.survey.counts;
        json!({
            "kind": "design",
            "title": plan.form.title,
            "about": plan.form.about,
            "source": plan.source.name(),
            "unit": if plan.workspace.workspace.units == terrain::Units::Metres { "m" } else { "unit" },
            "behaviours": plan.behaviour_names(),
            "populations": populations.collect::<Vec<_>>(),
            "trials": plan.form.trials,
            "generated": counts.generated,
            "derives": matches!(plan.source, Source::Grammar(_)),
            "environments": environments,
            // without a workspace each environment fills its own picture
            "bounds": bounds(&there).map(|(low, high)| [low, high]),
        })
    }
    /// Drawings of so many environments from one on; or, with `steps`, the derivation of one.
    fn part(&self, at: &At) -> Result<Json, LiveError> {
        let feasible = &self.survey.feasible;
        if at.perhaps("steps").is_some() {
            let (_, construct) = &feasible[at.below("environment", feasible.len())?];
            let steps: Vec<Json> = self.derivation(construct).iter().map(drawing).collect();
            return Ok(json!({ "steps": steps, "material": rounded(construct.material()) }));
        }
        let from = at.whole("from")?;
        let count = at.whole("count")?.min(DRAWN);
        let some = feasible.iter().skip(from).take(count);
        let drawings: Vec<Json> = some.map(|(_, construct)| drawing(&self.drawn(construct))).collect();
        Ok(json!({ "from": from, "drawings": drawings }))
    }
    fn watched(&self, at: &At) -> Result<Watched, LiveError> {
        let plan = &self.plan;
        let feasible = &self.survey.feasible;
        let (attempt, construct) = &feasible[at.below("environment", feasible.len())?];
        let population = &plan.populations[at.below("population", plan.populations.len())?];
        let trial = at.perhaps("trial").unwrap_or(1).max(1);
        let title = format!("{}: candidate {attempt}, {}, trial {trial}", plan.form.title, population.name);
        let seed = plan.seed_of(*attempt, trial);
        let name = format!("candidate-{attempt}-{}-trial-{trial}.toml", population.name);
        Ok(Watched::Scenario { name, text: export::scenario(plan, population, construct, seed, &title), seed: None })
    }
    fn page(&self, program: &str) -> Page {
        let results = Results::new(&self.plan, self.survey.clone(), self.known.trials.clone());
        // copies of environments that were the best of fewer candidates are left out
        let wanted = robustness::copies(&results).into_iter();
        let copies = wanted.filter_map(|copy| Some((copy, *self.known.copies.get(&copy)?))).collect();
        report::page(&results, &copies, &self.known.streams, program)
    }
    fn telling(&self) -> Vec<At> {
        let plan = &self.plan;
        // the best environment for each group, by the first behaviour
        let best = |population: usize| {
            let rate = |(place, (attempt, _)): (usize, &(u64, Construct))| {
                let trials = self.known.trials.get(attempt)?.get(population)?;
                let share = Share::of(&trials.built, 0, plan.form.success);
                (share.trials > 0).then(|| (place, share.rate()))
            };
            let rates = self.survey.feasible.iter().enumerate().filter_map(rate);
            let (place, _) = rates.reduce(|best, other| if other.1 > best.1 { other } else { best })?;
            Some(At::new(&[("environment", place as f64), ("population", population as f64), ("trial", 1.0)]))
        };
        (0..plan.populations.len()).filter_map(best).collect()
    }
    fn words(&self) -> Vec<String> {
        ["environment", "population", "trial"].map(str::to_owned).to_vec()
    }
}
