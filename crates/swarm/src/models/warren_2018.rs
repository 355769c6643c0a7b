//! Pedestrians approach the heading and the speed of those they see, the nearer the more.
//!
//! W. H. Warren (2018), Collective motion in human crowds, Current Directions in Psychological Science 27:232; after K. W. Rio,
//! G. C. Dachner, W. H. Warren (2018), Local interactions underlying collective motion in human crowds.

use crate::card::*;
use crate::models::families::angles::{facing, turned};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};

parameters! {
    /// Parameters of `warren_2018`.
    pub struct Warren2018 {
        /// Rate at which the heading follows.
        turning_rate alias "k": R = 3.15, "k", "1/time", NonNegative, Paper;
        /// Rate at which the speed follows.
        speed_rate alias "c": R = 3.61, "c", "1/time", NonNegative, Paper;
        /// Decay of influence up to the nearest neighbour.
        near_decay alias "omega1": R = 0.2, "w1", "1/length", NonNegative, Ours;
        /// Decay of influence beyond the nearest neighbour.
        far_decay alias "omega2": R = 1.3, "w2", "1/length", NonNegative, Ours;
        /// Distance below which others count.
        range: R = 5.0, "beta", "length", Positive, Paper;
        /// Full field of view.
        field_of_view alias "fov_deg": R = 180.0, "alpha", "deg", Within(0.0, 360.0), Source;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Warren2018<R> {
    const CARD: Card = Card {
        id: "warren_2018",
        title: "Warren 2018",
        about: "Pedestrians approach the headings and speeds of those they see, whose influence falls with distance.",
        reference: "W. H. Warren (2018). Collective motion in human crowds. Current Directions in Psychological Science 27, \
                    232-240. doi:10.1177/0963721417746743; after K. W. Rio, G. C. Dachner, W. H. Warren (2018). Proceedings of \
                    the Royal Society B 285, 20180611. doi:10.1098/rspb.2018.0611",
        equations: "rho0 = nearest selected;  w_j = exp(-w1 rho0) exp(-w2 (rho_j - rho0))\n\
                    theta_i' = wrap(theta_i + Dt k mean w_j sin(theta_j - theta_i))\n\
                    s_i' = max(0, s_i + Dt c mean w_j (s_j - s_i));  x_i' = x_i + Dt s_i' h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range) within angle(alpha)",
            motion: "heading and speed",
            physics: "ideal",
            obstacles: "",
        },
        departures: "an interpretation: first-order rates; k, c and w2 as quoted in the literature; contributions add before the \
                     division by the number of neighbours",
        edge: "nobody: unchanged; at rest the heading is angle 0, and all are seen",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, true, true],
            validation: "SP",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
}

impl<R: Scalar> Model<R, 2> for Warren2018<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        let view = Perception::angle(self.field_of_view.radians());
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.range).both(view))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, _: &Draws<'_>) -> Motion<R, 2> {
        let (theta, speed) = (me.velocity.angle(), me.velocity.length());
        let nearest = seen.nearest(0).map_or(R::ZERO, |k| seen.distance(k));
        let (mut turn, mut faster, mut count) = (R::ZERO, R::ZERO, R::ZERO);
        for k in seen.set(0) {
            let velocity = seen.velocity(k);
            let weight = (-self.near_decay * nearest).exp() * (-self.far_decay * (seen.distance(k) - nearest)).exp();
            turn += weight * (velocity.angle() - theta).sin();
            faster += weight * (velocity.length() - speed);
            count += R::ONE;
        }
        let (mut turned_to, mut new_speed) = (theta, speed);
        if count > R::ZERO {
            let turn = self.turning_rate * turn / count;
            let faster = self.speed_rate * faster / count;
            me.value("turning rate", turn, "rad/time");
            me.value("acceleration", faster, "length/time^2");
            turned_to = turned(theta, self.time_step * turn);
            new_speed = (speed + self.time_step * faster).most(R::ZERO);
        }
        let velocity = if count > R::ZERO { facing(turned_to) * new_speed } else { me.velocity };
        me.unit("length/time");
        me.note("velocity", velocity);
        me.sum(velocity);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn heading_and_speed_follow_by_distance() {
        let pair = |x: f64, going: [f64; 2]| {
            Oracle::new("warren_2018").step(&[([0.0, 0.0], [1.0, 0.0]), ([x, 0.0], going)]).velocity(0)
        };
        let weight = |x: f64| (-0.2 * x).exp();
        let turn = 0.05 * 3.15 * weight(2.0);
        close(pair(2.0, [0.0, 1.0]), [turn.cos(), turn.sin()]);
        close(pair(2.0, [3.0, 0.0]), [1.0 + 0.05 * 3.61 * 2.0 * weight(2.0), 0.0]);
        // beyond the range, and behind
        close(pair(5.0, [3.0, 0.0]), [1.0, 0.0]);
        close(pair(-2.0, [3.0, 0.0]), [1.0, 0.0]);
    }

    #[test]
    fn the_farther_count_less_and_all_are_averaged() {
        let w = Oracle::new("warren_2018").step(&[
            ([0.0, 0.0], [1.0, 0.0]),
            ([1.0, 0.0], [1.0, 0.0]),
            ([3.0 * 0.6, 3.0 * 0.8], [2.0, 0.0]),
        ]);
        let weight = (-0.2f64).exp() * (-1.3f64 * 2.0).exp();
        close(w.velocity(0), [1.0 + 0.05 * 3.61 * weight / 2.0, 0.0]);
        close(w.position(0), [0.05 * (1.0 + 0.05 * 3.61 * weight / 2.0), 0.0]);
        // nobody walks backwards
        let stop = [([0.0, 0.0], [1.0, 0.0]), ([0.1, 0.0], [0.0, 0.0])];
        close(Oracle::new("warren_2018").set("dt", 1.0).step(&stop).velocity(0), [0.0, 0.0]);
        close(Oracle::new("warren_2018").step(&stop[..1]).velocity(0), [1.0, 0.0]);
    }
}
