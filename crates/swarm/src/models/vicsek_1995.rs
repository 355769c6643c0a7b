//! Everyone takes the mean direction of those within a radius, itself included, and errs by a random angle.
//!
//! T. Vicsek, A. Czirok, E. Ben-Jacob, I. Cohen, O. Shochet (1995), Novel type of phase transition in a system of
//! self-driven particles, Physical Review Letters 75:1226, equations 1 and 2.

use crate::card::*;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use crate::{choice, parameters};
use space::Vector;
use space::lanes::{Lanes, Mask};
use space::random::normal;

choice! {
    /// Which velocity moves a member in the step.
    pub enum Update {
        /// The velocity before the step (as published).
        Old = "old_velocity",
        /// The velocity after it.
        New = "new_velocity",
    }
}

choice! {
    /// How the random angle is distributed.
    pub enum AngleNoise {
        /// Uniform in an interval whose width is the amplitude (as published).
        Uniform = "uniform",
        /// Normal, with the amplitude as its standard deviation.
        Normal = "normal",
    }
}

parameters! {
    /// Parameters of `vicsek_1995`.
    pub struct Vicsek1995 {
        /// Interaction radius.
        radius: R = 1.0, "r", "length", Positive, Paper;
        /// Speed, the same for all.
        speed: R = 0.03, "v", "length/time", NonNegative, Paper;
        /// Width of the interval from which the random angle is drawn.
        noise_amplitude alias "eta": R = 0.0, "eta", "rad", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Paper;
        /// Whether the velocity before or after the update moves the member.
        position_update: Update = "old_velocity", "-", "-", Any, Paper;
        /// Whether the random angle is uniform, or normal with the amplitude as its standard deviation.
        noise_distribution: AngleNoise = "uniform", "-", "-", Any, Paper;
    }
}

impl<R: Scalar> Law<R> for Vicsek1995<R> {
    const CARD: Card = Card {
        id: "vicsek_1995",
        title: "Vicsek et al. 1995",
        about: "Members of constant speed take the mean direction of all within a radius, themselves included, and err by a \
                random angle.",
        reference: "T. Vicsek, A. Czirok, E. Ben-Jacob, I. Cohen, O. Shochet (1995). Novel type of phase transition in a \
                    system of self-driven particles. Physical Review Letters 75, 1226. doi:10.1103/PhysRevLett.75.1226",
        equations: "H_i = h_i + sum_{j in I} h_j\n\
                    theta_i' = angle(H_i) + noise_i,  noise uniform in [-eta/2, eta/2)\n\
                    x_i' = x_i + v_i Dt  (old velocity);  v_i' = v h(theta_i')",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, radius)",
            motion: "mean heading with self, turned by noise",
            physics: "ideal, constant speed",
            obstacles: "",
        },
        departures: "the mean direction is the angle of the summed headings (atan2), which is right across the cut at pi; \
                     in three dimensions the heading turns by the noise about a random axis perpendicular to it",
        edge: "alone: keeps its heading, turned by the noise; zero resultant: the same",
        random: &[
            RandomQuantity {
                name: "noise",
                about: "angle, uniform in [-eta/2, eta/2); behaviour slot 0 (normal: SD eta, slots 0 and 2)",
            },
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

/// The law as published, with these parameters: for models that are this one for other neighbours or under another name.
pub(super) fn published<R: Scalar>(radius: R, speed: R, noise_amplitude: R, time_step: R) -> Vicsek1995<R> {
    Vicsek1995 {
        radius,
        speed,
        noise_amplitude,
        time_step,
        position_update: Update::Old,
        noise_distribution: AngleNoise::Uniform,
    }
}

impl<R: Scalar, const D: usize> Stream<R, D> for Vicsek1995<R> {
    type Sums<L: Lanes<R>> = [L; D];

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.radius))]
    }
    fn reach(&self) -> R {
        self.radius
    }
    fn draws_first(&self) -> bool {
        self.noise_amplitude > R::ZERO
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
    fn finish(&self, me: &mut Me<'_, R, D>, headings: &[R; D], draws: &Draws<'_>) -> Motion<R, D> {
        let own = me.heading();
        let sum = own + Vector(*headings);
        me.note("own heading", own);
        me.note("neighbours", Vector(*headings));
        me.sum(sum);
        let mut wanted = sum.unit_or(own);
        let eta = self.noise_amplitude.to_f64();
        if eta > 0.0 || draws.injected.is_some() {
            let noise = draws.number("noise", 0.0, |s| match self.noise_distribution {
                AngleNoise::Uniform => eta * (s.uniform(0) - 0.5),
                AngleNoise::Normal => eta * normal(s.uniform(0), s.uniform(2)),
            });
            let axis =
                if D == 3 { draws.number("axis_angle", 0.0, |s| s.uniform(1) * R::TAU.to_f64()) } else { R::ZERO };
            me.value("noise", noise, "rad");
            wanted = wanted.turned_by(noise, axis);
        }
        let velocity = wanted * self.speed;
        match self.position_update {
            Update::Old => Motion::old_velocity(me.velocity, velocity, self.time_step),
            Update::New => Motion::new_velocity(velocity, self.time_step),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn worked_example_of_the_catalogue() {
        let w = Oracle::new("vicsek_1995").step(&[
            ([0.0, 0.0], [0.03, 0.0]),
            ([0.5, 0.0], [0.0, 0.03]),
            ([3.0, 3.0], [-0.03, 0.0]),
        ]);
        close(w.velocity(0), [0.0212132, 0.0212132]);
        close(w.velocity(1), [0.0212132, 0.0212132]);
        close(w.velocity(2), [-0.03, 0.0]);
        close(w.position(0), [0.03, 0.0]);
        close(w.position(1), [0.5, 0.03]);
        close(w.position(2), [2.97, 3.0]);
    }

    #[test]
    fn supplied_noise_turns_a_lone_member_and_opposite_headings_keep_theirs() {
        let w = Oracle::new("vicsek_1995").set("eta", 0.5).inject("noise", &[0.2]).step(&[([0.0, 0.0], [0.03, 0.0])]);
        close(w.velocity(0), [0.03 * 0.2f64.cos(), 0.03 * 0.2f64.sin()]);
        let w = Oracle::new("vicsek_1995").step(&[([0.0, 0.0], [0.03, 0.0]), ([0.5, 0.0], [-0.03, 0.0])]);
        close(w.velocity(0), [0.03, 0.0]);
        close(w.velocity(1), [-0.03, 0.0]);
    }

    #[test]
    fn the_new_velocity_variant_moves_with_it() {
        let w = Oracle::new("vicsek_1995")
            .set("position_update", "new_velocity")
            .step(&[([0.0, 0.0], [0.03, 0.0]), ([0.5, 0.0], [0.0, 0.03])]);
        close(w.position(0), [0.0212132, 0.0212132]);
    }
}
