//! Turns towards others, at the speed it has.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `turn_toward`.
    pub struct TurnToward {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for TurnToward<R> {
    const CARD: TermCard = TermCard {
        id: "turn_toward",
        about: "Turns towards the middle of the members of the set, without going faster or slower.",
        equation: "u - (u . h_i) h_i,  u = unit(mean d_ij)",
        edge: "nobody, or the middle is here: zero; at rest: u; in one dimension there is nowhere to turn",
        members: true,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn meet<L: Lanes<R>, const D: usize>(&self, sum: &mut Sum<L, D>, met: &Met<'_, R, L, D>, mask: L::Mask) {
        sum.add(mask, *met.offset);
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, sum: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        let wanted = sum.taken(Take::Mean).unit();
        wanted - me.heading() * wanted.dot(me.heading())
    }
}
