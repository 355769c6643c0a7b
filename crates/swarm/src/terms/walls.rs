//! Keeps away from obstacles and walls.

use super::*;
use crate::parameters;

parameters! {
    /// Parameters of `walls`.
    pub struct Walls {
        /// What the vector is multiplied by.
        weight: R = 1.0, "w", "length/time^2", Any, Ours;
        /// Distance within which they matter.
        reach: R = 1.0, "r", "length", Positive, Ours;
    }
}

impl<R: Scalar> Term<R> for Walls<R> {
    const CARD: TermCard = TermCard {
        id: "walls",
        about: "Goes away from walls and obstacles, the more the nearer they are.",
        equation: "sum (1 - rho_iw/r) away_w  over walls and obstacles w nearer than r",
        edge: "nothing near: zero; on a surface or inside an obstacle: out of it with all its weight",
        members: false,
        velocity: false,
    };
    fn weight(&self) -> R {
        self.weight
    }
    fn obstacle_reach(&self) -> Option<R> {
        Some(self.reach)
    }
    #[inline(always)]
    fn vector<const D: usize>(&self, me: &Me<'_, R, D>, _: &Sum<R, D>, _: &Draws<'_>, _: u32) -> Vector<R, D> {
        let mut sum = Vector::ZERO;
        for near in me.around.obstacles.iter().filter(|near| near.distance < self.reach) {
            sum += near.away * (R::ONE - near.distance.most(R::ZERO) / self.reach);
        }
        sum
    }
}
