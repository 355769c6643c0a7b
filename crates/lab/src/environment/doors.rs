//! Doors: walls that go away, or come, when the group has done something.

use super::behaviour::{Around, ConditionForm};
use super::trial::obstacles;
use super::workspace::segment;
use crate::form;
use crate::scenario::build::Wrong;
use crate::scenario::surroundings::Obstacle;
use measure::behaviours::{Behaviour, Condition, Moment, Score, Watch};
use space::Segment;
use terrain::Geometry;

form! {
    /// A door: a wall that is not always there. It opens or shuts before the step after the one in which its condition came to
    /// hold.
    pub struct DoorForm {
        /// Where it is while it is shut, [x0, y0, x1, y1].
        wall: Vec<f64> = need, "length", Any;
        /// It is shut until this holds; left out, it begins open.
        opens: Option<ConditionForm> = none, "", Any;
        /// It is open until this holds, and then shut for good; where it opens first, steps are counted from the step after.
        shuts: Option<ConditionForm> = none, "", Any;
    }
}

/// A door.
#[derive(Clone, Debug, PartialEq)]
pub struct Door {
    /// Where it is while it is shut.
    pub wall: Segment,
    /// It is shut until this holds; none: it begins open.
    pub opens: Option<Behaviour>,
    /// From when it is open: until this holds; none: it stays open.
    pub shuts: Option<Behaviour>,
}

/// A door that has opened or shut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Which one.
    pub door: usize,
    /// When: the time of the step in which its condition held.
    pub time: f64,
    /// Whether it is shut from then on.
    pub shut: bool,
}

impl DoorForm {
    /// The wall in its frame.
    ///
    /// # Errors
    /// Neither of its conditions; a wall that is none.
    pub fn wall(&self) -> Result<Segment, Wrong> {
        if self.opens.is_none() && self.shuts.is_none() {
            return Err(Wrong::new("wall", "the door neither opens nor shuts", "`opens`, `shuts` or both"));
        }
        let wall = segment(&self.wall, "wall")?;
        if wall.from == wall.to {
            return Err(Wrong::new("wall", "the door has no length", "two different ends"));
        }
        Ok(wall)
    }
    /// The door at a place, with conditions over what is there. Wrongs carry paths below it.
    ///
    /// # Errors
    /// Signals and names that are not there.
    pub fn door(&self, name: &str, wall: Segment, around: Around<'_>) -> Result<Door, Wrong> {
        let condition = |form: &Option<ConditionForm>, key: &str| {
            let plain = form.as_ref().map(|form| form.plain(around)).transpose();
            let behaviour = |condition: Condition| Behaviour { name: name.to_owned(), score: Score::Binary(condition) };
            plain.map(|condition| condition.map(behaviour)).map_err(|wrong| wrong.below(key))
        };
        Ok(Door { wall, opens: condition(&self.opens, "opens")?, shuts: condition(&self.shuts, "shuts")? })
    }
}

impl Door {
    /// Whether it is shut at the start.
    pub fn begins_shut(&self) -> bool {
        self.opens.is_some()
    }
    /// The door in a scenario that tells when it moved: the obstacles that are there while it is shut.
    pub fn written(&self, moved: impl Iterator<Item = Moved>) -> Vec<Obstacle> {
        let wall = Geometry::Wall(self.wall);
        let shut = || obstacles([&wall]);
        let mut all = if self.begins_shut() { shut() } else { Vec::new() };
        for moved in moved {
            if moved.shut {
                all.extend(shut().into_iter().map(|door| Obstacle { appears: Some(moved.time), ..door }));
            } else if let Some(door) = all.last_mut() {
                door.disappears = Some(moved.time);
            }
        }
        all
    }
}

/// Doors that are followed step by step.
pub struct Guarded<'a> {
    doors: &'a [Door],
    /// What each waits for; none where it moves no more.
    watches: Vec<Option<Watch>>,
    shut: Vec<bool>,
    /// What has moved.
    pub moved: Vec<Moved>,
}

impl<'a> Guarded<'a> {
    /// Begins to follow a group.
    pub fn new(doors: &'a [Door]) -> Self {
        let first = |door: &Door| door.opens.as_ref().or(door.shuts.as_ref()).map(Behaviour::watch);
        let watches = doors.iter().map(first).collect();
        Self { doors, watches, shut: doors.iter().map(Door::begins_shut).collect(), moved: Vec::new() }
    }
    /// Takes the next moment; which doors move now, and whether they are shut from here on.
    pub fn step(&mut self, moment: &Moment<'_>, time: f64) -> Vec<(usize, bool)> {
        let mut now = Vec::new();
        for (k, (door, watch)) in self.doors.iter().zip(&mut self.watches).enumerate() {
            let Some(waiting) = watch else { continue };
            waiting.step(moment);
            if waiting.fitness() < 1.0 {
                continue;
            }
            let shut = !self.shut[k];
            self.shut[k] = shut;
            now.push((k, shut));
            self.moved.push(Moved { door: k, time, shut });
            *watch = if shut { None } else { door.shuts.as_ref().map(Behaviour::watch) };
        }
        now
    }
}
