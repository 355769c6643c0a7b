//! Agreement on velocity and a potential that keeps a distance: the stable flocks of Tanner, Jadbabaie and Pappas.

use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

/// The law.
#[derive(Debug)]
pub struct StableFlock<R> {
    /// Distance from which members do not see each other; `None`: they see others by number, however far.
    pub radius: Option<R>,
    /// Neighbours of each member, by index in the group; empty: all of the group are.
    pub lists: Vec<Vec<usize>>,
    /// Length of a step.
    pub time_step: R,
}

impl<R: Scalar, const D: usize> Model<R, D> for StableFlock<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new(
            "neighbours",
            match self.radius {
                Some(radius) => Perception::distance(R::ZERO, radius),
                None => Perception::All,
            },
        )]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let list = self.lists.get(me.member());
        let first = me.around.group.0;
        let (mut consensus, mut forces) = (Vector::ZERO, Vector::ZERO);
        for k in seen.set(0) {
            if self.radius.is_none() {
                let number = seen.id(k).wrapping_sub(first);
                let listed = list.map_or(number < me.around.group.1, |list| list.contains(&(number as usize)));
                if !listed {
                    continue;
                }
            }
            consensus += seen.velocity(k) - me.velocity;
            let distance = seen.distance(k);
            let slope = R::of(2.0) / distance - R::of(2.0) / (distance * distance * distance);
            if distance > R::TINY {
                forces += seen.direction(k) * slope;
            }
        }
        let acceleration = consensus + forces;
        me.unit("length/time^2");
        me.note("consensus", consensus);
        me.note("potential", forces);
        me.sum(acceleration);
        Motion::new_velocity(me.velocity + acceleration * self.time_step, self.time_step)
    }
}
