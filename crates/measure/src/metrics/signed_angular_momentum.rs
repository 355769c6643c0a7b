//! How much the group turns about its centre, and which way: 1 in a perfect mill to the left, -1 to the right.
//!
//! Positive is counter-clockwise in the axes of the data. Where the y axis points down, as in images, it looks clockwise.

use super::angular_momentum::moments;
use crate::sample::mean;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};

/// `signed_angular_momentum`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SignedAngularMomentum;

impl Metric for SignedAngularMomentum {
    const CARD: MetricCard = MetricCard {
        id: "signed_angular_momentum",
        title: "Signed angular momentum (milling)",
        symbol: "M_s",
        unit: "1",
        range: Some((-1.0, 1.0)),
        definition: "mean_i unit(x_i - c) x h_i,  c the centre,  all over members with a heading; counter-clockwise \
                    positive",
        variant: "with sign, in the plane; per member: unit vectors from the centre, unit headings",
        source: "Couzin et al. 2002 (group angular momentum), before its length is taken",
        counted: Counted::Headings,
        dimensions: &[2],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "undefined" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let moments = moments(sample)?;
        if D == 2 { mean(moments.iter().map(|moment| moment.0[2])) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, sample};
    use space::Space;

    #[test]
    fn left_is_positive() {
        let at = |angle: f64| [angle.to_radians().cos(), angle.to_radians().sin()];
        let ring =
            |turns: f64| Vec::from_iter((0..12).map(|k| (at(f64::from(k) * 30.0), at(f64::from(k) * 30.0 + turns))));
        close(SignedAngularMomentum.on(&sample(Space::open(), &ring(90.0))), 1.0);
        close(SignedAngularMomentum.on(&sample(Space::open(), &ring(-90.0))), -1.0);
        close(SignedAngularMomentum.on(&sample(Space::open(), &ring(210.0))), -0.5);
    }
}
