//! From an optimisation file to a schema, a box, methods and a behaviour.

use super::form::{AxisForm, Optimisation, Search};
use super::results::Results;
use super::searcher::Searcher;
use crate::design::plan::{opened, workspace};
use crate::environment::behaviour::Around;
use crate::environment::candidates::{axis_of, schema_of, values_of};
use crate::environment::claims;
use crate::environment::filter;
use crate::environment::trial::{self, Population};
use crate::environment::workspace::Resolved;
use crate::file::{Form, Node, Problems, Rule, Sources, Span};
use crate::scenario::build::{self, Wrong};
use crate::study::plan::{Files, Load};
use measure::behaviours::Behaviour;
use search::{Axis, Domain};
use serde_json::{Value as Json, json};
use space::random::child_seed;
use space::spelling::nearest;
use terrain::filters::Combined;
use terrain::grammar::Decided;
use terrain::{Construct, Schema, TerrainError};

/// More parameters than these are counted, not named.
const MOST_NAMED: usize = 6;

/// Kinds of child seeds, beside those of designs and maps: a run, what a construct draws.
const RUN: u32 = 9;
const DRAWN: u32 = 10;

/// What tells kinds of constructs apart beside the axes, with its unit.
pub const KINDS: [(&str, &str); 3] = [("material", "length"), ("pieces", "1"), ("steps", "steps")];

/// A parameter that is searched over.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchAxis {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its place among the schema's parameters.
    pub place: usize,
    /// Whether it takes whole numbers alone.
    pub whole: bool,
    /// Its ends.
    pub axis: Axis,
}

/// An optimisation as resolved.
pub struct Plan {
    /// What was written.
    pub form: Optimisation,
    /// What is there already.
    pub workspace: Resolved,
    /// What builds constructs.
    pub schema: Box<dyn Schema>,
    /// What that is, in words.
    pub builder: String,
    /// What its constructs must be like.
    pub filter: Combined,
    /// A construct of which nothing is built: markers alone, where one of its constructs has them.
    pub bare: Construct,
    /// Values of its parameters; those of the axes are replaced.
    pub values: Vec<f64>,
    /// What is searched over.
    pub axes: Vec<SearchAxis>,
    /// The box.
    pub domain: Domain,
    /// The group.
    pub population: Population,
    /// Evaluations of each run.
    pub evaluations: usize,
    /// Runs of each method.
    pub runs: usize,
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

impl Plan {
    /// Names of the methods, in order.
    pub fn methods(&self) -> Vec<&str> {
        self.form.method.0.iter().map(|(name, _)| name.as_str()).collect()
    }
    /// What is searched over: each parameter in these words, or how many there are where they are too many to name.
    pub fn over(&self, word: &dyn Fn(&SearchAxis) -> String) -> String {
        match self.axes.as_slice() {
            axes if axes.len() > MOST_NAMED => format!("{} parameters", axes.len()),
            axes => axes.iter().map(word).collect::<Vec<_>>().join(", "),
        }
    }
    /// The seed of a run of a method.
    pub fn seed_of(&self, method: usize, run: usize) -> u64 {
        child_seed(self.form.seed, RUN, run as u64, method as u32)
    }
    /// Values of all parameters of the schema at a point.
    fn values_at(&self, point: &[f64]) -> Vec<f64> {
        let mut values = self.values.clone();
        for (axis, value) in self.axes.iter().zip(point) {
            values[axis.place] = if axis.whole { value.round() } else { *value };
        }
        values
    }
    /// The construct at a point: what a schema draws follows from the point as well.
    ///
    /// # Errors
    /// A point outside the schema's domain; a construct that a filter does not let through.
    pub fn construct(&self, point: &[f64]) -> Result<Construct, TerrainError> {
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        for byte in point.iter().flat_map(|value| value.to_bits().to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        let seed = child_seed(self.form.seed, DRAWN, hash, 0);
        let construct = self.schema.construct(&self.values_at(point), &self.workspace.workspace, seed, 0)?;
        let verdict = self.filter.check(&construct, &self.workspace.workspace);
        if verdict.pass { Ok(construct) } else { Err(TerrainError::Infeasible(verdict.reason.to_owned())) }
    }
    /// The behaviour where a construct stands in the workspace.
    ///
    /// # Errors
    /// Names that are not there.
    pub fn behaviour(&self, construct: &Construct, built: bool) -> Result<Behaviour, Wrong> {
        let setting = self.workspace.setting(construct, built);
        let around = Around { setting: &setting, groups: &self.population.groups };
        self.form.behaviour.plain("behaviour", around).map_err(|wrong| wrong.below("behaviour"))
    }
    /// What the results depend on: runs, evaluations and statements may be added.
    pub fn identity(&self) -> Json {
        let mut form = self.form.clone();
        (form.title, form.about, form.claim) = (String::new(), String::new(), Vec::new());
        (form.evaluations, form.quick_evaluations, form.runs, form.quick_runs) = (1, 1, 1, 1);
        (form.scenario, form.show) = (None, 0);
        let mut scenario = self.population.scenario.clone();
        (scenario.title, scenario.about, scenario.seed) = (String::new(), String::new(), None);
        json!({ "optimisation": form.write().json(), "scenario": scenario.write().json() })
    }
}

/// Reads an optimisation from its text, the values put over it, and the files it names.
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
    let form = Optimisation::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut files.desk)
        .filter(|_| files.desk.problems.is_empty())?;
    let workspace = workspace(files, &form.workspace, name, &tree)?;
    let (builder, schema, values) = built(files, &form, name, &tree)?;
    let filter = filter::all_of(&form.filter, &tree, &mut files.desk);
    let axes = axes(files, &form, &*schema, &tree)?;
    let start = Span { source: tree.span.source, bytes: 0..0 };
    let base = files.scenario(form.scenario.as_ref(), &form.title, &form.set.0, &start, "optimisation")?;
    let scenario = build::resolved(&base, &mut files.desk)?;
    let population = match Population::new("group", "", base.clone(), scenario, workspace.workspace.units) {
        Ok(population) => population,
        Err(wrong) => {
            files.desk.problem(&base.place(&wrong.path), wrong.what, wrong.expected, wrong.help);
            return None;
        }
    };
    let domain = Domain::new(axes.iter().map(|axis| axis.axis).collect());
    let domain = domain.map_err(|error| files.desk.problem(&tree.place("axis"), error.to_string(), "", "")).ok()?;
    methods(files, &form, &axes, &tree);
    let (evaluations, runs) = match quick {
        true => (form.quick_evaluations.min(form.evaluations), form.quick_runs.min(form.runs)),
        false => (form.evaluations, form.runs),
    };
    let bare = Construct::new(workspace.workspace.units, Vec::new());
    let mut plan = Plan {
        form,
        workspace,
        schema,
        builder,
        filter,
        bare,
        values,
        axes,
        domain,
        population,
        evaluations,
        runs,
        sources: Sources::default(),
        sets: sets.to_vec(),
        quick,
    };
    if files.desk.problems.is_empty() {
        tried(&mut plan, &tree, files);
    }
    Some(plan)
}

/// What constructs are made by, in words and as it is, with the values of its parameters.
fn built(
    files: &mut Files<'_>,
    form: &Optimisation,
    name: &str,
    tree: &Node,
) -> Option<(String, Box<dyn Schema>, Vec<f64>)> {
    let grammar = match (&form.schema, &form.grammar) {
        (Some(schema), None) => {
            let of = schema_of(&schema.id, "schema.id", tree, &mut files.desk)?;
            let values = values_of(&*of, &schema.at, "schema.at", tree, &mut files.desk)?;
            return Some((format!("the schema `{}`", schema.id), of, values));
        }
        (None, Some(grammar)) => grammar,
        (None, None) => {
            let what = "it is not said what builds constructs";
            files.desk.problem(&tree.span, what, "`schema` or `grammar`", "");
            return None;
        }
        (Some(_), Some(_)) => {
            files.desk.problem(&tree.place("grammar"), "constructs are built by a schema or by a grammar", "one", "");
            return None;
        }
    };
    let text = match grammar.file() {
        Some(file) => {
            let (path, text) = files.loaded(name, file, &tree.place("grammar"))?;
            files.sources.add(&path, &text);
            Some(text)
        }
        None => None,
    };
    let grammar = grammar.found(text.as_deref(), "grammar", tree, &mut files.desk)?;
    let builder = format!("derivations of the grammar `{}`, by what they decide", grammar.name);
    let schema: Box<dyn Schema> = Box::new(Decided { grammar, decisions: form.decisions });
    let values = schema.card().parameters.iter().map(|parameter| parameter.default).collect();
    Some((builder, schema, values))
}

fn axes(files: &mut Files<'_>, form: &Optimisation, schema: &dyn Schema, tree: &Node) -> Option<Vec<SearchAxis>> {
    let all: Vec<(String, AxisForm)> = match form.grammar {
        Some(_) if form.axis.0.is_empty() => {
            let parameters = schema.card().parameters;
            parameters
                .iter()
                .map(|parameter| (parameter.name.to_string(), AxisForm { low: None, high: None }))
                .collect()
        }
        _ => form.axis.0.clone(),
    };
    let mut axes = Vec::new();
    for (name, written) in &all {
        let at = tree.place(&format!("axis.{name}"));
        let found = axis_of(schema, name, (written.low, written.high), &at, &mut files.desk);
        axes.extend(found.map(|(place, axis, unit)| SearchAxis {
            name: name.clone(),
            unit,
            place,
            whole: matches!(schema.card().parameters[place].domain, terrain::schema::Domain::Whole(..)),
            axis: axis.about((axis.low + axis.high) / 2.0),
        }));
    }
    if axes.is_empty() && files.desk.problems.is_empty() {
        files.desk.problem(&tree.place("axis"), "there is nothing to search over", "at least one [axis.NAME]", "");
    }
    (axes.len() == all.len() && !axes.is_empty()).then_some(axes)
}

/// What is wrong with methods that their forms do not tell.
fn methods(files: &mut Files<'_>, form: &Optimisation, axes: &[SearchAxis], tree: &Node) {
    let desk = &mut files.desk;
    if form.method.0.is_empty() {
        desk.problem(&tree.place("method"), "there is no method", "at least one [method.NAME]", "");
    }
    for (name, search) in &form.method.0 {
        match search {
            Search::Genetic(genetic) => genetic.check(&format!("method.{name}.genetic"), tree, desk),
            Search::MapElites(archive) => {
                let known: Vec<&str> =
                    KINDS.iter().map(|(kind, _)| *kind).chain(axes.iter().map(|axis| axis.name.as_str())).collect();
                for (kind, ends) in &archive.kind.0 {
                    let place = tree.place(&format!("method.{name}.map_elites.kind.{kind}"));
                    if !known.contains(&kind.as_str()) {
                        let help = nearest(kind, known.iter().copied());
                        let help = help.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
                        let what = format!("constructs have no `{kind}`");
                        desk.problem(&place, what, format!("one of {}", known.join(", ")), help);
                    } else if ends.low >= ends.high {
                        desk.problem(&place, "the archive has no width", "low below high", "");
                    }
                }
            }
            Search::Uniform(_) | Search::CmaEs(_) => {}
        }
    }
}

/// Points looked at for one that gives a construct.
const LOOKED_AT: usize = 1000;

/// Whether the searches can begin, and some point of the box gives a world in which the behaviour has a meaning.
fn tried(plan: &mut Plan, tree: &Node, files: &mut Files<'_>) {
    let desk = &mut files.desk;
    for (method, (name, _)) in plan.form.method.0.iter().enumerate() {
        if let Err(error) = Searcher::new(plan, method, 0) {
            desk.problem(&tree.place(&format!("method.{name}")), error.to_string(), "not possible", "");
            return;
        }
    }
    let points = search::genetic::Genetic::random(&plan.domain, LOOKED_AT, plan.form.seed);
    let mut last = String::new();
    let found = points.iter().map(|point| plan.construct(point));
    let found = found.map(|made| made.map_err(|error| last = error.to_string()).ok()).find_map(|made| made);
    let Some(construct) = found else {
        let what = format!("none of {LOOKED_AT} points gives a construct: {last}");
        desk.problem(&tree.place("axis"), what, "not possible", "");
        return;
    };
    plan.bare.markers.clone_from(&construct.markers);
    match plan.behaviour(&construct, true) {
        Err(wrong) => desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help),
        Ok(behaviour) => {
            let geometry = plan.workspace.workspace.geometry.iter();
            let scenario = plan.population.among(geometry);
            // stopped at once: that it can begin is what is asked
            if let Err(what) =
                trial::run(&scenario, &plan.population, &[behaviour], plan.form.seed, &|| true, &mut |_| ())
            {
                desk.problem(&tree.place("scenario"), format!("the group cannot begin: {what}"), "not possible", "");
            }
        }
    }
    claims::check(&plan.form.claim, &Results::example(plan), "claim", tree, desk);
}
