//! What stands and lies about: obstacles, one by one or scattered, and food.

use super::build::{Wrong, vector};
use super::start::{Apart, Region};
use crate::file::{Named, Nothing};
use crate::{form, tagged, words};
use space::obstacles::{self, Plan};
use space::random::{Purpose, uniform};
use space::shape::Shape;
use space::{Edge, Real, Space, Vector};
use swarm::resources::{self, Gain, Metabolism, ResourcePlan, Respawn, Sharing, Store};

tagged! {
    /// The shape of an obstacle.
    pub enum ObstacleShape {
        /// A disc or sphere.
        ball => Ball(Ball);
        /// A thin wall.
        segment => Segment(Segment);
        /// A solid polygon (2-D), by its corners in order.
        polygon in "length", swarm::parameters::Range::Any => Polygon(Vec<Vec<f64>>);
        /// A solid box along the axes.
        box => Box(Region);
        /// Everything behind a plane.
        plane => Plane(Plane);
    }
}

form! {
    /// A disc or sphere.
    pub struct Ball {
        /// Its middle.
        centre: Vec<f64> = need, "length", Any;
        /// Its radius.
        radius: f64 = need, "length", Positive;
    }
}

form! {
    /// A thin wall between two points.
    pub struct Segment {
        /// One end.
        from: Vec<f64> = need, "length", Any;
        /// The other end.
        to: Vec<f64> = need, "length", Any;
    }
}

form! {
    /// A plane with everything behind it.
    pub struct Plane {
        /// Any point of it.
        point: Vec<f64> = need, "length", Any;
        /// The way out of the solid.
        normal: Vec<f64> = need, "1", Any;
    }
}

form! {
    /// Where an obstacle is at a time.
    pub struct Waypoint {
        /// The time.
        time: f64 = need, "time", Any;
        /// Offset from the drawn place.
        offset: Vec<f64> = need, "length", Any;
    }
}

form! {
    /// An obstacle.
    pub struct Obstacle {
        /// Its shape.
        shape: ObstacleShape = need, "", Any;
        /// Time from which it is there; left out, from the start.
        appears: Option<f64> = none, "time", NonNegative;
        /// Time from which it is there no longer; left out, it stays.
        disappears: Option<f64> = none, "time", NonNegative;
        /// Where it goes: straight from one way-point to the next.
        path: Vec<Waypoint> = [Vec::new()], "", Any;
        /// Share of a laser's light that it sends back.
        albedo: f64 = [0.2], "1", Within(0.0, 1.0);
        /// Whether it hides what is behind it.
        opaque: bool = [true], "", Any;
    }
}

impl Obstacle {
    /// The obstacle; wrongs carry paths below it.
    pub(super) fn resolved<R: Real, const D: usize>(&self) -> Result<obstacles::Obstacle<R, D>, Wrong> {
        let point = |numbers: &[f64], path: &str| {
            vector::<R, D>(numbers).map_err(|what| Wrong::new(format!("shape.{path}"), what, format!("{D} numbers")))
        };
        let shape = match &self.shape {
            ObstacleShape::Ball(ball) => {
                Shape::Ball { centre: point(&ball.centre, "ball.centre")?, radius: R::of(ball.radius) }
            }
            ObstacleShape::Segment(segment) => {
                Shape::Segment { from: point(&segment.from, "segment.from")?, to: point(&segment.to, "segment.to")? }
            }
            ObstacleShape::Polygon(corners) => {
                let at = |(k, corner): (usize, &Vec<f64>)| point(corner, &format!("polygon.{k}"));
                Shape::Polygon { vertices: corners.iter().enumerate().map(at).collect::<Result<_, _>>()? }
            }
            ObstacleShape::Box(region) => {
                Shape::Cuboid { low: point(&region.low, "box.low")?, high: point(&region.high, "box.high")? }
            }
            ObstacleShape::Plane(plane) => Shape::Plane {
                point: point(&plane.point, "plane.point")?,
                normal: point(&plane.normal, "plane.normal")?,
            },
        };
        if let Shape::Segment { from, to } = &shape
            && from == to
        {
            return Err(Wrong::new("shape.segment.to", "the segment has no length", "another point than `from`"));
        }
        let shape = shape.checked().map_err(|error| Wrong::new("shape", error.to_string(), "not a possible shape"))?;
        if let (Some(appears), Some(disappears)) = (self.appears, self.disappears)
            && appears >= disappears
        {
            let what = format!("it would disappear (at {disappears}) before it appears (at {appears})");
            return Err(Wrong::new("disappears", what, "must lie after `appears`"));
        }
        let mut waypoints = Vec::new();
        for (k, waypoint) in self.path.iter().enumerate() {
            let offset = vector::<R, D>(&waypoint.offset)
                .map_err(|what| Wrong::new(format!("path.{k}.offset"), what, format!("{D} numbers")))?;
            if waypoints.last().is_some_and(|&(before, _)| waypoint.time < before) {
                let what = "way-points must be in order of time";
                return Err(Wrong::new(format!("path.{k}.time"), what, "not before the one above"));
            }
            waypoints.push((waypoint.time, offset));
        }
        let planned = self.appears.is_some() || self.disappears.is_some() || !waypoints.is_empty();
        let plan = planned.then(|| Plan {
            appears: self.appears.unwrap_or(f64::NEG_INFINITY),
            disappears: self.disappears.unwrap_or(f64::INFINITY),
            waypoints,
        });
        Ok(obstacles::Obstacle { shape, plan, albedo: R::of(self.albedo), opaque: self.opaque })
    }
}

words! {
    /// How a density becomes a number of balls.
    pub enum CountLaw {
        /// The balls' own volume (area in 2-D) is so many percent of the space.
        Volume = "volume",
        /// As `volume` without the factor 4/3 of a sphere, as in the schooling study.
        WithoutFourThirds = "without_four_thirds",
    }
}

form! {
    /// Discs or spheres scattered at random, none overlapping another, all within the walls.
    pub struct Scatter {
        /// Radius of each.
        radius: f64 = need, "length", Positive;
        /// How many.
        count: Option<usize> = none, "1", Within(0.0, 1_000_000.0);
        /// How much of the space they fill, in place of `count`.
        percent: Option<f64> = none, "%", Within(0.0, 60.0);
        /// How percent become a number.
        law: CountLaw = [CountLaw::Volume], "", Any;
        /// The region in which they lie; left out, the whole space.
        region: Option<Region> = none, "", Any;
        /// Boxes that stay free of them.
        keep_clear: Vec<Region> = [Vec::new()], "", Any;
        /// Least gap between two of them.
        gap: f64 = [0.0], "length", NonNegative;
        /// Share of a laser's light that they send back.
        albedo: f64 = [0.2], "1", Within(0.0, 1.0);
    }
}

impl Scatter {
    /// The balls: centre k by U(seed, obstacles, attempt + 2^36 index, axis), attempts that fail are not used again.
    pub(super) fn resolved<R: Real, const D: usize>(
        &self,
        space: &Space<R, D>,
        seed: u64,
        index: u64,
    ) -> Result<Vec<obstacles::Obstacle<R, D>>, Wrong> {
        let radius = R::of(self.radius);
        let (mut low, mut high) = (Vector::<R, D>::ZERO, Vector::<R, D>::ZERO);
        if let Some(region) = &self.region {
            (low, high) = region.inside(space, "region")?;
        }
        for a in 0..D {
            let side = space.side(a);
            if self.region.is_none() {
                high.0[a] = side.ok_or_else(|| {
                    let what = format!("axis {a} is open, so that scattering needs a region");
                    Wrong::new("", what, "`region` is missing")
                })?;
            }
            if matches!(space.edges[a], Edge::Walls(_)) || self.region.is_some() {
                low.0[a] += radius;
                high.0[a] -= radius;
            }
            if low[a] > high[a] {
                return Err(Wrong::new("radius", "the balls do not fit in", "too large for the space"));
            }
        }
        let mut clear = Vec::new();
        for (k, region) in self.keep_clear.iter().enumerate() {
            clear.push(region.corners(&format!("keep_clear.{k}"))?);
        }
        let count = self.number(space)?;
        let distance = radius + radius + R::of(self.gap);
        let mut apart = Apart::new(space, distance);
        let most = 2000 * count as u64 + 10_000;
        let mut balls = Vec::with_capacity(count);
        let mut attempt = 0;
        while balls.len() < count {
            if attempt == most {
                let what = format!("only {} of {count} obstacles found a place in {most} attempts", balls.len());
                return Err(Wrong::new("", what, "too dense").help("fewer or smaller ones leave room"));
            }
            let a = attempt + (index << 36);
            attempt += 1;
            let draw = |axis: usize| R::of(uniform(seed, Purpose::Obstacles, a, axis as u32));
            let centre = Vector(core::array::from_fn(|axis| low[axis] + (high[axis] - low[axis]) * draw(axis)));
            let outside = |&(low, high): &(Vector<R, D>, Vector<R, D>)| {
                let gap: Vector<R, D> =
                    Vector(core::array::from_fn(|a| (low[a] - centre[a]).most(centre[a] - high[a]).most(R::ZERO)));
                gap.length() >= radius
            };
            if !clear.iter().all(outside) || !apart.admits(centre) {
                continue;
            }
            apart.add(centre);
            let ball = obstacles::Obstacle::new(Shape::Ball { centre, radius });
            balls.push(obstacles::Obstacle { albedo: R::of(self.albedo), ..ball });
        }
        Ok(balls)
    }
    fn number<R: Real, const D: usize>(&self, space: &Space<R, D>) -> Result<usize, Wrong> {
        let percent = match (self.count, self.percent) {
            (Some(count), None) => return Ok(count),
            (None, Some(percent)) => percent,
            (None, None) => return Err(Wrong::new("", "how many there are is missing", "needs `count` or `percent`")),
            (Some(_), Some(_)) => {
                return Err(Wrong::new("percent", "`count` and `percent` both say how many", "leave one of them out"));
            }
        };
        let mut volume = 1.0;
        for a in 0..D {
            volume *= match (&self.region, space.side(a)) {
                (Some(region), _) => region.high[a] - region.low[a],
                (None, side) => side.map_or(0.0, R::to_f64),
            };
        }
        let pi = core::f64::consts::PI;
        let own = match (D, self.law) {
            (1, _) => 2.0 * self.radius,
            (2, _) => pi * self.radius * self.radius,
            (_, CountLaw::Volume) => 4.0 / 3.0 * pi * self.radius.powi(3),
            (_, CountLaw::WithoutFourThirds) => pi * self.radius.powi(3),
        };
        // halves are rounded up
        let count = (percent / 100.0 * volume / own + 0.5).floor();
        if count > 1e6 {
            return Err(Wrong::new("percent", format!("that would be {count:.0} obstacles"), "at most 1,000,000"));
        }
        Ok(count as usize)
    }
}

tagged! {
    /// When a consumed item comes back.
    pub enum Return {
        /// Not at all.
        never => Never(Nothing);
        /// After so much time, somewhere else; 0 for at once.
        after in "time", swarm::parameters::Range::NonNegative => After(f64);
    }
}

form! {
    /// What an item does to a column of its consumer.
    pub struct FoodGain {
        /// What is added.
        amount: f64 = need, "1", Any;
        /// The column is never raised above this.
        capacity: f64 = need, "1", Any;
    }
}

form! {
    /// What it costs to live.
    pub struct Living {
        /// The column that pays.
        energy: String = ["energy".to_owned()], "", Any;
        /// What is paid per time.
        cost: f64 = need, "1/time", NonNegative;
        /// The column from which is taken what energy cannot pay; an agent at 0 is dead.
        health: String = ["health".to_owned()], "", Any;
        /// What is taken from health per unpaid unit.
        starvation: f64 = [1.0], "1", NonNegative;
        /// What is paid per time and squared speed, for motion against drag.
        motion: f64 = [0.0], "time/length^2", NonNegative;
        /// Who moves aligned behind a mate saves some of what motion costs; left out, nothing.
        drafting: Option<Drafting> = none, "", Any;
    }
}

form! {
    /// Moving aligned behind a member of the own group.
    pub struct Drafting {
        /// The one ahead is nearer than this.
        within: f64 = need, "length", Positive;
        /// It lies within this angle of the own heading.
        ahead: f64 = [30.0], "deg", Within(0.0, 180.0);
        /// Its heading differs from the own by no more than this.
        aligned: f64 = [30.0], "deg", Within(0.0, 180.0);
        /// Share of the cost of motion that is saved.
        saving: f64 = need, "1", Within(0.0, 1.0);
    }
}

form! {
    /// What mates near by get of a meal.
    pub struct Shared {
        /// Living members of the eater's group nearer to it than this get some.
        within: f64 = need, "length", NonNegative;
        /// What each of them gets, as a share of what the eater gets.
        share: f64 = need, "1", NonNegative;
    }
}

form! {
    /// Members of one group harm those of others.
    pub struct Predation {
        /// The group that hunts.
        hunters: String = need, "", Any;
        /// The groups that it harms.
        prey: Vec<String> = need, "", Any;
        /// The column from which damage is taken; an agent at 0 is dead.
        health: String = ["health".to_owned()], "", Any;
        /// A hunter harms the nearest living prey that is nearer than this.
        within: f64 = need, "length", NonNegative;
        /// What it takes from it per time.
        damage: f64 = need, "1/time", NonNegative;
        /// What every living prey that is so near takes from the hunter per time.
        rebuttal: f64 = [0.0], "1/time", NonNegative;
    }
}

form! {
    /// Food.
    pub struct Food {
        /// Number of items, placed anywhere in the space.
        count: Option<usize> = none, "1", Within(0.0, 1_000_000.0);
        /// Their places, in place of `count`.
        places: Option<Vec<Vec<f64>>> = none, "length", Any;
        /// An item nearer than this is consumed, by the nearest living agent.
        within: f64 = need, "length", NonNegative;
        /// What an item gives, by column.
        gains: Named<FoodGain> = [Named::default()], "", Any;
        /// When a consumed item comes back.
        respawn: Return = [Return::After(0.0)], "", Any;
        /// What mates near by get of a meal; left out, nothing.
        sharing: Option<Shared> = none, "", Any;
        /// Columns that every agent of the world has, with their values at the start; so any model may eat, live and die.
        stores: Named<f64> = [Named::default()], "1", Any;
        /// What it costs to live.
        metabolism: Option<Living> = none, "", Any;
        /// Who harms whom, by names of yours.
        predation: Named<Predation> = [Named::default()], "", Any;
    }
}

impl Predation {
    fn resolved<R: Real>(&self) -> resources::Predation<R> {
        resources::Predation {
            hunters: self.hunters.clone(),
            prey: self.prey.clone(),
            health: self.health.clone(),
            within: R::of(self.within),
            damage: R::of(self.damage),
            rebuttal: R::of(self.rebuttal),
        }
    }
}

impl Food {
    pub(super) fn resolved<R: Real, const D: usize>(
        &self,
        space: &Space<R, D>,
        seed: u64,
    ) -> Result<ResourcePlan<R, D>, Wrong> {
        let items = match (self.count, &self.places) {
            (None, Some(places)) => {
                let at = |(k, place): (usize, &Vec<f64>)| {
                    let path = format!("places.{k}");
                    let place = vector(place).map_err(|what| Wrong::new(&path, what, format!("{D} numbers")))?;
                    super::start::inside(space, place, &path)
                };
                places.iter().enumerate().map(at).collect::<Result<_, _>>()?
            }
            (Some(count), None) => {
                let mut sides = [R::ZERO; D];
                for (a, side) in sides.iter_mut().enumerate() {
                    *side = space.side(a).ok_or_else(|| {
                        let what = format!("axis {a} is open, so that food needs `places`");
                        Wrong::new("count", what, "use `places`")
                    })?;
                }
                let draw = |item: usize, a: usize| uniform(seed, Purpose::Environment, 1 << 40, (8 * item + a) as u32);
                let place = |item| Vector(core::array::from_fn(|a| sides[a] * R::of(draw(item, a))));
                (0..count).map(place).collect()
            }
            (None, None) => {
                return Err(Wrong::new("", "how much food there is is missing", "needs `count` or `places`"));
            }
            (Some(_), Some(_)) => {
                return Err(Wrong::new("places", "`count` and `places` both say how much", "leave one of them out"));
            }
        };
        let gain = |(column, gain): &(String, FoodGain)| Gain {
            column: column.clone(),
            amount: R::of(gain.amount),
            capacity: R::of(gain.capacity),
        };
        Ok(ResourcePlan {
            items,
            within: R::of(self.within),
            gains: self.gains.0.iter().map(gain).collect(),
            respawn: match self.respawn {
                Return::Never(_) => Respawn::Never,
                Return::After(time) => Respawn::After(time),
            },
            metabolism: self.metabolism.as_ref().map(|living| Metabolism {
                energy: living.energy.clone(),
                cost: R::of(living.cost),
                health: living.health.clone(),
                starvation: R::of(living.starvation),
                motion: R::of(living.motion),
                drafting: living.drafting.as_ref().map(|drafting| resources::Drafting {
                    within: R::of(drafting.within),
                    ahead: R::of(drafting.ahead.to_radians()),
                    aligned: R::of(drafting.aligned.to_radians()),
                    saving: R::of(drafting.saving),
                }),
            }),
            sharing: self
                .sharing
                .as_ref()
                .map(|sharing| Sharing { within: R::of(sharing.within), share: R::of(sharing.share) }),
            stores: self
                .stores
                .0
                .iter()
                .map(|(column, start)| Store { column: column.clone(), start: R::of(*start) })
                .collect(),
            predation: self.predation.0.iter().map(|(_, predation)| predation.resolved()).collect(),
        })
    }
}
