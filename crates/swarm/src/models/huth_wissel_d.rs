//! Fish turn by what up to four neighbours ask for, each further one weighing half of the one before, or follow one of them.
//!
//! A. Huth, C. Wissel (1992), The simulation of the movement of fish schools, Journal of Theoretical Biology 156:365 (D-model, decision).

use crate::card::*;
use crate::models::families::huth_wissel::{Combination, Priority, School};
use crate::motion::*;
use crate::parameters::Scalar;
use crate::{choice, parameters};

choice! {
    /// How a member decides between its neighbours.
    pub enum Decision {
        /// It weighs them, by half for each further one.
        Weights = "weights",
        /// It follows one of them, with these weights as probabilities.
        One = "one",
    }
}

parameters! {
    /// Parameters of `huth_wissel_d`.
    pub struct HuthWisselD {
        /// Distance below which a member swims across.
        repulsion_radius alias "r1": R = 0.5, "r1", "body length", NonNegative, Paper;
        /// Distance below which it swims in parallel.
        alignment_radius alias "r2": R = 2.0, "r2", "body length", NonNegative, Paper;
        /// Distance below which it swims up.
        attraction_radius alias "r3": R = 5.0, "r3", "body length", Positive, Paper;
        /// Number of neighbours that count.
        neighbour_count alias "k": usize = 4usize, "k", "1", NonNegative, Paper;
        /// Full blind angle behind.
        blind_angle alias "blind_deg": R = 30.0, "-", "deg", Within(0.0, 360.0), Paper;
        /// Whether the nearest neighbours count first or those ahead.
        priority: Priority = "distance", "-", "-", Any, Ours;
        /// Whether neighbours are weighed or one of them is followed.
        decision alias "choice": Decision = "weights", "-", "-", Any, Ours;
        /// Speed, the same for all.
        speed: R = 1.2, "v0", "body length/time", NonNegative, Paper;
        /// Length of a step.
        time_step alias "dt": R = 0.5, "Dt", "time", Positive, Paper;
        /// Standard deviation of the random angle.
        noise_deviation alias "sigma_deg": R = 0.0, "sigma", "deg", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for HuthWisselD<R> {
    const CARD: Card = Card {
        id: "huth_wissel_d",
        title: "Huth and Wissel 1992, decision",
        about: "Members turn by what a few neighbours ask for, each further one with half the weight of the one before.",
        reference: "A. Huth, C. Wissel (1992). The simulation of the movement of fish schools. Journal of Theoretical Biology \
                    156, 365-385. doi:10.1016/S0022-5193(05)80681-2",
        equations: "b_j = phi_ij -+ 90 deg (phi >= 0, < 0) if rho < r1;  wrap(theta_j - theta_i) if rho < r2;  phi_ij if rho < r3\n\
                    turn = weighted mean of b_j with weights 1, 1/2, 1/4, ... in the order of priority (or one b_j by these chances);  no neighbour: turn = search_i\n\
                    theta_i' = wrap(theta_i + turn + noise_i);  x_i' = x_i + v0 h(theta_i') Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, r3) within angle(360 deg - blind angle); of these the first k by distance \
                        or by |phi|",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "an interpretation of halved weights for every further neighbour; decision = one is the decision of the original; the \
                     speed is drawn from a gamma distribution in the paper and constant here; swimming across follows Aoki (1982)",
        edge: "ties go to the lower index; a coincident neighbour lies straight ahead; at rest the heading is angle 0 and all \
               are seen",
        random: &[
            RandomQuantity { name: "noise", about: "angle, normal with SD sigma; behaviour slots 0 and 1" },
            RandomQuantity { name: "search", about: "turn without neighbours, uniform in (-pi, pi]; behaviour slot 2" },
            RandomQuantity { name: "u", about: "choice of one neighbour, uniform in [0, 1); behaviour slot 3" },
        ],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
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
        if self.repulsion_radius > self.alignment_radius || self.alignment_radius > self.attraction_radius {
            return Err("the radii must not decrease from repulsion over alignment to attraction".into());
        }
        Ok(())
    }
}

impl<R: Scalar> Variant<R> for HuthWisselD<R> {
    type Shared = School<R>;
    fn shared(&self) -> Self::Shared {
        School {
            repulsion_radius: self.repulsion_radius,
            alignment_radius: self.alignment_radius,
            attraction_radius: self.attraction_radius,
            neighbour_count: self.neighbour_count,
            blind_angle: self.blind_angle.radians(),
            priority: self.priority,
            speed: self.speed,
            time_step: self.time_step,
            noise_deviation: self.noise_deviation.radians(),
            combination: match self.decision {
                Decision::Weights => Combination::Halved,
                Decision::One => Combination::One,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    /// The turn, in degrees, of a member that heads along x, with others at these places and headings.
    #[track_caller]
    fn expect(oracle: Oracle<2>, others: &[([f64; 2], f64)], degrees: f64) {
        let going = |d: f64| [d.to_radians().cos(), d.to_radians().sin()];
        let mut agents = vec![([0.0, 0.0], [1.0, 0.0])];
        agents.extend(others.iter().map(|&(place, d)| (place, going(d))));
        let w = oracle.step(&agents);
        close(w.velocity(0), going(degrees).map(|v| 1.2 * v));
        close(w.position(0), going(degrees).map(|v| 0.6 * v));
    }

    const OTHERS: [([f64; 2], f64); 3] = [([0.0, 3.0], 0.0), ([4.0, 0.0], 0.0), ([0.0, -4.5], 0.0)];

    #[test]
    fn weights_halve_in_the_order_of_priority() {
        let model = || Oracle::new("huth_wissel_d");
        // 90, 0 and -90 with weights 1, 1/2, 1/4
        expect(model(), &OTHERS, (90.0 - 22.5) / 1.75);
        expect(model().set("priority", "front"), &OTHERS, (45.0 - 22.5) / 1.75);
        // with one neighbour it is the averaging model
        expect(model().set("k", 1usize), &OTHERS, 90.0);
        expect(model().inject("noise", &[0.2, 0.0]), &OTHERS[1..2], 0.2f64.to_degrees());
    }

    #[test]
    fn one_neighbour_is_followed_by_its_weight() {
        let one = |u: f64| Oracle::new("huth_wissel_d").set("choice", "one").inject("u", &[u, 0.0, 0.0, 0.0]);
        expect(one(0.0), &OTHERS, 90.0);
        expect(one(0.57), &OTHERS, 90.0);
        expect(one(0.58), &OTHERS, 0.0);
        expect(one(0.86), &OTHERS, -90.0);
        expect(one(1.0), &OTHERS, -90.0);
        expect(one(0.5), &[], 0.0);
    }
}
