//! How fast the group as a whole moves: the speed of its centre, where all velocities are known.

use crate::sample::mean_vector;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `group_speed`.
#[derive(Clone, Copy, Debug, Default)]
pub struct GroupSpeed;

impl Metric for GroupSpeed {
    const CARD: MetricCard = MetricCard {
        id: "group_speed",
        title: "Group speed",
        symbol: "s_g",
        unit: "length/time",
        range: None,
        definition: "|mean_i v_i|,  over members with a velocity",
        variant: "length of the mean velocity, not mean of the lengths",
        source: "behaviour selection, section 7 (group speed)",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "its speed", at_rest: "0" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean_vector(sample.velocities()).map(Vector::length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, moving};

    #[test]
    fn closed_forms() {
        close(GroupSpeed.on(&moving(&[[3.0, 0.0], [0.0, 4.0]])), 2.5);
        close(GroupSpeed.on(&moving(&[[3.0, 0.0], [-3.0, 0.0]])), 0.0);
    }
}
