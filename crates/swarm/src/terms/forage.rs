//! Goes to food.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `forage`.
    pub struct Forage {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// Distance within which an item is seen.
        reach: R = 10.0, "r", "length", Positive, Ours;
    }
}

impl<R: Scalar> Term<R> for Forage<R> {
    const CARD: TermCard = TermCard {
        id: "forage",
        about: "Goes to the nearest item of the resource.",
        equation: "unit(x_item - x_i) of the nearest item, where it is nearer than r",
        edge: "no item, none near, or at the item: zero",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, _: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        match me.around.item {
            Some(item) if item.offset.length() < self.reach => item.offset.unit(),
            _ => Vector::ZERO,
        }
    }
}
