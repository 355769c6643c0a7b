//! How far a group is from round: 0 where it is as wide as it is long, 1 on a line.
//!
//! The length and the width are the standard deviations along the principal axes, the greatest and the second greatest.

use crate::{Counted, EdgeCases, Metric, MetricCard, Sample};
use space::Vector;

/// The greatest and the second greatest variance of offsets along their principal axes. `None` where all are zero.
pub(super) fn principal<const D: usize>(offsets: &[Vector<f64, D>]) -> Option<[f64; 2]> {
    let mut covariance = [[0.0; D]; D];
    // as shares of the widest, so that no square is too large or too small
    let widest = offsets.iter().map(|offset| offset.length()).fold(0.0, f64::max);
    if !(widest > 0.0 && widest.is_finite()) || D < 2 {
        return None;
    }
    for offset in offsets {
        let share = *offset / widest;
        for a in 0..D {
            for b in 0..D {
                covariance[a][b] += share.0[a] * share.0[b];
            }
        }
    }
    // Jacobi: rotations that make one element after the other zero
    for _ in 0..60 {
        for a in 0..D {
            for b in a + 1..D {
                if covariance[a][b] == 0.0 {
                    continue;
                }
                let ratio = (covariance[b][b] - covariance[a][a]) / (2.0 * covariance[a][b]);
                let tan = ratio.signum() / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
                let cos = 1.0 / (tan * tan + 1.0).sqrt();
                let sin = tan * cos;
                for k in 0..D {
                    let (x, y) = (covariance[k][a], covariance[k][b]);
                    (covariance[k][a], covariance[k][b]) = (cos * x - sin * y, sin * x + cos * y);
                }
                for k in 0..D {
                    let (x, y) = (covariance[a][k], covariance[b][k]);
                    (covariance[a][k], covariance[b][k]) = (cos * x - sin * y, sin * x + cos * y);
                }
                (covariance[a][b], covariance[b][a]) = (0.0, 0.0);
            }
        }
        if (0..D).all(|a| (a + 1..D).all(|b| covariance[a][b] == 0.0)) {
            break;
        }
    }
    let mut variances: [f64; D] = core::array::from_fn(|a| covariance[a][a].max(0.0));
    variances.sort_unstable_by(|one, other| other.total_cmp(one));
    // of a variance of zero rounding leaves that much
    let second = if variances[1] < 1e-14 * variances[0] { 0.0 } else { variances[1] };
    Some([variances[0], second])
}

/// `elongation`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Elongation;

impl Metric for Elongation {
    const CARD: MetricCard = MetricCard {
        id: "elongation",
        title: "Elongation",
        symbol: "e",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "1 - sqrt(l_2 / l_1),  l_1 >= l_2 the greatest eigenvalues of the covariance of x_i - c; \
                    undefined where all coincide",
        variant: "by principal axes, whatever the heading; second over first axis",
        source: "textbook (principal component analysis)",
        counted: Counted::Positions,
        dimensions: &[2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let offsets = sample.from_centre(sample.positions())?;
        let [first, second] = principal(&offsets)?;
        Some(1.0 - (second / first).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn closed_forms() {
        let box_of = |a: f64, b: f64| placed(Space::open(), &[[a, b], [a, -b], [-a, b], [-a, -b]]);
        close(Elongation.on(&box_of(2.0, 2.0)), 0.0);
        close(Elongation.on(&box_of(1.0, 4.0)), 0.75);
        close(Elongation.on(&placed(Space::open(), &[[0.0, 0.0], [1.0, 2.0], [3.0, 6.0]])), 1.0);
        assert_eq!(Elongation.on(&placed(Space::open(), &[[1.0, 2.0]; 3])), None);
        let axes = |a: f64, b: f64, c: f64| {
            placed(
                Space::open(),
                &[[a, 0.0, 0.0], [-a, 0.0, 0.0], [0.0, b, 0.0], [0.0, -b, 0.0], [0.0, 0.0, c], [0.0, 0.0, -c]],
            )
        };
        close(Elongation.on(&axes(4.0, 1.0, 2.0)), 0.5);
        close(Elongation.on(&axes(3.0, 3.0, 1.0)), 0.0);
    }
}
