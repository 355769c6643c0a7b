//! Fish flee the near, ignore those in between, and approach the far.
//!
//! J. H. Tien, S. A. Levin, D. I. Rubenstein (2004), Dynamics of fish shoals: identifying key decision rules, Evolutionary Ecology
//! Research 6:555.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `tien_2004`.
    pub struct Tien2004 {
        /// Distance below which others repel.
        repulsion_radius alias "r_r": R = 1.0, "r_r", "length", NonNegative, Ours;
        /// Distance below which others are ignored.
        neutral_radius alias "r_n": R = 2.5, "r_n", "length", NonNegative, Ours;
        /// Distance below which others attract.
        attraction_radius alias "r_a": R = 6.0, "r_a", "length", Positive, Ours;
        /// Full field of view.
        field_of_view alias "fov_deg": R = 300.0, "alpha", "deg", Within(0.0, 360.0), Ours;
        /// Speed, the same for all.
        speed: R = 1.0, "v0", "length/time", NonNegative, Ours;
        /// Largest turning rate.
        turning_rate alias "turn_deg": R = 90.0, "theta", "deg/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.2, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Tien2004<R> {
    const CARD: Card = Card {
        id: "tien_2004",
        title: "Tien et al. 2004",
        about: "Fish turn away from those near, else towards those far, and ignore those in between.",
        reference: "J. H. Tien, S. A. Levin, D. I. Rubenstein (2004). Dynamics of fish shoals: identifying key decision rules. \
                    Evolutionary Ecology Research 6, 555-565",
        equations: "u = unit(-sum_repulsion e_ij) if anybody is there, else unit(sum_attraction e_ij)\n\
                    h_i' = turn_toward(h_i, u, theta Dt);  x_i' = x_i + v0 h_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "repulsion = distance_based(0, r_r), neutral = distance_based(r_r, r_n), attraction = \
                        distance_based(r_n, r_a), each within angle(alpha)",
            motion: "heading",
            physics: "turn-limited, constant speed",
            obstacles: "",
        },
        departures: "an interpretation; the sizes of the zones are ours",
        edge: "nobody but neutral members: straight on; only coincident repellers: the heading is kept, attraction ignored",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, false],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "unbounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn check(&self, _: usize) -> Result<(), String> {
        if self.repulsion_radius > self.neutral_radius || self.neutral_radius > self.attraction_radius {
            return Err("the radii must not decrease from repulsion over neutral to attraction".into());
        }
        Ok(())
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for Tien2004<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        let view = Perception::angle(self.field_of_view.radians());
        let zone = |name, low, high| NamedSet::new(name, Perception::ring(low, high).both(view.clone()));
        vec![
            zone("repulsion", R::ZERO, self.repulsion_radius),
            zone("neutral", self.repulsion_radius, self.neutral_radius),
            zone("attraction", self.neutral_radius, self.attraction_radius),
        ]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let (mut away, mut towards, mut repels) = (Vector::ZERO, Vector::ZERO, false);
        for k in 0..seen.len() {
            if seen.is_in(k, 0) {
                away -= seen.direction(k);
                repels = true;
            } else if seen.is_in(k, 2) {
                towards += seen.direction(k);
            }
        }
        me.note("repulsion", away);
        me.note("attraction", towards);
        me.either(["repulsion", "attraction"], usize::from(!repels));
        me.acts(&[if repels { 0 } else { 2 }]);
        let (heading, limit) = (me.heading(), self.turning_rate.radians() * self.time_step);
        let wanted = if repels { away } else { towards }.unit();
        me.turn("turn asked for", heading, wanted);
        me.value("turn allowed", limit, "rad");
        Motion::new_velocity(heading.turned_toward(wanted, limit) * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    /// The turn, in degrees, of a member that heads along x, with others at these places.
    #[track_caller]
    fn expect(oracle: Oracle<2>, others: &[[f64; 2]], degrees: f64) {
        let mut agents = vec![([0.0, 0.0], [1.0, 0.0])];
        agents.extend(others.iter().map(|&place| (place, [1.0, 0.0])));
        let w = oracle.step(&agents);
        let going = [degrees.to_radians().cos(), degrees.to_radians().sin()];
        close(w.velocity(0), going);
        close(w.position(0), going.map(|v| 0.2 * v));
    }

    fn free() -> Oracle<2> {
        Oracle::new("tien_2004").set("turn_deg", 900.0)
    }

    #[test]
    fn zones_in_their_order() {
        expect(free(), &[[0.0, 0.5], [0.0, 4.0]], -90.0);
        expect(free(), &[[0.0, 4.0]], 90.0);
        expect(free(), &[[0.0, 4.0], [4.0, 0.0], [0.0, 2.0]], 45.0);
        // a neighbour in the neutral ring, one out of reach, one behind
        expect(free(), &[[0.0, 1.0], [0.0, 6.0], [-4.0, 0.1]], 0.0);
        expect(Oracle::new("tien_2004"), &[[0.0, 4.0]], 18.0);
    }

    #[test]
    fn coincident_repellers_keep_the_heading_and_space_has_three_dimensions() {
        expect(free(), &[[0.0, 0.0], [0.0, 4.0]], 0.0);
        expect(free(), &[], 0.0);
        let w = Oracle::new("tien_2004")
            .set("turn_deg", 900.0)
            .step(&[([0.0; 3], [1.0, 0.0, 0.0]), ([0.0, 0.0, 4.0], [1.0, 0.0, 0.0])]);
        close(w.velocity(0), [0.0, 0.0, 1.0]);
    }
}
