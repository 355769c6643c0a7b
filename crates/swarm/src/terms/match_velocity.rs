//! Matches the velocity of others.

use super::*;
use crate::motion::splat;
use crate::parameters;

parameters! {
    /// Parameters of `match_velocity`.
    pub struct MatchVelocity {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "1/time", Any, Ours;
        /// What is made of the differences to all members of the set.
        take: Take = "mean", "-", "-", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for MatchVelocity<R> {
    const CARD: TermCard = TermCard {
        id: "match_velocity",
        about: "Takes the velocity of the members of the set, direction and speed.",
        equation: "mean (v_j - v_i), or its sum, or the direction of the sum",
        edge: "nobody: zero",
        members: true,
        velocity: true,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn meet<L: Lanes<R>, const D: usize>(&self, sum: &mut Sum<L, D>, met: &Met<'_, R, L, D>, mask: L::Mask) {
        let mut difference: [L; D] = splat(met.other.velocity);
        for a in 0..D {
            difference[a] = difference[a] - met.me.velocity[a];
        }
        sum.add(mask, difference);
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, _: &Me<'_, R, D>, sum: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        sum.taken(self.take)
    }
}
