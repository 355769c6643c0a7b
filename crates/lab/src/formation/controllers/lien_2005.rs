//! Several shepherds behind the flock. J.-M. Lien, S. Rodriguez, J.-P. Malric, N. M. Amato (2005). Shepherding behaviors with multiple
//! shepherds. IEEE International Conference on Robotics and Automation, 3402-3407. doi:10.1109/ROBOT.2005.1570636
//!
//! Steering points lie on a line or an arc behind the flock; who goes to which is by least total distance. A member that has strayed
//! may be brought back by one of them first.

use super::flock::{Flock, held, row};
use super::{Controller, Scene};
use crate::{form, words};
use space::Vector;
use terrain::Point;
use terrain::posts::assign_to_posts;

words! {
    /// How steering points lie behind the flock.
    pub enum Steering {
        /// On a line across its way.
        Line = "line",
        /// On an arc about it.
        Arc = "arc",
    }
}

form! {
    /// Several shepherds behind the flock.
    pub struct Lien2005 {
        /// How many shepherds.
        robots: usize = [3usize], "1", Within(1.0, 100.0);
        /// How steering points lie.
        steering: Steering = [Steering::Arc], "", Any;
        /// Gap between the flock's boundary and the steering points.
        margin: f64 = [0.35], "length", NonNegative;
        /// Gap between the flock's boundary and the safe zone.
        safe_zone: f64 = [0.8], "length", NonNegative;
        /// Angle of the whole arc, or what the line is seen under from the flock's middle.
        spread: f64 = [140.0], "deg", Within(0.0, 300.0);
        /// A member this far from the flock's middle is brought back first; left out, none is.
        regroup: Option<f64> = none, "length", Positive;
    }
}

impl Lien2005 {
    /// The steering points.
    pub fn steering_points(&self, flock: Flock, to: Point) -> Vec<Point> {
        let back = (flock.centre - to).unit_or(Vector([-1.0, 0.0]));
        let reach = flock.radius + self.margin;
        let spread = self.spread.to_radians();
        let share = |k: usize| if self.robots > 1 { k as f64 / (self.robots - 1) as f64 - 0.5 } else { 0.0 };
        let point = |k: usize| match self.steering {
            Steering::Arc => flock.centre + Vector::at_angle(back.angle() + spread * share(k)) * reach,
            Steering::Line => {
                let half = reach * (spread.min(2.6) / 2.0).tan();
                flock.centre + back * reach + back.left() * (2.0 * half * share(k))
            }
        };
        (0..self.robots).map(point).collect()
    }
}

impl Controller for Lien2005 {
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        row(scene, self.robots, 0.5)
    }
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        let flock = Flock::of(scene.targets);
        let mut points = self.steering_points(flock, scene.milestone());
        let far = |target: &&Point| self.regroup.is_some_and(|far| (**target - flock.centre).length() > far);
        let farthest = scene
            .targets
            .iter()
            .filter(far)
            .max_by(|a, b| (**a - flock.centre).length().total_cmp(&(**b - flock.centre).length()));
        if let (Some(&stray), Some(first)) = (farthest, points.first_mut()) {
            *first = stray + (stray - flock.centre).unit() * (scene.radii.0 + scene.radii.1 + self.margin);
        }
        let chosen = assign_to_posts(scene.robots, &points).map_or_else(|_| Vec::new(), |(_, chosen)| chosen);
        let goal = |(robot, post): (&Point, Option<usize>)| {
            let steering = post.map_or(*robot, |post| points[post]);
            held(flock.approach(*robot, steering, self.safe_zone), scene)
        };
        scene.robots.iter().zip(chosen).map(goal).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steering_points_lie_behind() {
        let flock = Flock { centre: Vector([0.0, 0.0]), radius: 1.0 };
        for steering in [Steering::Line, Steering::Arc] {
            let form = Lien2005 { robots: 3, steering, margin: 0.5, safe_zone: 1.0, spread: 90.0, regroup: None };
            let points = form.steering_points(flock, Vector([5.0, 0.0]));
            assert!((points[1] - Vector([-1.5, 0.0])).length() < 1e-12);
            assert!(points.iter().all(|point| point[0] < -1.0));
            assert!((points[0][1] + points[2][1]).abs() < 1e-12 && points[0][1].abs() > 1.0);
        }
    }
}
