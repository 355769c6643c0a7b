//! Navigators who each err about the way, and correct their error by the headings of those near: the principle of many wrongs.
//!
//! E. A. Codling, J. W. Pitchford, S. D. Simpson (2007), Group navigation and the "many-wrongs principle" in models of animal
//! movement, Ecology 88:1864 (an interpretation: the project's sources classify the paper and give no law).

use crate::card::*;
use crate::models::families::angles::with_noise;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `codling_2007`.
    pub struct Codling2007 {
        /// Distance below which headings of others count.
        radius: R = 5.0, "R", "length", Positive, Ours;
        /// Weight of the others' mean heading; the rest is that of the own estimate of the way.
        social_weight alias "w": R = 0.5, "w", "1", Within(0.0, 1.0), Ours;
        /// Place to reach, or one for each member; the own heading is the estimate where empty.
        target: Points<R> = [0.0; 0], "x_*", "length", Any, Ours;
        /// Speed, the same for all.
        speed: R = 1.0, "v0", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
        /// Standard deviation of the error of the own estimate.
        noise_deviation alias "sigma": R = 0.0, "sigma", "rad", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for Codling2007<R> {
    const CARD: Card = Card {
        id: "codling_2007",
        title: "Codling et al. 2007, many wrongs",
        about: "Members estimate the way to a target with an error and correct it by the mean heading of those near.",
        reference: "E. A. Codling, J. W. Pitchford, S. D. Simpson (2007). Group navigation and the \"many-wrongs principle\" in \
                    models of animal movement. Ecology 88, 1864-1870. doi:10.1890/06-0854.1",
        equations: "n_i = unit(x_* - x_i), or h_i, turned by noise_i,  noise normal with SD sigma\n\
                    u = (1 - w) n_i + w unit(sum_{j in I} h_j);  nobody: u = n_i\n\
                    h_i' = unit(u);  x_i' = x_i + v0 h_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, R)",
            motion: "heading",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "an interpretation: the sources classify the paper and give no law. Its correlated walk is the error drawn anew \
                     each step; the balance of own estimate and others is ours, and so is the classification by design",
        edge: "nobody, or headings that cancel: the own estimate; u = 0: heading kept; at the target the heading is the estimate",
        random: &[
            RandomQuantity { name: "noise", about: "angle, normal with SD sigma; behaviour slots 0 and 1" },
            RandomQuantity {
                name: "axis_angle",
                about: "3-D: place of the axis, uniform in [0, 2 pi); behaviour slot 2",
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
    fn check(&self, members: usize) -> Result<(), String> {
        self.target.check("target", members)
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Codling2007<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let heading = me.heading();
        let mut headings = Vector::ZERO;
        for k in seen.set(0) {
            headings += seen.heading(k);
        }
        let others = headings.unit();
        let space = me.around.space;
        let way =
            self.target.of(me.member()).map_or(heading, |place| space.offset(me.position, place).unit_or(heading));
        let way = with_noise(way, self.noise_deviation, me, draws);
        let weight = if others.is_tiny() { R::ZERO } else { self.social_weight };
        let (own, others) = (way * (R::ONE - weight), others * weight);
        me.note("own estimate", own);
        me.note("others", others);
        me.sum(own + others);
        Motion::new_velocity((own + others).unit_or(heading) * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn own_estimate_and_others_are_balanced() {
        let pair = [([0.0, 0.0], [1.0, 0.0]), ([3.0, 0.0], [0.0, -1.0])];
        let model = || Oracle::new("codling_2007").set("target", [50.0, 0.0]);
        let w = model().set("w", 0.25).step(&pair);
        let length = 10f64.sqrt();
        close(w.velocity(0), [3.0 / length, -1.0 / length]);
        close(w.position(0), [3.0 / length, -1.0 / length]);
        close(model().set("w", 1.0).step(&pair).velocity(0), [0.0, -1.0]);
        close(model().set("radius", 3.0).step(&pair).velocity(0), [1.0, 0.0]);
    }

    #[test]
    fn errors_turn_the_estimate_and_cancelling_others_do_not_count() {
        let alone = [([0.0, 0.0], [1.0, 0.0])];
        let w = Oracle::new("codling_2007").set("target", [0.0, 9.0]).inject("noise", &[-0.3]).step(&alone);
        close(w.velocity(0), [0.3f64.sin(), 0.3f64.cos()]);
        close(Oracle::new("codling_2007").step(&alone).velocity(0), [1.0, 0.0]);
        let cancel = [alone[0], ([1.0, 0.0], [0.0, 1.0]), ([0.0, 1.0], [0.0, -1.0])];
        close(Oracle::new("codling_2007").step(&cancel).velocity(0), [1.0, 0.0]);
        let w = Oracle::new("codling_2007").set("target", [0.0, 0.0, 5.0]).step(&[([0.0; 3], [1.0, 0.0, 0.0])]);
        close(w.velocity(0), [0.0, 0.0, 1.0]);
    }
}
