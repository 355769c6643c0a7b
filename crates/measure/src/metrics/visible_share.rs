//! How much of their neighbours members can see past each other.

use super::view_groups_literal::{BODY_RADIUS, VIEW_RADIUS};
use crate::metric::takes;
use crate::{Counted, EdgeCases, Metric, MetricCard, Sample, Takes};

takes! {
    /// `visible_share`.
    pub struct VisibleShare { view_radius: VIEW_RADIUS, body_radius: BODY_RADIUS }
}

impl Metric for VisibleShare {
    const CARD: MetricCard = MetricCard {
        id: "visible_share",
        title: "Visible share of neighbours",
        symbol: "V",
        unit: "1",
        range: Some((0.0, 1.0)),
        definition: "over members i with others within view_radius + 2 body_radius: mean of the share of those others j whose line of \
                    centres passes no nearer member of i closer than body_radius",
        variant: "all round; only members hide, obstacles do not",
        source: "behaviour selection, section 10 (occlusion)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        edge: EdgeCases { empty: "undefined", one: "undefined", at_rest: "as ever" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let (places, space) = (sample.positions(), sample.space());
        let limit = (self.view_radius + 2.0 * self.body_radius).powi(2);
        let body = self.body_radius * self.body_radius;
        let (mut sum, mut members) = (0.0, 0.0);
        for (i, &own) in places.iter().enumerate() {
            let offsets =
                places.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, &other)| space.offset(own, other));
            let mut near: Vec<_> =
                offsets.map(|to| (to.length_squared(), to)).filter(|(far, _)| *far <= limit).collect();
            if near.is_empty() {
                continue;
            }
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            let seen = |n: &usize| {
                let (far, to) = near[*n];
                !near[..*n].iter().any(|&(nearer, other)| {
                    let along = (other.dot(to) / far).clamp(0.0, 1.0);
                    nearer < far && (other - to * along).length_squared() < body
                })
            };
            sum += (0..near.len()).filter(seen).count() as f64 / near.len() as f64;
            members += 1.0;
        }
        (members > 0.0).then(|| sum / members)
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        self.place(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::sketch::{close, placed};
    use space::Space;

    #[test]
    fn a_row_hides_and_a_triangle_does_not() {
        let metric = VisibleShare { view_radius: 24.0, body_radius: 1.0 };
        // of three in a row the outer two see the middle one only
        close(metric.on(&placed(Space::open(), &[[0.0, 0.0], [4.0, 0.0], [8.0, 0.5]])), 2.0 / 3.0);
        close(metric.on(&placed(Space::open(), &[[0.0, 0.0], [4.0, 0.0], [8.0, 3.0]])), 1.0);
        // too far to be a neighbour
        assert_eq!(metric.on(&placed(Space::open(), &[[0.0, 0.0], [27.0, 0.0]])), None);
        assert_eq!(metric.on(&placed(Space::open(), &[[0.0, 0.0]])), None);
    }
}
