//! A turn that passes through a group, in a trial.

use super::form::{TransferQuantity, TransferReading};
use super::trial::{Look, Reader, wide_space};
use measure::transfer::Transfer;
use swarm::World;
use swarm::parameters::Scalar;

pub(super) struct OfTransfer<const D: usize> {
    reading: TransferReading,
    column: usize,
    group: Option<usize>,
    turn: Transfer<D>,
}

impl<const D: usize> OfTransfer<D> {
    pub(super) fn new(reading: &TransferReading, column: usize, group: Option<usize>) -> Self {
        Self { turn: Transfer::new(reading.angle.to_radians()), reading: reading.clone(), column, group }
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for OfTransfer<D> {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        let members = look.members(self.group);
        let count = &look.world.frame().columns.state[self.column];
        let of = |values: &[space::Vector<f64, D>]| members.iter().map(|&k| values[k]).collect::<Vec<_>>();
        let ids: Vec<usize> = members.iter().map(|&k| look.ids[k]).collect();
        let met = |k: usize| count[look.rows[members[k]]] > R::ZERO;
        self.turn.look(look.world.time(), &ids, &of(&look.positions), &of(&look.velocities), met);
    }
    fn value(&self, world: &World<R, D>) -> Option<f64> {
        let space = wide_space(world.frame().space);
        let value = match self.reading.quantity {
            TransferQuantity::Share => self.turn.share(),
            TransferQuantity::Rearmost => self.turn.rearmost(&space),
            TransferQuantity::Speed => self.turn.speed(&space),
            TransferQuantity::Correlation => self.turn.correlation(&space),
            TransferQuantity::Delay => {
                let delays = self.turn.delays(&space);
                let sum: f64 = delays.iter().map(|(_, delay)| delay).sum();
                (!delays.is_empty()).then(|| sum / delays.len() as f64)
            }
        };
        value.map(|value| self.reading.scale * value)
    }
}
