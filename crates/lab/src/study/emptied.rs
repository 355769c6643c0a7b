//! How long it takes until a box is empty.

use super::trial::{Look, Reader};
use crate::form;
use space::Vector;
use swarm::World;
use swarm::parameters::Scalar;

form! {
    /// The time until so many living members or fewer are in a box along the axes, its edges included: how long it takes to leave a room.
    /// Nothing where it never comes to that.
    pub struct EmptiedReading {
        /// Lower corner.
        low: Vec<f64> = need, "length", Any;
        /// Upper corner.
        high: Vec<f64> = need, "length", Any;
        /// How many may be left.
        left: usize = [0usize], "1", NonNegative;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
    }
}

pub(super) struct Emptied {
    reading: EmptiedReading,
    group: Option<usize>,
    time: Option<f64>,
}

impl Emptied {
    pub(super) fn new(reading: &EmptiedReading, group: Option<usize>) -> Self {
        Self { reading: reading.clone(), group, time: None }
    }
    /// How many of these are in the box.
    fn inside<const D: usize>(&self, places: impl Iterator<Item = Vector<f64, D>>) -> usize {
        let EmptiedReading { low, high, .. } = &self.reading;
        places.filter(|place| (0..D).all(|a| (low[a]..=high[a]).contains(&place.0[a]))).count()
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Emptied {
    fn look(&mut self, _: &Look<'_, R, D>) {}
    fn steps(&self) -> bool {
        true
    }
    fn step(&mut self, world: &World<R, D>) {
        if self.time.is_some() {
            return;
        }
        let frame = world.frame();
        let ids =
            self.group.map(|group| frame.groups[group].first..frame.groups[group].first + frame.groups[group].count);
        let counts = |&row: &usize| {
            ids.as_ref().is_none_or(|ids| ids.contains(&frame.columns.id[row]))
                && world.mortality().is_none_or(|health| frame.columns.state[health][row] > R::ZERO)
        };
        let rows = (0..frame.columns.len()).filter(counts);
        if self.inside(rows.map(|row| Vector(frame.columns.position(row).0.map(R::to_f64)))) <= self.reading.left {
            self.time = Some(world.time());
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.time.map(|time| self.reading.scale * time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::Space;
    use std::collections::BTreeMap;
    use swarm::WorldPlan;
    use swarm::engine::{GroupPlan, Placement, Start};
    use swarm::parameters::Values;

    /// The time until at most so many of two are left of x = 2: both go right at a speed of 1, from 0 and from 1.
    fn emptied(left: usize, steps: usize) -> Option<f64> {
        let position = vec![Vector([0.0, 0.0]), Vector([1.0, 5.0])];
        let velocity = Some(vec![Vector([1.0, 0.0]); 2]);
        let placement = Placement::Given(Start { position, velocity, columns: BTreeMap::new() });
        let values = Values::from([("speed".to_owned(), 1.0.into()), ("time_step".to_owned(), 0.25.into())]);
        let plan =
            WorldPlan::new(Space::<f64, 2>::open(), GroupPlan::new("points", "vicsek_1995", values, 2, placement));
        let mut world = World::new(plan).ok()?;
        let [low, high] = [vec![-1.0, -1.0], vec![2.0, 9.0]];
        let mut emptied = Emptied::new(&EmptiedReading { low, high, left, scale: 2.0, group: None }, None);
        for _ in 0..steps {
            world.step();
            Reader::<f64, 2>::step(&mut emptied, &world);
        }
        emptied.value(&world)
    }

    #[test]
    fn two_that_leave() {
        // the edge is inside: at 2.25, a quarter after they came to it
        assert_eq!(emptied(1, 20), Some(2.0 * 1.25));
        assert_eq!(emptied(0, 20), Some(2.0 * 2.25));
        assert_eq!(emptied(0, 8), None);
    }
}
