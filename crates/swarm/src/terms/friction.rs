//! Slows down.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `friction`.
    pub struct Friction {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "1/time", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for Friction<R> {
    const CARD: TermCard = TermCard {
        id: "friction",
        about: "Slows down in proportion to its speed.",
        equation: "-v_i",
        edge: "at rest: zero",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, _: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        -me.velocity
    }
}
