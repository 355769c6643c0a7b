//! One trial: a group in an environment with one seed, stepped until nothing that is asked can change any more.

use super::doors::{Door, Guarded, Moved};
use super::relay::{Relay, State};
use crate::file::write::toml;
use crate::file::{Form, Named, Node, Tree};
use crate::form;
use crate::scenario::build::{self, Wrong};
use crate::scenario::start::{Place, Start};
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

    /// Radius of the widest body of a group; 0 where bodies are points.
    ///
    /// # Errors
    /// A scenario without a possible world, in a sentence.
    pub fn widest(&self) -> Result<f64, String> {
        let world = build::world::<f64, 2>(&self.scenario, self.scenario.seed.unwrap_or(0), 1)?;
        Ok(world.groups().iter().map(swarm::engine::Group::radius).fold(0.0, f64::max))
    }
    /// The group as it was at some moment of another trial: places and velocities, where everyone is there.
    pub fn from_state(&self, state: &State) -> Option<Self> {
        let mut population = self.clone();
        let mut first = 0;
        for (_, group) in &mut population.scenario.group.0 {
            let members = first..first + group.count;
            first = members.end;
            let places = state.positions.get(members.clone())?.iter().map(|place| Some((*place)?.0.to_vec()));
            let velocities = state.velocities.get(members)?.iter().map(|v| v.unwrap_or(Point::ZERO).0.to_vec());
            let place = Place::Points(places.collect::<Option<_>>()?);
            group.start = Some(Start { place, velocities: Some(velocities.collect()), ..Start::default() });
        }
        Some(population)
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

/// The scenario file of a trial among this geometry and doors at the times when they moved: run with its seed it is that trial, bit
/// by bit.
pub fn file<'a>(
    population: &Population,
    geometry: impl IntoIterator<Item = &'a Geometry>,
    doors: Vec<Obstacle>,
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
    all.extend(doors);
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

impl Outcome {
    /// Of a trial that was impossible.
    pub const NONE: Self = Self { fitness: f64::NAN, value: f64::NAN };
}

/// What came of a trial.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Steps made.
    pub steps: u64,
    /// What came of each behaviour.
    pub outcomes: Vec<Outcome>,
}

/// What is wanted in a trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wanted {
    /// Stage after stage. What comes of the stages, and of all together, stands before what comes of the behaviours.
    pub relay: Option<Relay>,
    /// From the start on.
    pub behaviours: Vec<Behaviour>,
    /// What opens and shuts meanwhile.
    pub doors: Vec<Door>,
}

/// A trial with what happened in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    /// What came of it.
    pub tried: Tried,
    /// Where the group was handed over, once for each stage that ended so.
    pub handed: Vec<State>,
    /// The doors that opened and shut, in order.
    pub moved: Vec<Moved>,
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
    let wanted = Wanted { behaviours: behaviours.to_vec(), ..Wanted::default() };
    Ok(relayed(scenario, population, &wanted, seed, stop, see)?.map(|told| told.tried))
}

/// Runs a trial in which stages may be wanted, and doors open and shut.
///
/// # Errors
/// As [`run`].
pub fn relayed(
    scenario: &Scenario,
    population: &Population,
    wanted: &Wanted,
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&[Option<Point>]),
) -> Result<Option<Told>, String> {
    let mut watches: Vec<Watch> = wanted.behaviours.iter().map(Behaviour::watch).collect();
    let mut following = wanted.relay.as_ref().map(Relay::follow);
    let mut judge = |moment: &Moment<'_>| {
        see(moment.positions);
        watches.iter_mut().filter(|watch| !watch.settled()).for_each(|watch| watch.step(moment));
        let mut settled = watches.iter().all(Watch::settled);
        if let Some(following) = &mut following {
            following.step(moment);
            settled &= following.settled();
        }
        settled
    };
    let Some((steps, moved)) = among_doors(scenario, population, &wanted.doors, seed, stop, &mut judge)? else {
        return Ok(None);
    };
    let mut outcomes = following.as_ref().map_or_else(Vec::new, |following| following.outcomes());
    outcomes.extend(watches.iter().zip(&wanted.behaviours).map(|(watch, behaviour)| outcome(watch, behaviour)));
    let handed = following.map_or_else(Vec::new, |following| following.handed);
    Ok(Some(Told { tried: Tried { steps, outcomes }, handed, moved }))
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
    Ok(among_doors(scenario, population, &[], seed, stop, see)?.map(|(steps, _)| steps))
}

/// [`follow`] among doors; with what these did.
fn among_doors(
    scenario: &Scenario,
    population: &Population,
    doors: &[Door],
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&Moment<'_>) -> bool,
) -> Result<Option<(u64, Vec<Moved>)>, String> {
    match scenario.precision {
        Precision::Single => followed::<f32>(scenario, population, doors, seed, stop, see),
        Precision::Double => followed::<f64>(scenario, population, doors, seed, stop, see),
    }
}

fn followed<R: Scalar>(
    scenario: &Scenario,
    population: &Population,
    doors: &[Door],
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(&Moment<'_>) -> bool,
) -> Result<Option<(u64, Vec<Moved>)>, String>
where
    Models: Catalogue<R, 2>,
{
    let (mut world, places) = with_doors::<R>(scenario, doors, seed)?;
    let mut guarded = Guarded::new(doors);
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
            return Ok(Some((step, guarded.moved)));
        }
        if step.is_multiple_of(ASKED) && stop() {
            return Ok(None);
        }
        let moved = guarded.step(&moment, world.time());
        if !moved.is_empty() {
            let put = |(door, shut): (usize, bool)| (places[door], shut.then_some(Vector::ZERO));
            world.put_obstacles(&moved.into_iter().map(put).collect::<Vec<_>>());
        }
        world.step();
    }
}

/// The world of a scenario with doors in it, and the place of each among the obstacles. Nobody begins in a door that is shut; one
/// that is open is not there for the start.
fn with_doors<R: Scalar>(
    scenario: &Scenario,
    doors: &[Door],
    seed: u64,
) -> Result<(swarm::World<R, 2>, Vec<usize>), String>
where
    Models: Catalogue<R, 2>,
{
    if doors.is_empty() {
        return Ok((build::world::<R, 2>(scenario, seed, 1)?, Vec::new()));
    }
    let mut with = scenario.clone();
    let mut open = Vec::new();
    let mut places = vec![0; doors.len()];
    for (k, door) in doors.iter().enumerate() {
        if door.begins_shut() {
            places[k] = with.obstacle.len();
            with.obstacle.extend(obstacles([&Geometry::Wall(door.wall)]));
        } else {
            open.push(k);
        }
    }
    let mut plan = build::planned::<R, 2>(&with, seed, 1)?;
    for &k in &open {
        let narrow = |p: Point| Vector(p.0.map(R::of));
        let wall = Shape::Segment { from: narrow(doors[k].wall.from), to: narrow(doors[k].wall.to) };
        places[k] = plan.obstacles.len();
        plan.obstacles.push(space::obstacles::Obstacle::new(wall));
    }
    let mut world = swarm::World::new(plan).map_err(|error| format!("with the seed {seed}: {error}"))?;
    world.put_obstacles(&open.iter().map(|&k| (places[k], None)).collect::<Vec<_>>());
    Ok((world, places))
}

pub(super) fn outcome(watch: &Watch, behaviour: &Behaviour) -> Outcome {
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
