//! How far departures from the common motion reach.

use super::form::Statistic;
use super::trial::{Look, Reader, Values};
use crate::form;
use measure::metrics::max_pair_distance::MaxPairDistance;
use measure::over_time::correlation_length::first_zero;
use measure::{Metric, Sample};
use swarm::World;
use swarm::parameters::Scalar;

form! {
    /// The distance at which the departures of two members from the mean velocity are no longer alike, over the looks: where their
    /// correlation falls to zero. The metric over time `correlation_length`, in bins that are equal parts of the greatest distance.
    pub struct CorrelationReading {
        /// Whether it is a share of the greatest distance between two members.
        relative: bool = [false], "", Any;
        /// Number of bins.
        bins: usize = [25usize], "1", Within(2.0, 1000.0);
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// What is made of its values.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

/// The distance of the first zero. `None` where there is none.
fn length<const D: usize>(sample: &Sample<D>, bins: usize, relative: bool) -> Option<f64> {
    let widest = MaxPairDistance.on(sample).filter(|&widest| widest > 0.0)?;
    let length = first_zero(sample, widest / bins as f64, bins as f64)?;
    Some(if relative { length / widest } else { length })
}

pub(super) struct CorrelationLength {
    reading: CorrelationReading,
    values: Values,
}

impl CorrelationLength {
    pub(super) fn new(reading: &CorrelationReading) -> Self {
        Self { reading: reading.clone(), values: Values::new(reading.statistic) }
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for CorrelationLength {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            self.values.add(length(&look.sample, self.reading.bins, self.reading.relative));
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value().map(|value| self.reading.scale * value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::{Space, Vector};

    #[test]
    fn two_halves_that_part() {
        // four on a line of 20, the left pair going left: alike at a distance of 1, opposed from 19 on
        let members = [(0.0, -1.0), (1.0, -1.0), (19.0, 1.0), (20.0, 1.0)].map(|(x, v)| (Vector([x]), Vector([v])));
        let sample = Sample::new(Space::open(), members);
        // in four bins, 1 at 2.5 and -1 at 17.5: between, nobody
        assert_eq!(length(&sample, 4, false), Some(10.0));
        assert_eq!(length(&sample, 4, true), Some(0.5));
        let alike = Sample::new(Space::open(), [0.0, 3.0].map(|x| (Vector([x]), Vector([1.0]))));
        assert_eq!(length(&alike, 4, true), None);
        assert_eq!(length(&Sample::<1>::empty(), 4, true), None);
    }
}
