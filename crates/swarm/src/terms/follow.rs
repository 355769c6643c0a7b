//! Follows the nearest.

use super::*;
use crate::parameters;
use space::lanes::Mask;

parameters! {
    /// Parameters of `follow`.
    pub struct Follow {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// Distance at which it is close enough.
        gap: R = 0.0, "g", "length", NonNegative, Ours;
    }
}

impl<R: Scalar> Term<R> for Follow<R> {
    const CARD: TermCard = TermCard {
        id: "follow",
        about: "Goes towards the nearest member of the set.",
        equation: "e_ij of the nearest j",
        edge: "nobody, a coincident member, or the nearest no farther away than the gap: zero; of several at the same distance \
               the first in canonical order",
        members: true,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    /// Keeps the offset of the nearest, with its squared distance as the total (0: none yet).
    #[inline(always)]
    fn meet<L: Lanes<R>, const D: usize>(&self, sum: &mut Sum<L, D>, met: &Met<'_, R, L, D>, mask: L::Mask) {
        let squared = met.squared.greater(L::splat(R::TINY * R::TINY));
        let first = sum.total.less_equal(L::splat(R::ZERO));
        let nearer = mask.and(first.or(squared.less(sum.total)));
        for a in 0..D {
            sum.vector[a] = L::choose(nearer, met.offset[a], sum.vector[a]);
        }
        sum.total = L::choose(nearer, squared, sum.total);
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, _: &Me<'_, R, D>, sum: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        if sum.total > self.gap * self.gap { Vector(sum.vector).unit() } else { Vector::ZERO }
    }
}
