//! Shepherds' bodies: how they get to where they are wanted without touching anybody, and how their wheels err.

use super::form::Shepherds;
use space::Vector;
use space::random::{Purpose, normal, uniform};
use swarm::motion::Motion;
use swarm::physics::{DifferentialDrive, Mobility};
use terrain::Point;
use terrain::posts::way_round;

/// Time ahead in which contacts are avoided.
const AHEAD: f64 = 1.5;
/// Gap kept between two shepherds.
const GAP: f64 = 0.05;
/// Directions that are looked at beside the wanted one.
const DIRECTIONS: usize = 16;
/// Errors of a drive: slip, bias, lost speed, least and greatest latency.
const SLIP: f64 = 0.03;
const BIAS: f64 = 0.02;
const LOST: f64 = 0.02;
const LATENCY: (f64, f64) = (0.05, 0.15);
/// Share by which a period of its own varies.
const JITTER: f64 = 0.05;

/// A shepherd.
#[derive(Clone, Debug)]
struct Robot {
    at: Point,
    velocity: Point,
    /// Direction it faces, and forward speed.
    body: [f64; 2],
    wanted: Point,
    /// What was decided, and when it takes effect.
    pending: Vec<(f64, Point)>,
    due: f64,
    decisions: u64,
    bias: f64,
}

/// All shepherds of a trial.
#[derive(Clone, Debug)]
pub struct Fleet {
    form: Shepherds,
    mobility: Mobility<f64>,
    seed: u64,
    robots: Vec<Robot>,
    /// Way driven so far by all.
    pub driven: f64,
    /// Moves that were not made since somebody was in the way.
    pub bumps: u64,
}

/// What shepherds must not touch.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    /// Where the targets are.
    pub targets: &'a [Point],
    /// Their body radius.
    pub target_radius: f64,
    /// The box in which to stay.
    pub bounds: Option<(Point, Point)>,
}

impl Fleet {
    /// Shepherds at rest at these places, facing `way`.
    pub fn new(form: &Shepherds, places: &[Point], way: Point, seed: u64) -> Self {
        let draw = |k: usize, slot: u32| uniform(seed, Purpose::Execution, 0, 8 * k as u32 + slot);
        let robot = |(k, &at): (usize, &Point)| Robot {
            at,
            velocity: Vector::ZERO,
            body: [way.angle(), 0.0],
            wanted: Vector::ZERO,
            pending: Vec::new(),
            due: if form.asynchronous { form.period * draw(k, 2) } else { 0.0 },
            decisions: 0,
            bias: if form.noise { BIAS * normal(draw(k, 0), draw(k, 1)) } else { 0.0 },
        };
        let mobility = match form.wheels {
            true => Mobility::DifferentialDrive(DifferentialDrive {
                forward_speed: form.speed,
                ..DifferentialDrive::default()
            }),
            false => Mobility::Ideal,
        };
        let robots = places.iter().enumerate().map(robot).collect();
        Self { form: form.clone(), mobility, seed, robots, driven: 0.0, bumps: 0 }
    }
    /// Where they are.
    pub fn places(&self) -> Vec<Point> {
        self.robots.iter().map(|robot| robot.at).collect()
    }
    /// Directions in which they face; of those that move freely, in which they go, zero at rest.
    pub fn faces(&self) -> Vec<Point> {
        let face = |robot: &Robot| match self.form.wheels {
            true => Vector::at_angle(robot.body[0]),
            false => robot.velocity.unit(),
        };
        self.robots.iter().map(face).collect()
    }
    /// Whether anybody decides in the tick that begins at a time.
    pub fn due(&self, time: f64, tick: f64) -> bool {
        self.robots.iter().any(|robot| robot.due <= time + 0.5 * tick)
    }
    /// Lets those whose time has come decide, given where each is wanted, and moves all by a tick.
    pub fn step(&mut self, goals: &[Point], around: Around<'_>, time: f64, tick: f64) {
        for k in 0..self.robots.len() {
            if self.robots[k].due > time + 0.5 * tick {
                continue;
            }
            let wanted = goals.get(k).map_or(Vector::ZERO, |&goal| self.decided(k, goal, around));
            let (seed, form) = (self.seed, &self.form);
            let robot = &mut self.robots[k];
            robot.decisions += 1;
            let draw = |slot: u32| uniform(seed, Purpose::Execution, robot.decisions, 8 * k as u32 + slot);
            let jitter = if form.asynchronous { JITTER * (2.0 * draw(2) - 1.0) } else { 0.0 };
            // a decision that is late for a long tick is not made up for
            robot.due = (robot.due + form.period * (1.0 + jitter)).max(time);
            let late = if form.noise { LATENCY.0 + (LATENCY.1 - LATENCY.0) * draw(3) } else { 0.0 };
            robot.pending.push((time + late, wanted));
        }
        for k in 0..self.robots.len() {
            self.moved(k, around, time, tick);
        }
    }
    /// The velocity that brings a shepherd to its goal: round the targets, and past the others.
    fn decided(&self, k: usize, goal: Point, around: Around<'_>) -> Point {
        let own = &self.robots[k];
        let clear = self.form.radius + around.target_radius + self.form.clearance;
        let next = way_round(own.at, goal, around.targets, clear).into_iter().next().unwrap_or(goal);
        let offset = next - own.at;
        // slower where it would go beyond within a period
        let last = next == goal;
        let speed =
            if last { self.form.speed.min(offset.length() / self.form.period.max(0.2)) } else { self.form.speed };
        let wanted = offset.unit() * speed;
        let others = self.robots.iter().enumerate().filter(|(other, _)| *other != k);
        let bodies: Vec<(Point, Point, f64)> = others
            .map(|(_, other)| (other.at - own.at, other.velocity, 2.0 * self.form.radius + GAP))
            .chain(around.targets.iter().map(|&target| {
                let touch = self.form.radius + around.target_radius;
                (target - own.at, Vector::ZERO, touch + GAP)
            }))
            .collect();
        let cost = |velocity: Point| {
            let soonest = bodies.iter().map(|&(offset, moving, reach)| contact(offset, velocity - moving, reach));
            let soonest = soonest.fold(f64::INFINITY, f64::min);
            let danger = if soonest < AHEAD { 2.0 * self.form.speed * (1.0 - soonest / AHEAD) } else { 0.0 };
            (velocity - wanted).length() + danger
        };
        let mut best = (cost(wanted), wanted);
        for direction in 0..DIRECTIONS {
            for share in [1.0, 0.4] {
                let angle = wanted.angle() + std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64;
                let velocity = Vector::at_angle(angle) * (self.form.speed * share);
                let found = cost(velocity);
                if found < best.0 {
                    best = (found, velocity);
                }
            }
        }
        let still = cost(Vector::ZERO);
        if still < best.0 { Vector::ZERO } else { best.1 }
    }
    /// Moves a shepherd by a tick; it stops before whatever it would touch.
    fn moved(&mut self, k: usize, around: Around<'_>, time: f64, tick: f64) {
        let Self { form, mobility, seed, robots, .. } = self;
        let robot = &mut robots[k];
        let now = robot.pending.iter().take_while(|(at, _)| *at <= time + 1e-9).count();
        if let Some((_, wanted)) = robot.pending.drain(..now).next_back() {
            robot.wanted = wanted;
        }
        let mut wanted = robot.wanted;
        if form.noise {
            let step = (time / tick).round() as u64;
            let draw = |slot: u32| uniform(*seed, Purpose::Execution, (1 << 40) + step, 8 * k as u32 + slot);
            let slip = SLIP * normal(draw(0), draw(1));
            wanted = wanted * (1.0 + robot.bias + slip);
            if wanted.length() < LOST {
                wanted = Vector::ZERO;
            }
        }
        let wanted = Motion { velocity: wanted, displacement: wanted * tick };
        let mut body = robot.body;
        let motion = mobility.perform(robot.velocity, wanted, tick, &mut body);
        let mut to = robot.at + motion.displacement;
        if let Some((low, high)) = around.bounds {
            for axis in 0..2 {
                to[axis] = to[axis].clamp(low[axis] + form.radius, high[axis] - form.radius);
            }
        }
        let from = robot.at;
        let nearer =
            |place: Point, reach: f64| (to - place).length() < reach && (to - place).length() < (from - place).length();
        let blocked = around.targets.iter().any(|&target| nearer(target, form.radius + around.target_radius))
            || robots.iter().enumerate().any(|(other, own)| other != k && nearer(own.at, 2.0 * form.radius));
        let robot = &mut self.robots[k];
        robot.body = body;
        if blocked {
            self.bumps += 1;
            robot.velocity = Vector::ZERO;
            // a bump stops the wheels, not the turn
            robot.body[1] = 0.0;
            return;
        }
        self.driven += (to - from).length();
        robot.at = to;
        robot.velocity = motion.velocity;
    }
}

/// Time until a body at `offset`, moving with `-velocity` against us, is nearer than `reach`; infinite where it never is, 0 where it
/// is so already and comes nearer.
fn contact(offset: Point, velocity: Point, reach: f64) -> f64 {
    let approach = offset.dot(velocity);
    if approach <= 0.0 {
        return f64::INFINITY;
    }
    let over = offset.length_squared() - reach * reach;
    if over <= 0.0 {
        return 0.0;
    }
    let squared = velocity.length_squared();
    let under = approach * approach - squared * over;
    if under < 0.0 { f64::INFINITY } else { (approach - under.sqrt()) / squared }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(targets: &[Point]) -> Around<'_> {
        Around { targets, target_radius: 0.17, bounds: Some((Vector([-5.0, -5.0]), Vector([5.0, 5.0]))) }
    }

    #[test]
    fn shepherds_pass_each_other_and_go_round_the_targets() {
        for wheels in [false, true] {
            let form = Shepherds { wheels, ..Shepherds::default() };
            let places = [Vector([-3.0, 0.0]), Vector([3.0, 0.0])];
            let targets = [Vector([0.0, 0.0]), Vector([0.0, 0.6])];
            let mut fleet = Fleet::new(&form, &places, Vector([1.0, 0.0]), 1);
            let goals = [Vector([3.0, 0.1]), Vector([-3.0, -0.1])];
            let mut nearest = f64::INFINITY;
            for tick in 0..4000 {
                fleet.step(&goals, around(&targets), f64::from(tick) * 0.01, 0.01);
                let now = fleet.places();
                nearest = nearest.min((now[0] - now[1]).length());
                for place in now {
                    assert!(targets.iter().all(|target| (*target - place).length() >= 0.34 - 1e-9));
                }
            }
            let there = fleet.places();
            assert!((0..2).all(|k| (there[k] - goals[k]).length() < 0.15), "{wheels}: {there:?}");
            assert!(nearest >= 0.34 - 1e-9 && fleet.driven > 12.0, "{nearest}");
        }
    }

    #[test]
    fn contacts_are_foreseen() {
        assert_eq!(contact(Vector([3.0, 0.0]), Vector([1.0, 0.0]), 1.0), 2.0);
        assert_eq!(contact(Vector([3.0, 0.0]), Vector([-1.0, 0.0]), 1.0), f64::INFINITY);
        assert_eq!(contact(Vector([3.0, 2.0]), Vector([1.0, 0.0]), 1.0), f64::INFINITY);
        assert_eq!(contact(Vector([0.5, 0.0]), Vector([1.0, 0.0]), 1.0), 0.0);
    }

    #[test]
    fn noise_is_of_its_seed() {
        let run = |noise: bool, seed: u64| {
            let form = Shepherds { noise, wheels: true, asynchronous: true, ..Shepherds::default() };
            let mut fleet = Fleet::new(&form, &[Vector([0.0, 0.0])], Vector([1.0, 0.0]), seed);
            for tick in 0..300 {
                fleet.step(&[Vector([3.0, 1.0])], around(&[]), f64::from(tick) * 0.01, 0.01);
            }
            fleet.places()[0]
        };
        assert_eq!(run(true, 1), run(true, 1));
        assert_ne!(run(true, 1), run(true, 2));
        assert_ne!(run(true, 1), run(false, 1));
    }
}
