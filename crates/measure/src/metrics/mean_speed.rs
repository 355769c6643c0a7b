//! How fast members are, on average, members at rest included.

use crate::sample::mean;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `mean_speed`.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeanSpeed;

impl Metric for MeanSpeed {
    const CARD: MetricCard = MetricCard {
        id: "mean_speed",
        title: "Mean speed",
        symbol: "s",
        unit: "length/time",
        range: None,
        definition: "mean_i |v_i|,  over members with a velocity",
        variant: "members at rest included",
        source: "plain mean",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "its speed", at_rest: "0" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean(sample.velocities().map(Vector::length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, moving};

    #[test]
    fn closed_forms() {
        close(MeanSpeed.on(&moving(&[[3.0, 4.0], [0.0, 0.0], [0.0, -1.0]])), 2.0);
        close(MeanSpeed.on(&moving(&[[3.0, 4.0], [f64::NAN, 0.0]])), 5.0);
        close(MeanSpeed.on(&moving(&[[0.0, 0.0]])), 0.0);
    }
}
