//! Everyone agrees on velocity with those within a radius and keeps a distance to them.
//!
//! H. G. Tanner, A. Jadbabaie, G. J. Pappas (2003), Stable flocking of mobile agents, part II: dynamic topology, Proceedings of the 42nd IEEE
//! Conference on Decision and Control, 2016-2021.

use crate::card::*;
use crate::models::families::tanner::StableFlock;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `tanner_2003_dynamic`.
    pub struct Tanner2003Dynamic {
        /// Distance from which members do not see each other.
        interaction_radius alias "R": R = 2.0, "R", "length", Positive, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.01, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Tanner2003Dynamic<R> {
    const CARD: Card = Card {
        id: "tanner_2003_dynamic",
        title: "Tanner et al. 2003, dynamic topology",
        about: "Members agree on velocity with all within a radius and keep a distance of one to them.",
        reference: "H. G. Tanner, A. Jadbabaie, G. J. Pappas (2003). Stable flocking of mobile agents, part II: dynamic topology. \
                    Proceedings of the 42nd IEEE Conference on Decision and Control, 2016-2021. doi:10.1109/CDC.2003.1272912",
        equations: "u_i = sum_{j in I} (v_j - v_i) + sum_{j in I} V'(rho_ij) e_ij\n\
                    V = 1/rho^2 + ln(rho^2),  V' = -2/rho^3 + 2/rho  (0 from R on)\n\
                    v_i' = v_i + Dt u_i;  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, R)",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the velocity term has the wrong sign in the table (it would drive velocities apart); log(L2)^2 is ln(rho^2)",
        edge: "coincident: no pair force; nobody in range: straight on",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, true],
            validation: "MS",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
}

impl<R: Scalar> Variant<R> for Tanner2003Dynamic<R> {
    type Shared = StableFlock<R>;
    fn shared(&self) -> Self::Shared {
        StableFlock { radius: Some(self.interaction_radius), lists: Vec::new(), time_step: self.time_step }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn worked_example_of_the_family() {
        let w = Oracle::new("tanner_2003_dynamic").step(&[([0.0, 0.0], [1.0, 0.0]), ([0.5, 0.0], [0.0, 0.0])]);
        close(w.velocity(0), [0.87, 0.0]);
        close(w.velocity(1), [0.13, 0.0]);
        close(w.position(0), [0.0087, 0.0]);
        close(w.position(1), [0.5013, 0.0]);
    }

    #[test]
    fn rest_at_distance_one_and_nothing_from_the_radius_on() {
        let first = |x: f64| Oracle::new("tanner_2003_dynamic").step(&[([0.0], [0.0]), ([x], [0.0])]).velocity(0);
        close(first(1.0), [0.0]);
        close(first(2.0), [0.0]);
        close(first(1.6), [0.01 * (2.0 / 1.6 - 2.0 / 1.6f64.powi(3))]);
        // coincident: agreement alone; alone: straight on
        let w = Oracle::new("tanner_2003_dynamic").step(&[([0.0; 3], [1.0, 0.0, 0.0]), ([0.0; 3], [0.0, 1.0, 0.0])]);
        close(w.velocity(0), [0.99, 0.01, 0.0]);
        close(Oracle::new("tanner_2003_dynamic").step(&[([0.0, 0.0], [1.0, 2.0])]).velocity(0), [1.0, 2.0]);
    }

    #[test]
    fn momentum_stays_and_velocities_agree() {
        let mut w = Oracle::new("tanner_2003_dynamic").set("R", 50.0).world(&[
            ([0.0, 0.0], [0.3, 0.0]),
            ([1.0, 0.2], [0.0, 0.3]),
            ([0.2, 1.1], [0.0, 0.0]),
        ]);
        w.run(3000);
        for id in 0..3 {
            assert!((w.velocity(id) - space::Vector([0.1, 0.1])).length() < 1e-3);
        }
    }
}
