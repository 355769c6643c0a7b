//! How much the group turns about its centre: 1 in a perfect mill.
//!
//! I. D. Couzin, J. Krause, R. James, G. D. Ruxton, N. R. Franks (2002), Collective memory and spatial sorting in animal
//! groups, Journal of Theoretical Biology 218:1.
//!
//! The centre is that of the members with a heading, so that a member that stands aside changes nothing. A member at the
//! centre counts with the moment zero.

use crate::sample::mean_vector;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::{Real, Vector};

/// `angular_momentum`.
#[derive(Clone, Copy, Debug, Default)]
pub struct AngularMomentum;

impl Metric for AngularMomentum {
    const CARD: MetricCard = MetricCard {
        id: "angular_momentum",
        title: "Angular momentum (milling)",
        symbol: "M",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "|mean_i unit(x_i - c) x h_i|,  c the centre,  all over members with a heading",
        variant: "without sign, per member: unit vectors from the centre, unit headings",
        source: "Couzin et al. 2002 (group angular momentum)",
        counted: Counted::Headings,
        dimensions: &[2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "0", at_rest: "undefined" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        mean_vector(moments(sample)?.into_iter()).map(Vector::length)
    }
}

/// The moment of each member with a heading, `unit(x_i - c) x h_i`; in the plane along the third axis. `None` on a line, and
/// without a centre.
pub(super) fn moments<const D: usize>(sample: &Sample<D>) -> Option<Vec<Vector<f64, 3>>> {
    if D < 2 {
        return None;
    }
    let (positions, headings): (Vec<_>, Vec<_>) = sample.headings().unzip();
    let offsets = sample.from_centre(&positions)?;
    let widest = offsets.iter().map(|offset| offset.length()).fold(1.0, f64::max);
    let moment = |(offset, heading): (&Vector<f64, D>, &Vector<f64, D>)| {
        // what rounding leaves of the offset of a member at the centre has no direction
        let out = if offset.length() <= f64::TINY * widest { Vector::ZERO } else { offset.unit() };
        if D == 2 { Vector([0.0, 0.0, out.left().dot(*heading)]) } else { wide(out).cross3(wide(*heading)) }
    };
    Some(offsets.iter().zip(&headings).map(moment).collect())
}

/// The first three components.
fn wide<const D: usize>(v: Vector<f64, D>) -> Vector<f64, 3> {
    Vector::of(&v.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, sample};
    use space::Space;

    fn ring(turns: f64) -> Vec<([f64; 2], [f64; 2])> {
        let at = |angle: f64| [angle.to_radians().cos(), angle.to_radians().sin()];
        (0..12).map(|k| (at(f64::from(k) * 30.0), at(f64::from(k) * 30.0 + turns))).collect()
    }

    #[test]
    fn a_mill_has_one_and_radial_motion_none() {
        close(AngularMomentum.on(&sample(Space::open(), &ring(90.0))), 1.0);
        close(AngularMomentum.on(&sample(Space::open(), &ring(-90.0))), 1.0);
        close(AngularMomentum.on(&sample(Space::open(), &ring(30.0))), 0.5);
        close(AngularMomentum.on(&sample(Space::open(), &ring(0.0))), 0.0);
        let space_mill: Vec<_> = ring(90.0).iter().map(|(x, v)| ([0.0, x[0], x[1]], [0.0, v[0], v[1]])).collect();
        close(AngularMomentum.on(&sample(Space::open(), &space_mill)), 1.0);
    }

    #[test]
    fn members_at_the_centre_and_at_rest() {
        let mut members = ring(90.0);
        members.push(([0.0, 0.0], [1.0, 0.0]));
        close(AngularMomentum.on(&sample(Space::open(), &members)), 12.0 / 13.0);
        // someone at rest far away does not move the centre
        members[12] = ([500.0, 0.0], [0.0, 0.0]);
        close(AngularMomentum.on(&sample(Space::open(), &members)), 1.0);
        assert_eq!(
            AngularMomentum.on(&sample(Space::open(), &[([0.0], [1.0]), ([1.0], [1.0])])),
            None,
            "one dimension"
        );
    }
}
