//! Steps towards the middle of those seen, or of their largest connected part: the four variations of the local crowded horizon.

use crate::choice;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use core::cell::Cell;
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

/// An input in the order along the first axis.
struct Node {
    place: [f64; 3],
    percept: u32,
    /// Inputs to both sides of it; those that were left meanwhile lead on to farther ones.
    beside: [u32; 2],
    /// Whether it is in a component.
    taken: bool,
}

/// What components are filled in; kept between decisions so that none allocates.
#[derive(Default)]
struct Room {
    nodes: Vec<Node>,
    component: Vec<u32>,
    largest: Vec<u32>,
}

thread_local! {
    static ROOM: Cell<Room> = const { Cell::new(Room { nodes: Vec::new(), component: Vec::new(), largest: Vec::new() }) };
}

/// No input.
const NONE: u32 = u32::MAX;

/// The next input on a side that is in no component yet.
fn next_free(nodes: &mut [Node], from: u32, side: usize) -> u32 {
    let mut next = nodes[from as usize].beside[side];
    while next != NONE && nodes[next as usize].taken {
        next = nodes[next as usize].beside[side];
    }
    nodes[from as usize].beside[side] = next;
    next
}

/// How the places of two inputs tell whether they are linked.
struct Nearness {
    /// The squared distance up to which they are.
    bound: f64,
    /// Places that are wrong by rounding say so unless they are farther than that from the bound; infinite where they say nothing.
    margin: f64,
}

/// Calls `each` with the percepts of the largest connected component of set 0, in canonical order, and returns how many they
/// are. Of components of equal size it is the one with the lowest id. `linked` is asked where places are not enough.
fn largest_component<R: Scalar, const D: usize>(
    seen: &Percepts<'_, R, D>,
    linked: impl Fn(usize, usize) -> bool,
    place: impl Fn(usize) -> Vector<R, D>,
    bound: Option<f64>,
    each: impl FnMut(usize),
) -> usize {
    let Room { mut nodes, mut component, mut largest } = ROOM.take();
    nodes.clear();
    largest.clear();
    let mut extent: f64 = 0.0;
    for k in seen.set(0) {
        let mut node = Node { place: [0.0; 3], percept: k as u32, beside: [NONE; 2], taken: false };
        for (to, from) in node.place.iter_mut().zip(place(k).0) {
            *to = from.to_f64();
            extent = extent.max(if to.is_finite() { to.abs() } else { 0.0 });
        }
        nodes.push(node);
    }
    nodes.sort_unstable_by(|a, b| a.place[0].total_cmp(&b.place[0]).then(a.percept.cmp(&b.percept)));
    let near = match bound {
        Some(bound) => Nearness { bound, margin: 1e-5 * (bound + bound.sqrt() * extent) },
        None => Nearness { bound: 0.0, margin: f64::INFINITY },
    };
    let reach = (near.bound + near.margin).sqrt();
    let count = nodes.len();
    for (k, node) in nodes.iter_mut().enumerate() {
        node.beside = [if k > 0 { k as u32 - 1 } else { NONE }, if k + 1 < count { k as u32 + 1 } else { NONE }];
    }
    let (mut lowest_of_largest, mut taken) = (NONE, 0);
    for start in 0..count {
        // no smaller rest can win
        if count - taken < largest.len() {
            break;
        }
        if nodes[start].taken {
            continue;
        }
        nodes[start].taken = true;
        component.clear();
        component.push(start as u32);
        let mut next = 0;
        while next < component.len() {
            let here = component[next];
            let (place, percept) = (nodes[here as usize].place, nodes[here as usize].percept);
            for side in 0..2 {
                let mut other = next_free(&mut nodes, here, side);
                while other != NONE {
                    let node = &mut nodes[other as usize];
                    let [x, y, z] = [0, 1, 2].map(|a| node.place[a] - place[a]);
                    if x.abs() > reach {
                        break;
                    }
                    let beyond = x * x + y * y + z * z - near.bound;
                    let sure = beyond.abs() > near.margin;
                    if if sure { beyond < 0.0 } else { linked(percept as usize, node.percept as usize) } {
                        node.taken = true;
                        component.push(other);
                    }
                    other = next_free(&mut nodes, other, side);
                }
            }
            next += 1;
        }
        taken += component.len();
        for member in &mut component {
            *member = nodes[*member as usize].percept;
        }
        let lowest = component.iter().map(|&k| seen.id(k as usize)).min().unwrap_or(NONE);
        if component.len() > largest.len() || (component.len() == largest.len() && lowest < lowest_of_largest) {
            lowest_of_largest = lowest;
            core::mem::swap(&mut component, &mut largest);
        }
    }
    largest.sort_unstable();
    largest.iter().map(|&k| k as usize).for_each(each);
    let size = largest.len();
    ROOM.set(Room { nodes, component, largest });
    size
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
                // around the edge of a periodic space links reach anywhere
                let bound = (!space.is_periodic()).then(|| threshold.to_f64() * threshold.to_f64());
                let place = |k: usize| seen.offset(k);
                size = largest_component(seen, |a, b| apart(a, b) <= most, place, bound, |k| sum += seen.offset(k));
            }
            (Input::Bearing, Some(threshold)) => {
                // one of the two has no direction: no link
                let apart = |a: usize, b: usize| {
                    let (a, b) = (seen.direction(a), seen.direction(b));
                    if a.is_tiny() || b.is_tiny() { R::INFINITY } else { a.angle_to(b) }
                };
                // the square of the chord
                let chord = 2.0 * (threshold.to_f64() * 0.5).min(core::f64::consts::FRAC_PI_2).sin();
                let place = |k: usize| {
                    let direction = seen.direction(k);
                    if direction.is_tiny() { Vector([R::INFINITY; D]) } else { direction }
                };
                size = largest_component(
                    seen,
                    |a, b| apart(a, b) <= threshold,
                    place,
                    Some(chord * chord),
                    |k| sum += seen.direction(k),
                );
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
