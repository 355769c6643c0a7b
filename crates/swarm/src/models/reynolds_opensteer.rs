//! Boids in the steering form: separation, alignment and cohesion, each with its own radius and cone, add to a capped force.
//!
//! C. W. Reynolds (1987), Flocks, herds, and schools: a distributed behavioral model, Computer Graphics 21:25, as the program
//! OpenSteer (2004) has it.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::lanes::{Lanes, Mask};

parameters! {
    /// Parameters of `reynolds_opensteer`.
    pub struct ReynoldsOpensteer {
        /// Radius of separation.
        separation_radius alias "sep_radius": R = 5.0, "r_s", "length", NonNegative, Paper;
        /// Cosine of the half-angle of separation's cone.
        separation_cosine alias "sep_cos": R = -0.707, "-", "1", Within(-1.0, 1.0), Paper;
        /// Weight of separation.
        separation_weight alias "w_sep": R = 12.0, "w1", "force", NonNegative, Paper;
        /// Radius of alignment.
        alignment_radius alias "ali_radius": R = 7.5, "r_al", "length", NonNegative, Paper;
        /// Cosine of the half-angle of alignment's cone.
        alignment_cosine alias "ali_cos": R = 0.7, "-", "1", Within(-1.0, 1.0), Paper;
        /// Weight of alignment.
        alignment_weight alias "w_ali": R = 8.0, "w2", "force", NonNegative, Paper;
        /// Radius of cohesion.
        cohesion_radius alias "coh_radius": R = 9.0, "r_co", "length", NonNegative, Paper;
        /// Cosine of the half-angle of cohesion's cone.
        cohesion_cosine alias "coh_cos": R = -0.15, "-", "1", Within(-1.0, 1.0), Paper;
        /// Weight of cohesion.
        cohesion_weight alias "w_coh": R = 8.0, "w3", "force", NonNegative, Paper;
        /// Distance below which others count in any direction: three body radii.
        minimum_distance alias "min_dist": R = 1.5, "-", "length", NonNegative, Paper;
        /// Cap of the force.
        maximum_force alias "max_force": R = 27.0, "F_max", "force", NonNegative, Paper;
        /// Cap of the speed.
        maximum_speed alias "max_speed": R = 9.0, "v_max", "length/time", NonNegative, Paper;
        /// Mass.
        mass alias "m": R = 1.0, "m", "mass", Positive, Paper;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for ReynoldsOpensteer<R> {
    const CARD: Card = Card {
        id: "reynolds_opensteer",
        title: "Reynolds 1987, OpenSteer",
        about: "Members steer away from, along with and towards those they see, with a capped force and a capped speed.",
        reference: "C. W. Reynolds (1987). Flocks, herds, and schools: a distributed behavioral model. Computer Graphics 21, \
                    25-34. doi:10.1145/37402.37406; as in OpenSteer 0.8.2 (2004)",
        equations: "F = w1 unit(mean_s -d_ij/rho_ij^2) + w2 unit(mean_a h_j - h_i) + w3 unit(mean_c d_ij)\n\
                    v_i' = clip(v_i + Dt clip(F, F_max)/m, v_max);  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "separation, alignment, cohesion: distance_based(0, min_dist), or distance_based(0, radius) within the \
                        cone h_i . e_ij > cosine, with a radius and a cosine each",
            motion: "steering force",
            physics: "speed cap",
            obstacles: "",
        },
        departures: "the sign of the table's separation is reversed (the program divides the offset by -rho^2); three radii \
                     for one; the weighted sum is a force, not the velocity; the program's smoothing of the force is left out",
        edge: "coincident: left out of separation; equal headings: no alignment force; at rest h_i = 0, so a cone with a \
               cosine of 0 or more is empty and any other is all round; nobody: straight on",
        random: &[],
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
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        // as the program starts its flock
        self.maximum_speed * R::of(0.3)
    }
}

/// The least cosine that counts as more than `limit`.
#[inline(always)]
fn above<R: Scalar>(limit: R) -> R {
    limit + R::TINY
}

impl<R: Scalar> ReynoldsOpensteer<R> {
    /// Radius and cosine limit of the three sets.
    #[inline(always)]
    fn zones(&self) -> [(R, R); 3] {
        [
            (self.separation_radius, self.separation_cosine),
            (self.alignment_radius, self.alignment_cosine),
            (self.cohesion_radius, self.cohesion_cosine),
        ]
    }
}

impl<R: Scalar, const D: usize> Stream<R, D> for ReynoldsOpensteer<R> {
    /// Separation, alignment, cohesion; and how many are in each.
    type Sums<L: Lanes<R>> = ([L; D], [L; D], [L; D], [L; 3]);

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        // nobody in it while moving (but the coincident), everybody at rest
        let at_rest = || Perception::Angle { opening: R::ZERO, cos_half: R::of(2.0) };
        let set = |name: &'static str, (radius, limit): (R, R)| {
            let cone = Perception::Angle { opening: limit.acos() * R::of(2.0), cos_half: above(limit) };
            let cone = match limit < R::ZERO {
                true => cone,
                false => Perception::Difference(Box::new(cone), Box::new(at_rest())),
            };
            let near = (self.minimum_distance > R::ZERO).then(|| Perception::distance(R::ZERO, self.minimum_distance));
            let ahead = (radius > R::ZERO).then(|| Perception::distance(R::ZERO, radius).both(cone));
            let perception = match (near, ahead) {
                (Some(near), Some(ahead)) => Perception::Union(vec![near, ahead]),
                (near, ahead) => near.or(ahead).unwrap_or(Perception::KNearest(0)),
            };
            NamedSet::new(name, perception)
        };
        ["separation", "alignment", "cohesion"].into_iter().zip(self.zones()).map(|(n, z)| set(n, z)).collect()
    }
    fn reach(&self) -> R {
        self.zones().into_iter().fold(self.minimum_distance, |reach, (radius, _)| reach.most(radius))
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(
        &self,
        me: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        _: &Other<'_, R, D>,
    ) -> SetMasks<L::Mask> {
        let within = |radius: R| squared.less(L::splat(radius * radius));
        let near = within(self.minimum_distance);
        // with a cosine of 0 or more only those ahead, and nobody while at rest
        let ahead = squared
            .square_root()
            .less_equal(L::splat(R::TINY))
            .not()
            .and(dot(&me.heading, &me.heading).less_equal(L::splat(R::ZERO)).not());
        let mut sets = [L::Mask::all_of(false); 4];
        for (set, (radius, limit)) in sets.iter_mut().zip(self.zones()) {
            let seen = in_view(&me.heading, offset, squared, above(limit));
            let seen = seen.and(ahead.or(L::Mask::all_of(limit < R::ZERO)));
            *set = near.or(within(radius).and(seen));
        }
        sets
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (separation, alignment, cohesion, counts): &mut Self::Sums<L>,
        _: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        let apart = sets[0].and(L::splat(R::TINY).less(squared.square_root()));
        // those left out divide by one
        let divisor = L::choose(apart, squared, L::splat(R::ONE));
        add_where(separation, apart, core::array::from_fn(|a| -offset[a] / divisor));
        add_where(alignment, sets[1], splat(other.heading));
        add_where(cohesion, sets[2], *offset);
        for (count, mask) in counts.iter_mut().zip([apart, sets[1], sets[2]]) {
            *count = count.add_where(mask, L::splat(R::ONE));
        }
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, D>,
        (separation, alignment, cohesion, counts): &Self::Sums<R>,
        _: &Draws<'_>,
    ) -> Motion<R, D> {
        let mean = |sum: &[R; D], count: R| if count > R::ZERO { Vector(*sum) / count } else { Vector::ZERO };
        let turn = if counts[1] > R::ZERO { mean(alignment, counts[1]) - me.heading() } else { Vector::ZERO };
        let separation = mean(separation, counts[0]).unit() * self.separation_weight;
        let alignment = turn.unit() * self.alignment_weight;
        let cohesion = mean(cohesion, counts[2]).unit() * self.cohesion_weight;
        let force = separation + alignment + cohesion;
        me.unit("force");
        me.note("separation", separation);
        me.note("alignment", alignment);
        me.note("cohesion", cohesion);
        me.sum(force);
        let force = force.clip(self.maximum_force);
        me.length("force after the cap", force, "force");
        let velocity = (me.velocity + force * (self.time_step / self.mass)).clip(self.maximum_speed);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn worked_example_of_the_catalogue() {
        let w = Oracle::new("reynolds_opensteer").step(&[([0.0, 0.0], [5.0, 0.0]), ([2.0, 0.0], [5.0, 0.0])]);
        close(w.velocity(0), [4.8, 0.0]);
        close(w.position(0), [0.24, 0.0]);
        close(w.velocity(1), [5.0, 0.0]);
        close(w.position(1), [2.25, 0.0]);
    }

    #[test]
    fn within_the_minimum_distance_nobody_hides_and_the_coincident_do_not_separate() {
        // straight behind at 1: separation ahead by 12, cohesion back by 8, headings equal
        let w = Oracle::new("reynolds_opensteer").step(&[([0.0, 0.0], [5.0, 0.0]), ([-1.0, 0.0], [5.0, 0.0])]);
        close(w.velocity(0), [5.2, 0.0]);
        // coincident and going up: alignment alone
        let w = Oracle::new("reynolds_opensteer").step(&[([0.0, 0.0], [5.0, 0.0]), ([0.0, 0.0], [0.0, 5.0])]);
        let turn = 0.05 * 8.0 * 0.5f64.sqrt();
        close(w.velocity(0), [5.0 - turn, turn]);
    }

    #[test]
    fn at_rest_negative_cosines_see_all_round_and_others_nobody() {
        // at 3 behind a member at rest: separation and cohesion see it, alignment does not
        let agents = [([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]), ([-3.0, 0.0, 0.0], [0.0, 9.0, 0.0])];
        close(Oracle::new("reynolds_opensteer").step(&agents).velocity(0), [0.05 * (12.0 - 8.0), 0.0, 0.0]);
        let w = Oracle::new("reynolds_opensteer").set("ali_cos", -0.1).step(&agents);
        close(w.velocity(0), [0.2, 0.4, 0.0]);
    }

    #[test]
    fn force_and_speed_are_capped() {
        let pair = [([0.0, 0.0], [9.0, 0.0]), ([1.0, 0.0], [9.0, 0.0])];
        let base = || Oracle::new("reynolds_opensteer").set("w_sep", 0.0).set("w_coh", 100.0).set("m", 0.5);
        close(base().step(&pair).velocity(0), [9.0, 0.0]);
        close(base().step(&pair).velocity(1), [9.0 - 0.05 * 27.0 / 0.5, 0.0]);
    }
}
