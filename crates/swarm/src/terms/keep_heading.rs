//! Goes on as before.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `keep_heading`.
    pub struct KeepHeading {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for KeepHeading<R> {
    const CARD: TermCard = TermCard {
        id: "keep_heading",
        about: "Goes on in its own direction.",
        equation: "h_i",
        edge: "at rest: zero",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, _: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        me.heading()
    }
}
