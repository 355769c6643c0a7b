//! Headings that approach those of neighbours by a share of their differences; leaders keep theirs.

use super::angles::{facing, turned};
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};

/// Consensus of headings in the plane.
#[derive(Debug)]
pub struct HeadingConsensus<R> {
    /// Interaction radius.
    pub radius: R,
    /// Speed, the same for all.
    pub speed: R,
    /// What the summed differences are divided by; 0: by one more than the neighbours are.
    pub gain: R,
    /// Members that keep their heading, by index in the group.
    pub leaders: Vec<usize>,
    /// Length of a step.
    pub time_step: R,
}

impl<R: Scalar> Model<R, 2> for HeadingConsensus<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, _: &Draws<'_>) -> Motion<R, 2> {
        let theta = me.velocity.angle();
        let (mut differences, mut neighbours) = (R::ZERO, R::ONE);
        for k in seen.set(0) {
            differences += (seen.velocity(k).angle() - theta).wrapped();
            neighbours += R::ONE;
        }
        let divisor = if self.gain > R::ZERO { self.gain } else { neighbours };
        let leads = self.leaders.contains(&me.member());
        let turn = if leads { R::ZERO } else { differences / divisor };
        if !self.leaders.is_empty() {
            me.either(["follow", "lead"], usize::from(leads));
        }
        me.value("summed differences of heading", differences, "rad");
        me.value("divided by", divisor, "1");
        me.value("turn", turn, "rad");
        let velocity = facing(turned(theta, turn)) * self.speed;
        me.unit("length/time");
        me.note("turned heading", velocity);
        me.sum(velocity);
        Motion::old_velocity(me.velocity, velocity, self.time_step)
    }
}
