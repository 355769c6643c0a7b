//! How far members' headings stray from the mean heading, as an angle: 0 in parallel motion, about 90 in confusion.
//!
//! A. Huth, C. Wissel (1992), The simulation of the movement of fish schools, Journal of Theoretical Biology 156:365, where
//! it is called polarisation.

use crate::sample::{CANCELLED, mean, mean_vector};
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Real;

/// `mean_angular_deviation`.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeanAngularDeviation;

impl Metric for MeanAngularDeviation {
    const CARD: MetricCard = MetricCard {
        id: "mean_angular_deviation",
        title: "Mean angular deviation",
        symbol: "delta",
        unit: "deg",
        range: None,
        definition: "mean_i of the angle between h_i and m = mean_j h_j,  over members with a heading; undefined where \
                     |m| <= 1e-6",
        variant: "mean of the angles to the mean heading, in degrees",
        source: "Huth and Wissel 1992 (where it is called polarisation)",
        counted: Counted::Headings,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "undefined" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let headings = || sample.headings().map(|(_, heading)| heading);
        let sum = mean_vector(headings()).filter(|sum| sum.length() > CANCELLED)?;
        let ahead = sum.unit();
        // the arc tangent keeps its digits at small angles, where the arc cosine loses them
        let angle = |heading| {
            let along = ahead.dot(heading);
            Real::atan2((heading - ahead * along).length(), along)
        };
        mean(headings().map(angle)).map(f64::to_degrees)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, moving};

    #[test]
    fn closed_forms() {
        let deviation = |velocities: &[[f64; 2]]| MeanAngularDeviation.on(&moving(velocities));
        close(deviation(&[[1.0, 1.0], [2.0, 2.0]]), 0.0);
        close(deviation(&[[1.0, 0.0], [0.0, 7.0]]), 45.0);
        // the mean points along x: 90 degrees to either side, and none
        close(deviation(&[[0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [0.0, 0.0]]), 60.0);
        assert_eq!(deviation(&[[1.0, 0.0], [-2.0, 0.0]]), None, "no mean heading");
        assert_eq!(deviation(&[[0.0, 0.0]]), None);
    }

    #[test]
    fn small_angles_keep_their_digits() {
        let sample = moving(&[[1.0, 1e-9], [1.0, -1e-9]]);
        let found = MeanAngularDeviation.on(&sample).map(|deviation| deviation / 1e-9f64.to_degrees());
        close(found, 1.0);
    }
}
