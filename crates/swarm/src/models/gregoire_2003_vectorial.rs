//! Everyone adds the velocities of those within a radius to its own, keeps a distance, and errs by a random vector.
//!
//! G. Gregoire, H. Chate, Y. Tu (2003), Moving and staying together without a leader, Physica D 181:157, with the vectorial
//! noise (model 2).

use crate::card::*;
use crate::models::families::pair_law::{self, Neighbourhood, Noise, PairLaw};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `gregoire_2003_vectorial`.
    pub struct Gregoire2003Vectorial {
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
        /// Length of the random vector for each member that votes, itself included.
        noise_amplitude alias "eta": R = 0.0, "eta", "1", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Paper;
        /// Whether all within the radius count or only Voronoi neighbours among them.
        neighbours: Neighbourhood = "metric", "-", "-", Any, Ours;
    }
}

impl<R: Scalar> Law<R> for Gregoire2003Vectorial<R> {
    const CARD: Card = Card {
        id: "gregoire_2003_vectorial",
        title: "Gregoire et al. 2003, vectorial noise",
        about: "Members of constant speed sum the velocities of those within a radius and forces that keep them at a distance, \
                and err by a random vector.",
        reference: "G. Gregoire, H. Chate, Y. Tu (2003). Moving and staying together without a leader. Physica D 181, \
                    157-170. doi:10.1016/S0167-2789(03)00102-7",
        equations: "V = alpha (v_i + sum_{j in I} v_j) + beta sum_{j in I} f(rho_ij) e_ij + (|I| + 1) eta unit_i\n\
                    f = (rho - r_e) / (4 (r_a - r_e)) for r_hc <= rho < r_a;  1 for rho >= r_a\n\
                    any rho_ij < r_hc:  V = -sum over those of e_ij\n\
                    h_i' = unit(V);  v_i' = v h_i';  x_i' = x_i + v_i' Dt  (new velocity)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, r_0), or that and voronoi",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the infinite repulsion of the hard core is realised as its precedence over all else, without noise; \
                     velocities have the length of the speed, so alpha acts on vectors of that length",
        edge: "V = 0: heading kept; alone: heading turned by the noise; coincident members have no direction but still \
               make the hard core",
        random: &[RandomQuantity {
            name: "unit",
            about: "unit vector, uniform over directions, scaled by (|I| + 1) eta in the law; behaviour slot 0 (3-D: 0 and 1)",
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

impl<R: Scalar> Variant<R> for Gregoire2003Vectorial<R> {
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
            noise: Noise::Vector(self.noise_amplitude),
            time_step: self.time_step,
            neighbours: self.neighbours.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn the_hard_core_comes_before_all_else() {
        let w = Oracle::new("gregoire_2003_vectorial").set("eta", 0.4).step(&[
            ([0.0, 0.0], [0.0, 0.05]),
            ([0.1, 0.0], [0.0, 0.05]),
            ([-0.9, 0.0], [0.05, 0.0]),
        ]);
        close(w.velocity(0), [-0.05, 0.0]);
        close(w.velocity(1), [0.05, 0.0]);
        close(w.position(1), [0.15, 0.0]);
    }

    #[test]
    fn full_attraction_beyond_and_no_force_at_the_equilibrium() {
        // V = 20 (0, 0.1) + 0.5 (1, 0)
        let side_by_side = |distance: f64| {
            Oracle::new("gregoire_2003_vectorial").step(&[([0.0, 0.0], [0.0, 0.05]), ([distance, 0.0], [0.0, 0.05])])
        };
        let length = (0.25f64 + 4.0).sqrt();
        close(side_by_side(0.9).velocity(0), [0.05 * 0.5 / length, 0.05 * 2.0 / length]);
        close(side_by_side(0.5).velocity(0), [0.0, 0.05]);
        // f(0.65) = 0.15 / 1.2 = 1/8
        let length = (0.0625f64.powi(2) + 4.0).sqrt();
        close(side_by_side(0.65).velocity(0), [0.05 * 0.0625 / length, 0.05 * 2.0 / length]);
        close(side_by_side(1.0).velocity(0), [0.0, 0.05]);
    }

    #[test]
    fn coincident_members_and_opposite_velocities_keep_their_headings() {
        let w = Oracle::new("gregoire_2003_vectorial").step(&[([0.0, 0.0], [0.03, 0.04]), ([0.0, 0.0], [0.0, -0.05])]);
        close(w.velocity(0), [0.03, 0.04]);
        let w = Oracle::new("gregoire_2003_vectorial")
            .set("beta", 0.0)
            .step(&[([0.0, 0.0], [0.05, 0.0]), ([0.5, 0.0], [-0.05, 0.0])]);
        close(w.velocity(0), [0.05, 0.0]);
    }

    #[test]
    fn the_middle_one_of_a_row_separates_voronoi_neighbours() {
        let row = [([0.0, 0.0], [0.05, 0.0]), ([0.4, 0.0], [0.0, 0.05]), ([0.8, 0.0], [0.0, -0.05])];
        let first = |neighbours: &str| {
            Oracle::new("gregoire_2003_vectorial").set("beta", 0.0).set("neighbours", neighbours).step(&row).velocity(0)
        };
        close(first("metric"), [0.05, 0.0]);
        close(first("voronoi"), [0.05 * 0.5f64.sqrt(), 0.05 * 0.5f64.sqrt()]);
    }
}
