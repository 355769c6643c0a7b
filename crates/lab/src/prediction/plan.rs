//! From a prediction file to constructs, groups, a behaviour and models.

use super::course::Asked;
use super::form::{ModelForm, Prediction, RangeForm};
use super::results::Results;
use super::surroundings::{Wall, walls};
use crate::design::plan::{TRIAL, opened, workspace};
use crate::environment::behaviour::Around;
use crate::environment::candidates::{axis_of, schema_of, values_of};
use crate::environment::claims;
use crate::environment::trial::{self, Population, PopulationForm, populations};
use crate::environment::workspace::Resolved;
use crate::file::{Form, Named, Node, Problems, Rule, Sources, Span};
use crate::scenario::Scenario;
use crate::scenario::build::Wrong;
use crate::study::plan::{Files, Load};
use measure::behaviours::Behaviour;
use search::Axis;
use serde_json::{Value as Json, json};
use space::random::{Purpose, child_seed, uniform};
use terrain::schema::Domain;
use terrain::{Construct, Schema};

/// Kinds of child seeds, beside those of designs, maps, optimisations and decompositions: a construct, a trial without one, a start, a
/// predicted trial.
const CONSTRUCT: u32 = 16;
const BARE: u32 = 17;
const START: u32 = 18;
const PREDICTED: u32 = 19;
/// Points drawn for a construct, until one lies in the schema's domain.
const POINTS: u64 = 1000;
/// The test of constructs that are held out.
pub const HELD_OUT: &str = "held_out";
/// Predictors that are there without a model: the mean of the training constructs, and nearest neighbours by parameters.
pub const BASELINES: [&str; 2] = ["mean", "parameters"];

/// A parameter that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its place among the schema's parameters.
    pub place: usize,
    /// Between which values.
    pub axis: Axis,
    /// Whether it is a whole number.
    pub whole: bool,
}

/// Constructs that are drawn alike and tried on one group.
#[derive(Clone, Debug)]
pub struct Lot {
    /// The group; it has the name of the test, that of the first lot is [`HELD_OUT`].
    pub population: Population,
    /// Values of the schema's parameters; those that are drawn are replaced.
    pub values: Vec<f64>,
    /// Parameters that are drawn.
    pub drawn: Vec<Drawn>,
    /// Number of constructs.
    pub constructs: u64,
}

/// A construct with the values of the parameters that were drawn.
#[derive(Clone, Debug)]
pub struct Built {
    /// The values, in the order of [`Lot::drawn`].
    pub values: Vec<f64>,
    /// The construct.
    pub construct: Construct,
}

/// A prediction as resolved.
pub struct Plan {
    /// What was written.
    pub form: Prediction,
    /// What is there already.
    pub workspace: Resolved,
    /// The schema.
    pub schema: Box<dyn Schema>,
    /// The lots: that of the file, of which some constructs are held out, then those of further tests.
    pub lots: Vec<Lot>,
    /// Simulated trials of each construct.
    pub trials: usize,
    /// Predicted trials of each construct.
    pub predicted: usize,
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

/// A hash of a text (FNV-1a).
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

impl Plan {
    /// Whether a construct of a lot is held out: all but those of the first, of which every so many are.
    pub fn held_out(&self, lot: usize, number: u64) -> bool {
        let share = self.form.held_out;
        lot > 0 || ((number + 1) as f64 * share).floor() > (number as f64 * share).floor()
    }
    /// Names of the tests: what is held out, where something is, and the lots after the first; each with its lot.
    pub fn tests(&self) -> Vec<(usize, &str)> {
        let held = (0..self.lots[0].constructs).any(|number| self.held_out(0, number));
        let all = self.lots.iter().enumerate().skip(usize::from(!held));
        all.map(|(k, lot)| (k, lot.population.name.as_str())).collect()
    }
    /// The numbers of the constructs of a lot that are held out, or of those that are not.
    pub fn numbers(&self, lot: usize, held_out: bool) -> Vec<u64> {
        (0..self.lots[lot].constructs).filter(|&number| self.held_out(lot, number) == held_out).collect()
    }
    /// Names of all predictors: baselines, then models.
    pub fn predictors(&self) -> Vec<&str> {
        BASELINES.into_iter().chain(self.form.model.0.iter().map(|(name, _)| name.as_str())).collect()
    }
    /// The seed of a construct: of what it is, in no order.
    fn seed_of(&self, lot: usize, number: u64) -> u64 {
        let name = hash(&self.lots[lot].population.name);
        child_seed(self.form.seed, CONSTRUCT, number, (name ^ (name >> 32)) as u32)
    }
    /// The seed of a simulated trial of a construct, from 1 on. It has 63 bits, so that a file can give it.
    pub fn trial(&self, lot: usize, number: u64, trial: u64) -> u64 {
        child_seed(self.seed_of(lot, number), TRIAL, trial, 0) >> 1
    }
    /// The seed of a trial without a construct.
    pub fn bare(&self, trial: u64) -> u64 {
        child_seed(self.form.seed, BARE, trial, 0) >> 1
    }
    /// The seed of the start of a predicted trial, the same for all constructs.
    pub fn start(&self, trial: u64) -> u64 {
        child_seed(self.form.seed, START, trial, 0) >> 1
    }
    /// The key of the draws of a predicted trial.
    pub fn key(&self, lot: usize, number: Option<u64>, trial: u64) -> u64 {
        let parent = number.map_or(self.form.seed, |number| self.seed_of(lot, number));
        child_seed(parent, PREDICTED, trial, 0)
    }
    /// A construct of a lot: at the first point of those drawn that lies in the schema's domain.
    ///
    /// # Errors
    /// Where none does; the last reason.
    pub fn built(&self, lot: usize, number: u64) -> Result<Built, String> {
        let seed = self.seed_of(lot, number);
        let Lot { values, drawn, .. } = &self.lots[lot];
        let mut last = String::new();
        for attempt in 0..POINTS {
            let mut all = values.clone();
            for (k, one) in drawn.iter().enumerate() {
                let share = uniform(seed, Purpose::Search, attempt, k as u32);
                let Axis { low, high, .. } = one.axis;
                all[one.place] = if one.whole {
                    (low + (share * (high - low + 1.0)).floor()).min(high)
                } else {
                    low + (high - low) * share
                };
            }
            match self.schema.construct(&all, &self.workspace.workspace, seed, attempt) {
                Ok(construct) => {
                    return Ok(Built { values: drawn.iter().map(|one| all[one.place]).collect(), construct });
                }
                Err(error) => last = error.to_string(),
            }
        }
        Err(last)
    }
    /// The scenario of a lot with a construct in it, and the walls of both.
    pub fn among(&self, lot: usize, construct: Option<&Construct>) -> (Scenario, Vec<Wall>) {
        let there = self.workspace.workspace.geometry.iter();
        let geometry: Vec<&terrain::Geometry> =
            there.chain(construct.into_iter().flat_map(Construct::geometry)).collect();
        (self.lots[lot].population.among(geometry.iter().copied()), walls(geometry.iter().copied()))
    }
    /// The behaviour where a construct stands in the workspace.
    ///
    /// # Errors
    /// Names that are not there.
    pub fn behaviour(&self, lot: usize, construct: Option<&Construct>) -> Result<Behaviour, Wrong> {
        let nothing = Construct::new(self.workspace.workspace.units, Vec::new());
        let setting = self.workspace.setting(construct.unwrap_or(&nothing), construct.is_some());
        let around = Around { setting: &setting, groups: &self.lots[lot].population.groups };
        self.form.behaviour.plain("behaviour", around).map_err(|wrong| wrong.below("behaviour"))
    }
    /// How a group is looked at.
    pub fn asked<'a>(&'a self, lot: usize, behaviour: &'a Behaviour) -> Asked<'a> {
        let population = &self.lots[lot].population;
        Asked { population, behaviour, every: self.form.every, link: self.form.link }
    }
    /// By what predictions of a model are known: another model, or one that is fitted to more, has others.
    pub fn fingerprint(&self, model: &ModelForm) -> u64 {
        let mut model = model.clone();
        model.about = String::new();
        let fitted = self.numbers(0, false).len();
        hash(&json!({ "model": model.write().json(), "fitted": fitted, "predicted": self.predicted }).to_string())
    }
    /// What the simulated trials depend on: constructs may be added and models changed, and statements are made afterwards.
    pub fn identity(&self) -> Json {
        let mut form = self.form.clone();
        (form.title, form.about) = (String::new(), String::new());
        (form.claim, form.model) = (Vec::new(), Named::default());
        (form.scenario, form.show, form.predicted, form.quick_predicted) = (None, 0, 1, 1);
        (form.constructs, form.quick_constructs) = (2, 2);
        form.test.0.iter_mut().for_each(|(_, test)| (test.about, test.constructs) = (String::new(), 1));
        let scenario = |lot: &Lot| {
            let mut scenario = lot.population.scenario.clone();
            (scenario.title, scenario.about, scenario.seed) = (String::new(), String::new(), None);
            (lot.population.name.clone(), scenario.write().json())
        };
        let scenarios: serde_json::Map<String, Json> = self.lots.iter().map(scenario).collect();
        let there = terrain::text::wkt::write(&self.workspace.workspace.geometry);
        json!({ "prediction": form.write().json(), "scenarios": scenarios, "workspace": there, "trials": self.trials })
    }
}

/// Reads a prediction from its text, the values put over it, and the files it names.
///
/// # Errors
/// Everything that is wrong with it, at its place.
pub fn read(name: &str, text: &str, sets: &[String], quick: bool, load: Load<'_>) -> Result<Plan, Problems> {
    let (mut plan, sources) = Files::read(load, |files| planned(files, name, text, sets, quick))?;
    plan.sources = sources;
    Ok(plan)
}

fn planned(files: &mut Files<'_>, name: &str, text: &str, sets: &[String], quick: bool) -> Option<Plan> {
    let tree = opened(files, name, text, sets)?;
    let form = Prediction::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut files.desk)
        .filter(|_| files.desk.problems.is_empty())?;
    let workspace = workspace(files, &form.workspace, name, &tree)?;
    let schema = schema_of(&form.schema.id, "schema.id", &tree, &mut files.desk)?;
    let start = Span { source: tree.span.source, bytes: 0..0 };
    let base = files.scenario(form.scenario.as_ref(), &form.title, &form.set.0, &start, "prediction")?;
    let own = (HELD_OUT.to_owned(), PopulationForm { about: String::new(), set: crate::study::form::empty() });
    let tests = form
        .test
        .0
        .iter()
        .map(|(name, test)| (name.clone(), PopulationForm { about: test.about.clone(), set: test.set.clone() }));
    let given = Named(std::iter::once(own).chain(tests).collect());
    let populations = populations(&base, &given, workspace.workspace.units, files)?;
    named(files, &form, &tree);
    let mut lots = Vec::new();
    for (k, population) in populations.into_iter().enumerate() {
        let test = k.checked_sub(1).map(|k| &form.test.0[k]);
        let (mut at, mut ranges) = (form.schema.at.clone(), form.range.clone());
        let (mut at_path, mut range_path) = ("schema.at".to_owned(), "range".to_owned());
        let mut constructs = form.constructs;
        if let Some((name, test)) = test {
            // what is given for a test stands in the place of what the file gives
            let told = |name: &String| {
                test.at.0.iter().any(|(own, _)| own == name) || test.range.0.iter().any(|(own, _)| own == name)
            };
            at.0.retain(|(name, _)| !told(name));
            ranges.0.retain(|(name, _)| !told(name));
            at.0.extend(test.at.0.iter().cloned());
            ranges.0.extend(test.range.0.iter().cloned());
            (at_path, range_path) = (format!("test.{name}.at"), format!("test.{name}.range"));
            constructs = test.constructs;
        }
        let values = values_of(&*schema, &at, &at_path, &tree, &mut files.desk)?;
        let drawn = drawn(files, &*schema, &ranges, &range_path, &tree)?;
        let constructs = if quick { constructs.min(form.quick_constructs) } else { constructs } as u64;
        lots.push(Lot { population, values, drawn, constructs });
    }
    let (trials, predicted) = match quick {
        true => (form.quick_trials.min(form.trials), form.quick_predicted.min(form.predicted)),
        false => (form.trials, form.predicted),
    };
    let sets = sets.to_vec();
    let plan = Plan { form, workspace, schema, lots, trials, predicted, sources: Sources::default(), sets, quick };
    if files.desk.problems.is_empty() {
        tried(&plan, &tree, files);
    }
    Some(plan)
}

/// Whether names of models and tests are theirs alone, and something is asked.
fn named(files: &mut Files<'_>, form: &Prediction, tree: &Node) {
    for (name, _) in form.model.0.iter().filter(|(name, _)| BASELINES.contains(&name.as_str())) {
        let what = format!("`{name}` is what a model is compared with");
        files.desk.problem(&tree.place(&format!("model.{name}")), what, "another name", "");
    }
    if form.model.0.is_empty() {
        files.desk.problem(&tree.place("model"), "there is no model", "at least one [model.NAME]", "");
    }
    for (name, _) in form.test.0.iter().filter(|(name, _)| name == HELD_OUT) {
        let what = format!("`{name}` is the test of the constructs of the file that are held out");
        files.desk.problem(&tree.place(&format!("test.{name}")), what, "another name", "");
    }
    if form.held_out == 0.0 && form.test.0.is_empty() {
        files.desk.problem(&tree.place("held_out"), "nothing is held out", "a share above 0, or a [test.NAME]", "");
    }
}

/// The parameters that are drawn; what is wrong goes to the desk.
fn drawn(
    files: &mut Files<'_>,
    schema: &dyn Schema,
    ranges: &Named<RangeForm>,
    path: &str,
    tree: &Node,
) -> Option<Vec<Drawn>> {
    let mut drawn = Vec::new();
    for (name, written) in &ranges.0 {
        let place = tree.place(&format!("{path}.{name}"));
        let (at, axis, unit) = axis_of(schema, name, (written.low, written.high), &place, &mut files.desk)?;
        let domain = &schema.card().parameters[at].domain;
        let (least, most) = domain.bounds();
        let whole = matches!(domain, Domain::Whole(..));
        if !(axis.low < axis.high && axis.low >= least && axis.high <= most) {
            let what = format!("`{name}` cannot be drawn from {} to {}", axis.low, axis.high);
            files.desk.problem(&place, what, format!("from {least} to {most} at most, in order"), "");
            return None;
        }
        if whole && (axis.low.fract() != 0.0 || axis.high.fract() != 0.0) {
            files.desk.problem(&place, format!("`{name}` is a whole number"), "whole ends", "");
            return None;
        }
        drawn.push(Drawn { name: name.clone(), unit, place: at, axis, whole });
    }
    Some(drawn)
}

/// Whether every lot gives a world in which the behaviour has a meaning.
fn tried(plan: &Plan, tree: &Node, files: &mut Files<'_>) {
    let desk = &mut files.desk;
    if plan.numbers(0, false).len() < 2 {
        let what = format!(
            "{} of {} constructs are left to fit a model to",
            plan.numbers(0, false).len(),
            plan.lots[0].constructs
        );
        desk.problem(&tree.place("held_out"), what, "at least 2", "");
        return;
    }
    for (k, lot) in plan.lots.iter().enumerate() {
        let built = match plan.built(k, 0) {
            Ok(built) => built,
            Err(what) => {
                desk.problem(&tree.place("schema"), format!("no point gives a construct: {what}"), "not possible", "");
                return;
            }
        };
        match plan.behaviour(k, Some(&built.construct)) {
            Err(wrong) => desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help),
            Ok(behaviour) => {
                let (scenario, _) = plan.among(k, Some(&built.construct));
                // stopped at once: that it can begin is what is asked
                let begun =
                    trial::run(&scenario, &lot.population, &[behaviour], plan.trial(k, 0, 1), &|| true, &mut |_| ());
                if let Err(what) = begun {
                    let what = format!("`{}` cannot begin: {what}", lot.population.name);
                    desk.problem(&tree.place("scenario"), what, "not possible", "");
                }
            }
        }
    }
    if desk.problems.is_empty() {
        claims::check(&plan.form.claim, &Results::example(plan), "claim", tree, desk);
    }
}
