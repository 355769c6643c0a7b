//! How a group begins.
//!
//! Every draw depends on the seed, on what it is for, and on an attempt number that never resets between bodies, so
//! that a start is the same on any machine: place by U(seed, init, attempt + 2^36 group, axis), heading by
//! U(seed, init, id, 4 and 5), jitter and deviations from a given heading by U(seed, init, 2^42 + id, 0 to 5 and 6 to 7), the common heading of a group by U(seed, init, 2^40, 8 group and 8 group + 1), and the
//! offsets from it by U(seed, init, 2^40 + 1 + id, 0 and 1).

use super::agents::PerMember;
use super::build::{Wrong, short, vector};
use super::{Group, Scenario};
use crate::file::tree::written;
use crate::file::{Named, Nothing};
use crate::{form, tagged};
use space::obstacles::Obstacles;
use space::random::{Purpose, normal, uniform, unit_vector};
use space::{Real, Space, Vector};
use std::collections::BTreeMap;
use swarm::engine as plan;
use swarm::parameters::Scalar;
use swarm::physics::Contact;

form! {
    /// How a group begins.
    pub struct Start {
        /// Where.
        place: Place = [Place::Anywhere(Nothing)], "", Any;
        /// Least distance between the centres of two members.
        spacing: f64 = [0.0], "length", NonNegative;
        /// Standard deviation of a shift of each place along every axis.
        jitter: f64 = [0.0], "length", NonNegative;
        /// Which way they head.
        heading: Heading = [Heading::Random(Nothing)], "", Any;
        /// How fast they move; left out, as the model begins.
        speed: Option<PerMember> = none, "length/time", NonNegative;
        /// Velocities, one for each member, in place of heading and speed.
        velocities: Option<Vec<Vec<f64>>> = none, "length/time", Any;
        /// What the model remembers of each member, by column, as `flockworks models ID` lists them.
        state: Named<PerMember> = [Named::default()], "", Any;
    }
}

impl Default for Start {
    fn default() -> Self {
        Self {
            place: Place::Anywhere(Nothing),
            spacing: 0.0,
            jitter: 0.0,
            heading: Heading::Random(Nothing),
            speed: None,
            velocities: None,
            state: Named::default(),
        }
    }
}

tagged! {
    /// Where a group begins.
    pub enum Place {
        /// Anywhere in the space.
        anywhere => Anywhere(Nothing);
        /// In a box.
        box => Box(Region);
        /// In a disc or sphere.
        ball => Ball(BallRegion);
        /// On a square lattice about a point.
        lattice => Lattice(Lattice);
        /// At these points, one for each member.
        points in "length", swarm::parameters::Range::Any => Points(Vec<Vec<f64>>);
    }
}

form! {
    /// A box along the axes.
    pub struct Region {
        /// Lower corner.
        low: Vec<f64> = need, "length", Any;
        /// Upper corner.
        high: Vec<f64> = need, "length", Any;
    }
}

impl Region {
    /// The corners; wrongs carry paths below `path`.
    pub(super) fn corners<R: Real, const D: usize>(&self, path: &str) -> Result<(Vector<R, D>, Vector<R, D>), Wrong> {
        let low: Vector<R, D> = at_path(&self.low, &format!("{path}.low"))?;
        let high: Vector<R, D> = at_path(&self.high, &format!("{path}.high"))?;
        if (0..D).any(|a| low[a] > high[a]) {
            let what = "the lower corner lies above the upper one";
            return Err(Wrong::new(format!("{path}.low"), what, "low must not exceed high on any axis"));
        }
        Ok((low, high))
    }
    /// The corners of a region that lies inside the space.
    pub(super) fn inside<R: Real, const D: usize>(
        &self,
        space: &Space<R, D>,
        path: &str,
    ) -> Result<(Vector<R, D>, Vector<R, D>), Wrong> {
        let (low, high) = self.corners(path)?;
        inside(space, low, &format!("{path}.low"))?;
        inside(space, high, &format!("{path}.high"))?;
        Ok((low, high))
    }
}

/// A place, if it lies inside the space.
pub(super) fn inside<R: Real, const D: usize>(
    space: &Space<R, D>,
    place: Vector<R, D>,
    path: &str,
) -> Result<Vector<R, D>, Wrong> {
    for a in 0..D {
        if let Some(side) = space.side(a)
            && !(place[a] >= R::ZERO && place[a] <= side)
        {
            let (found, side) = (written(place[a].to_f64()), written(side.to_f64()));
            let what = format!("{found} lies outside the space, which goes from 0 to {side} on axis {a}");
            return Err(Wrong::new(format!("{path}.{a}"), what, "a place inside the space"));
        }
    }
    Ok(place)
}

form! {
    /// A disc or sphere.
    pub struct BallRegion {
        /// Its middle.
        centre: Vec<f64> = need, "length", Any;
        /// Its radius.
        radius: f64 = need, "length", Positive;
    }
}

form! {
    /// A square lattice.
    pub struct Lattice {
        /// Its middle.
        centre: Vec<f64> = need, "length", Any;
        /// Distance between neighbours.
        spacing: f64 = need, "length", Positive;
    }
}

tagged! {
    /// Which way a group heads at the start.
    pub enum Heading {
        /// Each its own way.
        random => Random(Nothing);
        /// All the same, given way.
        along in "1", swarm::parameters::Range::Any => Along(Vec<f64>);
        /// One way drawn for all; in 3-D azimuth and elevation are uniform.
        common => Common(Common);
        /// About a given way, with normal deviations of the azimuth.
        about => About(About);
    }
}

form! {
    /// Headings about a given way.
    pub struct About {
        /// The way.
        direction: Vec<f64> = need, "1", Any;
        /// Standard deviation of the azimuth.
        deviation: f64 = need, "deg", NonNegative;
    }
}

form! {
    /// One heading for all, with deviations.
    pub struct Common {
        /// Largest deviation, of azimuth and elevation each.
        spread: f64 = [0.0], "deg", Within(0.0, 180.0);
    }
}

/// What a start needs to know of the group and its surroundings.
pub(super) struct Surroundings<'a, R, const D: usize> {
    pub(super) space: &'a Space<R, D>,
    pub(super) obstacles: &'a Obstacles<R, D>,
    pub(super) seed: u64,
    /// Index of the group.
    pub(super) group: u64,
    /// Id of its first member.
    pub(super) first: u32,
    pub(super) count: usize,
    pub(super) body_radius: R,
    /// Speeds at which the model begins, for each member.
    pub(super) initial_speeds: &'a [R],
}

impl Start {
    /// The start, agent by agent. Wrongs carry paths below the start.
    pub(super) fn resolved<R: Real, const D: usize>(
        &self,
        around: &Surroundings<'_, R, D>,
    ) -> Result<plan::Start<R, D>, Wrong> {
        if self.spacing > 0.0 && matches!(self.place, Place::Points(_) | Place::Lattice(_)) {
            return Err(Wrong::new("spacing", "the place says already how far apart they begin", "leave it out"));
        }
        let mut position = self.positions(around)?;
        if self.jitter > 0.0 {
            for (id, place) in (around.first..).zip(&mut position) {
                let draw = |slot| uniform(around.seed, Purpose::Init, (1 << 42) + u64::from(id), slot);
                let shift = |a: usize| R::of(self.jitter * normal(draw(2 * a as u32), draw(2 * a as u32 + 1)));
                *place = inside(around.space, *place + Vector(core::array::from_fn(shift)), "jitter")?;
            }
        }
        let velocity = self.velocities(around)?;
        let mut columns = BTreeMap::new();
        for (name, values) in &self.state.0 {
            let values = values.values(around.count, around.seed, name, around.first).map_err(|found| {
                let what = format!("{found} values of `{name}` for {} members", around.count);
                Wrong::new(format!("state.{name}"), what, format!("expected {}", around.count))
            })?;
            columns.insert(name.clone(), values);
        }
        Ok(plan::Start { position, velocity, columns })
    }

    fn positions<R: Real, const D: usize>(&self, around: &Surroundings<'_, R, D>) -> Result<Vec<Vector<R, D>>, Wrong> {
        let bounds = |low: Vector<R, D>, high: Vector<R, D>| (low, high);
        match &self.place {
            Place::Points(points) => {
                if points.len() != around.count {
                    let what = format!("{} points for {} members", points.len(), around.count);
                    return Err(Wrong::new("place.points", what, format!("expected {} points", around.count)));
                }
                let at = |(k, point): (usize, &Vec<f64>)| {
                    let path = format!("place.points.{k}");
                    let point = vector(point).map_err(|what| Wrong::new(&path, what, "a point of the space"))?;
                    inside(around.space, point, &path)
                };
                points.iter().enumerate().map(at).collect()
            }
            Place::Lattice(lattice) => {
                let centre: Vector<R, D> = at_path(&lattice.centre, "place.lattice.centre")?;
                let mut side = 1usize;
                while side.pow(D as u32) < around.count {
                    side += 1;
                }
                let middle = (side as f64 - 1.0) / 2.0;
                let place = |k: usize| {
                    let along = |a: usize| (k / side.pow(a as u32) % side) as f64 - middle;
                    centre + Vector(core::array::from_fn(|a| R::of(along(a) * lattice.spacing)))
                };
                (0..around.count).map(|k| inside(around.space, place(k), "place.lattice")).collect()
            }
            Place::Anywhere(_) => {
                let mut high = Vector::ZERO;
                for a in 0..D {
                    high.0[a] = around.space.side(a).ok_or_else(|| {
                        let what = format!("\"anywhere\" has no meaning on axis {a}, which is open");
                        Wrong::new("place", what, "a place in open space")
                            .help("use place.box, place.ball or place.lattice")
                    })?;
                }
                let (low, high) = bounds(Vector::ZERO, high);
                self.scattered(around, low, high, |_| true, "place")
            }
            Place::Box(region) => {
                let (low, high) = region.inside(around.space, "place.box")?;
                self.scattered(around, low, high, |_| true, "place.box")
            }
            Place::Ball(ball) => {
                let centre: Vector<R, D> = at_path(&ball.centre, "place.ball.centre")?;
                inside(around.space, centre, "place.ball.centre")?;
                let radius = R::of(ball.radius);
                let reach = Vector([radius; D]);
                let inside = |p: Vector<R, D>| (p - centre).length_squared() <= radius * radius;
                self.scattered(around, centre - reach, centre + reach, inside, "place.ball")
            }
        }
    }

    /// Places drawn in a box until all keep their distance, are inside, and touch neither wall nor obstacle.
    fn scattered<R: Real, const D: usize>(
        &self,
        around: &Surroundings<'_, R, D>,
        low: Vector<R, D>,
        high: Vector<R, D>,
        inside: impl Fn(Vector<R, D>) -> bool,
        path: &str,
    ) -> Result<Vec<Vector<R, D>>, Wrong> {
        let mut apart = Apart::new(around.space, R::of(self.spacing));
        let mut places = Vec::with_capacity(around.count);
        let most = 2000 * around.count as u64 + 10_000;
        let radius = around.body_radius;
        let mut attempt = 0;
        while places.len() < around.count {
            if attempt == most {
                let what =
                    format!("only {} of {} members found a place in {most} attempts", places.len(), around.count);
                return Err(Wrong::new(path, what, "too little room").help(
                    "a larger place, a smaller spacing or fewer members leave room; bodies keep clear of walls and obstacles",
                ));
            }
            let a = attempt + (around.group << 36);
            attempt += 1;
            let draw = |axis: usize| R::of(uniform(around.seed, Purpose::Init, a, axis as u32));
            let place = Vector(core::array::from_fn(|axis| low[axis] + (high[axis] - low[axis]) * draw(axis)));
            if !inside(place) || !around.clear(place, radius) || !apart.admits(place) {
                continue;
            }
            apart.add(place);
            places.push(place);
        }
        Ok(places)
    }

    fn velocities<R: Real, const D: usize>(
        &self,
        around: &Surroundings<'_, R, D>,
    ) -> Result<Option<Vec<Vector<R, D>>>, Wrong> {
        if let Some(velocities) = &self.velocities {
            if velocities.len() != around.count {
                let what = format!("{} velocities for {} members", velocities.len(), around.count);
                return Err(Wrong::new("velocities", what, format!("expected {}", around.count)));
            }
            if self.speed.is_some() || self.heading != Heading::Random(Nothing) {
                let what = "velocities say it all; speed and heading beside them contradict";
                return Err(Wrong::new("velocities", what, "leave out either"));
            }
            let at = |(k, v): (usize, &Vec<f64>)| {
                vector(v).map_err(|what| Wrong::new(format!("velocities.{k}"), what, "a velocity"))
            };
            return velocities.iter().enumerate().map(at).collect::<Result<_, _>>().map(Some);
        }
        if self.speed.is_none()
            && self.heading == Heading::Random(Nothing)
            && around.initial_speeds.iter().all(|&speed| speed == R::ZERO)
        {
            // the model begins as it will: at rest, or with velocities of its own
            return Ok(None);
        }
        let speeds = match &self.speed {
            None => around.initial_speeds.to_vec(),
            Some(speed) => {
                let speeds = speed.values(around.count, around.seed, "speed", around.first).map_err(|found| {
                    Wrong::new("speed", format!("{found} speeds for {} members", around.count), "one for each member")
                })?;
                if let Some(least) = speeds.iter().copied().find(|&v| v < 0.0) {
                    return Err(Wrong::new("speed", format!("a speed of {least} was drawn"), "0 or more"));
                }
                speeds.into_iter().map(R::of).collect()
            }
        };
        let headings = self.headings(around)?;
        Ok(Some(headings.into_iter().zip(speeds).map(|(heading, speed)| heading * speed).collect()))
    }

    fn headings<R: Real, const D: usize>(&self, around: &Surroundings<'_, R, D>) -> Result<Vec<Vector<R, D>>, Wrong> {
        let ids = around.first..around.first + around.count as u32;
        let seed = around.seed;
        Ok(match &self.heading {
            Heading::Random(_) => ids
                .map(|id| {
                    let draw = |slot| uniform(seed, Purpose::Init, u64::from(id), slot);
                    unit_vector(draw(4), draw(5))
                })
                .collect(),
            Heading::Along(way) => {
                let way: Vector<R, D> = at_path(way, "heading.along")?;
                if way.is_tiny() {
                    return Err(Wrong::new("heading.along", "the zero vector shows no way", "a vector with a length"));
                }
                vec![way.unit(); around.count]
            }
            Heading::About(about) => {
                let way: Vector<R, D> = at_path(&about.direction, "heading.about.direction")?;
                if way.is_tiny() {
                    let what = "the zero vector shows no way";
                    return Err(Wrong::new("heading.about.direction", what, "a vector with a length"));
                }
                ids.map(|id| {
                    let draw = |slot| uniform(seed, Purpose::Init, (1 << 42) + u64::from(id), slot);
                    let off = (about.deviation * normal(draw(6), draw(7))).to_radians();
                    turned(way.unit(), R::of(off))
                })
                .collect()
            }
            Heading::Common(common) => {
                let base = |slot: u32| uniform(seed, Purpose::Init, 1 << 40, 8 * around.group as u32 + slot);
                let (azimuth, elevation) = (-180.0 + 360.0 * base(0), -90.0 + 180.0 * base(1));
                ids.map(|id| {
                    let own = |slot| uniform(seed, Purpose::Init, (1 << 40) + 1 + u64::from(id), slot);
                    let off = |slot| common.spread * (2.0 * own(slot) - 1.0);
                    towards(azimuth + off(0), (elevation + off(1)).clamp(-90.0, 90.0))
                })
                .collect()
            }
        })
    }
}

/// A vector turned by an angle in the plane of the first two axes; in one dimension as it is.
fn turned<R: Real, const D: usize>(v: Vector<R, D>, angle: R) -> Vector<R, D> {
    let (sin, cos) = angle.sin_cos();
    let (x, y) = (v[0], if D > 1 { v[1] } else { R::ZERO });
    Vector(core::array::from_fn(|a| match a {
        _ if D == 1 => v[a],
        0 => x * cos - y * sin,
        1 => x * sin + y * cos,
        _ => v[a],
    }))
}

/// The unit vector of an azimuth and an elevation, in degrees; in one dimension its sign.
fn towards<R: Real, const D: usize>(azimuth: f64, elevation: f64) -> Vector<R, D> {
    let (sin, cos) = Real::sin_cos(azimuth.to_radians());
    let (up, along) = Real::sin_cos(elevation.to_radians());
    Vector(core::array::from_fn(|a| {
        R::of(match (D, a) {
            (1, _) => {
                if cos < 0.0 {
                    -1.0
                } else {
                    1.0
                }
            }
            (2, 0) => cos,
            (2, _) => sin,
            (_, 0) => along * cos,
            (_, 1) => along * sin,
            _ => up,
        })
    }))
}

fn at_path<R: Real, const D: usize>(numbers: &[f64], path: &str) -> Result<Vector<R, D>, Wrong> {
    vector(numbers).map_err(|what| Wrong::new(path, what, format!("{D} numbers")))
}

impl<R: Real, const D: usize> Surroundings<'_, R, D> {
    /// Whether a body here touches neither wall nor obstacle.
    fn clear(&self, place: Vector<R, D>, radius: R) -> bool {
        if (0..D).any(|a| beyond_wall(self.space, place, radius, a)) {
            return false;
        }
        let mut free = true;
        self.obstacles.near(place, radius.most(R::TINY), |_, _, _| free = false);
        free
    }
}

/// What is left of a radius where bodies touch: places are written in few digits, and touching is not overlapping.
const TOUCHING: f64 = 1.0 - 1e-5;

/// Bodies that begin at given places where they cannot be: in a wall, in an obstacle, in each other. Places that are drawn keep
/// clear of walls and obstacles by themselves.
pub(super) fn in_the_way<R: Scalar, const D: usize>(scenario: &Scenario, world: &swarm::World<R, D>) -> Vec<Wrong> {
    // in a lattice or at points
    let given = |group: &Group| match group.start.as_ref().filter(|start| start.jitter == 0.0)?.place {
        Place::Points(_) => Some("points"),
        Place::Lattice(_) => Some("lattice"),
        _ => None,
    };
    // groups that begin at given places and have bodies, each with its number
    let groups: Vec<(usize, &plan::Group<R, D>)> = (world.groups().iter().enumerate())
        .filter(|(g, body)| body.contact() != Contact::Free && given(&scenario.group.0[*g].1).is_some())
        .collect();
    if groups.is_empty() {
        return Vec::new();
    }
    let frame = world.frame();
    let mut places = vec![Vector::ZERO; frame.columns.len()];
    for row in 0..places.len() {
        places[frame.columns.id[row] as usize] = frame.columns.position(row);
    }
    let members = |g: usize| {
        let range = &frame.groups[g];
        &places[range.first as usize..(range.first + range.count) as usize]
    };
    let mut wrongs = Vec::new();
    let mut wrong = |g: usize, member: usize, what: String| {
        let (name, group) = &scenario.group.0[g];
        let place = format!("group.{name}.start.place");
        // a lattice is one thing in the file, and wrong once
        let lattice = given(group) == Some("lattice");
        let path = if lattice { format!("{place}.lattice") } else { format!("{place}.points.{member}") };
        if !lattice || wrongs.iter().all(|other: &Wrong| other.path != path) {
            wrongs.push(Wrong::new(path, what, "no room for a body"));
        }
    };
    for &(g, body) in &groups {
        let radius = body.radius() * R::of(TOUCHING);
        for (k, &place) in members(g).iter().enumerate() {
            if let Some(axis) = (0..D).find(|&a| beyond_wall(frame.space, place, radius, a)) {
                let what = format!("a body of radius {} would reach into a wall here, on axis {axis}", body.radius());
                wrong(g, k, what);
            }
            let mut met = None;
            world.obstacles().near(place, radius.most(R::TINY), |index, _, _| met = met.or(Some(index as usize)));
            if let Some(index) = met {
                let obstacle = if index < scenario.obstacle.len() {
                    format!("`obstacle.{index}`")
                } else {
                    "a scattered obstacle".to_owned()
                };
                wrong(g, k, format!("a body of radius {} would reach into {obstacle} here", body.radius()));
            }
        }
    }
    // who is reflected or clamped passes through other bodies
    let meets = |body: &plan::Group<R, D>| {
        body.meets() && body.radius() > R::ZERO && matches!(body.contact(), Contact::Refuse | Contact::Slide)
    };
    for (i, &(g, one)) in groups.iter().enumerate() {
        for &(h, other) in groups[i..].iter().filter(|(_, other)| meets(one) && meets(other)) {
            let apart = one.radius() + other.radius();
            let mut room = Apart::new(frame.space, apart * R::of(TOUCHING));
            if g != h {
                members(g).iter().for_each(|&place| room.add(place));
            }
            for (k, &place) in members(h).iter().enumerate() {
                if let Some(number) = room.nearer(place) {
                    let near = frame.space.offset(place, members(g)[number]).length();
                    let (name, near) = (&scenario.group.0[g].0, short(near.to_f64()));
                    let whose =
                        if g == h { format!("member {number}") } else { format!("member {number} of `{name}`") };
                    wrong(
                        h,
                        k,
                        format!(
                            "the body here would overlap that of {whose}: {near} apart, where they touch at {apart}"
                        ),
                    );
                }
                if g == h {
                    room.add(place);
                }
            }
        }
    }
    wrongs
}

/// Whether a body reaches beyond a wall of an axis.
fn beyond_wall<R: Real, const D: usize>(space: &Space<R, D>, place: Vector<R, D>, radius: R, axis: usize) -> bool {
    match space.edges[axis] {
        space::Edge::Walls(length) => place[axis] < radius || place[axis] > length - radius,
        _ => false,
    }
}

/// Places that keep a distance from each other, found again by cells of that size.
pub(super) struct Apart<'a, R, const D: usize> {
    space: &'a Space<R, D>,
    distance: R,
    /// Places with their numbers, in the order in which they were added.
    cells: std::collections::HashMap<[i64; D], Vec<(usize, Vector<R, D>)>>,
    count: usize,
}

impl<'a, R: Real, const D: usize> Apart<'a, R, D> {
    pub(super) fn new(space: &'a Space<R, D>, distance: R) -> Self {
        Self { space, distance, cells: std::collections::HashMap::new(), count: 0 }
    }
    /// How many cells a periodic axis has, and how wide they are on any axis.
    fn axis(&self, a: usize) -> (Option<i64>, f64) {
        let wanted = self.distance.to_f64().max(1e-9);
        match self.space.periods()[a] {
            Some(length) => {
                let cells = (length.to_f64() / wanted).floor().clamp(1.0, 1e6);
                (Some(cells as i64), length.to_f64() / cells)
            }
            None => (None, wanted),
        }
    }
    fn cell(&self, place: Vector<R, D>) -> [i64; D] {
        core::array::from_fn(|a| {
            let (cells, width) = self.axis(a);
            let cell = (place[a].to_f64() / width).floor() as i64;
            cells.map_or(cell, |cells| cell.rem_euclid(cells))
        })
    }
    pub(super) fn admits(&self, place: Vector<R, D>) -> bool {
        self.nearer(place).is_none()
    }
    /// Number of a place that is nearer than the distance.
    fn nearer(&self, place: Vector<R, D>) -> Option<usize> {
        if self.distance <= R::ZERO {
            return None;
        }
        let here = self.cell(place);
        let near = 3usize.pow(D as u32);
        let limit = self.distance * self.distance;
        (0..near).find_map(|k| {
            let there = core::array::from_fn(|a| {
                let cell = here[a] + (k / 3usize.pow(a as u32) % 3) as i64 - 1;
                self.axis(a).0.map_or(cell, |cells| cell.rem_euclid(cells))
            });
            let close = |other: Vector<R, D>| self.space.offset(place, other).length_squared() < limit;
            self.cells.get(&there)?.iter().find(|(_, other)| close(*other)).map(|&(number, _)| number)
        })
    }
    pub(super) fn add(&mut self, place: Vector<R, D>) {
        if self.distance > R::ZERO {
            self.cells.entry(self.cell(place)).or_default().push((self.count, place));
            self.count += 1;
        }
    }
}
