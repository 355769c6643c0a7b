//! Fish that respond to their nearest by speed (ahead and behind) and by turning (left and right), without any alignment.
//!
//! Y. Katz, K. Tunstrom, C. C. Ioannou, C. Huepe, I. D. Couzin (2011), Inferring the structure and dynamics of interactions in
//! schooling fish, PNAS 108:18720; J. E. Herbert-Read et al. (2011), Inferring the rules of interaction of shoaling fish,
//! PNAS 108:18726.

use crate::card::*;
use crate::models::families::angles::{angle_noise, bearing, facing, turned};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};

parameters! {
    /// Parameters of `katz_herbert_read_2011`.
    pub struct KatzHerbertRead2011 {
        /// Number of neighbours.
        neighbour_count alias "k": usize = 1usize, "k", "1", NonNegative, Ours;
        /// Distance below which others repel.
        repulsion_radius alias "r_rep": R = 1.0, "r_rho", "length", Positive, Ours;
        /// Distance from which others attract.
        attraction_start alias "r_att": R = 2.0, "r_att", "length", NonNegative, Ours;
        /// Distance below which others are perceived.
        sensing_range alias "r_max": R = 8.0, "r_max", "length", Positive, Ours;
        /// Preferred speed.
        preferred_speed alias "s0": R = 2.0, "s0", "length/time", NonNegative, Ours;
        /// Time in which the preferred speed is approached.
        relaxation_time alias "tau_s": R = 1.0, "tau_s", "time", Positive, Ours;
        /// Response of the speed.
        speed_response alias "k_s": R = 3.0, "k_s", "length/time^2", NonNegative, Ours;
        /// Response of the heading.
        turning_response alias "k_t": R = 3.0, "k_t", "rad/time", NonNegative, Ours;
        /// Lowest speed.
        least_speed alias "s_min": R = 0.2, "s_min", "length/time", NonNegative, Ours;
        /// Highest speed.
        greatest_speed alias "s_max": R = 6.0, "s_max", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Ours;
        /// Standard deviation of the random angle.
        noise_deviation: R = 0.0, "-", "rad", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for KatzHerbertRead2011<R> {
    const CARD: Card = Card {
        id: "katz_herbert_read_2011",
        title: "Katz et al. 2011, Herbert-Read et al. 2011",
        about: "Fish speed up or slow down for a neighbour ahead or behind and turn to one at the side; none aligns.",
        reference: "Y. Katz, K. Tunstrom, C. C. Ioannou, C. Huepe, I. D. Couzin (2011). Inferring the structure and dynamics of \
                    interactions in schooling fish. Proceedings of the National Academy of Sciences 108, 18720-18725. \
                    doi:10.1073/pnas.1107583108; J. E. Herbert-Read et al. (2011). Inferring the rules of interaction of \
                    shoaling fish. The same, 18726-18731. doi:10.1073/pnas.1109355108",
        equations: "q(rho) = (rho - r_rho)/r_rho below r_rho;  0 below r_att;  (rho - r_att)/(r_max - r_att) beyond\n\
                    s_i' = clamp(s_i + Dt ((s0 - s_i)/tau_s + k_s mean q cos(phi)), s_min, s_max)\n\
                    theta_i' = wrap(theta_i + Dt k_t mean[q sin(phi), 0 if q > 0 and cos(phi) < 0] + noise_i)\n\
                    x_i' = x_i + Dt s_i' h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, r_max), of these k_nearest(k)",
            motion: "heading and speed",
            physics: "ideal",
            obstacles: "",
        },
        departures: "an interpretation: speed answers ahead and behind, turning left and right, attraction to those ahead only; \
                     no alignment",
        edge: "nobody: the speed relaxes to s0; a coincident neighbour lies straight ahead and slows down; at rest the heading \
               is angle 0",
        random: &[RandomQuantity {
            name: "noise",
            about: "angle, normal with SD noise_deviation; behaviour slots 0 and 1",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "bounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.preferred_speed
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.repulsion_radius > self.attraction_start || self.attraction_start >= self.sensing_range {
            return Err("the distances must increase from repulsion over attraction to the sensing range".into());
        }
        if self.least_speed > self.greatest_speed {
            return Err("the lowest speed must not be more than the highest".into());
        }
        Ok(())
    }
}

impl<R: Scalar> KatzHerbertRead2011<R> {
    /// Repulsion (negative) or attraction by distance.
    fn response(&self, distance: R) -> R {
        if distance < self.repulsion_radius {
            (distance - self.repulsion_radius) / self.repulsion_radius
        } else if distance < self.attraction_start {
            R::ZERO
        } else {
            (distance - self.attraction_start) / (self.sensing_range - self.attraction_start)
        }
    }
}

impl<R: Scalar> Model<R, 2> for KatzHerbertRead2011<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        let near = Perception::distance(R::ZERO, self.sensing_range);
        let nearest = Perception::KNearest(self.neighbour_count);
        vec![NamedSet::new("neighbours", Perception::Sequence(vec![near, nearest]))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let (theta, speed) = (me.velocity.angle(), me.velocity.length());
        let (mut along, mut across, mut count) = (R::ZERO, R::ZERO, R::ZERO);
        for k in seen.set(0) {
            let q = self.response(seen.distance(k));
            let (sin, cos) = bearing(seen, k, theta).sin_cos();
            along += q * cos;
            if q <= R::ZERO || cos >= R::ZERO {
                across += q * sin;
            }
            count += R::ONE;
        }
        let mean = |sum: R| if count > R::ZERO { sum / count } else { R::ZERO };
        let (relaxation, response) =
            ((self.preferred_speed - speed) / self.relaxation_time, self.speed_response * mean(along));
        let turn = self.time_step * self.turning_response * mean(across);
        me.value("relaxation of the speed", relaxation, "length/time^2");
        me.value("response of the speed", response, "length/time^2");
        me.value("turn", turn, "rad");
        let faster = speed + self.time_step * (relaxation + response);
        let speed = faster.clamped(self.least_speed, self.greatest_speed);
        let noise = angle_noise(self.noise_deviation, me, draws);
        let velocity = facing(turned(theta, turn + noise)) * speed;
        me.unit("length/time");
        me.note("turned heading", velocity);
        me.sum(velocity);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    fn first(other: [f64; 2]) -> space::Vector<f64, 2> {
        Oracle::new("katz_herbert_read_2011").step(&[([0.0, 0.0], [2.0, 0.0]), (other, [0.0, 2.0])]).velocity(0)
    }

    #[test]
    fn speed_ahead_and_behind() {
        // attraction at 5 is a half: 0.1 * 3 / 2 faster or slower; repulsion at 0.5 is minus a half
        close(first([5.0, 0.0]), [2.15, 0.0]);
        close(first([-5.0, 0.0]), [1.85, 0.0]);
        close(first([0.5, 0.0]), [1.85, 0.0]);
        close(first([1.5, 0.0]), [2.0, 0.0]);
        close(first([8.0, 0.0]), [2.0, 0.0]);
        close(first([0.0, 0.0]), [1.7, 0.0]);
        // alone the speed relaxes, and it has limits
        let alone = |speed: f64| Oracle::new("katz_herbert_read_2011").step(&[([0.0, 0.0], [speed, 0.0])]);
        close(alone(3.0).velocity(0), [2.9, 0.0]);
        close(alone(3.0).position(0), [0.29, 0.0]);
        close(alone(0.0).velocity(0), [0.2, 0.0]);
        close(alone(9.0).velocity(0), [6.0, 0.0]);
    }

    #[test]
    fn turning_to_the_sides() {
        close(first([0.0, 5.0]), [2.0 * 0.15f64.cos(), 2.0 * 0.15f64.sin()]);
        close(first([0.0, -0.5]), [2.0 * 0.15f64.cos(), 2.0 * 0.15f64.sin()]);
        // those behind do not draw aside, but push aside
        let half = 0.5f64.sqrt();
        let slower = 2.0 - 0.15 * half;
        close(first([-5.0 * half, 5.0 * half]), [slower, 0.0]);
        let (faster, turn) = (2.0 + 0.15 * half, 0.15 * half);
        close(first([-0.5 * half, 0.5 * half]), [faster * turn.cos(), -faster * turn.sin()]);
        let w = Oracle::new("katz_herbert_read_2011").inject("noise", &[0.3]).step(&[([0.0, 0.0], [2.0, 0.0])]);
        close(w.velocity(0), [2.0 * 0.3f64.cos(), 2.0 * 0.3f64.sin()]);
    }
}
