//! Propulsion along the mean heading of those near, drag, and repulsion and attraction that decay over different lengths.
//!
//! H. Levine, W.-J. Rappel, I. Cohen (2000), Self-organization in systems of self-propelled particles, Physical Review E 63:017101.

use crate::card::*;
use crate::models::families::morse::{MorseSwarm, Propulsion};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `levine_2000`.
    pub struct Levine2000 {
        /// Mass.
        mass alias "m": R = 1.0, "m", "mass", Positive, Ours;
        /// Propulsion.
        propulsion alias "alpha": R = 1.0, "alpha", "force", NonNegative, Ours;
        /// Drag.
        drag alias "beta": R = 0.5, "beta", "mass/time", NonNegative, Ours;
        /// Strength of repulsion.
        repulsion_strength alias "C_r": R = 1.0, "C_r", "energy", NonNegative, Ours;
        /// Distance over which repulsion decays.
        repulsion_length alias "l_r": R = 0.5, "l_r", "length", Positive, Ours;
        /// Strength of attraction.
        attraction_strength alias "C_a": R = 0.5, "C_a", "energy", NonNegative, Ours;
        /// Distance over which attraction decays.
        attraction_length alias "l_a": R = 2.0, "l_a", "length", Positive, Ours;
        /// Distance over which the headings of others count less.
        alignment_length alias "l_c": R = 1.0, "l_c", "length", Positive, Ours;
        /// Distance below which others count.
        range: R = 10.0, "beta", "length", Positive, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Levine2000<R> {
    const CARD: Card = Card {
        id: "levine_2000",
        title: "Levine et al. 2000",
        about: "Particles propel themselves along the mean heading of those near, repel nearby and attract farther away.",
        reference: "H. Levine, W.-J. Rappel, I. Cohen (2000). Self-organization in systems of self-propelled particles. Physical \
                    Review E 63, 017101. doi:10.1103/PhysRevE.63.017101",
        equations: "f_i = unit(h_i + sum_{j in I} h_j exp(-rho/l_c))\n\
                    acc = (1/m)(alpha f_i - beta v_i - sum (C_r/l_r exp(-rho/l_r) - C_a/l_a exp(-rho/l_a)) e_ij)\n\
                    v_i' = v_i + Dt acc;  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range)",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the table marks f with a hat but gives a bare sum: normalised, with self. Its w4, w5 are the repulsive pair, \
                     w6, w7 the attractive one",
        edge: "at rest and alone: f = 0; coincident members align but have no direction",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: false,
            information: [Information::Global, Information::Constant, Information::Global],
            environment: "periodic free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
}

impl<R: Scalar> Variant<R> for Levine2000<R> {
    type Shared = MorseSwarm<R>;
    fn shared(&self) -> Self::Shared {
        MorseSwarm {
            mass: self.mass,
            propulsion: Propulsion::Aligned {
                strength: self.propulsion,
                drag: self.drag,
                decay: self.alignment_length,
            },
            repulsion: [self.repulsion_strength, self.repulsion_length],
            attraction: [self.attraction_strength, self.attraction_length],
            range: self.range,
            time_step: self.time_step,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn the_lone_reach_their_speed() {
        let w = Oracle::new("levine_2000").step(&[([0.0, 0.0], [1.0, 0.0])]);
        close(w.velocity(0), [1.025, 0.0]);
        close(w.position(0), [0.05125, 0.0]);
        let mut w = Oracle::new("levine_2000").world(&[([0.0, 0.0], [0.0, 1.0])]);
        w.run(1000);
        close(w.velocity(0), [0.0, 2.0]);
        close(Oracle::new("levine_2000").step(&[([0.0, 0.0], [0.0, 0.0])]).velocity(0), [0.0, 0.0]);
    }

    #[test]
    fn two_exponentials_and_alignment_that_fades() {
        let still = |x: f64| {
            let agents = [([0.0, 0.0], [0.0, 0.0]), ([x, 0.0], [0.0, 0.0])];
            Oracle::new("levine_2000").set("m", 2.0).step(&agents).velocity(0)
        };
        let force = |x: f64| 0.25 * (-x / 2.0).exp() - 2.0 * (-x / 0.5).exp();
        for x in [0.3, 1.0, 3.0] {
            close(still(x), [0.025 * force(x), 0.0]);
        }
        close(still(0.0), [0.0, 0.0]);
        close(still(10.0), [0.0, 0.0]);
        // headings: unit((1, 0) + exp(-2) (0, 1)), without pair forces
        let w = Oracle::new("levine_2000")
            .set("C_r", 0.0)
            .set("C_a", 0.0)
            .step(&[([0.0; 3], [1.0, 0.0, 0.0]), ([0.0, 0.0, 2.0], [0.0, 1.0, 0.0])]);
        let (near, length) = ((-2.0f64).exp(), (1.0 + (-4.0f64).exp()).sqrt());
        close(w.velocity(0), [0.975 + 0.05 / length, 0.05 * near / length, 0.0]);
    }
}
