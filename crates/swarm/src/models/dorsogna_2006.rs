//! Propulsion with quadratic drag, and the Morse potential: swarms, rings, and mills.
//!
//! M. R. D'Orsogna, Y. L. Chuang, A. L. Bertozzi, L. S. Chayes (2006), Self-propelled particles with soft-core interactions:
//! patterns, stability, and collapse, Physical Review Letters 96:104302.

use crate::card::*;
use crate::models::families::morse::{MorseSwarm, Propulsion};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `dorsogna_2006`.
    pub struct Dorsogna2006 {
        /// Mass.
        mass alias "m": R = 1.0, "m", "mass", Positive, Paper;
        /// Propulsion per velocity.
        propulsion alias "alpha": R = 1.6, "alpha", "mass/time", NonNegative, Paper;
        /// Drag, which grows with the square of the speed.
        drag alias "beta": R = 0.5, "beta", "mass time/length^2", NonNegative, Paper;
        /// Strength of repulsion.
        repulsion_strength alias "C_r": R = 1.0, "C_r", "energy", NonNegative, Paper;
        /// Distance over which repulsion decays.
        repulsion_length alias "l_r": R = 0.5, "l_r", "length", Positive, Paper;
        /// Strength of attraction.
        attraction_strength alias "C_a": R = 0.5, "C_a", "energy", NonNegative, Paper;
        /// Distance over which attraction decays.
        attraction_length alias "l_a": R = 2.0, "l_a", "length", Positive, Paper;
        /// Distance below which others count.
        range: R = 40.0, "-", "length", Positive, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.01, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Dorsogna2006<R> {
    const CARD: Card = Card {
        id: "dorsogna_2006",
        title: "D'Orsogna et al. 2006, Morse potential",
        about: "Particles approach a preferred speed and interact by the Morse potential, which repels nearby and attracts farther \
                away.",
        reference: "M. R. D'Orsogna, Y. L. Chuang, A. L. Bertozzi, L. S. Chayes (2006). Self-propelled particles with soft-core \
                    interactions: patterns, stability, and collapse. Physical Review Letters 96, 104302. \
                    doi:10.1103/PhysRevLett.96.104302",
        equations: "m dv_i/dt = (alpha - beta |v_i|^2) v_i - grad_i U,  U = sum_j C_r exp(-rho/l_r) - C_a exp(-rho/l_a)\n\
                    so -grad_i U = -sum_j (C_r/l_r exp(-rho/l_r) - C_a/l_a exp(-rho/l_a)) e_ij\n\
                    v_i' = v_i + Dt dv_i/dt;  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range)",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "from the literature as known, not from the project's sources; others beyond range, where the force has fallen \
                     by a factor of 5e8 at the defaults, are left out",
        edge: "at rest and alone: stays at rest; coincident members have no direction",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, false],
            validation: "MS",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "unbounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        if self.drag > R::ZERO { (self.propulsion / self.drag).root() } else { R::ONE }
    }
}

impl<R: Scalar> Variant<R> for Dorsogna2006<R> {
    type Shared = MorseSwarm<R>;
    fn shared(&self) -> Self::Shared {
        MorseSwarm {
            mass: self.mass,
            propulsion: Propulsion::Rayleigh { strength: self.propulsion, drag: self.drag },
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
    fn the_lone_reach_the_preferred_speed() {
        // 1 + 0.01 (1.6 - 0.5)
        let w = Oracle::new("dorsogna_2006").step(&[([0.0, 0.0], [1.0, 0.0])]);
        close(w.velocity(0), [1.011, 0.0]);
        close(w.position(0), [0.01011, 0.0]);
        let mut w = Oracle::new("dorsogna_2006").world(&[([0.0; 3], [0.0, 0.0, 0.1])]);
        w.run(3000);
        close(w.velocity(0), [0.0, 0.0, 3.2f64.sqrt()]);
    }

    #[test]
    fn two_at_rest_balance_where_the_slopes_are_equal() {
        // C_r/l_r exp(-r/l_r) = C_a/l_a exp(-r/l_a)  at  r = ln(8) / (1/0.5 - 1/2)
        let balance = 8f64.ln() / 1.5;
        let first =
            |x: f64| Oracle::new("dorsogna_2006").step(&[([0.0, 0.0], [0.0, 0.0]), ([x, 0.0], [0.0, 0.0])]).velocity(0);
        close(first(balance) * 1e4, [0.0, 0.0]);
        assert!(first(balance - 0.1)[0] < 0.0 && first(balance + 0.1)[0] > 0.0);
        close(first(1.0), [0.01 * (0.25 * (-0.5f64).exp() - 2.0 * (-2.0f64).exp()), 0.0]);
        close(first(0.0), [0.0, 0.0]);
    }
}
