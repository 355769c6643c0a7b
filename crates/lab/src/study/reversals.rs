//! How often a group turns round.

use super::trial::{Look, Reader};
use crate::form;
use swarm::World;
use swarm::parameters::Scalar;

form! {
    /// How often the common direction along an axis turns into its opposite, per time: the mean heading goes from beyond the threshold on
    /// one side to beyond it on the other. Nothing for a single look.
    pub struct ReversalReading {
        /// The axis: 1 for x.
        axis: usize = [1usize], "1", Within(1.0, 3.0);
        /// Least component of the mean heading along the axis at which the group has a direction.
        threshold: f64 = [0.5], "1", Within(0.0, 1.0);
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
    }
}

/// Turns of a mean heading so far.
#[derive(Clone, Copy, Debug, Default)]
struct Turns {
    /// The side on which it was last beyond the threshold: -1, 1, or 0 before it ever was.
    side: f64,
    count: f64,
}

impl Turns {
    fn add(&mut self, component: f64, threshold: f64) {
        if component.abs() > threshold {
            if component * self.side < 0.0 {
                self.count += 1.0;
            }
            self.side = component.signum();
        }
    }
}

pub(super) struct Reversals {
    reading: ReversalReading,
    group: Option<usize>,
    turns: Turns,
    /// Time between the first look and the last.
    time: f64,
    looks: u64,
}

impl Reversals {
    /// # Errors
    /// An axis that is not there.
    pub(super) fn new(reading: &ReversalReading, group: Option<usize>, dimensions: usize) -> Result<Self, String> {
        if reading.axis > dimensions {
            return Err(format!("there is no axis {} in {dimensions} dimensions", reading.axis));
        }
        Ok(Self { reading: reading.clone(), group, turns: Turns::default(), time: 0.0, looks: 0 })
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Reversals {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        let axis = self.reading.axis - 1;
        let members = look.members(self.group);
        let components: Vec<f64> = members.iter().map(|&k| look.velocities[k].unit().0[axis]).collect();
        let mean = components.iter().fold(0.0, |sum, component| sum + component) / components.len().max(1) as f64;
        self.turns.add(mean, self.reading.threshold);
        if self.looks > 0 {
            self.time += look.interval;
        }
        self.looks += 1;
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        (self.time > 0.0).then(|| self.reading.scale * self.turns.count / self.time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_from_one_side_to_the_other() {
        let count = |components: &[f64]| {
            let mut turns = Turns::default();
            components.iter().for_each(|&component| turns.add(component, 0.5));
            turns.count
        };
        assert_eq!(count(&[0.2, 0.9, 0.4, -0.4, 0.8, -0.6, -0.9, 0.1, 0.51]), 2.0);
        assert_eq!(count(&[-0.9, 0.5, -0.9]), 0.0, "not beyond the threshold");
        assert_eq!(count(&[]), 0.0);
    }
}
