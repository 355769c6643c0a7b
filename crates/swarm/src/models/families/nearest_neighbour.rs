//! Steps towards the nearest neighbour until it is near enough.

use super::environment::Environment;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

/// Nearest neighbour: a step of fixed length towards the nearest neighbour, if that is farther than the repulsion distance.
#[derive(Debug)]
pub struct NearestNeighbour<R> {
    /// Distance below which others are perceived; `None`: everyone is.
    pub range: Option<R>,
    /// Length of a step.
    pub step_length: R,
    /// Distance at which the neighbour is near enough.
    pub repulsion_distance: R,
    /// Avoidance of walls and discs, for the model that has it.
    pub environment: Option<Environment<R>>,
}

impl<R: Scalar, const D: usize> Model<R, D> for NearestNeighbour<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        let nearest = match self.range {
            None => Perception::Nearest,
            Some(range) => Perception::Sequence(vec![Perception::distance(R::ZERO, range), Perception::Nearest]),
        };
        vec![NamedSet::new("neighbours", nearest)]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let (far, step) = match seen.nearest(0) {
            Some(k) if seen.distance(k) > self.repulsion_distance => (true, seen.direction(k) * self.step_length),
            _ => (false, Vector::ZERO),
        };
        me.either(["approach", "stay"], usize::from(!far));
        let step = match self.environment {
            Some(environment) => environment.steer(me, step),
            None => {
                me.unit("length");
                me.note("nearest", step);
                me.sum(step);
                step
            }
        };
        Motion::step(step)
    }
}
