//! How much speeds differ from member to member.

use crate::sample::spread;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `speed_sd`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpeedSd;

impl Metric for SpeedSd {
    const CARD: MetricCard = MetricCard {
        id: "speed_sd",
        title: "Standard deviation of speed",
        symbol: "sd(s)",
        unit: "length/time",
        range: None,
        definition: "sqrt(sum_i (|v_i| - mean |v|)^2 / (N - 1)),  over two or more members with a velocity",
        variant: "between members of one frame; divisor N - 1",
        source: "plain standard deviation",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let speeds: Vec<f64> = sample.velocities().map(Vector::length).collect();
        Some(spread(&speeds)?.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, moving};

    #[test]
    fn closed_forms() {
        close(SpeedSd.on(&moving(&[[1.0, 0.0], [0.0, 3.0]])), 2f64.sqrt());
        close(SpeedSd.on(&moving(&[[1.0, 0.0], [0.0, -1.0], [f64::NAN, 0.0]])), 0.0);
        assert_eq!(SpeedSd.on(&moving(&[[1.0, 0.0]])), None);
    }
}
