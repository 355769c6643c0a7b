//! One robot behind the flock. R. Vaughan, N. Sumpter, J. Henderson, A. Frost, S. Cameron (2000). Experiments in automatic flock
//! control. Robotics and Autonomous Systems 31, 109-117. doi:10.1016/S0921-8890(99)00084-6
//!
//! The robot sees the flock's centroid F and radius alone. It is drawn to F in proportion to the distance and pushed away from the goal
//! G, so that it settles behind the flock as seen from G; near the flock's boundary it is held off. Gains and standoff are ours.

use super::flock::{Flock, held, row};
use super::{Controller, Scene};
use crate::form;
use terrain::Point;

form! {
    /// One robot behind the flock.
    pub struct Vaughan2000 {
        /// Gain of the way to the flock.
        to_flock: f64 = [1.0], "1/time", NonNegative;
        /// Strength of the way away from the goal.
        from_goal: f64 = [1.2], "length/time", NonNegative;
        /// Distance from the flock's boundary below which it is held off.
        standoff: f64 = [0.7], "length", Positive;
        /// Strength with which it is held off at the boundary.
        hold_off: f64 = [2.0], "length/time", NonNegative;
    }
}

impl Vaughan2000 {
    /// The wanted velocity of a robot at a place.
    pub fn velocity(&self, robot: Point, flock: Flock, goal: Point) -> Point {
        let to = flock.centre - robot;
        let gap = to.length() - flock.radius;
        let near = ((self.standoff - gap) / self.standoff).max(0.0);
        to * self.to_flock - (goal - robot).unit() * self.from_goal - to.unit() * (self.hold_off * near)
    }
}

impl Controller for Vaughan2000 {
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        row(scene, 1, 0.0)
    }
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        let flock = Flock::of(scene.targets);
        let goal = |&robot: &Point| held(robot + self.velocity(robot, flock, scene.milestone()), scene);
        scene.robots.iter().map(goal).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::Vector;

    #[test]
    fn the_robot_settles_behind_the_flock() {
        let form = Vaughan2000 { to_flock: 1.0, from_goal: 1.2, standoff: 0.7, hold_off: 2.0 };
        let (flock, goal) = (Flock { centre: Vector([0.0, 0.0]), radius: 0.5 }, Vector([4.0, 0.0]));
        let mut at = Vector([1.0, 2.0]);
        for _ in 0..2000 {
            at += form.velocity(at, flock, goal) * 0.01;
        }
        assert!(at[0] < -0.5 && at[1].abs() < 0.05, "{at:?}");
        assert!(form.velocity(at, flock, goal).length() < 0.01);
    }
}
