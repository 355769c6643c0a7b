//! Goes towards others.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `attract`.
    pub struct Attract {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// How much a member counts by its distance.
        by_distance: ByDistance = "linear", "f", "-", Any, Ours;
        /// The distance at which it counts once.
        scale: R = 1.0, "s", "length", Positive, Ours;
        /// What is made of the vectors to all members of the set.
        take: Take = "mean", "-", "-", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for Attract<R> {
    const CARD: TermCard = TermCard {
        id: "attract",
        about: "Goes towards the members of the set.",
        equation: "mean f(rho_ij/s) e_ij, or its sum, or the direction of the sum;\n\
                   f(x) = 1 (constant), x (linear), 1/x (inverse), 1/x^2 (inverse_square), max(0, 1 - x) (falling)",
        edge: "nobody: zero; a coincident member has no direction, and is counted; inverse distances are floored at s/1000",
        members: true,
        velocity: false,
    };
    const DIRECTED: bool = true;
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn meet<L: Lanes<R>, const D: usize>(&self, sum: &mut Sum<L, D>, met: &Met<'_, R, L, D>, mask: L::Mask) {
        sum.add(mask, met.counted(self.by_distance, self.scale));
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, _: &Me<'_, R, D>, sum: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        sum.taken(self.take)
    }
}
