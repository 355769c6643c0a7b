//! What metrics of groups' ground share.

use crate::{Bounds, Parameter, Sample};
use space::Vector;
use std::collections::BTreeSet;

/// How fine ground is divided.
pub(super) const CELL_SIZE: Parameter = Parameter {
    name: "cell_size",
    unit: "length",
    default: None,
    bounds: Bounds::Positive,
    about: "Side of the cells into which the ground is divided.",
};

/// The cells in which a group has members, by their numbers along the axes.
pub(super) fn cells<const D: usize>(sample: &Sample<D>, size: f64) -> BTreeSet<[i64; D]> {
    sample.positions().iter().map(|place| cell_of(*place, size)).collect()
}

/// The cell of a place, by its numbers along the axes.
pub(super) fn cell_of<const D: usize>(place: Vector<f64, D>, size: f64) -> [i64; D] {
    place.0.map(|x| (x / size).floor() as i64)
}
