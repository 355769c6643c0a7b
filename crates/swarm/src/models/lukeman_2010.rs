//! Ducks: propulsion and drag, repulsion, alignment and attraction in rings, and a preferred distance to those straight ahead.
//!
//! R. Lukeman, Y.-X. Li, L. Edelstein-Keshet (2010), Inferring individual rules from collective behavior, Proceedings of the
//! National Academy of Sciences 107:12576.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `lukeman_2010`.
    pub struct Lukeman2010 {
        /// Distance below which others repel.
        repulsion_radius alias "r_rep": R = 1.5, "r_rep", "length", Positive, Ours;
        /// Distance below which, beyond repulsion, others are aligned with.
        alignment_radius alias "r_al": R = 3.0, "r_al", "length", NonNegative, Ours;
        /// Distance below which, beyond alignment, others attract.
        attraction_radius alias "r_att": R = 6.0, "r_att", "length", NonNegative, Ours;
        /// Weight of repulsion.
        repulsion_weight alias "w_rep": R = 1.5, "w_rep", "length/time^2", NonNegative, Ours;
        /// Weight of alignment.
        alignment_weight alias "w_al": R = 0.5, "w_al", "length/time^2", NonNegative, Ours;
        /// Weight of attraction.
        attraction_weight alias "w_att": R = 0.3, "w_att", "length/time^2", NonNegative, Ours;
        /// Weight of the distance to those ahead.
        frontal_weight alias "w_front": R = 0.3, "w_fr", "length/time^2", NonNegative, Ours;
        /// Full angle ahead.
        frontal_angle alias "front_deg": R = 60.0, "-", "deg", Within(0.0, 360.0), Ours;
        /// Preferred distance to those ahead.
        frontal_distance alias "d_front": R = 2.0, "d_fr", "length", Positive, Ours;
        /// Distance below which others are ahead.
        frontal_radius alias "r_front": R = 4.0, "r_fr", "length", NonNegative, Ours;
        /// Propulsion along the heading.
        propulsion alias "a": R = 1.0, "a", "length/time^2", NonNegative, Ours;
        /// Drag.
        drag alias "gamma": R = 1.0, "gamma", "1/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Lukeman2010<R> {
    const CARD: Card = Card {
        id: "lukeman_2010",
        title: "Lukeman et al. 2010",
        about: "Members propel themselves, avoid, align and approach in rings about them, and keep a distance to those ahead.",
        reference: "R. Lukeman, Y.-X. Li, L. Edelstein-Keshet (2010). Inferring individual rules from collective behavior. \
                    Proceedings of the National Academy of Sciences 107, 12576-12580. doi:10.1073/pnas.1001763107",
        equations: "acc = a h_i - gamma v_i - w_rep mean (1 - rho/r_rep) e_ij + w_al mean h_j + w_att mean e_ij\n\
                    + w_fr mean_ahead clamp((rho - d_fr)/d_fr, -1, 1) e_ij\n\
                    v_i' = v_i + Dt acc;  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "repulsion = distance_based(0, r_rep), alignment = distance_based(r_rep, r_al), attraction = \
                        distance_based(r_al, r_att), ahead = distance_based(0, r_fr) within the frontal angle",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "an interpretation; all radii and weights are ours",
        edge: "at rest: no propulsion and nobody ahead; coincident members are not ahead; empty sets add nothing",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, true, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.repulsion_radius > self.alignment_radius || self.alignment_radius > self.attraction_radius {
            return Err("the radii must not decrease from repulsion over alignment to attraction".into());
        }
        Ok(())
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Lukeman2010<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        let ahead =
            Perception::ring(R::ZERO, self.frontal_radius).both(Perception::angle(self.frontal_angle.radians()));
        vec![
            NamedSet::new("repulsion", Perception::ring(R::ZERO, self.repulsion_radius)),
            NamedSet::new("alignment", Perception::ring(self.repulsion_radius, self.alignment_radius)),
            NamedSet::new("attraction", Perception::ring(self.alignment_radius, self.attraction_radius)),
            NamedSet::new("ahead", ahead),
        ]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let heading = me.heading();
        let moves = !heading.is_tiny();
        let (mut sums, mut counts) = ([Vector::ZERO; 4], [R::ZERO; 4]);
        for k in 0..seen.len() {
            let (distance, direction) = (seen.distance(k), seen.direction(k));
            let mut add = |set: usize, part: Vector<R, D>| {
                sums[set] += part;
                counts[set] += R::ONE;
            };
            if seen.is_in(k, 0) {
                add(0, direction * (distance / self.repulsion_radius - R::ONE));
            }
            if seen.is_in(k, 1) {
                add(1, seen.heading(k));
            }
            if seen.is_in(k, 2) {
                add(2, direction);
            }
            if seen.is_in(k, 3) && moves && distance > R::TINY {
                let excess = (distance - self.frontal_distance) / self.frontal_distance;
                add(3, direction * excess.clamped(-R::ONE, R::ONE));
            }
        }
        let weights = [self.repulsion_weight, self.alignment_weight, self.attraction_weight, self.frontal_weight];
        let parts: [Vector<R, D>; 4] = core::array::from_fn(|s| match counts[s] > R::ZERO {
            true => sums[s] * (weights[s] / counts[s]),
            false => Vector::ZERO,
        });
        let (propulsion, drag) = (heading * self.propulsion, -(me.velocity * self.drag));
        me.unit("length/time^2");
        let mut acceleration = propulsion + drag;
        me.note("propulsion", propulsion);
        me.note("drag", drag);
        for (name, part) in ["repulsion", "alignment", "attraction", "distance ahead"].into_iter().zip(parts) {
            me.note(name, part);
            acceleration += part;
        }
        me.sum(acceleration);
        Motion::new_velocity(me.velocity + acceleration * self.time_step, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn the_lone_reach_their_speed() {
        let w = Oracle::new("lukeman_2010").set("a", 2.0).step(&[([0.0, 0.0], [1.0, 0.0])]);
        close(w.velocity(0), [1.1, 0.0]);
        close(w.position(0), [0.11, 0.0]);
        let mut w = Oracle::new("lukeman_2010").set("a", 2.0).world(&[([0.0, 0.0], [1.0, 0.0])]);
        w.run(300);
        close(w.velocity(0), [2.0, 0.0]);
        close(Oracle::new("lukeman_2010").step(&[([0.0, 0.0], [0.0, 0.0])]).velocity(0), [0.0, 0.0]);
    }

    #[test]
    fn rings_and_those_ahead() {
        let first = |place: [f64; 2]| {
            Oracle::new("lukeman_2010").step(&[([0.0, 0.0], [1.0, 0.0]), (place, [0.0, 1.0])]).velocity(0)
        };
        // at the side: 1.5 (1 - 1/1.5) away, 0.5 along, 0.3 towards
        close(first([0.0, 1.0]), [1.0, -0.05]);
        close(first([0.0, 2.0]), [1.0, 0.05]);
        close(first([0.0, 4.0]), [1.0, 0.03]);
        close(first([0.0, 6.0]), [1.0, 0.0]);
        // ahead: at 3 (attraction) also 0.3 (3 - 2)/2; at 1 repulsion and -0.3/2; at the preferred distance alignment alone
        close(first([3.0, 0.0]), [1.0 + 0.1 * (0.3 + 0.15), 0.0]);
        close(first([1.0, 0.0]), [1.0 - 0.1 * (0.5 + 0.15), 0.0]);
        close(first([2.0, 0.0]), [1.0, 0.05]);
        // coincident: counted, without direction
        close(first([0.0, 0.0]), [1.0, 0.0]);
        let w = Oracle::new("lukeman_2010").step(&[([0.0; 3], [0.0, 0.0, 1.0]), ([0.0, 0.0, 3.0], [0.0, 0.0, 1.0])]);
        close(w.velocity(0), [0.0, 0.0, 1.045]);
    }
}
