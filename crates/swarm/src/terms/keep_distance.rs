//! Keeps a distance to others, as if by springs.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `keep_distance`.
    pub struct KeepDistance {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// The distance that is kept.
        distance: R = 1.0, "d", "length", Positive, Ours;
        /// What is made of the vectors of all members of the set.
        take: Take = "mean", "-", "-", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for KeepDistance<R> {
    const CARD: TermCard = TermCard {
        id: "keep_distance",
        about: "Goes towards the members of the set that are farther away than a distance, and away from those nearer.",
        equation: "mean (rho_ij/d - 1) e_ij, or its sum, or the direction of the sum",
        edge: "nobody: zero; a coincident member has no direction, and is counted",
        members: true,
        velocity: false,
    };
    const DIRECTED: bool = true;
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn meet<L: Lanes<R>, const D: usize>(&self, sum: &mut Sum<L, D>, met: &Met<'_, R, L, D>, mask: L::Mask) {
        let stretched = met.distance / L::splat(self.distance) - L::splat(R::ONE);
        let mut pull = met.towards;
        for a in 0..D {
            pull[a] = pull[a] * stretched;
        }
        sum.add(mask, pull);
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, _: &Me<'_, R, D>, sum: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        sum.taken(self.take)
    }
}
