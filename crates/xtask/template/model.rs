//! Everyone takes the mean heading of the others within a radius. (REPLACE ME: one plain sentence.)
//!
//! REPLACE ME: authors (year), title, journal, and the numbers of the equations used below.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::lanes::{Lanes, Mask};

parameters! {
    /// Parameters of `new_model_name`.
    pub struct NewModelName {
        /// Interaction radius.
        radius alias "r": R = 1.0, "r", "length", Positive, Ours;
        /// Speed, the same for all.
        speed alias "v": R = 1.0, "v", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for NewModelName<R> {
    const CARD: Card = Card {
        id: "new_model_name",
        title: "REPLACE ME: a few words",
        about: "REPLACE ME: members of constant speed take the mean heading of the others within a radius.",
        reference: "REPLACE ME: authors (year). Title. Journal volume, pages. doi",
        equations: "H_i = sum_{j in I} h_j\n\
                    v_i' = v unit(H_i), or v h_i where H_i = 0;  x_i' = x_i + v_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "mean heading of the neighbours",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "REPLACE ME: how this differs from the publication, or \"none\"",
        edge: "alone, or zero resultant: keeps its heading",
        random: &[],
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
            environment: "REPLACE ME: the environment of the publication",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
}

impl<R: Scalar, const D: usize> Stream<R, D> for NewModelName<R> {
    /// Sum of the neighbours' headings.
    type Sums<L: Lanes<R>> = [L; D];

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
        headings: &mut [L; D],
        _: &MeLanes<L, D>,
        _: &[L; D],
        _: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        add_where(headings, sets[0], splat(other.heading));
    }
    #[inline(always)]
    fn finish(&self, me: &mut Me<'_, R, D>, headings: &[R; D], _: &Draws<'_>) -> Motion<R, D> {
        me.note("neighbours", Vector(*headings));
        me.sum(Vector(*headings));
        let wanted = Vector(*headings).unit_or(me.heading());
        Motion::new_velocity(wanted * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn takes_the_mean_heading_of_those_within_the_radius() {
        let w = Oracle::new("new_model_name").step(&[
            ([0.0, 0.0], [1.0, 0.0]),
            ([0.5, 0.0], [0.0, 1.0]),
            ([0.0, 0.5], [0.0, 1.0]),
        ]);
        close(w.velocity(0), [0.0, 1.0]);
        close(w.position(0), [0.0, 0.1]);
    }

    #[test]
    fn keeps_its_heading_where_nobody_is_near_or_headings_cancel() {
        let w = Oracle::new("new_model_name").step(&[
            ([0.0, 0.0], [1.0, 0.0]),
            ([0.5, 0.0], [0.0, 1.0]),
            ([0.0, 0.5], [0.0, -1.0]),
            ([9.0, 0.0], [0.0, 1.0]),
        ]);
        close(w.velocity(0), [1.0, 0.0]);
        close(w.velocity(3), [0.0, 1.0]);
    }
}
