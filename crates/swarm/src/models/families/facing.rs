//! Bodies that face somewhere also while they stand: the column `theta`.

use super::angles::{bearing, facing};
use crate::motion::{Percepts, Start};
use crate::parameters::Scalar;
use space::{Column, ColumnKind, Vector};

/// The column, first among those of a model that has it.
pub const THETA: Column =
    Column { name: "theta", unit: "rad", kind: ColumnKind::Quantity, about: "Orientation, also while standing." };

/// Completes an initial state: an orientation that is not given is that of the velocity, a velocity that is not given is `speed`
/// along the orientation.
pub fn complete<R: Scalar>(start: &mut Start<'_, R, 2>, speed: R) {
    if !start.given[0] {
        start.own[0] = start.velocity.angle();
        return;
    }
    start.own[0] = start.own[0].wrapped();
    if !start.velocity_given {
        *start.velocity = facing(start.own[0]) * speed;
    }
}

/// The orientation after a body moved otherwise than wanted: along its velocity, or against it where it backs up.
pub fn performed<R: Scalar>(own: &mut [R], velocity: Vector<R, 2>) {
    if !velocity.is_tiny() {
        let backs = velocity.dot(facing(own[0])) < R::ZERO;
        own[0] = if backs { -velocity } else { velocity }.angle();
    }
}

/// The nearest of set `set` that lies ahead of a body facing `theta` (up to a quarter turn to either side).
pub fn nearest_ahead<R: Scalar>(seen: &Percepts<'_, R, 2>, set: usize, theta: R) -> Option<usize> {
    nearest_within(seen, set, theta, R::PI * R::HALF)
}

/// The nearest of set `set` that lies within an angle to either side of where a body faces; ties go to the lower id.
pub fn nearest_within<R: Scalar>(seen: &Percepts<'_, R, 2>, set: usize, theta: R, half_angle: R) -> Option<usize> {
    let mut best: Option<usize> = None;
    for k in seen.set(set) {
        let nearer = |b: usize| (seen.squared[k], seen.id(k)) < (seen.squared[b], seen.id(b));
        if best.is_none_or(nearer) && bearing(seen, k, theta).abs() <= half_angle {
            best = Some(k);
        }
    }
    best
}
