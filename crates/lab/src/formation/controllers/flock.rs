//! What herding controllers see of a flock, and places about it.

use space::Vector;
use terrain::Point;

/// Largest angle, rad, by which a shepherd goes about a flock at once.
const ARC: f64 = 0.5;

/// A flock as shepherds see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flock {
    /// Its centroid.
    pub centre: Point,
    /// Distance of its farthest member from there.
    pub radius: f64,
}

impl Flock {
    /// Of members; nobody is a flock about the origin.
    pub fn of(members: &[Point]) -> Self {
        let sum = members.iter().fold(Vector::ZERO, |sum, &member| sum + member);
        let centre = sum / members.len().max(1) as f64;
        let radius = members.iter().map(|&member| (member - centre).length()).fold(0.0, f64::max);
        Self { centre, radius }
    }
    /// Where to go next on the way to a steering point: straight once it is near ahead, else along the safe zone, a circle at `safe`
    /// beyond the flock.
    pub fn approach(&self, from: Point, steering: Point, safe: f64) -> Point {
        let (own, wanted) = (from - self.centre, steering - self.centre);
        let angle = signed(own.angle(), wanted.angle());
        if angle.abs() <= ARC || own.length() < 1e-9 {
            return steering;
        }
        let next = own.angle() + angle.clamp(-ARC, ARC);
        self.centre + Vector::at_angle(next) * (self.radius + safe).max(wanted.length())
    }
    /// The steering point behind the flock as seen from where it is to go.
    pub fn behind(&self, to: Point, margin: f64) -> Point {
        let way = (to - self.centre).unit_or(Vector([1.0, 0.0]));
        self.centre - way * (self.radius + margin)
    }
}

/// The turn from one direction to another, in (-pi, pi].
pub(super) fn signed(from: f64, to: f64) -> f64 {
    space::Real::wrapped(to - from)
}

/// Places in a row behind the start of a task, `apart` from each other.
pub(super) fn row(scene: &super::Scene<'_>, count: usize, apart: f64) -> Vec<Point> {
    let (way, start) = (scene.task.way(0), scene.task.path[0]);
    let room = scene.task.start_radius + scene.radii.0 + scene.radii.1 + 0.3;
    let place = |k: usize| start - way * room + way.left() * ((k as f64 - (count as f64 - 1.0) / 2.0) * apart);
    (0..count).map(place).map(|place| held(place, scene)).collect()
}

/// A place inside the bounds.
pub(super) fn held(mut place: Point, scene: &super::Scene<'_>) -> Point {
    if let Some((low, high)) = scene.bounds {
        for axis in 0..2 {
            place[axis] = place[axis].clamp(low[axis] + scene.radii.1, high[axis] - scene.radii.1);
        }
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shepherd_goes_about_the_flock() {
        let flock = Flock::of(&[Vector([1.0, 0.0]), Vector([-1.0, 0.0])]);
        assert_eq!((flock.centre, flock.radius), (Vector([0.0, 0.0]), 1.0));
        let behind = flock.behind(Vector([9.0, 0.0]), 0.5);
        assert_eq!(behind, Vector([-1.5, 0.0]));
        let mut at = Vector([3.0, 0.1]);
        for _ in 0..7 {
            at = flock.approach(at, behind, 0.5);
            assert!(at.length() >= 1.5 - 1e-12, "{at:?}");
        }
        assert_eq!(at, behind);
        assert_eq!(Flock::of(&[]).radius, 0.0);
    }
}
