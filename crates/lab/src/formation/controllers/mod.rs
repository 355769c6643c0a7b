//! What brings targets along: one file and one line of the list each. From the list come the file's keys, the schema and the reference.

mod flock;
pub mod formation;
pub mod frame;
pub mod lien_2004;
pub mod lien_2005;
pub mod pierson_schwager_2015;
pub mod posts;
pub mod vaughan_2000;
pub mod walls;

use super::task::{Progress, Task, Wall};
use crate::file::Nothing;
use crate::tagged;
use terrain::Point;

pub use flock::Flock;

/// What a controller knows at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The task.
    pub task: &'a Task,
    /// How far each target has come.
    pub progress: &'a Progress,
    /// Where the targets are.
    pub targets: &'a [Point],
    /// Where the shepherds are.
    pub robots: &'a [Point],
    /// Radius of a target's body, and of a shepherd's.
    pub radii: (f64, f64),
    /// The box in which to stay.
    pub bounds: Option<(Point, Point)>,
    /// Time since the start.
    pub time: f64,
}

impl Scene<'_> {
    /// The point that the slower half of the targets is to reach next.
    pub fn milestone(&self) -> Point {
        self.task.path[self.progress.leg() + 1]
    }
}

/// Tells shepherds where to be.
pub trait Controller: Send {
    /// Where the shepherds begin; none where walls alone do it.
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point>;
    /// Where each is wanted now. Called once a period, in order of time.
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point>;
    /// Whether a wall of the task is there now; asked after `begin` or `goals`.
    fn stands(&self, wall: usize) -> bool {
        let _ = wall;
        false
    }
    /// The posts at which its robots come to stand, of all walls; none where robots do not stand in the places of walls.
    fn posts(&self) -> Vec<Point> {
        Vec::new()
    }
    /// Is told to go on to the next walls at a time that is not over. All times at which it is told to, in order; none where it is no
    /// formation.
    fn switch_at(&mut self, time: f64) -> Option<Vec<f64>> {
        let _ = time;
        None
    }
}

tagged! {
    /// What brings the targets along.
    pub enum By {
        /// Nothing: the control.
        nothing => Nothing(Nothing);
        /// The walls of the task. A timed task's are there only while they are needed.
        walls => Walls(walls::Walls);
        /// Robots that rest at posts along every wall.
        posts => Posts(posts::Posts);
        /// The walls that posts stand for: the way back from robots to an environment.
        restored => Restored(posts::Restored);
        /// Robots at posts along a few walls, which go to the next wall when the targets have cleared one.
        formation => Formation(formation::FormationForm);
        /// Robots about a frame that goes along the path, open in front: they push from behind and at the sides.
        piloting => Piloting(frame::Piloting);
        /// Robots on a ring about a frame that goes along the path.
        caging => Caging(frame::Caging);
        /// One robot behind the flock (Vaughan and others 2000).
        vaughan_2000 => Vaughan2000(vaughan_2000::Vaughan2000);
        /// One shepherd at steering points of milestones (Lien and others 2004).
        lien_2004 => Lien2004(lien_2004::Lien2004);
        /// Several shepherds on a line or arc behind the flock (Lien and others 2005).
        lien_2005 => Lien2005(lien_2005::Lien2005);
        /// Robots on an arc that steer the herd like a unicycle (Pierson and Schwager 2015).
        pierson_schwager_2015 => PiersonSchwager2015(pierson_schwager_2015::PiersonSchwager2015);
    }
}

impl By {
    /// The controller of one trial of a task with these walls.
    pub fn controller(&self, task: &Task, walls: &[Wall], timed: bool) -> Box<dyn Controller> {
        match self {
            Self::Nothing(_) => Box::new(walls::Standing::new(task, walls, &walls::Walls::default(), Some(0..0))),
            Self::Walls(form) => {
                let all = if timed { None } else { Some(0..walls.len()) };
                Box::new(walls::Standing::new(task, walls, form, all))
            }
            Self::Posts(form) => Box::new(posts::Resting::new(form, walls)),
            Self::Restored(_) => {
                Box::new(walls::Standing::new(task, walls, &walls::Walls::default(), Some(0..usize::MAX)))
            }
            Self::Formation(form) => Box::new(formation::Switching::new(form, task, walls)),
            Self::Piloting(form) => Box::new(form.controller()),
            Self::Caging(form) => Box::new(form.controller()),
            Self::Vaughan2000(form) => Box::new(form.clone()),
            Self::Lien2004(form) => Box::new(lien_2004::Driving::new(form)),
            Self::Lien2005(form) => Box::new(form.clone()),
            Self::PiersonSchwager2015(form) => Box::new(pierson_schwager_2015::Steering::new(form, task)),
        }
    }
    /// Whether it goes from wall to wall.
    pub fn goes_on(&self) -> bool {
        matches!(self, Self::Formation(_))
    }
    /// Whether somebody has to say when it goes on, since the file does not.
    pub fn waits(&self) -> bool {
        matches!(self, Self::Formation(form) if form.waits())
    }
    /// Whether it needs walls of the task.
    pub fn needs_walls(&self) -> bool {
        matches!(self, Self::Walls(_) | Self::Posts(_) | Self::Restored(_) | Self::Formation(_))
    }
    /// The walls as they stand in the world, in the order in which the path comes by.
    pub fn walls(&self, task: &Task, walls: &[Wall]) -> Vec<Wall> {
        let walls = task.ordered(walls);
        if let Self::Restored(form) = self { form.restored(&walls) } else { walls }
    }
}
