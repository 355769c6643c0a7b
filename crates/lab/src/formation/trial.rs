//! One trial: targets on their way, walls that come and go, and shepherds that are told where to be.

use super::controllers::{By, Scene};
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
    let task = arena.task;
    let mut scenario = arena.scenario.clone();
    let first_wall = scenario.obstacle.len();
    let mut controller = arena.by.controller(task, &arena.walls, arena.timed);
    let members: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
    let mut progress = Progress::new(task, members);
    // bodies are known once the world is; until then the model's own radius does
    let radius = scenario.group.0.first().and_then(|(_, group)| group.physics.as_ref()?.radius);
    let radius = radius.unwrap_or(arena.shepherds.radius);
    let radii = (radius, arena.shepherds.radius);
    let begin = Scene { task, progress: &progress, targets: &[], robots: &[], radii, bounds: arena.bounds, time: 0.0 };
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
    let mut world = build::world::<R, 2>(&scenario, seed, 1)?;
    let radii = (world.groups().first().map_or(radius, |group| group.radius().to_f64()), radii.1);
    let errors = space::random::child_seed(seed, ERRORS, 0, 0);
    let mut fleet = Fleet::new(arena.shepherds, &places, task.way(0), errors);
    let mut watch = if arena.parts.is_none() { Some(watch(arena)?) } else { None };
    let parts = arena.parts.unwrap_or(task.legs());
    let mut targets: Vec<Point> = vec![Vector::ZERO; members];
    let (mut standing, mut put) = (vec![true; arena.walls.len()], Vec::new());
    let (mut dispersion, mut held, mut last) = (0.0, 0u64, f64::NAN);
    let wide = |v: Vector<R, 2>| Vector(v.0.map(R::to_f64));
    let narrow = |v: Point| Vector(v.0.map(R::of));
    loop {
        let frame = world.frame();
        for row in 0..members {
            let at = wide(frame.columns.position(row));
            if at.finite() {
                targets[frame.columns.id[row] as usize] = at;
            }
        }
        let (step, time) = (world.step_number(), world.time());
        progress.step(&targets);
        if let Some(watch) = &mut watch {
            let positions: Vec<Option<Point>> = targets.iter().copied().map(Some).collect();
            watch.step(&Moment { positions: &positions, velocities: &[], types: &[] });
        }
        let robots = fleet.places();
        let scene =
            Scene { task, progress: &progress, targets: &targets, robots: &robots, radii, bounds: arena.bounds, time };
        let middle = super::controllers::Flock::of(&targets).centre;
        dispersion += targets.iter().map(|&target| (target - middle).length()).sum::<f64>() / members.max(1) as f64;
        held += u64::from(
            robots.len() > 2 && {
                let hull = hull(&robots);
                targets.iter().all(|&target| within(&hull, target))
            },
        );
        if progress.share(parts) >= 1.0 && last.is_nan() {
            last = time;
        }
        // where nobody decides, nothing is asked
        let goals =
            if robots.is_empty() || fleet.due(time, arena.step) { controller.goals(&scene) } else { Vec::new() };
        put.clear();
        for (wall, stands) in standing.iter_mut().enumerate() {
            *stands = controller.stands(wall);
            put.push((first_wall + wall, stands.then_some(narrow(-drawn[wall]))));
        }
        see(Shown { time, targets: &targets, robots: &robots, standing: &standing, target_radius: radii.0 });
        if step == arena.steps || progress.share(parts) >= 1.0 {
            let steps = step + 1;
            return Ok(Some(Tried {
                steps: step,
                fitness: watch.as_ref().map_or_else(|| progress.share(parts), Watch::fitness),
                time: last,
                path_length: fleet.driven,
                dispersion: dispersion / steps as f64,
                held: if robots.len() > 2 { held as f64 / steps as f64 } else { f64::NAN },
                robots: robots.len() as f64,
                bumps: fleet.bumps as f64,
            }));
        }
        if step.is_multiple_of(ASKED) && stop() {
            return Ok(None);
        }
        if !robots.is_empty() {
            let around = Around { targets: &targets, target_radius: radii.0, bounds: arena.bounds };
            fleet.step(&goals, around, time, arena.step);
        }
        put.extend(fleet.places().iter().enumerate().map(|(k, &at)| (first_robot + k, Some(narrow(at - outside)))));
        world.put_obstacles(&put);
        world.step();
    }
}

/// Why an arena cannot be, if it cannot.
///
/// # Errors
/// What stands in the way, by path.
pub fn possible(arena: &Arena<'_>, seed: u64) -> Result<(), Wrong> {
    run(arena, seed, &|| true, &mut |_| ()).map(|_| ()).map_err(|what| Wrong::new("", what, "not possible"))
}
