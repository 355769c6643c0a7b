//! Steps towards the middle of those seen, or of their largest connected part: the four variations of the local crowded horizon.

use crate::choice;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
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

/// What is known of each input.
#[derive(Debug)]
pub enum Input {
    /// Where it is.
    Pose,
    /// The direction in which it lies.
    Bearing,
}

/// A step of fixed length towards the middle of the inputs.
#[derive(Debug)]
pub struct CrowdedHorizon<R> {
    /// What is known of the inputs.
    pub input: Input,
    /// Largest difference of two inputs that belong together (a length, or an angle in rad between bearings); only the largest
    /// connected component then counts. `None`: all inputs count.
    pub splitting_threshold: Option<R>,
    /// Length of a step.
    pub step_length: R,
    /// Distance below which inputs count.
    pub range: R,
    /// What a member does when nobody is detected.
    pub on_empty: OnEmpty,
}

thread_local! {
    /// Percepts in the order in which components are filled; kept between decisions so that none allocates.
    static ORDER: Cell<Vec<u32>> = const { Cell::new(Vec::new()) };
}

/// Calls `each` with the percepts of the largest connected component of set 0, in canonical order, and returns how many they
/// are. Of components of equal size it is the one with the lowest id.
fn largest_component<R: Scalar, const D: usize>(
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

impl<R: Scalar> CrowdedHorizon<R> {
    /// Adds up the inputs that count; returns the sum and how many they are.
    fn gather<const D: usize>(&self, me: &Me<'_, R, D>, seen: &Percepts<'_, R, D>) -> (Vector<R, D>, usize) {
        let (mut sum, mut size) = (Vector::ZERO, 0);
        let space = me.around.space;
        match (&self.input, self.splitting_threshold) {
            (Input::Pose, None) => seen.set(0).for_each(|k| {
                sum += seen.offset(k);
                size += 1;
            }),
            (Input::Bearing, None) => seen.set(0).for_each(|k| {
                sum += seen.direction(k);
                size += 1;
            }),
            (Input::Pose, Some(threshold)) => {
                let most = threshold.squared();
                let apart = |a: usize, b: usize| space.minimal(seen.offset(b) - seen.offset(a)).length_squared();
                size = largest_component(seen, |a, b| apart(a, b) <= most, |k| sum += seen.offset(k));
            }
            (Input::Bearing, Some(threshold)) => {
                // one of the two has no direction: no link
                let apart = |a: usize, b: usize| {
                    let (a, b) = (seen.direction(a), seen.direction(b));
                    if a.is_tiny() || b.is_tiny() { R::INFINITY } else { a.angle_to(b) }
                };
                size = largest_component(seen, |a, b| apart(a, b) <= threshold, |k| sum += seen.direction(k));
            }
        }
        (sum, size)
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for CrowdedHorizon<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("inputs", Perception::distance(R::ZERO, self.range))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let (sum, size) = self.gather(me, seen);
        let step = if size > 0 {
            let middle = match self.input {
                Input::Pose => {
                    me.unit("length");
                    sum / R::count(size)
                }
                Input::Bearing => sum,
            };
            me.value("inputs that count", R::count(size), "1");
            me.note("middle of the inputs", middle);
            me.sum(middle);
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
