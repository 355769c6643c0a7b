//! Everyone is drawn to the velocities of all others, the less the farther they are.
//!
//! F. Cucker, S. Smale (2007), Emergent behavior in flocks, IEEE Transactions on Automatic Control 52:852.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `cucker_smale_2007`.
    pub struct CuckerSmale2007 {
        /// Strength of the coupling.
        coupling alias "K": R = 1.0, "K", "length^(2 beta)/time", NonNegative, Ours;
        /// Distance beyond which the coupling decays.
        decay_length alias "sigma": R = 1.0, "sigma", "length", Positive, Ours;
        /// Exponent of the decay; below 1/2 every start ends in a flock.
        decay_exponent alias "beta": R = 0.4, "beta", "1", NonNegative, Ours;
        /// Whether the sum is divided by the number of members.
        normalise: bool = false, "-", "-", Any, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for CuckerSmale2007<R> {
    const CARD: Card = Card {
        id: "cucker_smale_2007",
        title: "Cucker and Smale 2007",
        about: "Members are drawn to the velocities of all others, the less the farther these are.",
        reference: "F. Cucker, S. Smale (2007). Emergent behavior in flocks. IEEE Transactions on Automatic Control 52, \
                    852-862. doi:10.1109/TAC.2007.895842",
        equations: "v_i' = v_i + Dt sum_{j in I} K / (sigma^2 + rho_ij^2)^beta (v_j - v_i)\n\
                    the sum divided by N where normalised\n\
                    x_i' = x_i + v_i Dt  (old velocity)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = all",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "not in the source's table; N is the number of neighbours and oneself, which is that of all members \
                     where everyone is detected",
        edge: "alone: keeps its velocity; coincident members use rho = 0",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, true, false],
            validation: "M",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::None],
            environment: "unbounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for CuckerSmale2007<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::All)]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let least = self.decay_length * self.decay_length;
        let mut consensus = Vector::ZERO;
        let mut members = R::ONE;
        for k in seen.set(0) {
            // the power by way of the logarithm, which costs less
            let weight = self.coupling * ((least + seen.squared[k]).most(R::TINY).ln() * -self.decay_exponent).exp();
            consensus += (seen.velocity(k) - me.velocity) * weight;
            members += R::ONE;
        }
        if self.normalise {
            consensus = consensus / members;
        }
        me.unit("length/time^2");
        me.note("consensus", consensus);
        me.sum(consensus);
        Motion::old_velocity(me.velocity, me.velocity + consensus * self.time_step, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn a_pair_exchanges_velocity_and_moves_with_the_old_one() {
        // sigma^2 + rho^2 = 4, so the weight is 2 / 4^(1/2) = 1
        let pair = [([0.0, 0.0], [1.0, 0.0]), ([0.0, 3f64.sqrt()], [0.0, 1.0])];
        let model = || Oracle::new("cucker_smale_2007").set("K", 2.0).set("beta", 0.5);
        let w = model().step(&pair);
        close(w.velocity(0), [0.95, 0.05]);
        close(w.velocity(1), [0.05, 0.95]);
        close(w.position(0), [0.05, 0.0]);
        close(model().set("normalise", true).step(&pair).velocity(0), [0.975, 0.025]);
    }

    #[test]
    fn coincident_members_couple_fully_and_the_lone_go_on() {
        let w = Oracle::new("cucker_smale_2007").step(&[([2.0], [1.0]), ([2.0], [-1.0])]);
        close(w.velocity(0), [0.9]);
        close(w.velocity(1), [-0.9]);
        let w = Oracle::new("cucker_smale_2007").step(&[([0.0, 0.0, 0.0], [1.0, 2.0, 3.0])]);
        close(w.velocity(0), [1.0, 2.0, 3.0]);
        close(w.position(0), [0.05, 0.1, 0.15]);
    }
}
