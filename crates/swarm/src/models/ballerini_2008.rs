//! Everyone takes the mean direction of its nearest few, itself included, and errs by a random angle.
//!
//! M. Ballerini et al. (2008), Interaction ruling animal collective behavior depends on topological rather than metric
//! distance, Proceedings of the National Academy of Sciences 105:1232 (alignment alone).

use crate::card::*;
use crate::models::vicsek_1995::published;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `ballerini_2008`.
    pub struct Ballerini2008 {
        /// Number of neighbours.
        neighbour_count alias "k": usize = 7usize, "k", "1", NonNegative, Paper;
        /// Speed, the same for all.
        speed: R = 0.05, "v", "length/time", NonNegative, Ours;
        /// Width of the interval from which the random angle is drawn.
        noise_amplitude alias "eta": R = 0.0, "eta", "rad", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Ballerini2008<R> {
    const CARD: Card = Card {
        id: "ballerini_2008",
        title: "Ballerini et al. 2008",
        about: "Members of constant speed take the mean direction of their nearest few, themselves included, and err by a random \
                angle.",
        reference: "M. Ballerini, N. Cabibbo, R. Candelier, A. Cavagna, E. Cisbani, I. Giardina, V. Lecomte, A. Orlandi, \
                    G. Parisi, A. Procaccini, M. Viale, V. Zdravkovic (2008). Interaction ruling animal collective behavior \
                    depends on topological rather than metric distance: evidence from a field study. Proceedings of the \
                    National Academy of Sciences 105, 1232-1237. doi:10.1073/pnas.0711437105",
        equations: "H_i = h_i + sum_{j in I} h_j\n\
                    theta_i' = angle(H_i) + noise_i,  noise uniform in [-eta/2, eta/2)\n\
                    x_i' = x_i + v_i Dt  (old velocity);  v_i' = v h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = k_nearest(k)",
            motion: "mean heading with self, turned by noise",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "an interpretation: the sources give no formula, so the law of vicsek_1995 is applied to the k nearest; \
                     three dimensions as there",
        edge: "fewer than k others: all of them; alone or zero resultant: keeps its heading, turned by the noise",
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

impl<R: Scalar, const D: usize> Model<R, D> for Ballerini2008<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::KNearest(self.neighbour_count))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let mut headings = Vector::ZERO;
        for k in seen.set(0) {
            headings += seen.heading(k);
        }
        published(R::INFINITY, self.speed, self.noise_amplitude, self.time_step).finish(me, &headings.0, draws)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn the_nearest_one_counts_however_far() {
        let w = Oracle::new("ballerini_2008").set("k", 1usize).step(&[
            ([0.0, 0.0], [0.05, 0.0]),
            ([100.0, 0.0], [0.0, 0.05]),
            ([300.0, 0.0], [-0.05, 0.0]),
        ]);
        let half = 0.05 * 0.5f64.sqrt();
        close(w.velocity(0), [half, half]);
        close(w.velocity(1), [half, half]);
        close(w.velocity(2), [-half, half]);
        close(w.position(0), [0.05, 0.0]);
    }

    #[test]
    fn fewer_than_k_are_all_and_noise_turns_the_lone() {
        let w = Oracle::new("ballerini_2008").step(&[([0.0, 0.0], [0.05, 0.0]), ([1.0, 0.0], [-0.05, 0.0])]);
        close(w.velocity(0), [0.05, 0.0]);
        let w = Oracle::new("ballerini_2008").inject("noise", &[0.2]).step(&[([0.0, 0.0], [0.05, 0.0])]);
        close(w.velocity(0), [0.05 * 0.2f64.cos(), 0.05 * 0.2f64.sin()]);
    }
}
