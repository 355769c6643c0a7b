//! Robots that avoid, lead when they see nobody, and else follow the nearest.
//!
//! I. D. Kelly, D. A. Keating (1996), On flocking by the fusion of sonar and active infrared sensors on physical autonomous mobile
//! robots, Mechatronics and Machine Vision in Practice 3.

use crate::card::*;
use crate::models::families::angles::{bearing, facing as heading_at, turned};
use crate::models::families::facing;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::{Column, ColumnKind, Vector};

parameters! {
    /// Parameters of `kelly_keating_1996`.
    pub struct KellyKeating1996 {
        /// Distance below which others are seen.
        range: R = 5.0, "beta", "m", Positive, Ours;
        /// Full field of view.
        field_of_view alias "fov_deg": R = 180.0, "alpha", "deg", Within(0.0, 360.0), Ours;
        /// Distance below which somebody ahead is avoided.
        avoidance_distance alias "r_avoid": R = 0.6, "-", "m", NonNegative, Ours;
        /// Distance below which a follower slows down.
        near_distance alias "r_near": R = 1.0, "-", "m", NonNegative, Ours;
        /// Distance above which a follower hurries.
        far_distance alias "r_far": R = 2.0, "-", "m", NonNegative, Ours;
        /// Weight of the way to the one followed.
        attraction_weight alias "w_at": R = 1.0, "w_at", "1", NonNegative, Ours;
        /// Weight of the direction of the one followed.
        alignment_weight alias "w_al": R = 0.5, "w_al", "1", NonNegative, Ours;
        /// Speed of a leader.
        leader_speed alias "s_lead": R = 0.2, "-", "m/s", NonNegative, Ours;
        /// Slow speed.
        slow_speed alias "s_slow": R = 0.1, "-", "m/s", NonNegative, Ours;
        /// Fast speed.
        fast_speed alias "s_fast": R = 0.4, "-", "m/s", NonNegative, Ours;
        /// Largest turning rate.
        turning_rate alias "turn_deg": R = 60.0, "theta", "deg/s", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.5, "Dt", "s", Positive, Ours;
        /// Standard deviation of a leader's wander in a step.
        noise_deviation: R = 0.0, "-", "rad", NonNegative, Ours;
    }
}

const AVOID: usize = 0;
const LEAD: usize = 1;
const FOLLOW: usize = 2;
const MODES: [&str; 3] = ["AVOID", "LEAD", "FOLLOW"];

impl<R: Scalar> Law<R> for KellyKeating1996<R> {
    const CARD: Card = Card {
        id: "kelly_keating_1996",
        title: "Kelly and Keating 1996",
        about: "Robots turn from whom they meet; of the others, who sees nobody leads, and everyone else follows the nearest.",
        reference: "I. D. Kelly, D. A. Keating (1996). On flocking by the fusion of sonar and active infrared sensors on physical \
                    autonomous mobile robots. Proceedings of the 3rd Conference on Mechatronics and Machine Vision in Practice, \
                    1-4",
        equations: "AVOID   somebody ahead (|phi| <= 90 deg) within r_avoid: turn from the nearest by turn Dt (right if it is left \
                    or straight ahead), speed s_slow\n\
                    LEAD    nobody visible: theta_i + wander_i, speed s_lead\n\
                    FOLLOW  k nearest visible: turn toward w_at e_ik + w_al h(theta_k) by at most turn Dt;\n\
                    speed s_fast if rho > r_far, s_slow if rho < r_near, else the speed of k\n\
                    v_i' = s h(theta_i');  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal within range (stands for infrared, sonar, radio)",
            detection: "ideal",
            selection: "near = distance_based(0, r_avoid), of these those ahead; range = distance_based(0, range), of these those \
                        within angle(alpha) of the orientation",
            motion: "orientation and speed",
            physics: "turn-limited",
            obstacles: "",
        },
        departures: "an interpretation with the hierarchy of the paper (avoid, lead, follow); the rules concern robots, walls are \
                     the body's affair",
        edge: "a zero wish: straight on; a coincident robot lies straight ahead; ties go to the lower index; h is that of the \
               orientation theta, also at rest",
        random: &[RandomQuantity {
            name: "wander",
            about: "angle, normal with SD noise_deviation; behaviour slots 0 and 1",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: false,
            avoidance: Avoidance::All,
            identification: true,
            uses: [true, true, true],
            validation: "P",
            synchronous: false,
            information: [Information::Local, Information::Inferred, Information::Inferred],
            environment: "bounded free",
        },
    };
    fn columns() -> &'static [Column] {
        &[
            facing::THETA,
            Column {
                name: "mode",
                unit: "1",
                kind: ColumnKind::Label(&MODES),
                about: "Behaviour that made the last step.",
            },
        ]
    }
    fn needs(&self) -> Needs {
        Needs { velocity: true, state: true, ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.leader_speed
    }
}

impl<R: Scalar> Model<R, 2> for KellyKeating1996<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![
            NamedSet::new("near", Perception::ring(R::ZERO, self.avoidance_distance)),
            NamedSet::new("range", Perception::distance(R::ZERO, self.range)),
        ]
    }
    fn complete(&self, start: &mut Start<'_, R, 2>) {
        facing::complete(start, self.leader_speed);
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, 2>) {
        facing::performed(own, velocity);
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let theta = me.own[0];
        let most = self.turning_rate.radians() * self.time_step;
        let half_angle = self.field_of_view.radians() * R::HALF;
        let (mode, turn, speed) = if let Some(k) = facing::nearest_ahead(seen, 0, theta) {
            let left = bearing(seen, k, theta) >= R::ZERO;
            me.acts(&[0]);
            (AVOID, if left { -most } else { most }, self.slow_speed)
        } else if let Some(k) = facing::nearest_within(seen, 1, theta, half_angle) {
            let towards = seen.direction(k) * self.attraction_weight;
            let along = heading_at(seen.state(k, 0)) * self.alignment_weight;
            me.note("towards the nearest", towards);
            me.note("along with it", along);
            let wish = towards + along;
            me.sum(wish);
            me.acts(&[1]);
            let turn = if wish.is_tiny() { R::ZERO } else { (wish.angle() - theta).wrapped() };
            let distance = seen.distance(k);
            let speed = if distance > self.far_distance {
                self.fast_speed
            } else if distance < self.near_distance {
                self.slow_speed
            } else {
                seen.velocity(k).length()
            };
            (FOLLOW, turn.clamped(-most, most), speed)
        } else {
            let drawn = self.noise_deviation > R::ZERO || draws.injected.is_some();
            let deviation = self.noise_deviation.to_f64();
            let wander = if drawn { draws.number("wander", 0.0, |s| deviation * s.normal(0)) } else { R::ZERO };
            me.acts(&[]);
            (LEAD, wander, self.leader_speed)
        };
        me.either(MODES, mode);
        me.value("turn", turn, "rad");
        me.own[0] = turned(theta, turn);
        me.own[1] = R::count(mode);
        let velocity = heading_at(me.own[0]) * speed;
        if mode != FOLLOW {
            me.unit("m/s");
            me.note("turned orientation", velocity);
            me.sum(velocity);
        }
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    use super::{AVOID, FOLLOW, LEAD};

    fn mode(w: &crate::World<f64, 2>, id: u32) -> Option<usize> {
        w.state(id, "mode").map(|m| m as usize)
    }

    fn at(degrees: f64, speed: f64) -> [f64; 2] {
        [speed * degrees.to_radians().cos(), speed * degrees.to_radians().sin()]
    }

    #[test]
    fn who_sees_nobody_leads_and_the_other_follows() {
        // 1 is behind 0 at 1.5, so follows at its speed; towards it, and half along with it
        let w = Oracle::new("kelly_keating_1996").step(&[([0.0, 0.0], at(0.0, 0.3)), ([-1.5, 0.0], at(10.0, 0.1))]);
        assert_eq!((mode(&w, 0), mode(&w, 1)), (Some(LEAD), Some(FOLLOW)));
        close(w.velocity(0), [0.2, 0.0]);
        close(w.position(0), [0.1, 0.0]);
        close(w.velocity(1), [0.3, 0.0]);
        // far it hurries, near it slows down, and turns are limited to 30 degrees
        let follower = |x: f64, degrees: f64| {
            let agents = [([0.0, 0.0], at(0.0, 0.3)), ([x, 0.0], at(degrees, 0.1))];
            Oracle::new("kelly_keating_1996").step(&agents).velocity(1)
        };
        close(follower(-2.5, 80.0), at(50.0, 0.4));
        close(follower(-0.9, -20.0), at(0.0, 0.1));
        let w = Oracle::new("kelly_keating_1996").inject("wander", &[0.2]).step(&[([0.0, 0.0], at(0.0, 0.3))]);
        close(w.velocity(0), at(0.2f64.to_degrees(), 0.2));
    }

    #[test]
    fn avoiding_comes_first() {
        let first = |place: [f64; 2]| {
            Oracle::new("kelly_keating_1996").step(&[([0.0, 0.0], at(0.0, 0.3)), (place, at(0.0, 0.1))])
        };
        for (place, degrees) in [([0.5, 0.0], -30.0), ([0.3, 0.3], -30.0), ([0.3, -0.3], 30.0), ([0.0, 0.0], -30.0)] {
            let w = first(place);
            assert_eq!(mode(&w, 0), Some(AVOID));
            close(w.velocity(0), at(degrees, 0.1));
        }
        // behind: not met, and not seen
        assert_eq!(mode(&first([-0.3, 0.1]), 0), Some(LEAD));
        // at the edge of the view it is followed, along with its orientation
        let w = first([0.0, 3.0]);
        assert_eq!(mode(&w, 0), Some(FOLLOW));
        close(w.velocity(0), at(30.0, 0.4));
    }
}
