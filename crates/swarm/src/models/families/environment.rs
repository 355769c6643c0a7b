//! Environment avoidance of the "plus" models: an intended step is turned away from what is near. Whether the step is then made
//! is the body's affair (a move into a wall or a disc is refused).

use crate::motion::Me;
use crate::parameters::Scalar;
use space::Vector;

/// How a step is turned away from walls and discs.
#[derive(Clone, Copy, Debug)]
pub struct Environment<R> {
    /// Distance below which they matter.
    pub range: R,
    /// Weight of the way out, beside the intended direction.
    pub weight: R,
}

impl<R: Scalar> Environment<R> {
    /// How far the law looks for obstacles.
    pub fn reach(&self) -> Option<R> {
        (self.range > R::ZERO).then_some(self.range)
    }
    /// The sum over walls and discs of the directions away from them, fading to 0 at the range, weighted.
    fn away<const D: usize>(&self, me: &Me<'_, R, D>) -> Vector<R, D> {
        let mut away = Vector::ZERO;
        for near in me.around.obstacles.iter().filter(|near| near.distance < self.range) {
            away += near.away * (R::ONE - near.distance.most(R::ZERO) / self.range);
        }
        away * self.weight
    }
    /// The directions intended and out of the way, and what they make of an intended displacement: one of the same length; none
    /// stays none. Where intention and way out cancel, the heading is kept.
    pub fn turned<const D: usize>(&self, me: &Me<'_, R, D>, intended: Vector<R, D>) -> [Vector<R, D>; 3] {
        let along = intended.unit();
        if along.is_tiny() {
            return [Vector::ZERO, Vector::ZERO, intended];
        }
        let away = self.away(me);
        [along, away, (along + away).unit_or(me.heading()) * intended.length()]
    }
    /// The same displacement, told.
    pub fn steer<const D: usize>(&self, me: &mut Me<'_, R, D>, intended: Vector<R, D>) -> Vector<R, D> {
        let [along, away, turned] = self.turned(me, intended);
        me.note("intended direction", along);
        me.note("environment", away);
        me.sum(along + away);
        turned
    }
}
