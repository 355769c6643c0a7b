//! Comes back to a speed.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `keep_speed`.
    pub struct KeepSpeed {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "1/time", Any, Ours;
        /// The speed that is kept.
        speed: R = 1.0, "v_0", "length/time", NonNegative, Ours;
    }
}

impl<R: Scalar> Term<R> for KeepSpeed<R> {
    const CARD: TermCard = TermCard {
        id: "keep_speed",
        about: "Goes faster or slower, towards a speed of its own.",
        equation: "(v_0 - |v_i|) h_i",
        edge: "at rest: zero, since there is no direction to go faster in",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, _: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        me.heading() * (self.speed - me.velocity.length())
    }
}
