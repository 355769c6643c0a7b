//! Robots on an arc that steer the herd like a unicycle. A. Pierson, M. Schwager (2015). Bio-inspired non-cooperative multi-robot herding. IEEE
//! International Conference on Robotics and Automation, 1843-1849. doi:10.1109/ICRA.2015.7139438
//!
//! m robots stand about the herd's mean at the angles phi + pi + Delta (2j - m - 1)/(2m - 2). Under repulsion of 1/r^2 the herd then
//! moves along phi with the speed sin(m Delta/(2m-2)) / (r^2 sin(Delta/(2m-2))): a unicycle, of which a point ahead is steered to
//! the goal; Delta follows from the wanted speed.

use super::flock::{Flock, held, signed};
use super::{Controller, Scene};
use crate::form;
use crate::formation::task::Task;
use space::Vector;
use terrain::Point;

/// Halvings in which the speed is inverted.
const HALVINGS: usize = 60;

form! {
    /// Robots on an arc.
    pub struct PiersonSchwager2015 {
        /// How many robots.
        robots: usize = [4usize], "1", Within(2.0, 100.0);
        /// Gap between the herd's boundary and the arc.
        margin: f64 = [0.35], "length", NonNegative;
        /// Distance ahead of the mean of the point that is steered.
        ahead: f64 = [0.5], "length", Positive;
        /// Gain of the way to the goal.
        gain: f64 = [0.5], "1/time", Positive;
    }
}

/// The herd's speed in units of 1/r^2 for a spread of the arc.
pub fn speed(robots: usize, spread: f64) -> f64 {
    let (m, part) = (robots as f64, spread / (2 * robots - 2) as f64);
    if part.abs() < 1e-9 { m } else { (m * part).sin() / part.sin() }
}

/// The spread at which the herd has a speed in units of 1/r^2: 0 for the greatest, all round for none.
pub fn spread(robots: usize, wanted: f64) -> f64 {
    let round = std::f64::consts::TAU * (robots - 1) as f64 / robots as f64;
    let (mut low, mut high) = (0.0, round);
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        // the speed falls from m to 0 as the arc closes
        if speed(robots, middle) > wanted { low = middle } else { high = middle }
    }
    (low + high) / 2.0
}

/// The arc of one trial.
#[derive(Clone, Debug)]
pub struct Steering {
    form: PiersonSchwager2015,
    heading: f64,
    time: f64,
}

impl Steering {
    pub(super) fn new(form: &PiersonSchwager2015, task: &Task) -> Self {
        Self { form: form.clone(), heading: task.way(0).angle(), time: 0.0 }
    }
    fn places(&self, centre: Point, radius: f64, spread: f64) -> Vec<Point> {
        let m = self.form.robots;
        let angle = |j: usize| {
            let share = (2.0 * j as f64 - m as f64 - 1.0) / (2 * m - 2) as f64;
            self.heading + std::f64::consts::PI + spread * share
        };
        (1..=m).map(|j| centre + Vector::at_angle(angle(j)) * radius).collect()
    }
}

impl Controller for Steering {
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        let radius = scene.task.start_radius + scene.radii.0 + scene.radii.1 + self.form.margin;
        let places = self.places(scene.task.path[0], radius, std::f64::consts::PI);
        places.into_iter().map(|place| held(place, scene)).collect()
    }
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        let dt = scene.time - self.time;
        self.time = scene.time;
        let herd = Flock::of(scene.targets);
        let radius = herd.radius + scene.radii.0 + scene.radii.1 + self.form.margin;
        let facing = Vector::at_angle(self.heading);
        let wanted = (scene.milestone() - (herd.centre + facing * self.form.ahead)) * self.form.gain;
        let speed = wanted.dot(facing).max(0.0);
        self.heading = signed(0.0, self.heading + wanted.dot(facing.left()) / self.form.ahead * dt);
        let spread = spread(self.form.robots, speed * radius * radius);
        let places = self.places(herd.centre, radius, spread);
        places.into_iter().map(|place| held(place, scene)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_over_the_arc_is_the_speed() {
        for m in 2..7 {
            let form = PiersonSchwager2015 { robots: m, margin: 0.0, ahead: 1.0, gain: 1.0 };
            let steering = Steering { form, heading: 0.7, time: 0.0 };
            for spread in [0.0, 0.4, 1.5, 3.0] {
                let places = steering.places(Vector([2.0, 1.0]), 1.0, spread);
                // each pushes away from itself with strength 1
                let push = places.iter().fold(Vector::ZERO, |sum, &place| sum + (Vector([2.0, 1.0]) - place));
                assert!((push - Vector::at_angle(0.7) * speed(m, spread)).length() < 1e-9, "{m} {spread}");
                assert!((super::spread(m, speed(m, spread)) - spread).abs() < 1e-6, "{m} {spread}");
            }
            assert!(super::spread(m, 99.0) < 1e-9 && speed(m, super::spread(m, 0.0)).abs() < 1e-6);
        }
    }
}
