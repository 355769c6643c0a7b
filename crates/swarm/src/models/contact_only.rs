//! Everyone goes straight on and learns of others and of walls by touch alone.
//!
//! A model of ours for a question that B. T. Fine (2015), Constructing geometries for group control, leaves open (3.6.1, 9.1.2):
//! whether collisions can be the input of a control-law.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::{Column, ColumnKind};

parameters! {
    /// Parameters of `contact_only`.
    pub struct ContactOnly {
        /// Radius of the body.
        body_radius: R = 0.5, "r", "length", Positive, Ours;
        /// Distance between two surfaces below which bodies touch.
        touch_distance: R = 0.1, "-", "length", Positive, Ours;
        /// Weight of the headings of those touched.
        alignment_weight alias "w_al": R = 1.0, "w_al", "1", NonNegative, Ours;
        /// Weight of the way out from those touched.
        repulsion_weight alias "w_rep": R = 0.5, "w_rep", "1", NonNegative, Ours;
        /// Largest turn, to either side, after a move that was stopped without a touch.
        largest_turn: R = core::f64::consts::PI, "-", "rad", NonNegative, Ours;
        /// Speed, the same for all.
        speed: R = 0.2, "v0", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for ContactOnly<R> {
    const CARD: Card = Card {
        id: "contact_only",
        title: "Contact alone",
        about: "Members go straight on, take the headings of those they touch, push off them, and turn at random where a wall stops \
                them.",
        reference: "This project; after the question whether collisions can be the input of a control-law in B. T. Fine (2015). \
                    Constructing geometries for group control, sections 3.6.1 and 9.1.2",
        equations: "touched = {rho_ij < 2 r + touch}\n\
                    anybody touched:  u = h_i + w_al sum h_j - w_rep sum e_ij\n\
                    else, where the last move was stopped:  u = h_i turned by bounce_i, uniform in [-turn, turn)\n\
                    else u = h_i;  h_i' = unit(u);  x_i' = x_i + v0 h_i' Dt, unless that ends in contact",
        stages: Stages {
            sensing: "touch: bodies no farther than touch from one's own, and whether one was stopped",
            detection: "ideal",
            selection: "touched = distance_based(0, 2 r + touch)",
            motion: "heading",
            physics: "ideal, constant speed; a move that would end in contact is not made",
            obstacles: "",
        },
        departures: "none: there is no publication",
        edge: "u = 0: heading kept; a coincident member has no direction; with bodies of radius 0 only members closer than touch \
               are felt",
        random: &[
            RandomQuantity { name: "bounce", about: "angle after a stop, uniform in [-turn, turn); behaviour slot 0" },
            RandomQuantity {
                name: "axis_angle",
                about: "3-D: place of the axis, uniform in [0, 2 pi); behaviour slot 2",
            },
        ],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::None,
            identification: false,
            uses: [true, false, true],
            validation: "S",
            synchronous: true,
            information: [Information::Local, Information::None, Information::Local],
            environment: "bounded obstacles",
        },
    };
    fn columns() -> &'static [Column] {
        &[Column {
            name: "collided",
            unit: "1",
            kind: ColumnKind::Count,
            about: "Whether the move of the step was refused.",
        }]
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn body_radius(&self) -> R {
        self.body_radius
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for ContactOnly<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        let touch = self.body_radius + self.body_radius + self.touch_distance;
        vec![NamedSet::new("touched", Perception::distance(R::ZERO, touch))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Motion<R, D> {
        let heading = me.heading();
        let (mut headings, mut away, mut touches) = (Vector::ZERO, Vector::ZERO, false);
        for k in seen.set(0) {
            headings += seen.heading(k);
            away -= seen.direction(k);
            touches = true;
        }
        let stopped = me.own[0] > R::ZERO;
        me.either(["touch", "bounce", "straight on"], if touches { 0 } else { 2 - usize::from(stopped) });
        let (headings, away) = (headings * self.alignment_weight, away * self.repulsion_weight);
        let mut wanted = heading + headings + away;
        me.note("own heading", heading);
        me.note("headings of those touched", headings);
        me.note("away from them", away);
        me.sum(wanted);
        if stopped && !touches {
            let most = self.largest_turn.to_f64();
            let bounce = draws.number("bounce", 0.0, |s| most * (2.0 * s.uniform(0) - 1.0));
            let axis =
                if D == 3 { draws.number("axis_angle", 0.0, |s| s.uniform(2) * R::TAU.to_f64()) } else { R::ZERO };
            me.value("bounce", bounce, "rad");
            wanted = heading.turned_by(bounce, axis);
        }
        Motion::new_velocity(wanted.unit_or(heading) * self.speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    use space::Space;

    #[test]
    fn those_touched_share_their_headings_and_push() {
        let pair = |y: f64| [([0.0, 0.0], [0.2, 0.0]), ([0.0, y], [0.0, -0.2])];
        // (1, 0) + (0, -1) - 0.5 (0, 1)
        let length = f64::hypot(1.0, 1.5);
        let w = Oracle::new("contact_only").step(&pair(1.05));
        close(w.velocity(0), [0.2 / length, -0.3 / length]);
        close(w.position(0), [0.2 / length, -0.3 / length]);
        // not felt at 1.1 and beyond
        close(Oracle::new("contact_only").step(&pair(1.1)).velocity(0), [0.2, 0.0]);
        let w = Oracle::new("contact_only").step(&[([0.0; 3], [0.0, 0.0, 0.2]), ([0.0, 1.05, 0.0], [0.0, 0.0, 0.2])]);
        let length = f64::hypot(2.0, 0.5);
        close(w.velocity(0), [0.0, -0.1 / length, 0.4 / length]);
    }

    #[test]
    fn a_wall_stops_and_the_next_step_bounces() {
        let mut w = Oracle::new("contact_only")
            .space(Space::walled([10.0, 10.0]))
            .inject("bounce", &[2.0])
            .world(&[([9.4, 5.0], [0.2, 0.0])]);
        w.step();
        close(w.position(0), [9.4, 5.0]);
        assert_eq!(w.state(0, "collided"), Some(1.0));
        w.step();
        close(w.position(0), [9.4 + 0.2 * 2f64.cos(), 5.0 + 0.2 * 2f64.sin()]);
        assert_eq!(w.state(0, "collided"), Some(0.0));
        w.step();
        close(w.position(0), [9.4 + 0.4 * 2f64.cos(), 5.0 + 0.4 * 2f64.sin()]);
    }
}
