//! Goes to a place.

use super::*;
use crate::parameters;
use crate::parameters::Points;

parameters! {
    /// Parameters of `goal`.
    pub struct Goal {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// The place: one point for all, or one for each member.
        point: Points<R> = Value::List(Vec::new()), "g", "length", Any, Ours;
        /// Distance within which the pull grows with the distance.
        arrive: R = 0.0, "a", "length", NonNegative, Ours;
    }
}

impl<R: Scalar> Term<R> for Goal<R> {
    const CARD: TermCard = TermCard {
        id: "goal",
        about: "Goes to a place, less eagerly where it has nearly come there.",
        equation: "min(1, |g - x_i| / a) unit(g - x_i)",
        edge: "at the place: zero",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    fn check(&self, dimensions: usize) -> Result<(), String> {
        match self.point.0.iter().find(|point| point.len() != dimensions) {
            Some(point) => Err(format!("its `point` needs {dimensions} coordinates, found {}", point.len())),
            None if self.point.0.is_empty() => Err(format!("it needs a `point` of {dimensions} coordinates")),
            None => Ok(()),
        }
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, _: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        let Some(point) = self.point.of(me.member()) else { return Vector::ZERO };
        let to = me.around.space.offset(me.position, point);
        let distance = to.length();
        if distance < self.arrive { to / self.arrive } else { to.unit() }
    }
}
