//! Everyone takes the mean direction of those within a radius, itself included, and errs by a random angle.
//!
//! J. A. Smith, A. M. Martin (2009), Comparison of hard-core and soft-core potentials for modelling flocking in free space
//! (as the dissertation's table groups it: without the potentials).

use crate::card::*;
use crate::models::vicsek_1995::{Vicsek1995, published};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `smith_martin_2009`.
    pub struct SmithMartin2009 {
        /// Interaction radius.
        radius: R = 1.0, "r", "length", Positive, Ours;
        /// Speed, the same for all.
        speed: R = 0.03, "v", "length/time", NonNegative, Ours;
        /// Width of the interval from which the random angle is drawn.
        noise_amplitude alias "eta": R = 0.0, "eta", "rad", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for SmithMartin2009<R> {
    const CARD: Card = Card {
        id: "smith_martin_2009",
        title: "Smith and Martin 2009",
        about: "Members of constant speed take the mean direction of all within a radius, themselves included, and err by a \
                random angle.",
        reference: "J. A. Smith, A. M. Martin (2009). Comparison of hard-core and soft-core potentials for modelling flocking in \
                    free space. arXiv:0905.2260",
        equations: "H_i = h_i + sum_{j in I} h_j\n\
                    theta_i' = angle(H_i) + noise_i,  noise uniform in [-eta/2, eta/2)\n\
                    x_i' = x_i + v_i Dt  (old velocity);  v_i' = v h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "mean heading with self, turned by noise",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "an interpretation: the paper's title concerns pair potentials, which the table's row leaves out (levine_2000 has \
                     such a potential); what is left is the law of vicsek_1995",
        edge: "alone: keeps its heading, turned by the noise; zero resultant: the same",
        random: &[
            RandomQuantity { name: "noise", about: "angle, uniform in [-eta/2, eta/2); behaviour slot 0" },
            RandomQuantity {
                name: "axis_angle",
                about: "3-D: place of the axis, uniform in [0, 2 pi); behaviour slot 1",
            },
        ],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
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
}

impl<R: Scalar> Variant<R> for SmithMartin2009<R> {
    type Shared = Vicsek1995<R>;
    fn shared(&self) -> Self::Shared {
        published(self.radius, self.speed, self.noise_amplitude, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close, same_trajectories};

    #[test]
    fn worked_example_of_the_family() {
        let three = [([0.0, 0.0], [0.03, 0.0]), ([0.5, 0.0], [0.0, 0.03]), ([3.0, 3.0], [-0.03, 0.0])];
        let w = Oracle::new("smith_martin_2009").step(&three);
        close(w.velocity(0), [0.0212132, 0.0212132]);
        close(w.velocity(1), [0.0212132, 0.0212132]);
        close(w.velocity(2), [-0.03, 0.0]);
        close(w.position(1), [0.5, 0.03]);
        close(w.position(2), [2.97, 3.0]);
    }

    #[test]
    fn its_trajectories_are_those_of_vicsek() {
        same_trajectories("smith_martin_2009", "vicsek_1995");
    }
}
