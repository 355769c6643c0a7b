//! What a world does, compiled in this crate.
//!
//! A world is generic over precision and dimension, and code that is generic is compiled once more by every crate that uses it.
//! These are the doors to the engine that are not: [`Compiled`] is filled in by functions of one precision and dimension each.

use super::{Checkpoint, Explanation, World, WorldError};
use crate::parameters::Scalar;

/// The doors to the engine of one precision and dimension.
pub struct Compiled<R: Scalar, const D: usize> {
    pub(crate) step: fn(&mut World<R, D>),
    pub(crate) restore: fn(&mut World<R, D>, &Checkpoint<R, D>) -> Result<(), WorldError>,
    pub(crate) explain: fn(&mut World<R, D>, u32) -> Option<Explanation>,
    pub(crate) mean_neighbours: fn(&mut World<R, D>, usize) -> f64,
}

impl<R: Scalar, const D: usize> Clone for Compiled<R, D> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<R: Scalar, const D: usize> Copy for Compiled<R, D> {}
