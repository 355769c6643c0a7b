//! On a line or a ring, everyone whose gap is not the smallest jumps into the narrower gap beside it.
//!
//! W. D. Hamilton (1971), Geometry for the selfish herd, Journal of Theoretical Biology 31:295 (the frogs around the pond).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::{Edge, Vector};

parameters! {
    /// Parameters of `hamilton_1d`.
    pub struct Hamilton1d {
        /// Share of the gap beyond the neighbour that a member passes it by.
        gap_fraction alias "fraction": R = 1.0 / 3.0, "phi", "1", NonNegative, Paper;
    }
}

impl<R: Scalar> Law<R> for Hamilton1d<R> {
    const CARD: Card = Card {
        id: "hamilton_1d",
        title: "Hamilton 1971, one dimension",
        about: "Members on a line or a ring jump over a neighbour into the narrower of the gaps beside their own.",
        reference: "W. D. Hamilton (1971). Geometry for the selfish herd. Journal of Theoretical Biology 31, 295-311. \
                    doi:10.1016/0022-5193(71)90189-5",
        equations: "order by (position, index): ... l, a, i, b, k ...; a missing neighbour makes an infinite gap\n\
                    own = gap(a,i) + gap(i,b);  left = gap(l,a);  right = gap(b,k)\n\
                    x_i' = x_i  if own < min(left, right), or min(left, right) is infinite\n\
                    x_i' = x_a - phi left  if left < right;  x_i' = x_b + phi right  otherwise",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = all; of these the two nearest in order on either side",
            motion: "target point",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the table's target, half a difference of positions, is no position: as the frogs do, a member passes \
                     the neighbour by a share of the gap beyond it (1/2 is the table's midpoint), and only where its own gap \
                     is not the smallest",
        edge: "fewer than three members: stays; on a ring gaps are arcs between neighbours in the order, so the velocity is \
               the signed arc travelled and may exceed half the ring; on a ring of three l is b and k is a",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "unbounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn velocity_is_step(&self) -> bool {
        true
    }
}

/// A place in the order that starts at the deciding member: whether it lies behind, its displacement, its id.
type Place<R> = (bool, R, u32);

/// Keeps the two places that come first.
fn keep<R: Scalar>(two: &mut [Option<Place<R>>; 2], place: Place<R>, earlier: fn(&Place<R>, &Place<R>) -> bool) {
    if two[0].is_none_or(|first| earlier(&place, &first)) {
        *two = [Some(place), two[0]];
    } else if two[1].is_none_or(|second| earlier(&place, &second)) {
        two[1] = Some(place);
    }
}

impl<R: Scalar> Model<R, 1> for Hamilton1d<R> {
    fn sets(&self) -> Vec<NamedSet<R, 1>> {
        vec![NamedSet::new("neighbours", Perception::All)]
    }
    fn decide(&self, me: &mut Me<'_, R, 1>, seen: &Percepts<'_, R, 1>, _: &Draws<'_>) -> Motion<R, 1> {
        // the first two and the last two of the order that starts at me and closes on itself
        let (mut first, mut last) = ([None; 2], [None; 2]);
        for j in seen.set(0) {
            let (offset, id) = (seen.offset(j)[0], seen.id(j));
            let place = ((offset, id) < (R::ZERO, me.id), offset, id);
            keep(&mut first, place, |a, b| a < b);
            keep(&mut last, place, |a, b| a > b);
        }
        let ring = if let Edge::Periodic(length) = me.around.space.edges[0] { Some(length) } else { None };
        // arcs ahead of me on a ring; on a line displacements, and nobody behind follows those ahead
        let coordinate = |place: Option<Place<R>>, behind: bool| match (ring, place) {
            (Some(length), Some((true, offset, _))) => Some(offset + length),
            (None, Some((side, ..))) if side != behind => None,
            (_, place) => place.map(|(_, offset, _)| offset),
        };
        let [b, k] = first.map(|place| coordinate(place, false));
        let [a, l] = last.map(|place| coordinate(place, true));
        let turn = ring.unwrap_or(R::ZERO);
        let gap = |from: Option<R>, to: Option<R>| from.zip(to).map_or(R::INFINITY, |(from, to)| to - from);
        let (own, left, right) = (gap(a, b) + turn, gap(l, a), gap(b, k));
        let narrower = left.least(right);
        let jump = match (a, b) {
            _ if seen.count(0) < 2 || own < narrower || !narrower.finite() => R::ZERO,
            (Some(a), _) if left < right => a - turn - self.gap_fraction * left,
            (_, Some(b)) => b + self.gap_fraction * right,
            _ => R::ZERO,
        };
        me.unit("length");
        me.note("jump", Vector([jump]));
        me.sum(Vector([jump]));
        for (name, gap) in [("own gap", own), ("gap on the left", left), ("gap on the right", right)] {
            me.value(name, gap, "length");
        }
        me.either(
            ["stay", "jump left", "jump right"],
            if jump < R::ZERO { 1 } else { usize::from(jump > R::ZERO) * 2 },
        );
        Motion::step(Vector([jump]))
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Space;

    fn at<const N: usize>(places: [f64; N]) -> [([f64; 1], [f64; 1]); N] {
        places.map(|x| ([x], [0.0]))
    }

    #[test]
    fn a_member_between_wide_gaps_jumps_to_the_narrower_side() {
        // gaps 3, 10, 10, 6: the one in the middle passes its left neighbour by a third of 3
        let w = Oracle::new("hamilton_1d").step(&at([0.0, 3.0, 13.0, 23.0, 29.0]));
        close(w.position(2), [2.0]);
        close(w.velocity(2), [-11.0]);
        // at the ends one side is missing: the left end goes over its right neighbour, the right end over its left
        close(w.position(0), [3.0 + 10.0 / 3.0]);
        close(w.position(4), [23.0 - 10.0 / 3.0]);
        // own gap 13 against an infinite one and 10
        close(w.position(1), [13.0 + 10.0 / 3.0]);
    }

    #[test]
    fn on_a_ring_gaps_are_arcs_and_order_closes() {
        // arcs 40, 60, 30, 230 degrees: from 0 the own gap is 270, left 30, right 60
        let ring = || Oracle::new("hamilton_1d").space(Space::periodic([360.0]));
        let w = ring().step(&at([0.0, 40.0, 100.0, 130.0]));
        close(w.velocity(0), [-230.0 - 10.0]);
        close(w.position(0), [120.0]);
        // from 100 the own gap 90 exceeds left 40
        close(w.position(2), [40.0 - 40.0 / 3.0]);
        // a ring of three: l is b and k is a, so both gaps are the one opposite, and the right wins
        close(ring().step(&at([0.0, 10.0, 50.0])).position(0), [10.0 + 40.0 / 3.0]);
        // own gap the smallest: stays
        close(ring().step(&at([0.0, 10.0, 50.0])).position(1), [10.0]);
    }

    #[test]
    fn few_and_coincident_members() {
        close(Oracle::new("hamilton_1d").step(&at([0.0, 3.0])).position(0), [0.0]);
        // 1 and 2 coincide, 1 is left of 2: the own gap of 2 is 5, its left gap 4; the own gap of 1 is 4, its right gap 5
        let w = Oracle::new("hamilton_1d").step(&at([0.0, 4.0, 4.0, 9.0]));
        close(w.position(2), [4.0 - 4.0 / 3.0]);
        close(w.position(1), [4.0]);
    }
}
