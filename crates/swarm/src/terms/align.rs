//! Takes the direction of others.

use super::*;
use crate::motion::splat;
use crate::parameters;

parameters! {
    /// Parameters of `align`.
    pub struct Align {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// What is made of the headings of all members of the set.
        take: Take = "mean", "-", "-", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for Align<R> {
    const CARD: TermCard = TermCard {
        id: "align",
        about: "Takes the direction in which the members of the set move.",
        equation: "mean h_j, or sum h_j, or unit(sum h_j)",
        edge: "nobody: zero; a member at rest has no heading, and is counted",
        members: true,
        velocity: true,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn meet<L: Lanes<R>, const D: usize>(&self, sum: &mut Sum<L, D>, met: &Met<'_, R, L, D>, mask: L::Mask) {
        sum.add(mask, splat(met.other.heading));
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, _: &Me<'_, R, D>, sum: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        sum.taken(self.take)
    }
}
