//! How well a group would hold an agreement, from who is near to whom.

use super::form::Statistic;
use super::trial::{Look, Reader, Values};
use crate::{form, words};
use measure::over_time::consensus_robustness::{best_neighbours, robustness};
use swarm::World;
use swarm::parameters::Scalar;

words! {
    /// What is read off the graph of who listens to whom.
    pub enum ConsensusQuantity {
        /// The robustness of an agreement; 0 where nobody's opinion reaches everyone.
        Robustness = "robustness",
        /// The number of neighbours, up to `neighbours`, of the greatest robustness for each of them.
        BestNeighbours = "best_neighbours",
    }
}

form! {
    /// How well the members would hold an agreement against noise if each listened to its nearest others, over the looks. The metric over
    /// time `consensus_robustness`.
    pub struct ConsensusReading {
        /// What.
        quantity: ConsensusQuantity = [ConsensusQuantity::Robustness], "", Any;
        /// To how many each one listens.
        neighbours: usize = need, "1", Within(1.0, 1000.0);
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// What is made of its values.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

pub(super) struct Consensus {
    reading: ConsensusReading,
    values: Values,
}

impl Consensus {
    pub(super) fn new(reading: &ConsensusReading) -> Self {
        Self { reading: reading.clone(), values: Values::new(reading.statistic) }
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Consensus {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let neighbours = self.reading.neighbours;
            self.values.add(match self.reading.quantity {
                ConsensusQuantity::Robustness => robustness(&look.sample, neighbours),
                ConsensusQuantity::BestNeighbours => best_neighbours(&look.sample, neighbours).map(|best| best as f64),
            });
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value().map(|value| self.reading.scale * value)
    }
}
