//! Velocities that are sums of linear attraction and exponential repulsion by everyone.
//!
//! V. Gazi, K. M. Passino (2003), Stability analysis of swarms, IEEE Transactions on Automatic Control 48:692.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `gazi_passino_2003`.
    pub struct GaziPassino2003 {
        /// Attraction.
        attraction alias "a": R = 1.0, "a", "1/time", NonNegative, Paper;
        /// Repulsion, more than the attraction.
        repulsion alias "b": R = 20.0, "b", "1/time", NonNegative, Paper;
        /// Square of the distance over which repulsion decays.
        repulsion_area alias "c": R = 0.2, "c", "length^2", Positive, Paper;
        /// Length of a step.
        time_step alias "dt": R = 0.01, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for GaziPassino2003<R> {
    const CARD: Card = Card {
        id: "gazi_passino_2003",
        title: "Gazi and Passino 2003",
        about: "Members move by the sum of a linear attraction to everyone and a repulsion by those near.",
        reference: "V. Gazi, K. M. Passino (2003). Stability analysis of swarms. IEEE Transactions on Automatic Control 48, \
                    692-697. doi:10.1109/TAC.2003.809765",
        equations: "v_i' = sum_j d_ij (a - b exp(-rho_ij^2/c)),  b > a;  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = all",
            motion: "velocity",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the exponent of the table is garbled and a derivative is missing: it sets a position equal to the velocity",
        edge: "coincident members never part (the force is 0); alone: stays",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, true],
            validation: "M",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "none",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.repulsion > self.attraction { Ok(()) } else { Err("`repulsion` must be more than `attraction`".into()) }
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for GaziPassino2003<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::All)]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let (mut attraction, mut repulsion) = (Vector::ZERO, Vector::ZERO);
        for k in seen.set(0) {
            let offset = seen.offset(k);
            attraction += offset * self.attraction;
            repulsion -= offset * (self.repulsion * (-seen.squared[k] / self.repulsion_area).exp());
        }
        let velocity = attraction + repulsion;
        me.unit("length/time");
        me.note("attraction", attraction);
        me.note("repulsion", repulsion);
        me.sum(velocity);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn a_pair_by_hand_and_at_rest() {
        // (1 - 20 exp(-5/4)) at half a unit
        let speed = 0.5 * (1.0 - 20.0 * (-1.25f64).exp());
        let w = Oracle::new("gazi_passino_2003").step(&[([0.0, 0.0], [7.0, 7.0]), ([0.0, 0.5], [0.0, 0.0])]);
        close(w.velocity(0), [0.0, speed]);
        close(w.position(0), [0.0, 0.01 * speed]);
        let balance = (0.2 * 20f64.ln()).sqrt();
        let w = Oracle::new("gazi_passino_2003").step(&[([0.0], [0.0]), ([balance], [0.0])]);
        close(w.velocity(0), [0.0]);
        close(Oracle::new("gazi_passino_2003").step(&[([1.0], [5.0])]).position(0), [1.0]);
        close(Oracle::new("gazi_passino_2003").step(&[([1.0], [5.0]); 2]).velocity(0), [0.0]);
    }

    #[test]
    fn the_centroid_stays_and_all_end_near_it() {
        let places = [[0.0, 0.0, 0.0], [3.0, 0.0, 1.0], [0.0, 4.0, 0.0], [1.0, 1.0, 5.0], [-4.0, 2.0, 1.0]];
        let mut w = Oracle::new("gazi_passino_2003").world(&places.map(|place| (place, [0.0; 3])));
        w.run(2000);
        let centre = space::Vector([0.0, 7.0 / 5.0, 7.0 / 5.0]);
        let mean = (0..5).map(|id| w.position(id)).fold(space::Vector::ZERO, |sum, x| sum + x) / 5.0;
        close(mean, centre.0);
        let bound = 20.0 * 0.1f64.sqrt() * (-0.5f64).exp();
        assert!((0..5).all(|id| (w.position(id) - centre).length() <= bound));
    }
}
