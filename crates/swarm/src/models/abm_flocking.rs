//! The flocking model on which frameworks of agent-based models are compared.
//!
//! The Flocking model of ABMFrameworksComparison (JuliaDynamics), itself after Reynolds' boids: cohesion, separation and
//! matching are summed over all within one radius, added to the velocity, and the velocity is brought back to its length.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::lanes::{Lanes, Mask};

parameters! {
    /// Parameters of `abm_flocking`.
    pub struct AbmFlocking {
        /// Radius within which others are seen.
        radius alias "visual_distance": R = 5.0, "r", "length", Positive, Source;
        /// Distance below which members separate.
        separation_distance alias "separation": R = 1.0, "r_s", "length", NonNegative, Source;
        /// Weight of the displacements to those seen.
        cohesion alias "cohere_factor": R = 0.03, "w_c", "1/length", NonNegative, Source;
        /// Weight of the displacements to those too near.
        separation_weight alias "separate_factor": R = 0.015, "w_s", "1/length", NonNegative, Source;
        /// Weight of the velocities of those seen.
        alignment alias "match_factor": R = 0.05, "w_a", "1", NonNegative, Source;
        /// Speed, the same for all.
        speed: R = 1.0, "v0", "length/time", NonNegative, Source;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Source;
    }
}

impl<R: Scalar> Law<R> for AbmFlocking<R> {
    const CARD: Card = Card {
        id: "abm_flocking",
        title: "Flocking of agent-based-model frameworks (benchmark)",
        about: "Members of constant speed add pulls, pushes and the velocities of all within a radius to their own velocity.",
        reference: "Flocking model of ABMFrameworksComparison (github.com/JuliaDynamics/ABMFrameworksComparison), workload W3 \
                    of this project; after C. W. Reynolds (1987). Computer Graphics 21, 25-34. doi:10.1145/37402.37406",
        equations: "u = v_i + (w_c sum_j d_ij - w_s sum_{rho_ij < r_s} d_ij + w_a sum_j v_j)/max(n, 1)\n\
                    v_i' = v0 unit(u);  x_i' = x_i + v_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius); too_near = distance_based(0, separation_distance)",
            motion: "weighted sums",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "true distances and displacements by minimum image, which not all published versions use; the comparison \
                     activates members one after the other in a new random order each step (the sequential driver)",
        edge: "alone: keeps its heading; zero resultant: keeps its velocity's direction",
        random: &[],
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
            environment: "periodic free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.separation_distance > self.radius {
            return Err("the separation distance must not be more than the radius".into());
        }
        Ok(())
    }
}

impl<R: Scalar> Stream<R, 2> for AbmFlocking<R> {
    /// Weighted displacements (cohesion and separation), velocities, number.
    type Sums<L: Lanes<R>> = ([L; 2], [L; 2], [L; 1]);
    const HEADINGS: bool = false;

    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        let too_near = match self.separation_distance > R::ZERO {
            true => Perception::distance(R::ZERO, self.separation_distance),
            false => Perception::KNearest(0),
        };
        vec![
            NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius)),
            NamedSet::new("too_near", too_near),
        ]
    }
    fn reach(&self) -> R {
        self.radius
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(
        &self,
        _: &MeLanes<L, 2>,
        _: &[L; 2],
        squared: L,
        _: &Other<'_, R, 2>,
    ) -> SetMasks<L::Mask> {
        let [yes, no] = [true, false].map(L::Mask::all_of);
        [yes, squared.less(L::splat(self.separation_distance * self.separation_distance)), no, no]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (displacement, velocities, number): &mut Self::Sums<L>,
        _: &MeLanes<L, 2>,
        offset: &[L; 2],
        _: L,
        other: &Other<'_, R, 2>,
        sets: &SetMasks<L::Mask>,
    ) {
        // a scenario may choose the sets freely, so each term asks for its own
        let zero = L::splat(R::ZERO);
        let pull = L::choose(sets[0], L::splat(self.cohesion), zero);
        let push = L::choose(sets[1], L::splat(self.separation_weight), zero);
        let weight = pull - push;
        for a in 0..2 {
            displacement[a] = displacement[a] + offset[a] * weight;
        }
        add_where(velocities, sets[0], splat(other.velocity));
        number[0] = number[0].add_where(sets[0], L::splat(R::ONE));
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, 2>,
        (displacement, velocities, number): &Self::Sums<R>,
        _: &Draws<'_>,
    ) -> Motion<R, 2> {
        let number = number[0].most(R::ONE);
        let (gather, align) = (Vector(*displacement) / number, Vector(*velocities) * self.alignment / number);
        let sum = me.velocity + gather + align;
        me.unit("length/time");
        me.note("own velocity", me.velocity);
        me.note("cohesion and separation", gather);
        me.note("alignment", align);
        me.sum(sum);
        let heading = sum.unit_or(me.heading());
        Motion::new_velocity(heading * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::engine::{Driver, Order};
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn sums_over_a_near_and_a_far_neighbour() {
        let w = Oracle::new("abm_flocking").step(&[
            ([0.0, 0.0], [1.0, 0.0]),
            ([0.0, 0.5], [0.0, 1.0]),
            ([4.0, 0.0], [0.0, -1.0]),
            ([0.0, 7.0], [0.0, 1.0]),
        ]);
        let (x, y) = (1.0f64 + 0.03 * 4.0 / 2.0, (0.03 * 0.5 - 0.015 * 0.5) / 2.0);
        let length = (x * x + y * y).sqrt();
        close(w.velocity(0), [x / length, y / length]);
        close(w.position(0), [x / length, y / length]);
        close(w.velocity(3), [0.0, 1.0]);
    }

    #[test]
    fn the_second_in_a_sequence_sees_where_the_first_has_gone() {
        let w = Oracle::new("abm_flocking")
            .driver(Driver::Sequential(Order::RoundRobin))
            .step(&[([0.0, 0.0], [0.0, -1.0]), ([0.0, 4.5], [1.0, 0.0])]);
        // after the first step the two are more than 5 apart
        assert!(w.position(0)[1] < -0.5);
        close(w.velocity(1), [1.0, 0.0]);
    }

    #[test]
    fn opposed_neighbours_of_equal_weight_leave_the_heading() {
        let w = Oracle::new("abm_flocking")
            .set("match_factor", 1.0)
            .set("cohere_factor", 0.0)
            .step(&[([0.0, 0.0], [1.0, 0.0]), ([2.0, 0.0], [-1.0, 0.0])]);
        close(w.velocity(0), [1.0, 0.0]);
    }
}
