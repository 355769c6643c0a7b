//! Boids of an early program: a distance to the nearest, its direction, the middle of all, and a cruising speed, each by urgency.
//!
//! C. W. Reynolds (1987), Flocks, herds, and schools: a distributed behavioral model, Computer Graphics 21:25; as in the C++
//! program of C. Kline (1996).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `reynolds_kline`.
    pub struct ReynoldsKline {
        /// Distance below which others are seen.
        range: R = 9.0, "beta", "length", Positive, Ours;
        /// Preferred distance to the nearest.
        separation: R = 3.0, "-", "length", Positive, Paper;
        /// Least change.
        least_urgency alias "min_urgency": R = 0.05, "u_min", "length/time", NonNegative, Paper;
        /// Largest change.
        largest_urgency alias "max_urgency": R = 0.1, "u_max", "length/time", NonNegative, Paper;
        /// Cap of the speed.
        maximum_speed alias "max_speed": R = 1.0, "v_max", "length/time", Positive, Paper;
        /// Desired speed.
        cruise_speed: R = 0.5, "v_c", "length/time", NonNegative, Paper;
        /// Weight of the distance to the nearest.
        separation_weight alias "w_sep": R = 1.0, "w1", "1", NonNegative, Ours;
        /// Weight of its direction.
        alignment_weight alias "w_ali": R = 1.0, "w2", "1", NonNegative, Ours;
        /// Weight of the middle of those seen.
        cohesion_weight alias "w_coh": R = 1.0, "w3", "1", NonNegative, Ours;
        /// Standard deviation of each component of the jitter.
        noise_deviation: R = 0.0, "-", "length/time", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for ReynoldsKline<R> {
    const CARD: Card = Card {
        id: "reynolds_kline",
        title: "Reynolds 1987, Kline's program",
        about: "Members keep a distance to their nearest, take its direction, close up to the middle, and hold a cruising speed.",
        reference: "C. W. Reynolds (1987). Flocks, herds, and schools: a distributed behavioral model. Computer Graphics 21, \
                    25-34. doi:10.1145/37402.37406; as in C. Kline's C++ boids (1996)",
        equations: "k = nearest(I);  q = clamp(rho_ik/separation, u_min, u_max)\n\
                    c = w1 q (-e_ik if rho_ik < separation; +e_ik if greater; 0 if equal) + w2 u_min h_k + w3 u_min unit(mean d_ij)\n\
                    diff = (s_i - v_c)/v_max;  c += (diff > 0 ? -1 : +1) clamp(|diff|, u_min, u_max) unit(v_i + jitter_i)\n\
                    v_i' = clip(v_i + clip(c, v_max u_max), v_max);  x_i' = x_i + v_i'  (one step is one unit of time)",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range); of these the nearest for separation and alignment",
            motion: "velocity change",
            physics: "speed cap",
            obstacles: "",
        },
        departures: "Table 3.3 gives the separation row the distance of the nearest and the alignment row steps per axis; in the \
                     program these belong to the rule that keeps a distance and to the jitter of the cruise rule; the union \
                     printed for the two selections is a sequence. The vertical damping of the program is left out",
        edge: "nobody in range: only the cruise term, which is nothing at rest without jitter; coincident: no direction",
        random: &[RandomQuantity {
            name: "jitter",
            about: "vector, each component normal with SD noise_deviation; behaviour slots 0 to 5",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: false,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, true, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded obstacles",
        },
    };
    fn initial_speed(&self) -> R {
        self.cruise_speed
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.least_urgency <= self.largest_urgency {
            Ok(())
        } else {
            Err("the least urgency must not be more than the largest".into())
        }
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for ReynoldsKline<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.range))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let urgency = |of: R| of.clamped(self.least_urgency, self.largest_urgency);
        let mut change = Vector::ZERO;
        if let Some(k) = seen.nearest(0) {
            let (distance, direction) = (seen.distance(k), seen.direction(k));
            let towards = if distance < self.separation {
                -direction
            } else if distance > self.separation {
                direction
            } else {
                Vector::ZERO
            };
            let (mut middle, mut count) = (Vector::ZERO, R::ZERO);
            for j in seen.set(0) {
                middle += seen.offset(j);
                count += R::ONE;
            }
            let parts = [
                ("distance to the nearest", towards * (self.separation_weight * urgency(distance / self.separation))),
                ("direction of the nearest", seen.heading(k) * (self.alignment_weight * self.least_urgency)),
                ("middle", (middle / count).unit() * (self.cohesion_weight * self.least_urgency)),
            ];
            for (name, part) in parts {
                me.note(name, part);
                change += part;
            }
        }
        let jitter = draws.normal_vector("jitter", self.noise_deviation);
        let excess = (me.velocity.length() - self.cruise_speed) / self.maximum_speed;
        let along = if excess > R::ZERO { -urgency(excess) } else { urgency(-excess) };
        let cruise = (me.velocity + jitter).unit() * along;
        me.unit("length/time");
        me.note("cruise", cruise);
        change += cruise;
        me.sum(change);
        let change = change.clip(self.maximum_speed * self.largest_urgency);
        Motion::new_velocity((me.velocity + change).clip(self.maximum_speed), R::ONE)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn the_nearest_asks_for_its_distance_and_direction() {
        // at the cruising speed the cruise term still has the least urgency, ahead; closer than 3: back by 0.1
        let w = Oracle::new("reynolds_kline").step(&[([0.0, 0.0], [0.5, 0.0]), ([0.0, 2.0], [0.0, 0.5])]);
        // (0, -0.1) + (0, 0.05) + (0, 0.05) + (0.05, 0)
        close(w.velocity(0), [0.55, 0.0]);
        close(w.position(0), [0.55, 0.0]);
        // farther than 3: towards it, in all (0.05, 0.2), capped at 0.1
        let w = Oracle::new("reynolds_kline").step(&[([0.0, 0.0], [0.5, 0.0]), ([0.0, 4.0], [0.0, 0.5])]);
        let length = f64::hypot(0.05, 0.2);
        close(w.velocity(0), [0.5 + 0.1 * 0.05 / length, 0.1 * 0.2 / length]);
        // exactly 3: only direction and middle
        let w =
            Oracle::new("reynolds_kline").set("w_coh", 0.0).step(&[([0.0, 0.0], [0.5, 0.0]), ([0.0, 3.0], [0.0, 0.5])]);
        close(w.velocity(0), [0.55, 0.05]);
    }

    #[test]
    fn the_lone_cruise() {
        let alone = |speed: f64| Oracle::new("reynolds_kline").step(&[([0.0, 0.0], [speed, 0.0])]).velocity(0);
        close(alone(0.2), [0.3, 0.0]);
        close(alone(0.45), [0.5, 0.0]);
        close(alone(0.57), [0.5, 0.0]);
        close(alone(0.9), [0.8, 0.0]);
        close(alone(0.0), [0.0, 0.0]);
        let w = Oracle::new("reynolds_kline").inject_vectors("jitter", &[[0.0, 7.0]]).step(&[([0.0, 0.0], [0.0, 0.0])]);
        close(w.velocity(0), [0.0, 0.1]);
        // any other neighbour than the nearest changes the middle alone
        let place = |z: f64| {
            [([0.0; 3], [0.5, 0.0, 0.0]), ([0.0, 3.0, 0.0], [0.5, 0.0, 0.0]), ([0.0, 0.0, z], [9.0, 9.0, 0.0])]
        };
        let w = Oracle::new("reynolds_kline").step(&place(4.0));
        // (0.05 + 0.05, 0, 0) + 0.05 (0, 0.6, 0.8): capped at 0.1
        let length = (0.01f64 + 0.0025).sqrt();
        close(w.velocity(0), [0.5 + 0.1 * 0.1 / length, 0.1 * 0.03 / length, 0.1 * 0.04 / length]);
    }
}
