//! What is read off the food of a trial: who eats, how soon, and who wins where two groups are near.

use super::form::{FoodQuantity, FoodReading};
use space::Vector;
use swarm::World;
use swarm::parameters::Scalar;

/// What is known of the meals of a group so far.
#[derive(Clone, Debug)]
pub(super) struct Meals<R, const D: usize> {
    reading: FoodReading,
    /// The group, by index; none for everyone.
    group: Option<usize>,
    /// Where each item was before the step, and the step in which it appeared there.
    items: Vec<(Vector<R, D>, u64)>,
    eaten: u64,
    /// Steps from the appearance of an item to its consumption, summed.
    waited: u64,
    contested: u64,
    won: u64,
}

impl<R: Scalar, const D: usize> Meals<R, D> {
    /// Of a world at its start.
    ///
    /// # Errors
    /// A world without food, or without the group.
    pub(super) fn new(reading: &FoodReading, world: &World<R, D>) -> Result<Self, String> {
        let resources = world.resources().ok_or("there is no food")?;
        let group = match &reading.group {
            None => None,
            Some(name) => {
                let found = world.frame().groups.iter().position(|group| group.name == *name);
                Some(found.ok_or_else(|| format!("there is no group `{name}`"))?)
            }
        };
        let items = resources.place.iter().map(|&place| (place, world.step_number())).collect();
        Ok(Self { reading: reading.clone(), group, items, eaten: 0, waited: 0, contested: 0, won: 0 })
    }
    /// Takes in a step that was made.
    pub(super) fn step(&mut self, world: &World<R, D>) {
        let Some(resources) = world.resources() else { return };
        let (frame, step) = (world.frame(), world.step_number());
        let group_of = |id: u32| {
            let own = |group: &space::GroupRange| (group.first..group.first + group.count).contains(&id);
            frame.groups.iter().position(own)
        };
        for (item, consumer) in resources.consumer.iter().enumerate() {
            let Some(eater) = *consumer else { continue };
            let (place, appeared) = self.items[item];
            let ours = self.group.is_none() || group_of(eater) == self.group;
            if ours {
                self.eaten += 1;
                self.waited += step - appeared;
            }
            if self.reading.quantity == FoodQuantity::Won {
                let near = R::of(self.reading.near) * R::of(self.reading.near);
                let alive = |row: &usize| world.mortality().is_none_or(|c| frame.columns.state[c][*row] > R::ZERO);
                let by = (0..frame.columns.len())
                    .filter(alive)
                    .filter(|&row| frame.space.offset(frame.columns.position(row), place).length_squared() < near);
                let mut groups = by.map(|row| group_of(frame.columns.id[row]));
                let first = groups.next();
                if first.is_some_and(|first| groups.any(|other| other != first)) {
                    self.contested += 1;
                    self.won += u64::from(ours);
                }
            }
            // an item that comes back later has not appeared yet
            let back = resources.absent_until[item].map_or(0.0, |until| (until - world.time()).max(0.0));
            let later = if back.is_finite() { (back / world.time() * step as f64).round() as u64 } else { 0 };
            self.items[item] = (resources.place[item], step + later);
        }
    }
    /// What was asked; none where nothing was eaten or contested. `step` is the length of a step.
    pub(super) fn value(&self, world: &World<R, D>) -> Option<f64> {
        let over = |sum: f64, count: u64| (count > 0).then(|| sum / count as f64);
        let step = world.time() / world.step_number().max(1) as f64;
        match self.reading.quantity {
            FoodQuantity::Meals => {
                let groups = world.frame().groups;
                let members = self.group.map_or(world.frame().columns.len(), |group| groups[group].count as usize);
                over(self.eaten as f64, members as u64)
            }
            FoodQuantity::Wait => over(self.waited as f64 * step, self.eaten),
            FoodQuantity::Won => over(self.won as f64, self.contested),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::scenario::build;

    const WORLD: &str = r#"
kind = "scenario"
title = "Two flocks"
time.duration = 60
[space]
dimensions = 2
edges = "walls"
size = 40
[food]
count = 20
within = 5
gains = { energy = { amount = 40, capacity = 100 }, health = { amount = 10, capacity = 100 } }
respawn.after = 0
[group.red]
count = 6
model.competing_flocks = { flock = 0 }
[group.blue]
count = 4
model.competing_flocks = { flock = 1 }
"#;

    const STEPS: u32 = 100;

    fn read(quantity: FoodQuantity, group: Option<&str>, near: f64) -> (Option<f64>, u64, f64) {
        let scenario = build::read("two.toml", WORLD, &[]).unwrap().scenario;
        let mut world = build::world::<f64, 2>(&scenario, 3, 1).unwrap();
        let mut meals = Meals::new(&FoodReading { quantity, group: group.map(str::to_owned), near }, &world).unwrap();
        for _ in 0..STEPS {
            world.step();
            meals.step(&world);
        }
        (meals.value(&world), world.resources().unwrap().consumed, world.time())
    }

    #[test]
    fn what_is_eaten_is_what_the_groups_eat() {
        let of = |group| read(FoodQuantity::Meals, group, 20.0).0.unwrap();
        let (all, consumed, time) = read(FoodQuantity::Meals, None, 20.0);
        assert!(consumed > 10, "{consumed}");
        assert_eq!(all, Some(consumed as f64 / 10.0));
        assert!((6.0 * of(Some("red")) + 4.0 * of(Some("blue")) - consumed as f64).abs() < 1e-9);
        let wait = read(FoodQuantity::Wait, None, 20.0).0.unwrap();
        // twenty items, each waiting for at most all of the time
        assert!(wait > 0.0 && wait * consumed as f64 <= 20.0 * time + 1e-9, "{wait}");
    }

    #[test]
    fn a_contest_has_one_winner_and_needs_two_groups() {
        let won = |group: &str, near| read(FoodQuantity::Won, Some(group), near).0;
        let (red, blue) = (won("red", 20.0).unwrap(), won("blue", 20.0).unwrap());
        assert!(red > 0.0 && (red + blue - 1.0).abs() < 1e-12, "{red} {blue}");
        // nobody but the eater is as near as this
        assert_eq!(won("red", 1e-9), None);
    }

    #[test]
    fn what_is_not_there_is_named() {
        let scenario = build::read("two.toml", WORLD, &[]).unwrap().scenario;
        let world = build::world::<f64, 2>(&scenario, 3, 1).unwrap();
        let reading = FoodReading { quantity: FoodQuantity::Meals, group: Some("green".into()), near: 1.0 };
        assert!(Meals::new(&reading, &world).unwrap_err().contains("`green`"));
    }
}
