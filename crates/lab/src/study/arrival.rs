//! Who comes to a place, and when.

use super::form::{ArrivalQuantity, ArrivalReading};
use super::trial::{Look, Reader};
use space::Vector;
use std::collections::BTreeSet;
use swarm::World;
use swarm::parameters::Scalar;

/// Who has come so far.
pub(super) struct Arrival {
    reading: ArrivalReading,
    group: Option<usize>,
    members: usize,
    /// Ids of those who have come.
    come: BTreeSet<usize>,
    /// How many are there at the last look.
    there: usize,
    /// When so many had come.
    time: Option<f64>,
}

impl Arrival {
    pub(super) fn new(reading: &ArrivalReading, group: Option<usize>) -> Self {
        Self { reading: reading.clone(), group, members: 0, come: BTreeSet::new(), there: 0, time: None }
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Arrival {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        let at: Vector<f64, D> = Vector::of(&self.reading.at);
        let members = look.members(self.group);
        let near = |&&k: &&usize| look.space.offset(look.positions[k], at).length() < self.reading.within;
        let there: Vec<usize> = members.iter().filter(near).map(|&k| look.ids[k]).collect();
        self.there = there.len();
        self.come.extend(there);
        let frame = look.world.frame();
        self.members = self.group.map_or(frame.columns.len(), |group| frame.groups[group].count as usize);
        // a share of 0.3 of 10 is 3, whatever rounding makes of it
        let needed = self.reading.part * self.members as f64 - 1e-9;
        if self.time.is_none() && self.members > 0 && self.come.len() as f64 >= needed {
            self.time = Some(look.world.time());
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        let share = |count: usize| (self.members > 0).then(|| count as f64 / self.members as f64);
        let value = match self.reading.quantity {
            ArrivalQuantity::Share => share(self.come.len()),
            ArrivalQuantity::There => share(self.there),
            ArrivalQuantity::Time => self.time,
        };
        value.map(|value| self.reading.scale * value)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]
mod tests {
    use crate::study;

    const FILE: &str = r#"
kind = "study"
title = "Two who walk on"
trials = 1
[looks]
interval = 1
[scenario]
time.duration = 11
space = { dimensions = 2, edges = "open" }
[scenario.stimulus.lamp.point]
at = [1000, 0]
length = 100
[scenario.group.lead]
count = 1
model.vicsek_1995 = { noise_amplitude = 0, speed = 1, radius = 0.5 }
start = { place.points = [[0, 0]], heading.along = [1, 0] }
taxis.up = "lamp"
[scenario.group.tail]
count = 1
model.vicsek_1995 = { noise_amplitude = 0, speed = 1, radius = 0.5 }
start = { place.points = [[-4, 0]], heading.along = [1, 0] }
[reading.come]
of.arrival = { quantity = "share", at = [10, 0], within = 2 }
[reading.there]
of.arrival = { quantity = "there", at = [10, 0], within = 2, group = "lead", scale = 100 }
[reading.time]
of.arrival = { quantity = "time", at = [10, 0], within = 2 }
[reading.never]
of.arrival = { quantity = "time", at = [10, 0], within = 2, part = 1 }
[reading.ahead]
of.standing = { quantity = "ahead", linking_distance = 5, group = "lead" }
[reading.behind]
of.standing = { quantity = "ahead", linking_distance = 5, group = "tail" }
[reading.far]
of.standing = { quantity = "distance", linking_distance = 5 }
[reading.turned]
of.transfer = { quantity = "share", column = "informed" }
[reading.delay]
of.transfer = { quantity = "delay", column = "informed" }
"#;

    #[test]
    fn what_two_who_walk_on_leave() {
        let mut none = |_: &str| Err("no other file".to_owned());
        let plan = study::read("file", FILE, &[], false, &mut none).unwrap();
        let values = study::trial::run(&plan, &plan.conditions[0], 1, &|| false).unwrap().unwrap();
        let of = |name: &str| values[plan.readings.iter().position(|(own, _)| own == name).unwrap()];
        // the first is nearer than 2 from the ninth look on, and still so at the eleventh; the other comes to 3
        assert_eq!((of("come"), of("there"), of("time")), (0.5, 100.0, 9.0));
        assert!(of("never").is_nan());
        assert!(
            (of("ahead") - 1.0).abs() < 1e-9 && (of("behind") + 1.0).abs() < 1e-9 && (of("far") - 1.0).abs() < 1e-9
        );
        assert_eq!(of("turned"), 0.0);
        assert!(of("delay").is_nan());
        let wrong = FILE.replacen("at = [10, 0]", "at = [10, 0, 0]", 1);
        let problems = study::read("file", &wrong, &[], false, &mut none).expect_err("three coordinates").to_string();
        assert!(problems.contains("3 coordinates in 2 dimensions"), "{problems}");
        let wrong = FILE.replacen("column = \"informed\"", "column = \"informd\"", 1);
        let problems = study::read("file", &wrong, &[], false, &mut none).expect_err("no column").to_string();
        assert!(problems.contains("did you mean `informed`?"), "{problems}");
    }
}
