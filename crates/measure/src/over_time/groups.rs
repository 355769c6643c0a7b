//! What metrics of groups' ground share.

use crate::{Bounds, Parameter, Sample};
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
    sample.positions().iter().map(|place| place.0.map(|x| (x / size).floor() as i64)).collect()
}
