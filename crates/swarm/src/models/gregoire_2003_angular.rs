//! Everyone adds the velocities of those within a radius to its own, keeps a distance, and errs by a random angle.
//!
//! G. Gregoire, H. Chate, Y. Tu (2003), Moving and staying together without a leader, Physica D 181:157, with the angular
//! noise (model 1).

use crate::card::*;
use crate::models::families::pair_law::{self, Neighbourhood, Noise, PairLaw};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `gregoire_2003_angular`.
    pub struct Gregoire2003Angular {
        /// Weight of the summed velocities, which have the length of the speed.
        alignment_weight alias "alpha": R = 20.0, "alpha", "1", NonNegative, Ours;
        /// Weight of the summed pair forces.
        cohesion_weight alias "beta": R = 0.5, "beta", "1", NonNegative, Ours;
        /// Distance below which a neighbour repels before all else.
        hard_core_radius alias "r_hc": R = 0.2, "r_hc", "length", NonNegative, Paper;
        /// Distance at which the pair force vanishes.
        equilibrium_distance alias "r_e": R = 0.5, "r_e", "length", NonNegative, Paper;
        /// Distance from which attraction is full.
        attraction_radius alias "r_a": R = 0.8, "r_a", "length", Positive, Paper;
        /// Radius within which others are neighbours.
        interaction_radius alias "r0": R = 1.0, "r_0", "length", Positive, Paper;
        /// Speed, the same for all.
        speed: R = 0.05, "v", "length/time", NonNegative, Paper;
        /// Share of a half turn to either side up to which a heading errs.
        noise_amplitude alias "eta": R = 0.0, "eta", "1", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Paper;
        /// Whether all within the radius count or only Voronoi neighbours among them.
        neighbours: Neighbourhood = "metric", "-", "-", Any, Ours;
    }
}

impl<R: Scalar> Law<R> for Gregoire2003Angular<R> {
    const CARD: Card = Card {
        id: "gregoire_2003_angular",
        title: "Gregoire et al. 2003, angular noise",
        about: "Members of constant speed sum the velocities of those within a radius and forces that keep them at a distance, \
                and err by a random angle.",
        reference: "G. Gregoire, H. Chate, Y. Tu (2003). Moving and staying together without a leader. Physica D 181, \
                    157-170. doi:10.1016/S0167-2789(03)00102-7",
        equations: "V = alpha (v_i + sum_{j in I} v_j) + beta sum_{j in I} f(rho_ij) e_ij\n\
                    f = (rho - r_e) / (4 (r_a - r_e)) for r_hc <= rho < r_a;  1 for rho >= r_a\n\
                    any rho_ij < r_hc:  V = -sum over those of e_ij\n\
                    h_i' = unit(V) turned by eta xi_i;  v_i' = v h_i';  x_i' = x_i + v_i' Dt  (new velocity)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, r_0), or that and voronoi",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the infinite repulsion of the hard core is realised as its precedence over all else; \
                     velocities have the length of the speed, so alpha acts on vectors of that length",
        edge: "V = 0: heading kept; alone: heading turned by the noise; coincident members have no direction but still \
               make the hard core; noise turns the heading in every case",
        random: &[RandomQuantity {
            name: "xi",
            about: "angle, uniform in [-pi, pi), scaled by eta in the law; behaviour slot 0",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Constant, Information::Global],
            environment: "periodic free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn check(&self, _: usize) -> Result<(), String> {
        pair_law::check(self.equilibrium_distance, self.attraction_radius)
    }
}

impl<R: Scalar> Variant<R> for Gregoire2003Angular<R> {
    type Shared = PairLaw<R>;
    fn shared(&self) -> Self::Shared {
        PairLaw {
            alignment_weight: self.alignment_weight,
            cohesion_weight: self.cohesion_weight,
            hard_core_radius: self.hard_core_radius,
            equilibrium_distance: self.equilibrium_distance,
            attraction_radius: self.attraction_radius,
            interaction_radius: self.interaction_radius,
            speed: self.speed,
            noise: Noise::Angle(self.noise_amplitude),
            time_step: self.time_step,
            neighbours: self.neighbours.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn velocities_and_forces_add_up_and_noise_turns_them() {
        // V = 20 ((0.05, 0) + (0, 0.05)) + 0.5 (0.3/1.2, 0) = (1.125, 1)
        let pair = [([0.0, 0.0], [0.05, 0.0]), ([0.8, 0.0], [0.0, 0.05])];
        let pull = 1.0 + 0.5 * 1.0;
        let w = Oracle::new("gregoire_2003_angular").step(&pair);
        let length = f64::hypot(pull, 1.0);
        close(w.velocity(0), [0.05 * pull / length, 0.05 / length]);
        close(w.position(0), [0.05 * pull / length, 0.05 / length]);
        // below r_a attraction is a quarter at most
        let near = [([0.0, 0.0], [0.05, 0.0]), ([0.65, 0.0], [0.0, 0.05])];
        let pull = 1.0 + 0.5 * 0.125;
        let w = Oracle::new("gregoire_2003_angular").set("eta", 0.1).inject("xi", &[2.0, 0.0]).step(&near);
        let angle = 1f64.atan2(pull) + 0.2;
        close(w.velocity(0), [0.05 * angle.cos(), 0.05 * angle.sin()]);
    }

    #[test]
    fn noise_turns_also_the_lone_and_those_in_the_hard_core() {
        let turned = |angle: f64| [0.05 * angle.cos(), 0.05 * angle.sin()];
        let noisy = || Oracle::new("gregoire_2003_angular").set("eta", 0.5).inject("xi", &[0.8, 0.0]);
        close(noisy().step(&[([0.0, 0.0], [0.05, 0.0])]).velocity(0), turned(0.4));
        let touching = [([0.0, 0.0], [0.05, 0.0]), ([0.0, 0.1], [0.05, 0.0])];
        close(noisy().step(&touching).velocity(0), turned(0.4 - core::f64::consts::FRAC_PI_2));
        // balanced: the heading is kept, and turned
        let balanced = [([0.0, 0.0], [0.05, 0.0]), ([0.1, 0.0], [0.05, 0.0]), ([-0.1, 0.0], [0.05, 0.0])];
        close(noisy().inject("xi", &[0.8, 0.0, 0.0]).step(&balanced).velocity(0), turned(0.4));
    }
}
