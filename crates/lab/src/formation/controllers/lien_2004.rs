//! One shepherd at steering points. J.-M. Lien, O. B. Bayazit, R. T. Sowell, S. Rodriguez, N. M. Amato (2004). Shepherding behaviors. IEEE
//! International Conference on Robotics and Automation, 4159-4164. doi:10.1109/ROBOT.2004.1308924
//!
//! Milestones are the corners of the path (with nothing in the way, the roadmap is the path). The steering point lies behind the flock
//! opposite the next milestone; it is approached along a safe zone about the flock, and driven at straight or from side to side.

use super::flock::{Flock, held, row};
use super::{Controller, Scene};
use crate::{form, words};
use terrain::Point;

words! {
    /// How a flock is driven.
    pub enum Drive {
        /// From behind.
        Straight = "straight",
        /// From both sides in turn.
        SideToSide = "side_to_side",
    }
}

form! {
    /// One shepherd at steering points.
    pub struct Lien2004 {
        /// Gap between the flock's boundary and the steering point.
        margin: f64 = [0.35], "length", NonNegative;
        /// Gap between the flock's boundary and the safe zone.
        safe_zone: f64 = [0.8], "length", NonNegative;
        /// How the flock is driven.
        drive: Drive = [Drive::SideToSide], "", Any;
        /// Distance to either side of the straight way, in radii of the flock.
        side: f64 = [0.7], "1", NonNegative;
    }
}

/// The shepherd of one trial.
#[derive(Clone, Debug)]
pub struct Driving {
    form: Lien2004,
    left: bool,
}

impl Driving {
    pub(super) fn new(form: &Lien2004) -> Self {
        Self { form: form.clone(), left: true }
    }
}

impl Controller for Driving {
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        row(scene, 1, 0.0)
    }
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        let flock = Flock::of(scene.targets);
        let Some(&robot) = scene.robots.first() else { return Vec::new() };
        let mut steering = flock.behind(scene.milestone(), self.form.margin);
        if self.form.drive == Drive::SideToSide {
            let across = (scene.milestone() - flock.centre).unit().left() * (self.form.side * flock.radius);
            let point = |left: bool| if left { steering + across } else { steering - across };
            if (robot - point(self.left)).length() < 0.2 {
                self.left = !self.left;
            }
            steering = point(self.left);
        }
        vec![held(flock.approach(robot, steering, self.form.safe_zone), scene)]
    }
}
