//! Walls that stand all the time, or only while they are needed.

use super::{Controller, Scene};
use crate::form;
use crate::formation::task::{Task, Wall};
use core::ops::Range;
use terrain::Point;

form! {
    /// Walls.
    pub struct Walls {
        /// Of a timed task: legs ahead of the targets whose walls are there already.
        ahead: usize = [1usize], "1", Within(0.0, 100.0);
    }
}

impl Default for Walls {
    fn default() -> Self {
        Self { ahead: 1 }
    }
}

/// The walls of one trial.
#[derive(Clone, Debug)]
pub struct Standing {
    legs: Vec<usize>,
    ahead: usize,
    /// The walls that stand all the time; none where time tells.
    always: Option<Range<usize>>,
    leg: usize,
    last: usize,
}

impl Standing {
    pub(super) fn new(task: &Task, walls: &[Wall], form: &Walls, always: Option<Range<usize>>) -> Self {
        let legs = walls.iter().map(|wall| wall.leg).collect();
        Self { legs, ahead: form.ahead, always, leg: 0, last: task.legs() - 1 }
    }
}

impl Controller for Standing {
    fn begin(&mut self, _: &Scene<'_>) -> Vec<Point> {
        Vec::new()
    }
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        // a wall goes for good once every target has left its leg
        let slowest = scene.progress.done.iter().copied().min().unwrap_or(0).min(self.last);
        self.leg = self.leg.max(slowest);
        Vec::new()
    }
    fn stands(&self, wall: usize) -> bool {
        match &self.always {
            Some(always) => always.contains(&wall),
            None => self.legs.get(wall).is_some_and(|leg| (self.leg..=self.leg + self.ahead).contains(leg)),
        }
    }
}
