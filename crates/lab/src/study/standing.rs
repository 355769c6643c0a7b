//! Where members stand in their cluster, in a trial.

use super::form::{StandingQuantity, StandingReading};
use super::trial::{Look, Reader};
use measure::standing::standing;
use measure::statistics::spearman;
use std::collections::BTreeMap;
use swarm::World;
use swarm::parameters::Scalar;

/// What is known of a member: its places and the values of the column, summed, and how many.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    place: f64,
    column: f64,
    count: f64,
}

pub(super) struct Standing {
    reading: StandingReading,
    with: Option<usize>,
    group: Option<usize>,
    /// By id.
    members: BTreeMap<usize, Sums>,
}

impl Standing {
    pub(super) fn new(reading: &StandingReading, with: Option<usize>, group: Option<usize>) -> Self {
        Self { reading: reading.clone(), with, group, members: BTreeMap::new() }
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Standing {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        let places = standing(&look.space, &look.positions, &look.velocities, self.reading.linking_distance);
        let state = &look.world.frame().columns.state;
        for k in look.members(self.group) {
            let Some([ahead, left, up]) = places[k] else { continue };
            let sums = self.members.entry(look.ids[k]).or_default();
            sums.place += match self.reading.quantity {
                StandingQuantity::Ahead => ahead,
                StandingQuantity::Distance => (ahead * ahead + left * left + up * up).sqrt(),
            };
            sums.column += self.with.map_or(0.0, |column| state[column][look.rows[k]].to_f64());
            sums.count += 1.0;
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        let means = || self.members.values().map(|sums| (sums.place / sums.count, sums.column / sums.count));
        if self.with.is_some() {
            let (places, columns): (Vec<f64>, Vec<f64>) = means().unzip();
            return spearman(&places, &columns, 0.95).ok().map(|found| found.r);
        }
        let number = self.members.len() as f64;
        (number > 0.0).then(|| means().map(|(place, _)| place).sum::<f64>() / number)
    }
}
