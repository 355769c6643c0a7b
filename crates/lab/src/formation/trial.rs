//! One trial: targets on their way, walls that come and go, and shepherds that are told where to be. Each moment is decided on, and then
//! gone on from: by [`run`] to the end, and step by step where somebody looks on ([`Underway`]).

use super::controllers::{By, Controller, Flock, Scene};
use super::form::Shepherds;
use super::robot::{Around, Fleet};
use super::task::{Progress, Task, Wall};
use crate::scenario::build::{self, Wrong};
use crate::scenario::start::{About, BallRegion, Heading, Place, Start};
use crate::scenario::surroundings::{Ball, Obstacle, ObstacleShape};
use crate::scenario::{Precision, Scenario};
use measure::behaviours::{Moment, Setting, Watch, find};
use space::Vector;
use space::shape::Shape;
use swarm::World;
use swarm::engine::Explanation;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;
use terrain::{Geometry, Point, hull, within};

/// Steps between two questions whether to stop.
const ASKED: u64 = 64;
/// How far outside of everything shepherds are drawn before they are put to their places.
const OUTSIDE: f64 = 5.0;
/// Kind of child seeds: errors of the shepherds.
const ERRORS: u32 = 10;

/// What a trial is of.
#[derive(Clone, Debug)]
pub struct Arena<'a> {
    /// The targets among what is there already, at the start of the task.
    pub scenario: Scenario,
    /// The task.
    pub task: &'a Task,
    /// The walls of the task as they stand, in the order in which the path comes by.
    pub walls: Vec<Wall>,
    /// What brings the targets along.
    pub by: &'a By,
    /// Whether walls are there only while they are needed.
    pub timed: bool,
    /// The shepherds' bodies.
    pub shepherds: &'a Shepherds,
    /// The box in which shepherds stay.
    pub bounds: Option<(Point, Point)>,
    /// Steps, at most.
    pub steps: u64,
    /// Time of a step.
    pub step: f64,
    /// Parts of the task after which the trial ends; left out, all, and fitness is watched.
    pub parts: Option<usize>,
}

/// What came of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tried {
    /// Steps made.
    pub steps: u64,
    /// Share of the targets that passed all gates in order and reached the goal (of the parts asked for, where fewer are).
    pub fitness: f64,
    /// Time at which the last target arrived; not a number where not all did.
    pub time: f64,
    /// Way of all shepherds together.
    pub path_length: f64,
    /// Mean over time of the mean distance of targets from their middle.
    pub dispersion: f64,
    /// Share of the time in which all targets were inside the hull of the shepherds; not a number with fewer than three.
    pub held: f64,
    /// Number of shepherds.
    pub robots: f64,
    /// Moves of shepherds that somebody was in the way of.
    pub bumps: f64,
}

impl Tried {
    /// Of a trial that was impossible.
    pub const NONE: Self = Self {
        steps: 0,
        fitness: f64::NAN,
        time: f64::NAN,
        path_length: f64::NAN,
        dispersion: f64::NAN,
        held: f64::NAN,
        robots: f64::NAN,
        bumps: f64::NAN,
    };
}

/// A moment as it is shown to who looks on.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// Time.
    pub time: f64,
    /// The targets.
    pub targets: &'a [Point],
    /// The shepherds.
    pub robots: &'a [Point],
    /// Whether each wall is there.
    pub standing: &'a [bool],
    /// Radius of a target's body.
    pub target_radius: f64,
}

/// A scenario whose groups start where a task says.
pub fn at_start(scenario: &Scenario, task: &Task, deviation: f64) -> Scenario {
    let mut scenario = scenario.clone();
    for (_, group) in &mut scenario.group.0 {
        let before = group.start.take().unwrap_or_default();
        let place = Place::Ball(BallRegion { centre: task.path[0].0.to_vec(), radius: task.start_radius });
        let heading = Heading::About(About { direction: task.way(0).0.to_vec(), deviation });
        group.start = Some(Start { place, heading, jitter: 0.0, velocities: None, ..before });
    }
    scenario
}

/// A trial that is under way, in either precision.
pub trait Underway: Send {
    /// The moment; which walls stand is of the decision before.
    fn shown(&self) -> Shown<'_>;
    /// Number of the step that begins now.
    fn step(&self) -> u64;
    /// Share of the targets that have done all parts of the task.
    fn arrived(&self) -> f64;
    /// Mean distance of the targets from their middle.
    fn spread(&self) -> f64;
    /// Directions in which targets go and shepherds face, the targets first; zero at rest.
    fn ways(&self) -> Vec<Point>;
    /// The posts at which robots come to stand.
    fn posts(&self) -> Vec<Point>;
    /// Decides, and goes on by a step. Whether it did: not at the end.
    fn go_on(&mut self) -> bool;
    /// Lets a formation go on to its next walls in the step that begins now. All times at which it is told to, past and to come; none
    /// where what brings the targets along is no formation.
    fn switch(&mut self) -> Option<Vec<f64>>;
    /// What moves a target in the step that begins now, with the shepherds as they stand.
    fn explain(&mut self, target: u32) -> Option<Explanation>;
}

/// A trial at its start, to be gone on with.
///
/// # Errors
/// What this seed makes impossible, in a sentence.
pub fn begun(arena: &Arena<'_>, seed: u64) -> Result<Box<dyn Underway>, String> {
    Ok(match arena.scenario.precision {
        Precision::Single => Box::new(Trial::<f32>::new(arena, seed)?),
        Precision::Double => Box::new(Trial::<f64>::new(arena, seed)?),
    })
}

/// Runs a trial; none where it was stopped. `see` is shown every moment.
///
/// # Errors
/// What this seed makes impossible, in a sentence.
pub fn run(
    arena: &Arena<'_>,
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(Shown<'_>),
) -> Result<Option<Tried>, String> {
    match arena.scenario.precision {
        Precision::Single => tried::<f32>(arena, seed, stop, see),
        Precision::Double => tried::<f64>(arena, seed, stop, see),
    }
}

fn obstacle(shape: ObstacleShape) -> Obstacle {
    Obstacle { shape, appears: None, disappears: None, path: Vec::new(), albedo: 0.2, opaque: true }
}

/// The fitness of the listed behaviour `trajectory`.
fn watch(arena: &Arena<'_>) -> Result<Watch, String> {
    let goal = Shape::Ball { centre: arena.task.goal(), radius: arena.task.goal_radius };
    let setting = Setting {
        walls: Vec::new(),
        places: Vec::new(),
        regions: vec![("goal".into(), goal)],
        gates: arena.task.gates().into_iter().map(|gate| (String::new(), gate)).collect(),
        paths: Vec::new(),
    };
    let behaviour = find("trajectory", &[("horizon", arena.steps as f64 + 1.0)], &setting);
    behaviour.map(|behaviour| behaviour.watch()).map_err(|error| error.to_string())
}

fn tried<R: Scalar>(
    arena: &Arena<'_>,
    seed: u64,
    stop: &dyn Fn() -> bool,
    see: &mut dyn FnMut(Shown<'_>),
) -> Result<Option<Tried>, String>
where
    Models: Catalogue<R, 2>,
{
    let mut trial = Trial::<R>::new(arena, seed)?;
    loop {
        trial.decide();
        see(trial.shown());
        if let Some(tried) = trial.tried() {
            return Ok(Some(tried));
        }
        if trial.step().is_multiple_of(ASKED) && stop() {
            return Ok(None);
        }
        trial.perform();
    }
}

/// A trial at a moment.
struct Trial<R: Scalar> {
    task: Task,
    bounds: Option<(Point, Point)>,
    tick: f64,
    steps: u64,
    parts: usize,
    world: World<R, 2>,
    controller: Box<dyn Controller>,
    fleet: Fleet,
    progress: Progress,
    watch: Option<Watch>,
    /// Radius of a target's body, and of a shepherd's.
    radii: (f64, f64),
    /// Places of the task's walls, and of the shepherds, among the obstacles.
    first: (usize, usize),
    /// Where walls and shepherds are drawn, from where they are moved to their places.
    drawn: (Vec<Point>, Point),
    targets: Vec<Point>,
    robots: Vec<Point>,
    standing: Vec<bool>,
    goals: Vec<Point>,
    dispersion: f64,
    held: u64,
    last: f64,
}

impl<R: Scalar> Trial<R>
where
    Models: Catalogue<R, 2>,
{
    fn new(arena: &Arena<'_>, seed: u64) -> Result<Self, String> {
        let task = arena.task;
        let mut scenario = arena.scenario.clone();
        let first_wall = scenario.obstacle.len();
        let mut controller = arena.by.controller(task, &arena.walls, arena.timed);
        let members: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
        let progress = Progress::new(task, members);
        // bodies are known once the world is; until then the model's own radius does
        let radius = scenario.group.0.first().and_then(|(_, group)| group.physics.as_ref()?.radius);
        let radius = radius.unwrap_or(arena.shepherds.radius);
        let radii = (radius, arena.shepherds.radius);
        let begin =
            Scene { task, progress: &progress, targets: &[], robots: &[], radii, bounds: arena.bounds, time: 0.0 };
        let places = controller.begin(&begin);
        let mut outside = arena.bounds.map_or(Vector::ZERO, |bounds| bounds.1);
        outside += Vector([OUTSIDE; 2]);
        // walls that do not stand yet are in nobody's way at the start
        let away = |wall: usize| if controller.stands(wall) { Vector::ZERO } else { outside };
        let drawn: Vec<Point> = (0..arena.walls.len()).map(away).collect();
        let walls: Vec<Geometry> = arena
            .walls
            .iter()
            .zip(&drawn)
            .map(|(wall, away)| Geometry::wall(wall.at.from + *away, wall.at.to + *away))
            .collect();
        scenario.obstacle.extend(crate::environment::trial::obstacles(&walls));
        let first_robot = scenario.obstacle.len();
        for _ in &places {
            let ball = Ball { centre: outside.0.to_vec(), radius: arena.shepherds.radius };
            scenario.obstacle.push(obstacle(ObstacleShape::Ball(ball)));
        }
        let world = build::world::<R, 2>(&scenario, seed, 1)?;
        let radii = (world.groups().first().map_or(radius, |group| group.radius().to_f64()), radii.1);
        let errors = space::random::child_seed(seed, ERRORS, 0, 0);
        let mut trial = Self {
            task: task.clone(),
            bounds: arena.bounds,
            tick: arena.step,
            steps: arena.steps,
            parts: arena.parts.unwrap_or(task.legs()),
            world,
            fleet: Fleet::new(arena.shepherds, &places, task.way(0), errors),
            progress,
            watch: if arena.parts.is_none() { Some(watch(arena)?) } else { None },
            radii,
            first: (first_wall, first_robot),
            targets: vec![Vector::ZERO; members],
            robots: Vec::new(),
            standing: (0..drawn.len()).map(|wall| controller.stands(wall)).collect(),
            drawn: (drawn, outside),
            controller,
            goals: Vec::new(),
            dispersion: 0.0,
            held: 0,
            last: f64::NAN,
        };
        trial.observe();
        Ok(trial)
    }
    /// Takes in the moment.
    fn observe(&mut self) {
        let frame = self.world.frame();
        for row in 0..self.targets.len() {
            let at = Vector(frame.columns.position(row).0.map(R::to_f64));
            if at.finite() {
                self.targets[frame.columns.id[row] as usize] = at;
            }
        }
        let targets = &self.targets;
        self.progress.step(targets);
        if let Some(watch) = &mut self.watch {
            let positions: Vec<Option<Point>> = targets.iter().copied().map(Some).collect();
            watch.step(&Moment { positions: &positions, velocities: &[], types: &[] });
        }
        self.robots = self.fleet.places();
        self.dispersion += self.spread();
        self.held += u64::from(
            self.robots.len() > 2 && {
                let hull = hull(&self.robots);
                self.targets.iter().all(|&target| within(&hull, target))
            },
        );
        if self.progress.share(self.parts) >= 1.0 && self.last.is_nan() {
            self.last = self.world.time();
        }
    }
    /// Lets the controller decide where shepherds are wanted, and which walls stand.
    fn decide(&mut self) {
        let time = self.world.time();
        let Self { task, progress, targets, robots, radii, bounds, .. } = self;
        let scene = Scene { task, progress, targets, robots, radii: *radii, bounds: *bounds, time };
        // where nobody decides, nothing is asked
        let asked = robots.is_empty() || self.fleet.due(time, self.tick);
        self.goals = if asked { self.controller.goals(&scene) } else { Vec::new() };
        for (wall, stands) in self.standing.iter_mut().enumerate() {
            *stands = self.controller.stands(wall);
        }
    }
    /// What came of it, where this moment is the last.
    fn tried(&self) -> Option<Tried> {
        let step = self.world.step_number();
        if step < self.steps && self.progress.share(self.parts) < 1.0 {
            return None;
        }
        let (steps, robots) = (step + 1, self.robots.len());
        Some(Tried {
            steps: step,
            fitness: self.watch.as_ref().map_or_else(|| self.progress.share(self.parts), Watch::fitness),
            time: self.last,
            path_length: self.fleet.driven,
            dispersion: self.dispersion / steps as f64,
            held: if robots > 2 { self.held as f64 / steps as f64 } else { f64::NAN },
            robots: robots as f64,
            bumps: self.fleet.bumps as f64,
        })
    }
    /// Moves everybody as it was decided, and takes in the next moment.
    fn perform(&mut self) {
        let narrow = |v: Point| Vector(v.0.map(R::of));
        let (drawn, outside) = &self.drawn;
        let walls = self.standing.iter().zip(drawn).enumerate();
        let mut put: Vec<(usize, Option<Vector<R, 2>>)> =
            walls.map(|(wall, (stands, drawn))| (self.first.0 + wall, stands.then_some(narrow(-*drawn)))).collect();
        if !self.robots.is_empty() {
            let around = Around { targets: &self.targets, target_radius: self.radii.0, bounds: self.bounds };
            self.fleet.step(&self.goals, around, self.world.time(), self.tick);
        }
        let places = self.fleet.places();
        put.extend(places.iter().enumerate().map(|(k, &at)| (self.first.1 + k, Some(narrow(at - *outside)))));
        self.world.put_obstacles(&put);
        self.world.step();
        self.observe();
    }
}

impl<R: Scalar + Send> Underway for Trial<R>
where
    Models: Catalogue<R, 2>,
{
    fn shown(&self) -> Shown<'_> {
        Shown {
            time: self.world.time(),
            targets: &self.targets,
            robots: &self.robots,
            standing: &self.standing,
            target_radius: self.radii.0,
        }
    }
    fn step(&self) -> u64 {
        self.world.step_number()
    }
    fn arrived(&self) -> f64 {
        self.progress.share(self.parts)
    }
    fn spread(&self) -> f64 {
        let middle = Flock::of(&self.targets).centre;
        let apart: f64 = self.targets.iter().map(|&target| (target - middle).length()).sum();
        apart / self.targets.len().max(1) as f64
    }
    fn ways(&self) -> Vec<Point> {
        let frame = self.world.frame();
        let mut ways = vec![Vector::ZERO; self.targets.len()];
        for row in 0..ways.len() {
            ways[frame.columns.id[row] as usize] = Vector(frame.columns.velocity(row).unit().0.map(R::to_f64));
        }
        ways.extend(self.fleet.faces());
        ways
    }
    fn posts(&self) -> Vec<Point> {
        self.controller.posts()
    }
    fn go_on(&mut self) -> bool {
        if self.tried().is_some() {
            return false;
        }
        self.decide();
        self.perform();
        true
    }
    fn switch(&mut self) -> Option<Vec<f64>> {
        self.controller.switch_at(self.world.time())
    }
    fn explain(&mut self, target: u32) -> Option<Explanation> {
        self.world.explain(target)
    }
}

/// Why an arena cannot be, if it cannot.
///
/// # Errors
/// What stands in the way, by path.
pub fn possible(arena: &Arena<'_>, seed: u64) -> Result<(), Wrong> {
    run(arena, seed, &|| true, &mut |_| ()).map(|_| ()).map_err(|what| Wrong::new("", what, "not possible"))
}
