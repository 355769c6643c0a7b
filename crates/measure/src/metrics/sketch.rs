//! Small groups for tests.

use crate::Sample;
use space::{Columns, Frame, GroupRange, Real, Space, Vector};

/// Position and velocity of each member.
pub(crate) type Members<const D: usize> = Vec<([f64; D], [f64; D])>;

/// A group in a space.
pub(crate) fn sample<const D: usize>(space: Space<f64, D>, members: &[([f64; D], [f64; D])]) -> Sample<D> {
    Sample::new(space, members.iter().map(|&(x, v)| (Vector(x), Vector(v))))
}

/// Members at places, all moving alike.
pub(crate) fn placed<const D: usize>(space: Space<f64, D>, places: &[[f64; D]]) -> Sample<D> {
    sample(space, &Members::from_iter(places.iter().map(|&place| (place, [1.0; D]))))
}

/// Members side by side in the plane, with velocities.
pub(crate) fn moving(velocities: &[[f64; 2]]) -> Sample<2> {
    let member = |(k, &velocity)| ([k as f64, 0.0], velocity);
    sample(Space::open(), &Members::from_iter(velocities.iter().enumerate().map(member)))
}

/// What a frame borrows from.
pub(crate) struct Scene<R, const D: usize> {
    pub(crate) columns: Columns<R, D>,
    pub(crate) space: Space<R, D>,
    pub(crate) groups: Vec<GroupRange>,
}

impl<R: Real, const D: usize> Scene<R, D> {
    /// Members whose ids are their places in the list.
    pub(crate) fn new(space: Space<R, D>, members: &[([f64; D], [f64; D])]) -> Self {
        let mut columns = Columns::new(members.len(), 0);
        for (row, (position, velocity)) in members.iter().enumerate() {
            columns.set_position(row, Vector::of(position));
            columns.set_velocity(row, Vector::of(velocity));
        }
        Self { columns, space, groups: Vec::new() }
    }
    pub(crate) fn frame(&self) -> Frame<'_, R, D> {
        Frame { columns: &self.columns, declared: &[], groups: &self.groups, space: &self.space, time: 0.0, step: 0 }
    }
}

/// Asserts that a metric is defined and has this value, up to 1e-12 of it.
#[track_caller]
pub(crate) fn close(found: Option<f64>, expected: f64) {
    let fine = found.is_some_and(|found| (found - expected).abs() <= 1e-12 * expected.abs().max(1.0));
    assert!(fine, "found {found:?}, expected {expected}");
}
