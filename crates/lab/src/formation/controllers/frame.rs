//! Formations in a frame that goes along the path with the targets: open in front (piloting), or closed about them (caging).

use super::flock::{Flock, held, signed};
use super::{Controller, Scene};
use crate::form;
use space::Vector;
use terrain::Point;

/// Largest rate at which the frame turns, rad/time.
const TURN: f64 = 0.4;

form! {
    /// Robots about a frame, open in front.
    pub struct Piloting {
        /// How many robots.
        robots: usize = [8usize], "1", Within(1.0, 1000.0);
        /// Their distance from the middle of the frame.
        radius: f64 = [1.0], "length", Positive;
        /// Angle in front that is open.
        open: f64 = [140.0], "deg", Within(0.0, 350.0);
        /// Speed of the frame.
        speed: f64 = [0.4], "length/time", Positive;
        /// The frame waits while the middle of the targets is farther behind.
        slack: f64 = [0.2], "length", Positive;
    }
}

form! {
    /// Robots on a ring about a frame.
    pub struct Caging {
        /// How many robots.
        robots: usize = [10usize], "1", Within(3.0, 1000.0);
        /// Radius of the ring.
        radius: f64 = [1.0], "length", Positive;
        /// Speed of the frame.
        speed: f64 = [0.25], "length/time", Positive;
        /// The frame waits while the middle of the targets is farther behind.
        slack: f64 = [0.2], "length", Positive;
    }
}

impl Piloting {
    pub(super) fn controller(&self) -> Frame {
        Frame::new(self.robots, self.radius, self.open.to_radians(), self.speed, self.slack)
    }
}

impl Caging {
    pub(super) fn controller(&self) -> Frame {
        Frame::new(self.robots, self.radius, 0.0, self.speed, self.slack)
    }
}

/// A frame with posts, in one trial.
#[derive(Clone, Debug)]
pub struct Frame {
    robots: usize,
    radius: f64,
    open: f64,
    speed: f64,
    slack: f64,
    /// Way of the frame along the path.
    come: f64,
    heading: f64,
    time: f64,
}

impl Frame {
    fn new(robots: usize, radius: f64, open: f64, speed: f64, slack: f64) -> Self {
        Self { robots, radius, open, speed, slack, come: 0.0, heading: 0.0, time: 0.0 }
    }
    /// The posts: evenly over the ring without what is open in front.
    fn posts(&self, centre: Point) -> Vec<Point> {
        let closed = std::f64::consts::TAU - self.open;
        // a whole ring has no ends, an arc has one post at each
        let parts = if self.open > 0.0 { self.robots.saturating_sub(1) } else { self.robots }.max(1) as f64;
        let angle = |k: usize| self.heading + self.open / 2.0 + closed * k as f64 / parts;
        (0..self.robots).map(|k| centre + Vector::at_angle(angle(k)) * self.radius).collect()
    }
}

impl Controller for Frame {
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        self.heading = scene.task.way(0).angle();
        self.posts(scene.task.path[0]).into_iter().map(|post| held(post, scene)).collect()
    }
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        let dt = scene.time - self.time;
        self.time = scene.time;
        let (centre, leg) = scene.task.along(self.come);
        let way = scene.task.way(leg);
        let lag = (centre - Flock::of(scene.targets).centre).dot(way);
        let turn = signed(self.heading, way.angle());
        self.heading += turn.clamp(-TURN * dt, TURN * dt);
        // it goes on once the targets are there and it faces its way
        if lag <= self.slack && turn.abs() < 0.5 {
            self.come += self.speed * dt;
        }
        let (centre, _) = scene.task.along(self.come);
        self.posts(centre).into_iter().map(|post| held(post, scene)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn posts_are_on_the_ring_and_the_front_is_open() {
        let mut frame = Frame::new(5, 2.0, std::f64::consts::PI, 0.1, 0.1);
        let posts = frame.posts(Vector([1.0, 0.0]));
        assert!(
            posts
                .iter()
                .all(|post| post[0] <= 1.0 + 1e-9 && ((*post - Vector([1.0, 0.0])).length() - 2.0).abs() < 1e-12)
        );
        assert!((posts[0] - Vector([1.0, 2.0])).length() < 1e-9 && (posts[4] - Vector([1.0, -2.0])).length() < 1e-9);
        frame.open = 0.0;
        let ring = frame.posts(Vector([0.0, 0.0]));
        let sum = ring.iter().fold(Vector::ZERO, |sum, &post| sum + post);
        assert!(sum.length() < 1e-9, "evenly all round");
    }
}
