//! Repulsion before all, then alignment and attraction by distance, with a blind angle behind and a limited turning rate.
//!
//! I. D. Couzin, J. Krause, R. James, G. D. Ruxton, N. R. Franks (2002), Collective memory and spatial sorting in animal
//! groups, Journal of Theoretical Biology 218:1, equations 1 to 3.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use crate::sensing::cos_half;
use space::Vector;
use space::lanes::{Lanes, Mask};

parameters! {
    /// Parameters of `couzin_2002`.
    pub struct Couzin2002 {
        /// Radius of the zone of repulsion.
        repulsion_radius alias "r_r": R = 1.0, "r_r", "length", NonNegative, Paper;
        /// Outer radius of the zone of orientation.
        orientation_radius alias "r_o": R = 6.0, "r_o", "length", NonNegative, Ours;
        /// Outer radius of the zone of attraction.
        attraction_radius alias "r_a": R = 14.0, "r_a", "length", Positive, Ours;
        /// Full field of view; the rest is the blind angle behind.
        field_of_view alias "fov_deg": R = 270.0, "alpha", "deg", Within(0.0, 360.0), Paper;
        /// Speed, the same for all.
        speed: R = 3.0, "s", "length/time", NonNegative, Paper;
        /// Largest turning rate.
        turning_rate alias "turn_deg": R = 40.0, "theta", "deg/time", NonNegative, Paper;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "time", Positive, Paper;
        /// Standard deviation of the error of the wanted direction.
        noise_deviation alias "sigma": R = 0.0, "sigma", "rad", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for Couzin2002<R> {
    const CARD: Card = Card {
        id: "couzin_2002",
        title: "Couzin et al. 2002",
        about: "Members swim away from those too near, else with those at middle distance and towards those farther away.",
        reference: "I. D. Couzin, J. Krause, R. James, G. D. Ruxton, N. R. Franks (2002). Collective memory and spatial \
                    sorting in animal groups. Journal of Theoretical Biology 218, 1-11. doi:10.1006/jtbi.2002.3065",
        equations: "repulsion non-empty:  u = unit(-sum e_ij)\n\
                    else both zones filled:  u = unit((sum_o h_j + sum_a e_ij)/2);  one filled: unit of that sum\n\
                    u = 0 or nobody seen:  u = h_i\n\
                    u turned by noise_i (Gaussian, SD sigma);  h_i' = turn_toward(h_i, u, theta Dt);  x_i' = x_i + s h_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "repulsion = distance_based(0, r_r); orientation = distance_based(r_r, r_o) within angle(alpha); \
                        attraction = distance_based(r_o, r_a) within angle(alpha)",
            motion: "desired direction by priority",
            physics: "turn-limited, constant speed",
            obstacles: "",
        },
        departures: "the orientation sum leaves the member itself out (the paper is open); the two raw sums are averaged, \
                     as in the paper",
        edge: "a coincident repeller has no direction, so the heading is kept; repulsion counts in the blind angle too",
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
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.repulsion_radius > self.orientation_radius || self.orientation_radius > self.attraction_radius {
            return Err("the radii must not decrease from repulsion over orientation to attraction".into());
        }
        Ok(())
    }
}

impl<R: Scalar, const D: usize> Stream<R, D> for Couzin2002<R> {
    /// Repulsion, orientation, attraction; and how many are in each.
    type Sums<L: Lanes<R>> = ([L; D], [L; D], [L; D], [L; 3]);

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        let view = Perception::angle(self.field_of_view.radians());
        vec![
            NamedSet::new("repulsion", Perception::ring(R::ZERO, self.repulsion_radius)),
            NamedSet::new(
                "orientation",
                Perception::ring(self.repulsion_radius, self.orientation_radius).both(view.clone()),
            ),
            NamedSet::new("attraction", Perception::ring(self.orientation_radius, self.attraction_radius).both(view)),
        ]
    }
    fn reach(&self) -> R {
        self.attraction_radius
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(
        &self,
        me: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        _: &Other<'_, R, D>,
    ) -> SetMasks<L::Mask> {
        let limit = |radius: R| L::splat(radius * radius);
        let seen = in_view(&me.heading, offset, squared, cos_half(self.field_of_view.radians()));
        let near = squared.less(limit(self.repulsion_radius));
        let middle = squared.less(limit(self.orientation_radius));
        [near, middle.and(near.not()).and(seen), middle.not().and(near.not()).and(seen), L::Mask::all_of(false)]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (repulsion, orientation, attraction, counts): &mut Self::Sums<L>,
        _: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        let towards = directions(offset, squared);
        add_where(repulsion, sets[0], towards);
        add_where(orientation, sets[1], splat(other.heading));
        add_where(attraction, sets[2], towards);
        for s in 0..3 {
            counts[s] = counts[s].add_where(sets[s], L::splat(R::ONE));
        }
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, D>,
        (repulsion, orientation, attraction, counts): &Self::Sums<R>,
        draws: &Draws<'_>,
    ) -> Motion<R, D> {
        let heading = me.heading();
        let (orientation, attraction) = (Vector(*orientation), Vector(*attraction));
        me.note("repulsion", -Vector(*repulsion));
        me.note("orientation", orientation);
        me.note("attraction", attraction);
        let filled = counts.map(|count| count > R::ZERO);
        me.either(
            ["repulsion", "orientation and attraction", "orientation", "attraction", "none"],
            match filled {
                [true, ..] => 0,
                [_, true, true] => 1,
                [_, true, _] => 2,
                [_, _, true] => 3,
                _ => 4,
            },
        );
        me.acts(if filled[0] { &[0] } else { &[1, 2] });
        let mut wanted = if counts[0] > R::ZERO {
            -Vector(*repulsion)
        } else if counts[1] > R::ZERO && counts[2] > R::ZERO {
            (orientation + attraction) * R::HALF
        } else {
            orientation + attraction
        }
        .unit();
        if wanted.is_tiny() {
            wanted = heading;
        }
        let sigma = self.noise_deviation.to_f64();
        if sigma > 0.0 || draws.injected.is_some() {
            let noise = draws.number("noise", 0.0, |s| sigma * s.normal(0));
            let axis =
                if D == 3 { draws.number("axis_angle", 0.0, |s| s.uniform(2) * R::TAU.to_f64()) } else { R::ZERO };
            me.value("noise", noise, "rad");
            wanted = wanted.turned_by(noise, axis);
        }
        let limit = self.turning_rate.radians() * self.time_step;
        me.turn("turn asked for", heading, wanted);
        me.value("turn allowed", limit, "rad");
        let turned = heading.turned_toward(wanted, limit);
        Motion::new_velocity(turned * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn worked_example_of_the_catalogue() {
        let w = Oracle::new("couzin_2002").step(&[([0.0, 0.0], [3.0, 0.0]), ([4.0, 0.0], [0.0, 3.0])]);
        close(w.velocity(0), [2.992692, 0.209269]);
        close(w.position(0), [0.299269, 0.020927]);
        close(w.velocity(1), [0.209269, 2.992692]);
        close(w.position(1), [4.020927, 0.299269]);
    }

    #[test]
    fn repulsion_has_priority_even_from_behind() {
        // member 1 is right behind member 0, inside its zone of repulsion: 0 keeps on straight away from it
        let w = Oracle::new("couzin_2002").step(&[([0.0, 0.0], [3.0, 0.0]), ([-0.5, 0.0], [3.0, 0.0])]);
        close(w.velocity(0), [3.0, 0.0]);
        // and member 1, which has 0 ahead, turns by its limit of 4 degrees to the left (exactly opposite)
        let limit = 4f64.to_radians();
        close(w.velocity(1), [3.0 * limit.cos(), 3.0 * limit.sin()]);
    }

    #[test]
    fn the_blind_angle_hides_attraction() {
        let behind = [([0.0, 0.0], [3.0, 0.0]), ([-10.0, 1.0], [0.0, 3.0])];
        close(Oracle::new("couzin_2002").step(&behind).velocity(0), [3.0, 0.0]);
        assert!(Oracle::new("couzin_2002").set("fov_deg", 360.0).step(&behind).velocity(0)[1] > 0.1);
    }
}
