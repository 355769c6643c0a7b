//! Members that propel themselves and interact by two exponentials: the swarms of Levine, Rappel and Cohen (2000) and of D'Orsogna
//! et al. (2006).

use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

/// What moves a member besides others' attraction and repulsion.
#[derive(Clone, Copy, Debug)]
pub enum Propulsion<R> {
    /// A constant force along the mean heading of those near, and linear drag.
    Aligned {
        /// The force.
        strength: R,
        /// The drag.
        drag: R,
        /// Distance over which the headings of others count less.
        decay: R,
    },
    /// A force along the velocity and drag that grows with the square of the speed.
    Rayleigh {
        /// The force per velocity.
        strength: R,
        /// The drag.
        drag: R,
    },
}

/// The law.
#[derive(Debug)]
pub struct MorseSwarm<R> {
    /// Mass.
    pub mass: R,
    /// What moves a member by itself.
    pub propulsion: Propulsion<R>,
    /// Strength and length of repulsion.
    pub repulsion: [R; 2],
    /// Strength and length of attraction.
    pub attraction: [R; 2],
    /// Distance below which others count.
    pub range: R,
    /// Length of a step.
    pub time_step: R,
}

/// `strength/length exp(-rho/length)`.
fn slope<R: Scalar>([strength, length]: [R; 2], distance: R) -> R {
    strength / length * (-distance / length).exp()
}

impl<R: Scalar, const D: usize> Model<R, D> for MorseSwarm<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.range))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let (mut repulsion, mut attraction, mut headings) = (Vector::ZERO, Vector::ZERO, me.heading());
        for k in seen.set(0) {
            let (distance, direction) = (seen.distance(k), seen.direction(k));
            repulsion -= direction * slope(self.repulsion, distance);
            attraction += direction * slope(self.attraction, distance);
            if let Propulsion::Aligned { decay, .. } = self.propulsion {
                headings += seen.heading(k) * (-distance / decay).exp();
            }
        }
        let (drive, drag) = match self.propulsion {
            Propulsion::Aligned { strength, drag, .. } => (headings.unit() * strength, me.velocity * drag),
            Propulsion::Rayleigh { strength, drag } => {
                (me.velocity * strength, me.velocity * (drag * me.velocity.length_squared()))
            }
        };
        let force = drive - drag + repulsion + attraction;
        me.unit("force");
        me.note("propulsion", drive);
        me.note("drag", -drag);
        me.note("repulsion", repulsion);
        me.note("attraction", attraction);
        me.sum(force);
        Motion::new_velocity(me.velocity + force * (self.time_step / self.mass), self.time_step)
    }
}
