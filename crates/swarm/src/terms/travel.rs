//! Goes in a direction.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `travel`.
    pub struct Travel {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// The direction, as a vector of any length.
        direction: Vec<R> = Value::List(Vec::new()), "g", "1", Any, Ours;
    }
}

impl<R: Scalar> Term<R> for Travel<R> {
    const CARD: TermCard = TermCard {
        id: "travel",
        about: "Goes in a given direction of the world.",
        equation: "unit(g)",
        edge: "a direction of no length: zero",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    fn check(&self, dimensions: usize) -> Result<(), String> {
        if self.direction.len() == dimensions {
            return Ok(());
        }
        Err(format!("its `direction` needs {dimensions} components, found {}", self.direction.len()))
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, _: &Me<'_, R, D>, _: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        // as many as there are axes, which `check` has made sure of
        Vector(core::array::from_fn(|a| self.direction.get(a).copied().unwrap_or(R::ZERO))).unit()
    }
}
