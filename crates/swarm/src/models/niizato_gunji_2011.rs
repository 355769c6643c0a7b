//! Everyone takes the mean direction of those within a radius while these agree, and of its nearest few while they do not.
//!
//! T. Niizato, Y.-P. Gunji (2011), Metric-topological interaction model of collective behavior, Ecological Modelling 222:3041.

use crate::card::*;
use crate::models::vicsek_1995::published;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `niizato_gunji_2011`.
    pub struct NiizatoGunji2011 {
        /// Radius of metric neighbours.
        radius: R = 1.0, "R", "length", Positive, Ours;
        /// Number of topological neighbours.
        neighbour_count alias "k": usize = 7usize, "k", "1", NonNegative, Ours;
        /// Dissimilarity of metric neighbours above which topological ones count.
        dissimilarity_threshold alias "delta": R = 0.1, "delta", "1", Any, Ours;
        /// Speed, the same for all.
        speed: R = 0.05, "v", "length/time", NonNegative, Ours;
        /// Width of the interval from which the random angle is drawn.
        noise_amplitude alias "eta": R = 0.0, "eta", "rad", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for NiizatoGunji2011<R> {
    const CARD: Card = Card {
        id: "niizato_gunji_2011",
        title: "Niizato and Gunji 2011",
        about: "Members of constant speed take the mean direction of all within a radius, or of their nearest few where those \
                within the radius disagree.",
        reference: "T. Niizato, Y.-P. Gunji (2011). Metric-topological interaction model of collective behavior. Ecological \
                    Modelling 222, 3041-3049. doi:10.1016/j.ecolmodel.2011.06.008",
        equations: "M = distance_based(0, R);  q = 1 - |mean_{M, i} h_j|, or 0 where M is empty\n\
                    I = k_nearest(k) if q > delta, else M;  H_i = h_i + sum_{j in I} h_j\n\
                    theta_i' = angle(H_i) + noise_i,  noise uniform in [-eta/2, eta/2)\n\
                    x_i' = x_i + v_i Dt  (old velocity);  v_i' = v h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "metric = distance_based(0, R); topological = k_nearest(k); one of them by the dissimilarity of the first",
            motion: "mean heading with self, turned by noise",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "an interpretation: dissimilarity is one minus the local polarisation; three dimensions as in vicsek_1995",
        edge: "nobody within the radius: dissimilarity 0, so the heading is kept, unless delta is negative (topological \
               always); zero resultant: heading kept, turned by the noise",
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

const METRIC: usize = 0;
const TOPOLOGICAL: usize = 1;

impl<R: Scalar, const D: usize> Model<R, D> for NiizatoGunji2011<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![
            NamedSet::new("metric", Perception::distance(R::ZERO, self.radius)),
            NamedSet::new("topological", Perception::KNearest(self.neighbour_count)),
        ]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let sum = |set: usize| {
            let (mut headings, mut count) = (Vector::ZERO, R::ZERO);
            for k in seen.set(set) {
                headings += seen.heading(k);
                count += R::ONE;
            }
            (headings, count)
        };
        let (mut headings, count) = sum(METRIC);
        let dissimilarity = match count > R::ZERO {
            true => R::ONE - ((me.heading() + headings) / (count + R::ONE)).length(),
            false => R::ZERO,
        };
        let set = if dissimilarity > self.dissimilarity_threshold { TOPOLOGICAL } else { METRIC };
        if set == TOPOLOGICAL {
            headings = sum(TOPOLOGICAL).0;
        }
        me.value("dissimilarity", dissimilarity, "1");
        me.either(["metric", "topological"], set);
        me.acts(&[set]);
        published(self.radius, self.speed, self.noise_amplitude, self.time_step).finish(me, &headings.0, draws)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    const ALL: [([f64; 2], [f64; 2]); 3] =
        [([0.0, 0.0], [0.05, 0.0]), ([0.5, 0.0], [0.0, 0.05]), ([0.0, 0.9], [-0.05, 0.0])];

    #[test]
    fn who_agrees_is_metric_and_who_does_not_is_topological() {
        // the metric mean of (1, 0), (0, 1), (-1, 0) has length 1/3: dissimilarity 2/3
        let first =
            |delta: f64| Oracle::new("niizato_gunji_2011").set("k", 1usize).set("delta", delta).step(&ALL).velocity(0);
        close(first(0.7), [0.0, 0.05]);
        close(first(0.6), [0.05 * 0.5f64.sqrt(), 0.05 * 0.5f64.sqrt()]);
        // at delta of 1 and above metric always
        close(first(1.0), [0.0, 0.05]);
    }

    #[test]
    fn nobody_in_the_radius_is_no_disagreement() {
        let far = [([0.0, 0.0], [0.05, 0.0]), ([5.0, 0.0], [0.0, 0.05])];
        let w = Oracle::new("niizato_gunji_2011").set("delta", 0.0).step(&far);
        close(w.velocity(0), [0.05, 0.0]);
        close(w.position(0), [0.05, 0.0]);
        let w = Oracle::new("niizato_gunji_2011").set("delta", -0.1).step(&far);
        close(w.velocity(0), [0.05 * 0.5f64.sqrt(), 0.05 * 0.5f64.sqrt()]);
    }
}
