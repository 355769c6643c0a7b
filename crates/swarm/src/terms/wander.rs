//! Goes a random way.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `wander`.
    pub struct Wander {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for Wander<R> {
    const CARD: TermCard = TermCard {
        id: "wander",
        about: "Goes a new random way in every decision.",
        equation: "a unit vector, uniform over directions",
        edge: "supplied draws that leave `wander` out: zero",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, _: &Me<'_, R, D>, _: &Sum<R, D>, draws: &Draws<'_>, slot: u32) -> Vector<R, D> {
        draws.vector("wander", |s| s.unit(slot))
    }
}
