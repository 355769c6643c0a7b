//! Boids of constant speed whose three rules nudge a unit heading: the benchmark of cohesion, alignment and separation in
//! dense space.
//!
//! A workload of this project (W2), in the form that public flocking benchmarks share: every rule is a mean over those within
//! one radius, and the heading is normalised after their weighted sum.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::lanes::{Lanes, Mask};

parameters! {
    /// Parameters of `boids_unit_heading`.
    pub struct BoidsUnitHeading {
        /// Interaction radius.
        radius alias "r": R = 1.0, "r", "length", Positive, Source;
        /// Weight of the mean displacement to the neighbours.
        cohesion alias "w_c": R = 0.03, "w_c", "1/length", NonNegative, Source;
        /// Weight of the difference between the neighbours' mean heading and the own.
        alignment alias "w_a": R = 0.05, "w_a", "1", NonNegative, Source;
        /// Weight of the mean displacement over squared distance.
        separation alias "w_s": R = 0.2, "w_s", "length", NonNegative, Source;
        /// Added to squared distances, so that separation stays finite.
        softening: R = 1e-4, "epsilon", "length^2", Positive, Source;
        /// Speed, the same for all.
        speed alias "v0": R = 0.05, "v0", "length/time", NonNegative, Source;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Source;
    }
}

impl<R: Scalar> Law<R> for BoidsUnitHeading<R> {
    const CARD: Card = Card {
        id: "boids_unit_heading",
        title: "Boids with unit headings (benchmark)",
        about: "Members of constant speed turn a little towards, along with and away from all within a radius.",
        reference: "Benchmark law of this project (workload W2), after C. W. Reynolds (1987). Flocks, herds and schools: a \
                    distributed behavioral model. Computer Graphics 21, 25-34. doi:10.1145/37402.37406",
        equations: "h_i' = unit(h_i + w_c mean_j d_ij + w_a (mean_j h_j - h_i) - w_s mean_j d_ij/(rho_ij^2 + epsilon))\n\
                    x_i' = x_i + v0 h_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "weighted means",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "none",
        edge: "alone: keeps its heading; zero resultant: the same; a coincident neighbour counts, with its heading only",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
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

impl<R: Scalar, const D: usize> Stream<R, D> for BoidsUnitHeading<R> {
    /// Weighted displacements (cohesion and separation), headings, number.
    type Sums<L: Lanes<R>> = ([L; D], [L; D], [L; 1]);

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius))]
    }
    fn reach(&self) -> R {
        self.radius
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(&self, _: &MeLanes<L, D>, _: &[L; D], _: L, _: &Other<'_, R, D>) -> SetMasks<L::Mask> {
        let [yes, no] = [true, false].map(L::Mask::all_of);
        [yes, no, no, no]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (displacement, headings, number): &mut Self::Sums<L>,
        _: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        let near = sets[0];
        // both terms lie along the displacement, so one sum holds them
        let weight = L::splat(self.cohesion) - L::splat(self.separation) / (squared + L::splat(self.softening));
        add_where(displacement, near, offset.map(|d| d * weight));
        add_where(headings, near, splat(other.heading));
        number[0] = number[0].add_where(near, L::splat(R::ONE));
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, D>,
        (displacement, headings, number): &Self::Sums<R>,
        _: &Draws<'_>,
    ) -> Motion<R, D> {
        let heading = me.heading();
        let mut wanted = heading;
        if number[0] > R::ZERO {
            let gather = Vector(*displacement) / number[0];
            let align = (Vector(*headings) / number[0] - heading) * self.alignment;
            let sum = heading + gather + align;
            me.note("own heading", heading);
            me.note("cohesion and separation", gather);
            me.note("alignment", align);
            me.sum(sum);
            wanted = sum.unit();
            if wanted.is_tiny() {
                wanted = heading;
            }
        }
        Motion::new_velocity(wanted * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn one_neighbour_by_hand() {
        let w = Oracle::new("boids_unit_heading").step(&[([0.0, 0.0], [0.05, 0.0]), ([0.5, 0.0], [0.0, 0.05])]);
        let towards = 0.03 * 0.5 - 0.2 * 0.5 / (0.25 + 1e-4);
        let (x, y) = (1.0 + towards - 0.05, 0.05f64);
        let length = (x * x + y * y).sqrt();
        close(w.velocity(0), [0.05 * x / length, 0.05 * y / length]);
        close(w.position(0), [0.05 * x / length, 0.05 * y / length]);
    }

    #[test]
    fn the_lone_keep_their_heading_and_the_coincident_only_align() {
        close(Oracle::new("boids_unit_heading").step(&[([1.0, 1.0], [0.0, 0.05])]).velocity(0), [0.0, 0.05]);
        let w = Oracle::new("boids_unit_heading").step(&[([1.0, 1.0], [0.05, 0.0]), ([1.0, 1.0], [0.0, 0.05])]);
        let length = (0.95f64 * 0.95 + 0.05 * 0.05).sqrt();
        close(w.velocity(0), [0.05 * 0.95 / length, 0.05 * 0.05 / length]);
    }
}
