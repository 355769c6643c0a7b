//! A robot's eyes: a scanner, the detection behind it, and the association of detections over time.

use crate::detection::association::Tracks;
use crate::detection::readings::{ErrorCount, InjectedErrors, ReadingDetection, Readings};
use crate::motion::NearObstacle;
use crate::parameters::Scalar;
use crate::sensing::scanner::{Body, Scan, Scanner, Surface};
use space::obstacles::Obstacles;
use space::random::Stream as DrawStream;
use space::{Edge, Real, Space, Vector};

/// Margin of the count of errors: a detection within body radius + 0.1 m of a member belongs to it.
const MATCH_MARGIN: f64 = 0.1;

/// Sensing by scanner with the detection that follows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot<R> {
    /// The range-finder.
    pub scanner: Scanner<R>,
    /// How members are found among the readings.
    pub detection: ReadingDetection<R>,
    /// Largest distance between two sights of the same member; `None`: velocities of others stay unknown. A member that is seen
    /// for the first time is taken to move as the agent itself does.
    pub association: Option<R>,
    /// Errors put in on purpose.
    pub errors: Option<InjectedErrors<R>>,
    /// Largest body radius among those that may be seen.
    pub widest_body: R,
}

impl<R: Scalar> Robot<R> {
    /// How far the scanner reports.
    pub fn scanner_range(&self) -> R {
        self.scanner.longest_range
    }

    /// One scan and what is made of it: fills `scratch.found` and the obstacle points.
    ///
    /// Whose velocity is not known yet is taken to move as the agent itself does (`moving`): then it neither slows the agent
    /// down nor turns it.
    pub(crate) fn detect<const D: usize>(
        &self,
        obstacles: &Obstacles<R, D>,
        space: &Space<R, D>,
        place: Vector<R, D>,
        moving: Vector<R, D>,
        facing: R,
        draws: &DrawStream,
        time: f64,
        scratch: &mut RobotScratch<R>,
        memory: Option<&mut Memory<R>>,
    ) {
        let wide = |v: Vector<R, 2>| Vector::<R, D>(core::array::from_fn(|a| if a < 2 { v.0[a] } else { R::ZERO }));
        let flat = |v: Vector<R, D>| Vector::<R, 2>(core::array::from_fn(|a| if a < D { v.0[a] } else { R::ZERO }));
        let surface = |direction: Vector<R, 2>, limit: R| {
            let direction = wide(direction);
            let mut best: Option<Surface<R>> = obstacles.cast(place, direction, limit).map(|(hit, index)| Surface {
                distance: hit.distance,
                normal: flat(hit.normal),
                albedo: obstacles.list()[index as usize].albedo,
            });
            for a in 0..D {
                if let Edge::Walls(length) = space.edges[a] {
                    let towards = direction.0[a];
                    let room = if towards > R::ZERO { length - place.0[a] } else { -place.0[a] };
                    let distance = room / towards;
                    let nearest = best.as_ref().map_or(limit, |b| b.distance);
                    if towards != R::ZERO && distance >= R::ZERO && distance < nearest {
                        let mut normal = Vector::ZERO;
                        normal.0[a] = if towards > R::ZERO { -R::ONE } else { R::ONE };
                        best = Some(Surface { distance, normal: flat(normal), albedo: R::of(0.2) });
                    }
                }
            }
            best
        };
        let seen = !obstacles.is_empty() || space.has_walls();
        self.scanner.scan(facing, &scratch.bodies, surface, seen, draws, &mut scratch.scan);
        self.detection.detect(&self.scanner, &scratch.scan, &mut scratch.readings);
        if let Some(errors) = &self.errors {
            errors.apply(&self.scanner, &scratch.scan, draws, &mut scratch.readings.inputs);
        }
        let margin = R::of(MATCH_MARGIN);
        scratch.errors += scratch.readings.count_errors(&self.scanner, &scratch.scan, &scratch.bodies, margin);
        scratch.readings.find_walls(R::of(0.15), |range| {
            // readings stray by so much; what strays less is no corner
            let strays = self.scanner.noise.map_or(R::ZERO, |noise| noise.deviation(range));
            R::of(0.05).most(R::of(4.0) * strays)
        });
        scratch.found.clear();
        scratch
            .found
            .extend(scratch.readings.inputs.iter().map(|input| Found { offset: input.offset, velocity: Vector::ZERO }));
        if let (Some(_), Some(memory)) = (self.association, memory) {
            let here = flat(place);
            let elapsed = memory.time.map_or(R::ZERO, |before| R::of(time - before));
            // the shorter way, where a seam was crossed
            let own = flat(space.minimal(wide(here - memory.place)));
            memory.tracks.update(scratch.found.iter().map(|f| f.offset), own, elapsed);
            (memory.place, memory.time) = (here, Some(time));
            for (found, velocity) in scratch.found.iter_mut().zip(memory.tracks.velocities()) {
                found.velocity = velocity.unwrap_or(flat(moving));
            }
        }
    }
}

/// What an agent remembers of its last scan.
#[derive(Clone, Debug)]
pub(crate) struct Memory<R> {
    pub(crate) tracks: Tracks<R, 2>,
    pub(crate) place: Vector<R, 2>,
    pub(crate) time: Option<f64>,
}

impl<R: Scalar> Memory<R> {
    pub(crate) fn new(gate: R) -> Self {
        Self { tracks: Tracks::new(gate), place: Vector::ZERO, time: None }
    }
    pub(crate) fn save(&self, to: &mut Vec<f64>) {
        to.extend([self.place.0[0].to_f64(), self.place.0[1].to_f64()]);
        to.push(self.time.unwrap_or(f64::NAN));
        self.tracks.save(to);
    }
    /// Restores what [`Self::save`] wrote; the number of values used, or `None` where they are malformed.
    pub(crate) fn load(&mut self, from: &[f64]) -> Option<usize> {
        let [x, y, time, rest @ ..] = from else { return None };
        let used = self.tracks.load(rest)?;
        self.place = Vector::of(&[*x, *y]);
        self.time = (!time.is_nan()).then_some(*time);
        Some(used + 3)
    }
}

/// A member as detection hands it on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<R> {
    pub(crate) offset: Vector<R, 2>,
    pub(crate) velocity: Vector<R, 2>,
}

/// Buffers of a scan.
#[derive(Debug)]
pub(crate) struct RobotScratch<R> {
    pub(crate) bodies: Vec<Body<R>>,
    pub(crate) scan: Scan<R>,
    pub(crate) readings: Readings<R>,
    pub(crate) found: Vec<Found<R>>,
    pub(crate) errors: ErrorCount,
}

impl<R: Real> Default for RobotScratch<R> {
    fn default() -> Self {
        Self {
            bodies: Vec::new(),
            scan: Scan::default(),
            readings: Readings::default(),
            found: Vec::new(),
            errors: ErrorCount::default(),
        }
    }
}

impl<R: Scalar> RobotScratch<R> {
    /// A body among those the scan may meet.
    pub(crate) fn add_body<const D: usize>(&mut self, offset: Vector<R, D>, radius: R, member: u32) {
        let offset = Vector(core::array::from_fn(|a| if a < D { offset.0[a] } else { R::ZERO }));
        self.bodies.push(Body { offset, radius, albedo: R::of(Body::<f64>::WRAPPED), member });
    }
    /// What the last scan shows of obstacles within a reach: every place at which a connected outline comes nearest. So a disc, of which the
    /// pieces of the outline are many, is one obstacle, and a room has four walls.
    pub(crate) fn obstacles<const D: usize>(&self, reach: R) -> impl Iterator<Item = NearObstacle<R, D>> + '_ {
        let walls = &self.readings.walls;
        // where along a piece it is nearest, from 0 to 1
        let nearest = |(from, to): (Vector<R, 2>, Vector<R, 2>)| {
            let along = to - from;
            (-from.dot(along) / along.length_squared().most(R::TINY)).clamped(R::ZERO, R::ONE)
        };
        walls.iter().enumerate().filter_map(move |(k, &(from, to))| {
            let share = nearest((from, to));
            let before = k.checked_sub(1).map(|k| walls[k]).filter(|before| before.1 == from);
            let after = walls.get(k + 1).copied().filter(|after| after.0 == to);
            // at an end that two pieces share, it comes nearest if it does so for both; the second one tells of it
            let comes_nearer = match (before, after) {
                (Some(before), _) if share <= R::ZERO => nearest(before) < R::ONE,
                (_, Some(_)) if share >= R::ONE => true,
                _ => false,
            };
            let point = from + (to - from) * share;
            let distance = point.length();
            (!comes_nearer && distance < reach).then(|| {
                let wide = |v: Vector<R, 2>| Vector(core::array::from_fn(|a| if a < 2 { v.0[a] } else { R::ZERO }));
                NearObstacle { offset: wide(point), distance, away: wide(-point.unit()), radius: R::INFINITY }
            })
        })
    }
}
