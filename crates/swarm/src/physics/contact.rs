//! Contact policies: what happens where the way is not free.

use space::obstacles::Obstacles;
use space::{Edge, Real, Space, Vector};

/// What a body does on contact with walls, obstacles and other bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// Nothing stops it.
    Free,
    /// A move that would end in contact is not made; refused moves are counted. Bodies are dealt with in the order of their ids,
    /// each against the new places of those before it and the old ones of those after it.
    Refuse,
    /// It slides along what it hits (and stays if that is blocked too), then is pushed out to its radius; bodies that
    /// overlap are pushed apart by half the overlap each.
    Slide,
    /// It is reflected, as light is.
    Reflect,
    /// It stops at the wall and the velocity component into the wall is reversed.
    Clamp,
}

/// What was met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Met {
    /// Nothing.
    Nothing = 0,
    /// Another member's body.
    Member = 1,
    /// An obstacle.
    Obstacle = 2,
    /// A wall of the space.
    Wall = 3,
}

/// A move after contact with the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolved<R, const D: usize> {
    /// Where it ends.
    pub place: Vector<R, D>,
    /// Velocity after it.
    pub velocity: Vector<R, D>,
    /// What was met.
    pub met: Met,
}

/// What stands in the way of a straight move of a body: a wall, an obstacle crossed, or one nearer than the radius at its end
/// (a body that already touches may move away).
#[inline]
pub fn free_of_environment<R: Real, const D: usize>(
    space: &Space<R, D>,
    obstacles: &Obstacles<R, D>,
    from: Vector<R, D>,
    to: Vector<R, D>,
    radius: R,
) -> Met {
    for a in 0..D {
        if let Edge::Walls(length) = space.edges[a] {
            let (low, high) = (radius, length - radius);
            let (start, end) = (from.0[a], to.0[a]);
            if (end < low && end < start) || (end > high && end > start) {
                return Met::Wall;
            }
        }
    }
    if obstacles.is_empty() {
        return Met::Nothing;
    }
    // nothing can be met by a move whose end is farther from everything than the move and the body are long
    let around = ((to - from).length() + radius) * R::of(1.000_001) + R::TINY;
    if around <= obstacles.reach() {
        let mut near = false;
        obstacles.near(to, around, |_, _, _| near = true);
        if !near {
            return Met::Nothing;
        }
    }
    if obstacles.first_crossing(from, to).is_some() {
        return Met::Obstacle;
    }
    let mut met = Met::Nothing;
    if radius > R::ZERO {
        obstacles.near(to, radius, |_, shape, near| {
            if near.distance < shape.nearest(from).distance {
                met = Met::Obstacle;
            }
        });
    }
    met
}

/// A move under a contact policy, walls and obstacles only.
pub fn resolve<R: Real, const D: usize>(
    contact: Contact,
    space: &Space<R, D>,
    obstacles: &Obstacles<R, D>,
    from: Vector<R, D>,
    to: Vector<R, D>,
    velocity: Vector<R, D>,
    radius: R,
) -> Resolved<R, D> {
    let free = Resolved { place: to, velocity, met: Met::Nothing };
    match contact {
        Contact::Free => free,
        Contact::Refuse => match free_of_environment(space, obstacles, from, to, radius) {
            Met::Nothing => free,
            met => Resolved { place: from, velocity, met },
        },
        Contact::Clamp => clamp(space, obstacles, from, free, radius),
        Contact::Reflect => reflect(space, obstacles, from, free, radius),
        Contact::Slide => slide(space, obstacles, from, free, radius),
    }
}

/// The limits of a body's centre on a walled axis; the middle where the body does not fit.
fn limits<R: Real>(length: R, radius: R) -> (R, R) {
    let middle = length * R::HALF;
    (radius.least(middle), (length - radius).most(middle))
}

fn clamp<R: Real, const D: usize>(
    space: &Space<R, D>,
    obstacles: &Obstacles<R, D>,
    from: Vector<R, D>,
    mut to: Resolved<R, D>,
    radius: R,
) -> Resolved<R, D> {
    for a in 0..D {
        if let Edge::Walls(length) = space.edges[a] {
            let (low, high) = limits(length, radius);
            if to.place.0[a] < low || to.place.0[a] > high {
                to.place.0[a] = to.place.0[a].clamped(low, high);
                to.velocity.0[a] = -to.velocity.0[a];
                to.met = Met::Wall;
            }
        }
    }
    if !obstacles.is_empty() && free_of_environment(space, obstacles, from, to.place, radius) != Met::Nothing {
        return Resolved { place: from, velocity: -to.velocity, met: Met::Obstacle };
    }
    to
}

fn reflect<R: Real, const D: usize>(
    space: &Space<R, D>,
    obstacles: &Obstacles<R, D>,
    from: Vector<R, D>,
    mut to: Resolved<R, D>,
    radius: R,
) -> Resolved<R, D> {
    if let Some((fraction, _, normal)) = obstacles.first_crossing(from, to.place) {
        let move_by = to.place - from;
        // stop a hair before the surface: the reflected rest starts in free space
        let hit = from + move_by * (fraction * R::of(0.999));
        let rest = move_by * (R::ONE - fraction);
        let mirrored = hit + rest - normal * (rest.dot(normal) + rest.dot(normal));
        to.velocity -= normal * (to.velocity.dot(normal) + to.velocity.dot(normal));
        to.met = Met::Obstacle;
        to.place = if obstacles.first_crossing(hit, mirrored).is_none() { mirrored } else { from };
    }
    for a in 0..D {
        if let Edge::Walls(length) = space.edges[a] {
            let (low, high) = limits(length, radius);
            let x = to.place.0[a];
            if x < low || x > high {
                let beyond = if x < low { low - x } else { x - high };
                let room = high - low;
                // folding there and back as often as the move is long
                let (folds, rest) = if room > R::ZERO {
                    let folds = (beyond / room).floor();
                    (folds, beyond - folds * room)
                } else {
                    (R::ZERO, R::ZERO)
                };
                let odd = folds - (folds * R::HALF).floor() * R::of(2.0) >= R::ONE;
                let from_low = (x < low) != odd;
                to.place.0[a] = if from_low { low + rest } else { high - rest }.clamped(low, high);
                if !odd {
                    to.velocity.0[a] = -to.velocity.0[a];
                }
                to.met = Met::Wall;
            }
        }
    }
    if to.met != Met::Nothing && obstacles.first_crossing(from, to.place).is_some() && radius > R::ZERO {
        to.place = from;
    }
    to
}

fn slide<R: Real, const D: usize>(
    space: &Space<R, D>,
    obstacles: &Obstacles<R, D>,
    from: Vector<R, D>,
    mut to: Resolved<R, D>,
    radius: R,
) -> Resolved<R, D> {
    if let Some((_, _, normal)) = obstacles.first_crossing(from, to.place) {
        let move_by = to.place - from;
        let along = from + move_by - normal * move_by.dot(normal);
        to.met = Met::Obstacle;
        to.place = if obstacles.first_crossing(from, along).is_none() { along } else { from };
    }
    // pushed out to the radius, never through another wall
    if radius > R::ZERO && !obstacles.is_empty() {
        let mut out = to.place;
        let mut touched = false;
        obstacles.near(to.place, radius, |_, _, near| {
            out += near.away * (radius - near.distance);
            touched = true;
        });
        if touched {
            to.met = Met::Obstacle;
            let clear = out.finite()
                && obstacles.first_crossing(to.place, out).is_none()
                && obstacles.first_crossing(from, out).is_none();
            if clear {
                to.place = out;
            }
        }
    }
    for a in 0..D {
        if let Edge::Walls(length) = space.edges[a] {
            let (low, high) = limits(length, radius);
            if to.place.0[a] < low || to.place.0[a] > high {
                to.place.0[a] = to.place.0[a].clamped(low, high);
                to.met = Met::Wall;
            }
        }
    }
    if obstacles.first_crossing(from, to.place).is_some() {
        to.place = from;
    }
    to
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use space::obstacles::Obstacle;
    use space::random::{Purpose, uniform};
    use space::shape::Shape;

    fn with(shapes: Vec<Shape<f64, 2>>) -> Obstacles<f64, 2> {
        Obstacles::new(shapes.into_iter().map(Obstacle::new).collect(), [None; 2], 5.0).unwrap()
    }
    fn wall() -> Obstacles<f64, 2> {
        with(vec![Shape::new_segment(Vector([0.0, -5.0]), Vector([0.0, 5.0])).unwrap()])
    }
    const POLICIES: [Contact; 4] = [Contact::Refuse, Contact::Slide, Contact::Reflect, Contact::Clamp];

    #[test]
    fn each_policy_at_a_wall() {
        let (from, to, v) = (Vector([-1.0, 0.0]), Vector([1.0, 1.0]), Vector([2.0, 1.0]));
        let run = |contact| resolve(contact, &Space::open(), &wall(), from, to, v, 0.0);
        assert_eq!(run(Contact::Free).place, to);
        assert_eq!((run(Contact::Refuse).place, run(Contact::Refuse).met), (from, Met::Obstacle));
        assert_eq!(run(Contact::Slide).place, Vector([-1.0, 1.0]));
        let reflected = run(Contact::Reflect);
        assert!((reflected.place - Vector([-1.0, 1.0])).length() < 2e-3, "{reflected:?}");
        assert_eq!(reflected.velocity, Vector([-2.0, 1.0]));
    }

    #[test]
    fn a_box_keeps_everyone_for_steps_of_any_size() {
        let space = Space::walled([10.0, 10.0]);
        for contact in POLICIES {
            let mut at = Vector([5.0, 5.0]);
            for k in 0..2000 {
                let big = 10f64.powf(6.0 * uniform(1, Purpose::Init, k, 2) - 2.0);
                let d = Vector([uniform(1, Purpose::Init, k, 0) - 0.5, uniform(1, Purpose::Init, k, 1) - 0.5]) * big;
                let out = resolve(contact, &space, &with(vec![]), at, at + d, d, 0.5);
                at = out.place;
                assert!(
                    at.finite() && (0..2).all(|a| at[a] >= 0.5 - 1e-9 && at[a] <= 9.5 + 1e-9),
                    "{contact:?} {at:?}"
                );
            }
        }
    }

    #[test]
    fn reflection_mirrors() {
        let space = Space::walled([10.0]);
        let none = Obstacles::new(vec![], [None; 1], 1.0).unwrap();
        let out = resolve(Contact::Reflect, &space, &none, Vector([9.0]), Vector([12.0]), Vector([3.0]), 0.0);
        assert_eq!((out.place, out.velocity), (Vector([8.0]), Vector([-3.0])));
        let twice = resolve(Contact::Reflect, &space, &none, Vector([9.0]), Vector([23.0]), Vector([14.0]), 0.0);
        assert_eq!((twice.place, twice.velocity), (Vector([3.0]), Vector([14.0])));
    }

    #[test]
    fn nobody_passes_a_closed_ring_of_walls() {
        let corner = [Vector([-3.0, -3.0]), Vector([3.0, -3.0]), Vector([3.0, 3.0]), Vector([-3.0, 3.0])];
        let ring = with((0..4).map(|k| Shape::new_segment(corner[k], corner[(k + 1) % 4]).unwrap()).collect());
        for contact in POLICIES {
            for radius in [0.0, 0.4] {
                let mut at = Vector([0.0, 0.0]);
                for k in 0..20_000u64 {
                    let d =
                        Vector([uniform(2, Purpose::Init, k, 0) - 0.5, uniform(2, Purpose::Init, k, 1) - 0.5]) * 5.0;
                    at = resolve(contact, &Space::open(), &ring, at, at + d, d, radius).place;
                    assert!((0..2).all(|a| at[a].abs() <= 3.0), "{contact:?} {radius} {at:?} step {k}");
                }
            }
        }
    }
}
