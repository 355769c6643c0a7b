//! Everyone adds up alignment that fades with distance, an attraction that keeps a distance, and noise.
//!
//! U. Lopez, J. Gautrais, I. D. Couzin, G. Theraulaz (2012), From behavioural analyses to models of collective motion in fish
//! schools, Interface Focus 2:693 (its general form).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `lopez_2012`.
    pub struct Lopez2012 {
        /// Interaction radius.
        radius: R = 6.0, "R", "length", Positive, Ours;
        /// Weight of alignment.
        alignment_weight alias "w_al": R = 1.0, "w_al", "1", NonNegative, Ours;
        /// Distance over which alignment decays.
        alignment_decay alias "l_al": R = 3.0, "l_al", "length", Positive, Ours;
        /// Weight of attraction.
        attraction_weight alias "w_at": R = 1.0, "w_at", "1", NonNegative, Ours;
        /// Distance at which attraction vanishes.
        equilibrium_distance alias "r_e": R = 1.0, "r_e", "length", Positive, Ours;
        /// Speed, the same for all.
        speed: R = 1.0, "v0", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Ours;
        /// Standard deviation of each component of the random vector.
        noise_deviation: R = 0.0, "-", "1", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for Lopez2012<R> {
    const CARD: Card = Card {
        id: "lopez_2012",
        title: "Lopez et al. 2012",
        about: "Fish follow the mean of alignment, which fades with distance, and of an attraction that keeps a distance.",
        reference: "U. Lopez, J. Gautrais, I. D. Couzin, G. Theraulaz (2012). From behavioural analyses to models of collective \
                    motion in fish schools. Interface Focus 2, 693-707. doi:10.1098/rsfs.2012.0033",
        equations: "u = mean_I w_al exp(-rho/l_al) h_j + mean_I w_at clamp((rho - r_e)/r_e, -1, 1) e_ij + noise_vec_i\n\
                    h_i' = unit(u), kept if I is empty or u = 0;  x_i' = x_i + v0 h_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, R)",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the row writes an angle for a vector; its two response functions are free there: an exponential and a \
                     clamped line are ours",
        edge: "nobody: heading kept, without noise; u = 0: heading kept; coincident members align and do not attract, but count",
        random: &[RandomQuantity {
            name: "noise_vec",
            about: "vector, each component normal with SD noise_deviation; behaviour slots 0 to 5",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, false],
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
}

impl<R: Scalar, const D: usize> Model<R, D> for Lopez2012<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let (mut alignment, mut attraction, mut count) = (Vector::ZERO, Vector::ZERO, R::ZERO);
        for k in seen.set(0) {
            let distance = seen.distance(k);
            let excess = ((distance - self.equilibrium_distance) / self.equilibrium_distance).clamped(-R::ONE, R::ONE);
            alignment += seen.heading(k) * (-distance / self.alignment_decay).exp();
            attraction += seen.direction(k) * excess;
            count += R::ONE;
        }
        let mut wanted = Vector::ZERO;
        if count > R::ZERO {
            let alignment = alignment * (self.alignment_weight / count);
            let attraction = attraction * (self.attraction_weight / count);
            me.note("alignment", alignment);
            me.note("attraction", attraction);
            let noise = draws.normal_vector("noise_vec", self.noise_deviation);
            me.note("noise", noise);
            wanted = alignment + attraction + noise;
            me.sum(wanted);
        }
        Motion::new_velocity(wanted.unit_or(me.heading()) * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn alignment_fades_and_attraction_keeps_a_distance() {
        // at 1.5: exp(-1/2) of (0, 1), and half of (1, 0)
        let pair = |x: f64| [([0.0, 0.0], [1.0, 0.0]), ([x, 0.0], [0.0, 1.0])];
        let w = Oracle::new("lopez_2012").step(&pair(1.5));
        let up = (-0.5f64).exp();
        let length = f64::hypot(0.5, up);
        close(w.velocity(0), [0.5 / length, up / length]);
        close(w.position(0), [0.05 / length, 0.1 * up / length]);
        // alone each of them: towards the far, away from the near, nothing at r_e and in the distance
        let pull = |x: f64| Oracle::new("lopez_2012").set("w_al", 0.0).step(&pair(x)).velocity(1);
        close(pull(3.0), [-1.0, 0.0]);
        close(pull(0.5), [1.0, 0.0]);
        close(pull(1.0), [0.0, 1.0]);
        close(pull(6.0), [0.0, 1.0]);
    }

    #[test]
    fn noise_needs_neighbours() {
        let noisy = |agents: &[([f64; 2], [f64; 2])]| {
            Oracle::new("lopez_2012").inject_vectors("noise_vec", &[[0.0, -3.0], [0.0, 0.0]]).step(agents).velocity(0)
        };
        close(noisy(&[([0.0, 0.0], [1.0, 0.0])]), [1.0, 0.0]);
        // a coincident neighbour aligns with its full weight
        close(noisy(&[([0.0, 0.0], [1.0, 0.0]), ([0.0, 0.0], [0.0, 1.0])]), [0.0, -1.0]);
        let w = Oracle::new("lopez_2012").step(&[([0.0; 3], [1.0, 0.0, 0.0]), ([0.0; 3], [0.0, 0.0, 1.0])]);
        close(w.velocity(0), [0.0, 0.0, 1.0]);
    }
}
