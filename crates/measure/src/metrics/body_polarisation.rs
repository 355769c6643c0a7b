//! How much members point the same way with their bodies, wherever they move.

use crate::sample::mean_vector;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// `body_polarisation`.
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyPolarisation;

impl Metric for BodyPolarisation {
    const CARD: MetricCard = MetricCard {
        id: "body_polarisation",
        title: "Body polarisation",
        symbol: "P_b",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "|mean_i b_i|,  b_i the unit vector along the body,  over members whose direction of the body is \
                    known",
        variant: "of body axes, not of headings",
        source: "as polarisation; body axes apart from headings as in the package movement",
        counted: Counted::Bodies,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "undefined" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean_vector(sample.bodies()).map(Vector::length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ground;
    use crate::metrics::sketch::close;
    use space::Space;

    #[test]
    fn bodies_and_not_velocities_count() {
        let mut sample = Sample::<2>::new(Space::open(), []);
        let along = [Some(Vector([1.0, 0.0])), Some(Vector([0.0, -1.0])), None];
        let member = |body| (Vector([0.0; 2]), Vector([-1.0, 0.0]), body);
        sample.fill(&Ground::Plane(Space::open()), along.map(member));
        close(BodyPolarisation.on(&sample), 0.5f64.sqrt());
        assert_eq!(sample.count(Counted::Bodies), 2);
    }
}
