//! From a map file to a schema, axes, panels and a behaviour.

use super::form::{DivisionWord, Map, RuleWord};
use super::measures::Found;
use crate::design::plan::{opened, workspace};
use crate::environment::behaviour::Around;
use crate::environment::candidates::{axis_of, schema_of, values_of};
use crate::environment::claims;
use crate::environment::trial::{self, Population, PopulationForm, populations};
use crate::environment::workspace::Resolved;
use crate::file::{Form, Named, Node, Problems, Rule, Sources, Span};
use crate::scenario::build::Wrong;
use crate::study::plan::{Files, Load};
use measure::behaviours::Behaviour;
use measure::statistics::SequentialTest;
use search::refine::{Cell, Division, Refinement, RefinementPlan, Rule as Refine};
use search::{Axis, Domain};
use serde_json::{Value as Json, json};
use space::random::child_seed;
use terrain::{Construct, Schema, TerrainError};

/// Kind of child seeds, beside those of designs: a cell.
const CELL: u32 = 6;

/// A parameter that is an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct MapAxis {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its place among the schema's parameters.
    pub place: usize,
    /// Its ends.
    pub axis: Axis,
    /// Cells of the base grid.
    pub cells: u32,
}

/// A map beside others.
#[derive(Clone, Debug)]
pub struct Panel {
    /// The group; it has the name of the panel.
    pub population: Population,
    /// Values of the schema's parameters; those of the axes are replaced.
    pub values: Vec<f64>,
}

/// A map as resolved.
pub struct Plan {
    /// What was written.
    pub form: Map,
    /// What is there already.
    pub workspace: Resolved,
    /// The schema.
    pub schema: Box<dyn Schema>,
    /// The axes.
    pub axes: Vec<MapAxis>,
    /// The panels.
    pub panels: Vec<Panel>,
    /// When to stop trying.
    pub sequential: Option<SequentialTest>,
    /// Trials of each construct.
    pub trials: usize,
    /// How the map is refined.
    pub refinement: RefinementPlan,
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

impl Plan {
    /// A map that begins.
    ///
    /// # Errors
    /// None for a plan that was read.
    pub fn begin(&self) -> Result<Refinement, search::SearchError> {
        Refinement::new(self.refinement.clone())
    }
    /// The seed of a cell: a function of what it is, the same for all panels.
    pub fn seed_of(&self, cell: &Cell) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        for word in cell.place.iter().copied().chain(cell.level.iter().map(|&level| u64::from(level))) {
            for byte in word.to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
        child_seed(self.form.seed, CELL, hash, cell.generation)
    }
    /// The construct at a point, drawn with a seed.
    ///
    /// # Errors
    /// A point outside the schema's domain.
    pub fn construct(&self, panel: &Panel, point: &[f64], seed: u64, attempt: u64) -> Result<Construct, TerrainError> {
        let mut values = panel.values.clone();
        for (axis, value) in self.axes.iter().zip(point) {
            // sums of steps miss whole numbers and ends by rounding
            let near = (value * 1e9).round() / 1e9;
            values[axis.place] = near;
        }
        self.schema.construct(&values, &self.workspace.workspace, seed, attempt)
    }
    /// The behaviour where a construct stands in the workspace.
    ///
    /// # Errors
    /// Names that are not there.
    pub fn behaviour(&self, panel: &Panel, construct: &Construct, built: bool) -> Result<Behaviour, Wrong> {
        let setting = self.workspace.setting(construct, built);
        let around = Around { setting: &setting, groups: &panel.population.groups };
        self.form.behaviour.plain("behaviour", around).map_err(|wrong| wrong.below("behaviour"))
    }
    /// What the results depend on: panels and statements may be added, and the map may be refined further.
    pub fn identity(&self) -> Json {
        let mut form = self.form.clone();
        (form.title, form.about) = (String::new(), String::new());
        (form.claim, form.measure) = (Vec::new(), Named::default());
        (form.scenario, form.areas) = (None, true);
        let scenario = |panel: &Panel| {
            let mut scenario = panel.population.scenario.clone();
            (scenario.title, scenario.about, scenario.seed) = (String::new(), String::new(), None);
            (panel.population.name.clone(), scenario.write().json())
        };
        let scenarios: serde_json::Map<String, Json> = self.panels.iter().map(scenario).collect();
        json!({ "map": form.write().json(), "scenarios": scenarios, "trials": self.trials })
    }
}

/// Reads a map from its text, the values put over it, and the files it names.
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
    let form = Map::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut files.desk)
        .filter(|_| files.desk.problems.is_empty())?;
    let workspace = workspace(files, &form.workspace, name, &tree)?;
    let schema = schema_of(&form.schema.id, "schema.id", &tree, &mut files.desk)?;
    let values = values_of(&*schema, &form.schema.at, "schema.at", &tree, &mut files.desk)?;
    let axes = axes(files, &form, &*schema, &tree)?;
    let start = Span { source: tree.span.source, bytes: 0..0 };
    let base = files.scenario(form.scenario.as_ref(), &form.title, &form.set.0, &start, "map")?;
    let given = form
        .panel
        .0
        .iter()
        .map(|(name, panel)| (name.clone(), PopulationForm { about: panel.about.clone(), set: panel.set.clone() }));
    let populations = populations(&base, &Named(given.collect()), workspace.workspace.units, files)?;
    let mut panels = Vec::new();
    for (k, population) in populations.into_iter().enumerate() {
        let mut at = form.schema.at.clone();
        let mut path = "schema.at".to_owned();
        if let Some((name, panel)) = form.panel.0.get(k) {
            at.0.retain(|(known, _)| panel.at.0.iter().all(|(own, _)| own != known));
            at.0.extend(panel.at.0.iter().cloned());
            path = format!("panel.{name}.at");
        }
        let own = if form.panel.0.is_empty() {
            values.clone()
        } else {
            values_of(&*schema, &at, &path, &tree, &mut files.desk)?
        };
        panels.push(Panel { population, values: own });
    }
    let (iterations, trials) = match quick {
        true => (form.quick_iterations.min(form.refine.iterations), form.quick_trials.min(form.trials)),
        false => (form.refine.iterations, form.trials),
    };
    let sequential = match &form.sequential {
        None => None,
        Some(test) => {
            let most = (trials * form.constructs) as u32;
            match SequentialTest::new(test.lower, test.higher, test.alpha, test.beta, most) {
                Ok(test) => Some(test),
                Err(error) => {
                    files.desk.problem(&tree.place("sequential"), error.to_string(), "not possible", "");
                    None
                }
            }
        }
    };
    let domain = Domain::new(axes.iter().map(|axis| axis.axis).collect());
    let domain = domain.map_err(|error| files.desk.problem(&tree.place("axis"), error.to_string(), "", "")).ok()?;
    let refinement = RefinementPlan {
        domain,
        base: axes.iter().map(|axis| axis.cells).collect(),
        rule: match form.refine.rule {
            RuleWord::Success => Refine::Success,
            RuleWord::Boundary => Refine::Boundary,
        },
        division: match form.refine.division {
            DivisionWord::Orthtree => Division::Orthtree,
            DivisionWord::OneAxis => Division::OneAxis,
        },
        iterations,
        budget: form.refine.budget,
    };
    let plan = Plan {
        form,
        workspace,
        schema,
        axes,
        panels,
        sequential,
        trials,
        refinement,
        sources: Sources::default(),
        sets: sets.to_vec(),
        quick,
    };
    if files.desk.problems.is_empty() {
        tried(&plan, &tree, files);
    }
    Some(plan)
}

fn axes(files: &mut Files<'_>, form: &Map, schema: &dyn Schema, tree: &Node) -> Option<Vec<MapAxis>> {
    let mut axes = Vec::new();
    for (name, written) in &form.axis.0 {
        let place = tree.place(&format!("axis.{name}"));
        let found = axis_of(schema, name, (written.low, written.high), &place, &mut files.desk);
        axes.extend(found.map(|(place, axis, unit)| MapAxis {
            name: name.clone(),
            unit,
            place,
            axis,
            cells: written.cells,
        }));
    }
    if axes.is_empty() && files.desk.problems.is_empty() {
        files.desk.problem(&tree.place("axis"), "there is nothing to map", "at least one [axis.NAME]", "");
    }
    (axes.len() == form.axis.0.len() && !axes.is_empty()).then_some(axes)
}

/// Whether the map can begin, and a first cell gives a world in which the behaviour has a meaning.
fn tried(plan: &Plan, tree: &Node, files: &mut Files<'_>) {
    let desk = &mut files.desk;
    let map = match plan.begin() {
        Ok(map) => map,
        Err(error) => {
            desk.problem(&tree.place("refine"), error.to_string(), "not possible", "");
            return;
        }
    };
    for panel in &plan.panels {
        let all = map.cells().iter();
        let mut last = String::new();
        let found = all
            .map(|cell| plan.construct(panel, &map.centre(cell), plan.seed_of(cell), 0))
            .find_map(|made| made.map_err(|error| last = error.to_string()).ok());
        let Some(construct) = found else {
            desk.problem(&tree.place("axis"), format!("no cell gives a construct: {last}"), "not possible", "");
            return;
        };
        match plan.behaviour(panel, &construct, true) {
            Err(wrong) => desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help),
            Ok(behaviour) => {
                let geometry = plan.workspace.workspace.geometry.iter();
                let scenario = panel.population.among(geometry);
                let all = [behaviour];
                // stopped at once: that it can begin is what is asked
                if let Err(what) = trial::run(&scenario, &panel.population, &all, plan.form.seed, &|| true, &mut |_| ())
                {
                    let what = format!("`{}` cannot begin: {what}", panel.population.name);
                    desk.problem(&tree.place("scenario"), what, "not possible", "");
                }
            }
        }
    }
    for (path, what, help) in super::measures::check(plan) {
        desk.problem(&tree.place(&path), what, "not possible", help);
    }
    if desk.problems.is_empty() {
        claims::check(&plan.form.claim, &Found::example(plan), "claim", tree, desk);
    }
}
