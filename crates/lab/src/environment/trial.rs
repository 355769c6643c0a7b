//! One trial: a group in an environment with one seed, stepped until nothing that is asked can change any more.

use crate::file::write::toml;
use crate::file::{Form, Named, Node, Tree};
use crate::form;
use crate::scenario::build::{self, Wrong};
use crate::scenario::surroundings::{Ball, Obstacle, ObstacleShape, Segment};
use crate::scenario::{Precision, Scenario};
use crate::study::plan::Files;
use measure::behaviours::{Behaviour, Moment, Score, Watch};
use space::Vector;
use space::shape::Shape;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;
use terrain::{Geometry, Point};

/// Steps between two questions whether to stop.
const ASKED: u64 = 64;

form! {
    /// A group that is tried: values put over the scenario.
    pub struct PopulationForm {
        /// What it is.
        about: String = [""], "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: crate::file::Anything = [crate::study::form::empty()], "", Any;
    }
}

/// A group that is tried: a scenario in which no environment stands yet.
#[derive(Clone, Debug)]
pub struct Population {
    /// Its name.
    pub name: String,
    /// What it is.
    pub about: String,
    /// Its scenario as a tree, for files that are made of it.
    pub tree: Node,
    /// Its scenario.
    pub scenario: Scenario,
    /// The type of each member: the place of its group in the scenario.
    pub types: Vec<usize>,
    /// Names of the groups.
    pub groups: Vec<String>,
    /// Steps of a trial.
    pub steps: u64,
}

impl Population {
    /// The population of a scenario.
    ///
    /// # Errors
    /// A scenario that is not in the plane, has other units than the workspace, or times that are no whole steps; by path.
    pub fn new(name: &str, about: &str, tree: Node, scenario: Scenario, units: terrain::Units) -> Result<Self, Wrong> {
        if scenario.space.dimensions != 2 {
            return Err(Wrong::new("space.dimensions", "environments are in the plane", "2"));
        }
        let metres = units == terrain::Units::Metres;
        if (scenario.units.length == "m") != metres {
            let (here, there) = if metres { ("metres", "\"m\"") } else { ("field units", "\"unit\"") };
            let what =
                format!("the workspace is in {here}, and the scenario's lengths are in \"{}\"", scenario.units.length);
            return Err(Wrong::new("units.length", what, there).help("nothing is converted: both must be the same"));
        }
        let steps = build::schedule(&scenario, false)?.steps;
        let groups: Vec<String> = scenario.group.0.iter().map(|(name, _)| name.clone()).collect();
        let counted = scenario.group.0.iter().enumerate();
        let types = counted.flat_map(|(kind, (_, group))| std::iter::repeat_n(kind, group.count)).collect();
        Ok(Self { name: name.to_owned(), about: about.to_owned(), tree, scenario, types, groups, steps })
    }
    /// Its members.
    pub fn members(&self) -> usize {
        self.types.len()
    }
    /// The scenario with an environment in it.
    pub fn among<'a>(&self, geometry: impl IntoIterator<Item = &'a Geometry>) -> Scenario {
        let mut scenario = self.scenario.clone();
        scenario.obstacle.extend(obstacles(geometry));
        scenario
    }
}

/// Geometry as the obstacles of a scenario. Walls without length are in nobody's way and are left out.
pub fn obstacles<'a>(geometry: impl IntoIterator<Item = &'a Geometry>) -> Vec<Obstacle> {
    let obstacle =
        |shape| Obstacle { shape, appears: None, disappears: None, path: Vec::new(), albedo: 0.2, opaque: true };
    let written = |shape: Shape<f64, 2>| match shape {
        Shape::Segment { from, to } if from == to => None,
        Shape::Segment { from, to } => {
            Some(ObstacleShape::Segment(Segment { from: from.0.to_vec(), to: to.0.to_vec() }))
        }
        Shape::Ball { centre, radius } => Some(ObstacleShape::Ball(Ball { centre: centre.0.to_vec(), radius })),
        Shape::Polygon { .. } | Shape::Cuboid { .. } | Shape::Plane { .. } => None,
    };
    // what is no possible obstacle has been refused where the environment was read
    let shapes = geometry.into_iter().flat_map(|geometry| geometry.shapes().unwrap_or_default());
    shapes.filter_map(written).map(obstacle).collect()
}

/// The scenario file of a trial among this geometry: run with its seed it is that trial, bit by bit.
pub fn file<'a>(
    population: &Population,
    geometry: impl IntoIterator<Item = &'a Geometry>,
    seed: u64,
    title: &str,
) -> String {
    let mut tree = population.tree.clone();
    let span = tree.span.clone();
    let mut put = |key: &str, value: Tree| {
        // a table takes any key
        let _ = tree.set(key, Node { tree: value, span: span.clone() });
    };
    put("title", title.into());
    put("seed", seed.write());
    let mut all = population.scenario.obstacle.clone();
    all.extend(obstacles(geometry));
    put("obstacle", all.write());
    toml(&tree)
}

/// What came of a behaviour in a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Its fitness, 0 to 1.
    pub fitness: f64,
    /// The number behind it: the signal at the end; of a condition, the step at which it first held. Not a number where
    /// there is none.
    pub value: f64,
}

/// What came of a trial.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Steps made.
    pub steps: u64,
    /// What came of each behaviour.
    pub outcomes: Vec<Outcome>,
}

/// Runs a trial; none where it was stopped. `see` is shown the positions of all members at every step, from the start on.
///
/// # Errors
/// What this seed makes impossible, in a sentence.
pub fn run(
    scenario: &Scenario,
    population: &Population,
    behaviours: &[Behaviour],
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&[Option<Point>]),
) -> Result<Option<Tried>, String> {
    let mut watches: Vec<Watch> = behaviours.iter().map(Behaviour::watch).collect();
    let mut judge = |moment: &Moment<'_>| {
        see(moment.positions);
        watches.iter_mut().filter(|watch| !watch.settled()).for_each(|watch| watch.step(moment));
        watches.iter().all(Watch::settled)
    };
    let steps = follow(scenario, population, seed, stop, &mut judge)?;
    Ok(steps.map(|steps| {
        let outcomes = watches.iter().zip(behaviours).map(|(watch, behaviour)| outcome(watch, behaviour)).collect();
        Tried { steps, outcomes }
    }))
}

/// Runs a trial whose every moment is shown to `see`, until it says that it has seen enough or the time is over; the steps made,
/// none where it was stopped.
///
/// # Errors
/// What this seed makes impossible, in a sentence.
pub fn follow(
    scenario: &Scenario,
    population: &Population,
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&Moment<'_>) -> bool,
) -> Result<Option<u64>, String> {
    match scenario.precision {
        Precision::Single => followed::<f32>(scenario, population, seed, stop, see),
        Precision::Double => followed::<f64>(scenario, population, seed, stop, see),
    }
}

fn followed<R: Scalar>(
    scenario: &Scenario,
    population: &Population,
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&Moment<'_>) -> bool,
) -> Result<Option<u64>, String>
where
    Models: Catalogue<R, 2>,
{
    let mut world = build::world::<R, 2>(scenario, seed, 1)?;
    let members = population.members();
    let (mut positions, mut velocities) = (vec![None; members], vec![None; members]);
    loop {
        let frame = world.frame();
        let wide = |v: Vector<R, 2>| Some(Vector(v.0.map(R::to_f64))).filter(|v: &Point| v.finite());
        for row in 0..members {
            let lives = world.mortality().is_none_or(|column| frame.columns.state[column][row] > R::ZERO);
            let id = frame.columns.id[row] as usize;
            positions[id] = wide(frame.columns.position(row)).filter(|_| lives);
            velocities[id] = wide(frame.columns.velocity(row)).filter(|_| lives);
        }
        let moment = Moment { positions: &positions, velocities: &velocities, types: &population.types };
        let enough = see(&moment);
        let step = world.step_number();
        if step == population.steps || enough {
            return Ok(Some(step));
        }
        if step.is_multiple_of(ASKED) && stop() {
            return Ok(None);
        }
        world.step();
    }
}

fn outcome(watch: &Watch, behaviour: &Behaviour) -> Outcome {
    let explained = watch.explain();
    let root = explained.first();
    let value = match &behaviour.score {
        Score::Binary(_) => root.and_then(|root| root.first).map(|step| step as f64),
        _ => root.and_then(|root| root.value),
    };
    Outcome { fitness: watch.fitness(), value: value.unwrap_or(f64::NAN) }
}

/// The populations of a file: its scenario, with the values of each put over it. Without any there is one, called `group`.
/// What is wrong goes to the desk.
pub(crate) fn populations(
    base: &Node,
    given: &Named<PopulationForm>,
    units: terrain::Units,
    files: &mut Files<'_>,
) -> Option<Vec<Population>> {
    let alone = PopulationForm { about: String::new(), set: crate::study::form::empty() };
    let alone = Named(vec![("group".to_owned(), alone)]);
    let given = if given.0.is_empty() { &alone } else { given };
    let before = files.desk.problems.len();
    let mut populations = Vec::new();
    for (name, form) in &given.0 {
        let mut tree = base.clone();
        files.put(&mut tree, &form.set.0)?;
        let Some(scenario) = build::resolved(&tree, &mut files.desk) else { continue };
        match Population::new(name, &form.about, tree.clone(), scenario, units) {
            Ok(population) => populations.push(population),
            Err(wrong) => files.desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help),
        }
    }
    (files.desk.problems.len() == before).then_some(populations)
}
