//! Everyone takes the mean direction of those within a radius, itself included, errs by a normal angle, and moves on at once.
//!
//! J. Toner, Y. Tu (1998), Flocks, herds, and schools: a quantitative theory of flocking, Physical Review E 58:4828 (the
//! microscopic rule from which its continuum theory starts).

use crate::card::*;
use crate::models::vicsek_1995::{AngleNoise, Update, Vicsek1995};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `toner_tu_1998`.
    pub struct TonerTu1998 {
        /// Interaction radius.
        radius: R = 1.0, "r", "length", Positive, Ours;
        /// Speed, the same for all.
        speed: R = 0.5, "v", "length/time", NonNegative, Ours;
        /// Standard deviation of the random angle.
        noise_amplitude alias "eta": R = 0.0, "eta", "rad", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for TonerTu1998<R> {
    const CARD: Card = Card {
        id: "toner_tu_1998",
        title: "Toner and Tu 1998",
        about: "Members of constant speed take the mean direction of all within a radius, themselves included, err by a normal \
                angle, and move in the new direction.",
        reference: "J. Toner, Y. Tu (1998). Flocks, herds, and schools: a quantitative theory of flocking. Physical Review E 58, \
                    4828-4858. doi:10.1103/PhysRevE.58.4828",
        equations: "H_i = h_i + sum_{j in I} h_j\n\
                    h_i' = unit(H_i) turned by noise_i,  noise normal with SD eta\n\
                    x_i' = x_i + v h_i' Dt  (new heading)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "mean heading with self, turned by noise",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the table sums angles without dividing; an average is meant, taken as a circular mean with self; in three \
                     dimensions the heading turns by the noise about a random axis perpendicular to it",
        edge: "alone: keeps its heading, turned by the noise; zero resultant: the same",
        random: &[
            RandomQuantity { name: "noise", about: "angle, normal with SD eta; behaviour slots 0 and 2" },
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
            validation: "M",
            synchronous: true,
            information: [Information::Global, Information::Constant, Information::Global],
            environment: "bounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
}

impl<R: Scalar> Variant<R> for TonerTu1998<R> {
    type Shared = Vicsek1995<R>;
    fn shared(&self) -> Self::Shared {
        Vicsek1995 {
            radius: self.radius,
            speed: self.speed,
            noise_amplitude: self.noise_amplitude,
            time_step: self.time_step,
            position_update: Update::New,
            noise_distribution: AngleNoise::Normal,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn the_new_heading_moves() {
        let w = Oracle::new("toner_tu_1998").step(&[
            ([0.0, 0.0], [0.5, 0.0]),
            ([0.5, 0.0], [0.0, 0.5]),
            ([3.0, 3.0], [-0.5, 0.0]),
        ]);
        let half = 0.5 * 0.5f64.sqrt();
        close(w.velocity(0), [half, half]);
        close(w.position(0), [half, half]);
        close(w.position(2), [2.5, 3.0]);
    }

    #[test]
    fn supplied_noise_turns_also_the_lone_and_the_balanced() {
        let turned = [0.5 * 0.2f64.cos(), 0.5 * 0.2f64.sin()];
        let w = Oracle::new("toner_tu_1998").inject("noise", &[0.2]).step(&[([0.0, 0.0], [0.5, 0.0])]);
        close(w.position(0), turned);
        let opposite = [([0.0, 0.0], [0.5, 0.0]), ([0.5, 0.0], [-0.5, 0.0])];
        close(Oracle::new("toner_tu_1998").inject("noise", &[0.2, 0.0]).step(&opposite).velocity(0), turned);
    }

    #[test]
    fn the_noise_is_normal() {
        let agents: Vec<_> = (0..4000).map(|k| ([10.0 * f64::from(k), 0.0], [0.5, 0.0])).collect();
        let w = Oracle::new("toner_tu_1998").set("eta", 0.1).live().step(&agents);
        let angles: Vec<f64> = (0..4000).map(|id| w.velocity(id).angle()).collect();
        let moment = |power| angles.iter().map(|a| (a / 0.1f64).powi(power)).sum::<f64>() / 4000.0;
        // variance 1, fourth moment 3 (1.8 if it were uniform)
        assert!((moment(2) - 1.0).abs() < 0.08 && (moment(4) - 3.0).abs() < 0.5, "{} {}", moment(2), moment(4));
    }
}
