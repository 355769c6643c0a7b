//! Velocities and forces as in Gregoire, Chate and Tu (2003), but from the nearest few instead of all within a radius.
//!
//! M. Camperi, A. Cavagna, I. Giardina, G. Parisi, E. Silvestri (2012), Spatially balanced topological interaction grants
//! optimal cohesion in flocking models, Interface Focus 2:715.

use crate::card::*;
use crate::models::families::pair_law::{self, Neighbours, Noise, PairLaw};
use crate::motion::*;
use crate::parameters::Scalar;
use crate::{choice, parameters};

choice! {
    /// Who counts as a neighbour.
    pub enum Neighbourhood {
        /// The nearest few.
        Topological = "topological",
        /// Everyone within the interaction radius.
        Metric = "metric",
        /// Those whose Voronoi cells touch one's own.
        Voronoi = "voronoi",
    }
}

parameters! {
    /// Parameters of `camperi_2012`.
    pub struct Camperi2012 {
        /// Weight of the summed velocities, which have the length of the speed.
        alignment_weight alias "alpha": R = 35.0, "alpha", "1", NonNegative, Paper;
        /// Weight of the summed pair forces.
        cohesion_weight alias "beta": R = 5.0, "beta", "1", NonNegative, Paper;
        /// Distance below which a neighbour repels before all else.
        hard_core_radius alias "r_hc": R = 0.2, "r_hc", "length", NonNegative, Paper;
        /// Distance at which the pair force vanishes.
        equilibrium_distance alias "r_e": R = 0.5, "r_e", "length", NonNegative, Paper;
        /// Distance from which attraction is full, however far.
        attraction_radius alias "r_a": R = 0.8, "r_a", "length", Positive, Paper;
        /// Radius within which others are neighbours, where these are metric.
        interaction_radius alias "r0": R = 1.0, "r_0", "length", Positive, Paper;
        /// Speed, the same for all.
        speed: R = 0.05, "v", "length/time", NonNegative, Paper;
        /// Length of the random vector for each member that votes, itself included.
        noise_amplitude alias "eta": R = 0.0, "eta", "1", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Paper;
        /// Whether neighbours are the nearest few, all within the radius, or Voronoi neighbours.
        neighbours: Neighbourhood = "topological", "-", "-", Any, Ours;
        /// Number of topological neighbours.
        neighbour_count alias "k": usize = 6usize, "k", "1", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for Camperi2012<R> {
    const CARD: Card = Card {
        id: "camperi_2012",
        title: "Camperi et al. 2012",
        about: "Members of constant speed sum the velocities of their nearest few and forces that keep them at a distance, and \
                err by a random vector.",
        reference: "M. Camperi, A. Cavagna, I. Giardina, G. Parisi, E. Silvestri (2012). Spatially balanced topological \
                    interaction grants optimal cohesion in flocking models. Interface Focus 2, 715-725. \
                    doi:10.1098/rsfs.2012.0026",
        equations: "V = alpha (v_i + sum_{j in I} v_j) + beta sum_{j in I} f(rho_ij) e_ij + (|I| + 1) eta unit_i\n\
                    f = (rho - r_e) / (4 (r_a - r_e)) for r_hc <= rho < r_a;  1 for rho >= r_a\n\
                    any rho_ij < r_hc:  V = -sum over those of e_ij\n\
                    h_i' = unit(V);  v_i' = v h_i';  x_i' = x_i + v_i' Dt  (new velocity)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = k_nearest(k), or distance_based(0, r_0), or voronoi",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the source's table lists metric neighbours only; the paper compares them with topological ones, which \
                     hold the group together better and are the default",
        edge: "V = 0: heading kept; alone: heading turned by the noise; coincident members have no direction but still \
               make the hard core; fewer than k others: all of them",
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
            uses: [true, true, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::None],
            environment: "unbounded free",
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

impl<R: Scalar> Variant<R> for Camperi2012<R> {
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
            neighbours: match self.neighbours {
                Neighbourhood::Topological => Neighbours::Topological(self.neighbour_count),
                Neighbourhood::Metric => Neighbours::Metric,
                Neighbourhood::Voronoi => Neighbours::Voronoi,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn the_nearest_few_attract_from_afar_and_metric_neighbours_do_not() {
        // V = 35 (0, 0.1) + 5 (1, 0)
        let pair = [([0.0, 0.0], [0.0, 0.05]), ([100.0, 0.0], [0.0, 0.05])];
        let length = (25.0f64 + 12.25).sqrt();
        let drawn = [0.05 * 5.0 / length, 0.05 * 3.5 / length];
        close(Oracle::new("camperi_2012").step(&pair).velocity(0), drawn);
        close(Oracle::new("camperi_2012").set("neighbours", "voronoi").step(&pair).velocity(0), drawn);
        close(Oracle::new("camperi_2012").set("neighbours", "metric").step(&pair).velocity(0), [0.0, 0.05]);
    }

    #[test]
    fn only_k_are_followed() {
        let row = [([0.0, 0.0], [0.05, 0.0]), ([0.4, 0.0], [0.0, 0.05]), ([0.8, 0.0], [0.0, -0.05])];
        let first = |k: usize| Oracle::new("camperi_2012").set("beta", 0.0).set("k", k).step(&row).velocity(0);
        close(first(0), [0.05, 0.0]);
        close(first(1), [0.05 * 0.5f64.sqrt(), 0.05 * 0.5f64.sqrt()]);
        close(first(6), [0.05, 0.0]);
    }

    #[test]
    fn the_hard_core_counts_only_neighbours() {
        // both are within the hard core, but with k = 1 only the nearer of them repels
        let three = [([0.0, 0.0], [0.0, 0.05]), ([0.1, 0.0], [0.0, 0.05]), ([-0.15, 0.0], [0.0, 0.05])];
        close(Oracle::new("camperi_2012").set("k", 1usize).step(&three).velocity(0), [-0.05, 0.0]);
        close(Oracle::new("camperi_2012").step(&three).velocity(0), [0.0, 0.05]);
    }
}
