//! Everyone steps towards the middle of the largest connected part of the group that it sees.
//!
//! B. T. Fine, D. A. Shell (2012), Examining the information requirements for flocking motion (the variation of the local
//! crowded horizon that is group-centric and uses pose).

use crate::card::*;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use crate::{choice, parameters};
use core::cell::Cell;
use core::ops::Range;
use space::Vector;

choice! {
    /// What a member does when nobody is detected.
    pub enum OnEmpty {
        /// It stays.
        Stay = "stay",
        /// It makes a step along its heading.
        KeepHeading = "keep_heading",
    }
}

parameters! {
    /// Parameters of `lch_group_pose`.
    pub struct LchGroupPose {
        /// Distance up to which two inputs belong together.
        splitting_threshold alias "st": R = 0.5, "st", "length", NonNegative, Source;
        /// Distance moved per update.
        step_length alias "step": R = 0.1, "l", "body length", NonNegative, Ours;
        /// Distance below which inputs count.
        range: R = 3000.0, "beta", "length", Positive, Source;
        /// What a member does when nobody is detected.
        on_empty: OnEmpty = "stay", "-", "-", Any, Source;
    }
}

impl<R: Scalar> Law<R> for LchGroupPose<R> {
    const CARD: Card = Card {
        id: "lch_group_pose",
        title: "Fine and Shell 2012, group-centric, pose",
        about: "Members step towards the mean position of the largest connected component of those they see.",
        reference: "B. T. Fine, D. A. Shell (2012). Examining the information requirements for flocking motion; also in \
                    B. T. Fine (2015). Constructing geometries for group control",
        equations: "I = largest component of the graph that links inputs at distance <= st\n\
                    x_i' = x_i + l unit(mean_{j in I} d_ij)",
        stages: Stages {
            sensing: "ideal within range, or range-finder",
            detection: "any",
            selection: "inputs = distance_based(0, range); of these the largest connected component",
            motion: "target point",
            physics: "ideal, or differential drive",
            obstacles: "",
        },
        departures: "the components of the unit vector are added to the coordinates, where the listing adds the whole \
                     quotient to each; the step is 0.1, from the published final distances",
        edge: "nobody: stays, or one step along the heading (on_empty); components of equal size: the one that holds the \
               lowest index; the member itself is not in the graph; zero resultant: stays",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, false],
            validation: "SP",
            synchronous: false,
            information: [Information::Local, Information::None, Information::None],
            environment: "unbounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
}

thread_local! {
    /// Percepts in the order in which components are filled; kept between decisions so that none allocates.
    static ORDER: Cell<Vec<u32>> = const { Cell::new(Vec::new()) };
}

/// Calls `each` with the percepts of the largest connected component of set 0, in canonical order, and returns how many they
/// are. Of components of equal size it is the one with the lowest id.
pub(super) fn largest_component<R: Scalar, const D: usize>(
    seen: &Percepts<'_, R, D>,
    linked: impl Fn(usize, usize) -> bool,
    each: impl FnMut(usize),
) -> usize {
    let mut order = ORDER.take();
    order.clear();
    order.extend(seen.set(0).map(|k| k as u32));
    let mut largest: (Range<usize>, u32) = (0..0, u32::MAX);
    let mut start = 0;
    // no smaller rest can win
    while start < order.len() && order.len() - start >= largest.0.len() {
        // the component from `start` to `end`, of which those before `next` have looked for their links
        let (mut next, mut end) = (start, start + 1);
        while next < end {
            let rest = end..order.len();
            for other in rest {
                if linked(order[next] as usize, order[other] as usize) {
                    order.swap(end, other);
                    end += 1;
                }
            }
            next += 1;
        }
        let lowest = order[start..end].iter().map(|&k| seen.id(k as usize)).min().unwrap_or(u32::MAX);
        if end - start > largest.0.len() || (end - start == largest.0.len() && lowest < largest.1) {
            largest = (start..end, lowest);
        }
        start = end;
    }
    let component = &mut order[largest.0.clone()];
    component.sort_unstable();
    component.iter().map(|&k| k as usize).for_each(each);
    ORDER.set(order);
    largest.0.len()
}

impl<R: Scalar, const D: usize> Model<R, D> for LchGroupPose<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("inputs", Perception::distance(R::ZERO, self.range))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let threshold = self.splitting_threshold.squared();
        let space = me.around.space;
        let linked = |a: usize, b: usize| space.minimal(seen.offset(b) - seen.offset(a)).length_squared() <= threshold;
        let mut sum = Vector::ZERO;
        let size = largest_component(seen, linked, |k| sum += seen.offset(k));
        let step = if size > 0 {
            let middle = sum / R::count(size);
            me.unit("length");
            me.value("members of the largest component", R::count(size), "1");
            me.sum(middle);
            me.note("middle of the largest component", middle);
            middle.unit() * self.step_length
        } else {
            match self.on_empty {
                OnEmpty::Stay => Vector::ZERO,
                OnEmpty::KeepHeading => me.heading() * self.step_length,
            }
        };
        Motion::step(step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Space;

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn the_larger_component_wins_and_links_reach_through_others() {
        // a chain of three to the right, linked pairwise at exactly the threshold, against two above
        let w = Oracle::new("lch_group_pose").step(&[
            ([0.0, 0.0], REST),
            ([2.0, 0.0], REST),
            ([0.0, 5.0], REST),
            ([3.0, 0.0], REST),
            ([2.5, 0.0], REST),
            ([0.0, 5.25], REST),
        ]);
        close(w.position(0), [0.1, 0.0]);
        // the same from the upper pair, whose own component has only the other one of it
        close(w.position(2), [0.1 * 2.5 / 31.25f64.sqrt(), 5.0 - 0.1 * 5.0 / 31.25f64.sqrt()]);
    }

    #[test]
    fn of_equal_components_the_one_with_the_lowest_index_counts() {
        let w = Oracle::new("lch_group_pose").step(&[
            ([0.0, 0.0], REST),
            ([0.0, 4.0], REST),
            ([5.0, 0.0], REST),
            ([5.2, 0.0], REST),
            ([0.0, 4.2], REST),
        ]);
        close(w.position(0), [0.0, 0.1]);
    }

    #[test]
    fn links_close_over_a_periodic_edge() {
        let space = Space::periodic([10.0, 10.0]);
        // seen from 5 the two at the edge lie on opposite sides, 0.4 apart
        let agents = [([5.0, 5.0], REST), ([9.8, 5.0], REST), ([0.2, 5.0], REST), ([5.0, 8.0], REST)];
        let w = Oracle::new("lch_group_pose").space(space).step(&agents);
        close(w.position(0), [5.0, 5.0]);
    }

    #[test]
    fn nobody_there() {
        let alone = [([1.0, 1.0], [0.0, 2.0])];
        close(Oracle::new("lch_group_pose").step(&alone).position(0), [1.0, 1.0]);
        let w = Oracle::new("lch_group_pose").set("on_empty", "keep_heading").step(&alone);
        close(w.position(0), [1.0, 1.1]);
        close(w.velocity(0), [0.0, 0.1]);
    }
}
