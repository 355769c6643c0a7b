//! Boids among which one at the edge, in front, may become a leader for a while.
//!
//! C. Hartman, B. Benes (2006), Autonomous boids, Computer Animation and Virtual Worlds 17:199.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::{Column, ColumnKind};

parameters! {
    /// Parameters of `hartman_benes_2006`.
    pub struct HartmanBenes2006 {
        /// Distance below which others separate.
        separation_radius alias "sep_radius": R = 2.0, "r_s", "length", NonNegative, Ours;
        /// Distance below which others are seen.
        view_radius: R = 8.0, "eps", "length", Positive, Ours;
        /// Gain of separation.
        separation_gain alias "S": R = 0.5, "S", "1/time^2", NonNegative, Ours;
        /// Gain of cohesion.
        cohesion_gain alias "K": R = 0.1, "K", "1/time^2", NonNegative, Ours;
        /// Gain of alignment.
        alignment_gain alias "M": R = 0.3, "M", "1/time", NonNegative, Ours;
        /// Gain of leadership.
        leadership_gain alias "X": R = 1.0, "X", "1", NonNegative, Ours;
        /// Least eccentricity of a leader.
        least_eccentricity alias "ecc_min": R = 0.3, "-", "1", NonNegative, Ours;
        /// Probability of becoming a leader in a step, at an eccentricity of 1.
        leadership_probability alias "lead_prob": R = 0.05, "-", "1", NonNegative, Ours;
        /// Steps that leadership lasts.
        leadership_steps alias "lead_time": usize = 40usize, "-", "steps", NonNegative, Ours;
        /// Acceleration of a leader.
        leader_acceleration alias "lead_acc": R = 1.0, "-", "length/time^2", NonNegative, Ours;
        /// Cap of a leader's speed, as a multiple of the others'.
        leader_speed_factor alias "lead_boost": R = 1.5, "-", "1", NonNegative, Ours;
        /// Cap of the speed.
        maximum_speed alias "max_speed": R = 2.0, "v_max", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for HartmanBenes2006<R> {
    const CARD: Card = Card {
        id: "hartman_benes_2006",
        title: "Hartman and Benes 2006, change of leadership",
        about: "Boids separate, align and close up; one at the front edge may become a leader and speed away for a while.",
        reference: "C. Hartman, B. Benes (2006). Autonomous boids. Computer Animation and Virtual Worlds 17, 199-206. \
                    doi:10.1002/cav.123",
        equations: "c = mean d_ij (view);  ecc = |c|/view_radius\n\
                    leader (timer = lead_time) if timer = 0, -c . h_i > 0, ecc >= ecc_min, u_i < lead_prob ecc\n\
                    acc = S (-sum d_ij over separation) + M (mean v_j - v_i) + K c  (the last only while timer = 0)\n\
                    timer > 0:  acc += X lead_acc h_i,  cap = lead_boost v_max,  timer -= 1;  else cap = v_max\n\
                    v_i' = clip(v_i + Dt acc, cap);  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "separation = distance_based(0, r_s); view = distance_based(0, view_radius)",
            motion: "force",
            physics: "speed cap",
            obstacles: "",
        },
        departures: "the rule of leadership is an interpretation",
        edge: "nobody in view: only the timer runs, with a leader's thrust; at rest nobody becomes a leader",
        random: &[RandomQuantity { name: "u", about: "uniform in [0, 1); neutral value 1 (never); behaviour slot 0" }],
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
    fn columns() -> &'static [Column] {
        &[Column { name: "timer", unit: "steps", kind: ColumnKind::Count, about: "Steps of leadership that are left." }]
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.maximum_speed
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for HartmanBenes2006<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![
            NamedSet::new("separation", Perception::ring(R::ZERO, self.separation_radius)),
            NamedSet::new("view", Perception::distance(R::ZERO, self.view_radius)),
        ]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let (mut away, mut centre, mut velocities, mut count) = (Vector::ZERO, Vector::ZERO, Vector::ZERO, R::ZERO);
        for k in 0..seen.len() {
            let offset = seen.offset(k);
            if seen.is_in(k, 0) {
                away -= offset;
            }
            if seen.is_in(k, 1) {
                centre += offset;
                velocities += seen.velocity(k);
                count += R::ONE;
            }
        }
        let heading = me.heading();
        let mut parts = [Vector::ZERO; 4];
        let mut timer = me.own[0];
        if count > R::ZERO {
            centre = centre / count;
            let eccentricity = centre.length() / self.view_radius;
            let in_front = -centre.dot(heading) > R::ZERO && eccentricity >= self.least_eccentricity;
            if timer <= R::ZERO && in_front {
                let u: R = draws.number("u", 1.0, |s| s.uniform(0));
                if u < self.leadership_probability * eccentricity {
                    timer = R::count(self.leadership_steps);
                }
            }
            parts[0] = away * self.separation_gain;
            parts[1] = (velocities / count - me.velocity) * self.alignment_gain;
            if timer <= R::ZERO {
                parts[2] = centre * self.cohesion_gain;
            }
            me.value("eccentricity", eccentricity, "1");
        }
        let leads = timer > R::ZERO;
        me.either(["follow", "lead"], usize::from(leads));
        let mut cap = self.maximum_speed;
        if leads {
            parts[3] = heading * (self.leadership_gain * self.leader_acceleration);
            cap *= self.leader_speed_factor;
            timer -= R::ONE;
        }
        me.own[0] = timer.most(R::ZERO);
        me.unit("length/time^2");
        let mut acceleration = Vector::ZERO;
        for (name, part) in ["separation", "alignment", "cohesion", "leadership"].into_iter().zip(parts) {
            me.note(name, part);
            acceleration += part;
        }
        me.sum(acceleration);
        Motion::new_velocity((me.velocity + acceleration * self.time_step).clip(cap), self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    /// One behind the other, at 4.
    const PAIR: [([f64; 2], [f64; 2]); 2] = [([0.0, 0.0], [1.0, 0.0]), ([-4.0, 0.0], [1.5, 0.0])];

    #[test]
    fn plain_boids_without_leaders() {
        let w = Oracle::new("hartman_benes_2006").step(&PAIR);
        // 0.3 (1.5 - 1) - 0.1 * 4
        close(w.velocity(0), [1.0 + 0.1 * (0.15 - 0.4), 0.0]);
        close(w.position(0), [0.1 * (1.0 + 0.1 * (0.15 - 0.4)), 0.0]);
        // within 2 separation: 0.5 * 1
        let near = [PAIR[0], ([-1.0, 0.0], [1.0, 0.0])];
        close(Oracle::new("hartman_benes_2006").step(&near).velocity(0), [1.0 + 0.1 * (0.5 - 0.1), 0.0]);
        // nobody in view, and the cap
        close(Oracle::new("hartman_benes_2006").step(&PAIR[..1]).velocity(0), [1.0, 0.0]);
        close(Oracle::new("hartman_benes_2006").step(&[([0.0; 3], [0.0, 3.0, 4.0])]).velocity(0), [0.0, 1.2, 1.6]);
    }

    #[test]
    fn who_is_in_front_at_the_edge_may_lead() {
        // the eccentricity is a half, so the chance is 0.025
        let lead = |u: f64| Oracle::new("hartman_benes_2006").inject("u", &[u, u]).step(&PAIR);
        let w = lead(0.0249);
        assert_eq!((w.state(0, "timer"), w.state(1, "timer")), (Some(39.0), Some(0.0)));
        close(w.velocity(0), [1.0 + 0.1 * (0.15 + 1.0), 0.0]);
        assert_eq!(lead(0.025).state(0, "timer"), Some(0.0));
        // too near the centre
        let w = Oracle::new("hartman_benes_2006").set("ecc_min", 0.51).inject("u", &[0.0, 0.0]).step(&PAIR);
        assert_eq!(w.state(0, "timer"), Some(0.0));
        // a leader's thrust, cap and clock, also alone
        let w = Oracle::new("hartman_benes_2006").column("timer", &[7.0]).step(&[([0.0, 0.0], [2.95, 0.0])]);
        close(w.velocity(0), [3.0, 0.0]);
        assert_eq!(w.state(0, "timer"), Some(6.0));
    }
}
