//! Boids for group control: separation, alignment and cohesion of unit weight, a wandering heading, and walls that steer.
//!
//! The BOIDS model of the group-control experiments of B. T. Fine (2015), Constructing geometries for group control, after
//! C. W. Reynolds (1987) in the form of OpenSteer; the formulas and values are a reconstruction calibrated on its tables.

use crate::card::*;
use crate::models::families::control;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{Scalar, Value};
use crate::physics::Contact;
use crate::selection::{NamedSet, Perception};
use crate::sensing::cos_half;
use space::Vector;
use space::lanes::{Lanes, Mask};

/// Calibrated parameter sets, by name: `field-v1` (the defaults; field units, discrete iterations), `metre-v1` (metres and
/// seconds; bodies collide) and `field-mill` (cohesive and weakly aligned: a large group mills).
const PRESETS: &[Preset] = &[
    ("field-v1", &[]),
    (
        "metre-v1",
        &[
            ("radius", Value::Number(2.0)),
            ("separation_radius", Value::Number(0.6)),
            ("separation", Value::Number(1.0)),
            ("alignment", Value::Number(3.0)),
            ("wall_distance", Value::Number(0.6)),
            ("step_length", Value::Number(0.05)),
            ("time_step", Value::Number(0.2)),
            ("largest_turn", Value::Number(1.0)),
            ("wander_deviation", Value::Number(1.2)),
            ("body_radius", Value::Number(0.17)),
            ("bodies_collide", Value::Truth(true)),
        ],
    ),
    (
        "field-mill",
        &[
            ("radius", Value::Number(25.0)),
            ("alignment", Value::Number(0.5)),
            ("cohesion", Value::Number(2.0)),
            ("step_length", Value::Number(0.8)),
            ("wander_deviation", Value::Number(0.1)),
        ],
    ),
];

parameters! {
    /// Parameters of `control_boids`.
    pub struct ControlBoids {
        /// Interaction radius.
        radius alias "R": R = 22.0, "R", "length", Positive, Ours;
        /// Full field of view.
        field_of_view alias "fov_deg": R = 360.0, "alpha", "deg", Within(0.0, 360.0), Ours;
        /// Distance below which members separate.
        separation_radius alias "r_s": R = 8.0, "r_s", "length", NonNegative, Ours;
        /// Weight of separation.
        separation alias "w_s": R = 1.5, "w_s", "1", NonNegative, Ours;
        /// Weight of alignment.
        alignment alias "w_a": R = 1.0, "w_a", "1", NonNegative, Ours;
        /// Weight of cohesion.
        cohesion alias "w_c": R = 1.0, "w_c", "1", NonNegative, Ours;
        /// Weight of the own heading.
        heading_weight alias "w_h": R = 1.0, "w_h", "1", NonNegative, Ours;
        /// Weight of wall avoidance.
        wall_weight alias "w_o": R = 2.0, "w_o", "1", NonNegative, Ours;
        /// Distance below which walls and discs repel.
        wall_distance alias "d_w": R = 8.0, "d_w", "length", NonNegative, Ours;
        /// A wall counts only while the cosine between the way away from it and the heading is below this.
        leaving_cosine: R = 0.2, "-", "1", Within(-1.0, 1.000001), Ours;
        /// Distance moved in a step.
        step_length alias "v": R = 0.65, "v", "length", NonNegative, Ours;
        /// Largest turn in a step.
        largest_turn alias "turn_max": R = 0.5, "theta_max", "rad", NonNegative, Ours;
        /// Standard deviation of the heading's wander in a step.
        wander_deviation alias "eta": R = 0.2, "eta", "rad", NonNegative, Ours;
        /// Number seen at which alignment and cohesion have their full weight; 1 is the plain form.
        saturation alias "n_sat": R = 6.0, "n_sat", "1", Positive, Ours;
        /// Body radius.
        body_radius alias "rho": R = 0.5, "rho", "length", NonNegative, Ours;
        /// Whether bodies push each other apart (walls stop them in any case).
        bodies_collide: bool = false, "-", "-", Any, Ours;
        /// Length of a step in time.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for ControlBoids<R> {
    const CARD: Card = Card {
        id: "control_boids",
        title: "Boids for group control",
        about: "Boids of constant speed and limited turning that wander a little and steer clear of walls.",
        reference: "B. T. Fine (2015). Constructing geometries for group control, section 6.3.3 and Table 3.3; after \
                    C. W. Reynolds (1987). Computer Graphics 21, 25-34. doi:10.1145/37402.37406",
        equations: "s = -sum_{rho_ij < r_s} d_ij/rho_ij^2;  a = sum h_j;  c = sum d_ij;  f = min(1, n/n_sat)\n\
                    o = sum_{walls, d < d_w, u.h_i < 0.2} u (d_w - d)/d_w,  u from the wall to the member\n\
                    h' = rot(h_i, wander),  wander = eta N(0,1)\n\
                    D = w_h h' + w_s unit(s) + f (w_a unit(a) + w_c unit(c)) + w_o o\n\
                    h_i' = turn_toward(h_i, unit(D), theta_max);  x_i' = x_i + v h_i'",
        stages: Stages {
            sensing: "ideal within the radius; hidden behind walls and discs, unless the group's sensing says otherwise",
            detection: "ideal",
            selection: "neighbours = distance_based(0, R), R included, within angle(alpha); too_near = those of distance below r_s",
            motion: "weighted unit vectors",
            physics: "turn-limited, constant speed; slides along walls, pushed out to its radius",
            obstacles: "walls and discs nearer than d_w, unless the member is leaving them",
        },
        departures: "a reconstruction: the source names the model only; values were calibrated on its tables. The line of sight \
                     is the group's ideal sensing with occlusion, where a file says nothing else. Parameter sets: field-v1 (defaults), metre-v1, field-mill",
        edge: "nobody seen: wander and walls remain; zero D: keeps its heading; a coincident neighbour does not separate, but \
               counts and aligns",
        random: &[RandomQuantity { name: "wander", about: "angle, normal with SD eta; behaviour slots 0 and 1" }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, true, true],
            validation: "SP",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "bounded obstacles",
        },
    };
    fn blinded_by_obstacles() -> bool {
        true
    }
    fn presets() -> &'static [Preset] {
        PRESETS
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.step_length / self.time_step
    }
    fn obstacle_reach(&self) -> Option<R> {
        (self.wall_distance > R::ZERO).then_some(self.wall_distance)
    }
    fn body_radius(&self) -> R {
        self.body_radius
    }
    fn contact(&self) -> Contact {
        Contact::Slide
    }
    fn bodies_meet(&self) -> bool {
        self.bodies_collide
    }
}

impl<R: Scalar> Stream<R, 2> for ControlBoids<R> {
    /// Separation, alignment, cohesion, and how many are seen.
    type Sums<L: Lanes<R>> = ([L; 2], [L; 2], [L; 2], [L; 1]);

    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        let within = |radius: R| match radius > R::ZERO {
            true => Perception::distance(R::ZERO, radius.least(control::past(self.radius)))
                .both(Perception::angle(self.field_of_view.radians())),
            false => Perception::KNearest(0),
        };
        vec![
            NamedSet::new("neighbours", within(control::past(self.radius))),
            NamedSet::new("too_near", within(self.separation_radius)),
        ]
    }
    fn reach(&self) -> R {
        control::past(self.radius)
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(
        &self,
        me: &MeLanes<L, 2>,
        offset: &[L; 2],
        squared: L,
        _: &Other<'_, R, 2>,
    ) -> SetMasks<L::Mask> {
        let seen = in_view(&me.heading, offset, squared, cos_half(self.field_of_view.radians()));
        let near = squared.less(L::splat(self.separation_radius * self.separation_radius));
        let none = L::Mask::all_of(false);
        [seen, seen.and(near), none, none]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (separation, alignment, cohesion, number): &mut Self::Sums<L>,
        _: &MeLanes<L, 2>,
        offset: &[L; 2],
        squared: L,
        other: &Other<'_, R, 2>,
        sets: &SetMasks<L::Mask>,
    ) {
        let apart = L::splat(R::TINY * R::TINY).less(squared);
        add_where(separation, sets[1].and(apart), offset.map(|d| -d / squared));
        add_where(alignment, sets[0], splat(other.heading));
        add_where(cohesion, sets[0], *offset);
        number[0] = number[0].add_where(sets[0], L::splat(R::ONE));
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, 2>,
        (separation, alignment, cohesion, number): &Self::Sums<R>,
        draws: &Draws<'_>,
    ) -> Motion<R, 2> {
        let heading = me.heading();
        let walls = control::walls(me, self.wall_distance, self.leaving_cosine);
        let own = heading.turned_by(control::wander(self.wander_deviation, me, draws), R::ZERO);
        let social = (number[0] / self.saturation).least(R::ONE);
        let parts = [
            ("separation", Vector(*separation).unit() * self.separation),
            ("alignment", Vector(*alignment).unit() * (social * self.alignment)),
            ("cohesion", Vector(*cohesion).unit() * (social * self.cohesion)),
            ("walls", walls * self.wall_weight),
        ];
        let mut wanted = own * self.heading_weight;
        me.note("own heading", wanted);
        for (name, part) in parts {
            me.note(name, part);
            wanted += part;
        }
        me.sum(wanted);
        me.value("saturation of alignment and cohesion", social, "1");
        let turned = control::turn(me, wanted, self.largest_turn);
        let displacement = turned * self.step_length;
        Motion { velocity: displacement / self.time_step, displacement }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::models::oracle::{Oracle, close};
    use crate::parameters::Parameters;
    use space::shape::Shape;

    fn wall(x: f64) -> Shape<f64, 2> {
        Shape::new_segment(Vector([x, -20.0]), Vector([x, 20.0])).unwrap()
    }

    #[test]
    fn one_neighbour_has_a_sixth_of_the_social_weight() {
        // ahead to the left at distance 10: no separation
        let w = Oracle::new("control_boids").step(&[([0.0, 0.0], [0.65, 0.0]), ([6.0, 8.0], [0.0, 0.65])]);
        let wanted = Vector([1.0 + 0.6 / 6.0, (0.8 + 1.0) / 6.0]).unit();
        close(w.velocity(0), (wanted * 0.65).0);
        close(w.position(0), (wanted * 0.65).0);
        // nearer than 8 separation has its full weight at once, and the turn is limited
        let w = Oracle::new("control_boids").step(&[([0.0, 0.0], [0.65, 0.0]), ([0.0, 4.0], [0.65, 0.0])]);
        let angle = (-1.5f64 + 1.0 / 6.0).atan2(1.0 + 1.0 / 6.0);
        assert!(angle < -0.5);
        close(w.velocity(0), [0.65 * 0.5f64.cos(), -0.65 * 0.5f64.sin()]);
    }

    #[test]
    fn a_wall_ahead_turns_and_one_being_left_does_not() {
        let alone = [([0.0, 0.0], [0.65 * 0.8, 0.65 * 0.6])];
        let w = Oracle::new("control_boids").obstacle(wall(4.0)).step(&alone);
        let wanted = Vector([0.8 - 2.0 * 0.5, 0.6]).unit();
        let turn = wanted.angle() - 0.6f64.atan2(0.8);
        assert!(turn > 0.5, "limited");
        let angle = 0.6f64.atan2(0.8) + 0.5;
        close(w.velocity(0), [0.65 * angle.cos(), 0.65 * angle.sin()]);
        let w = Oracle::new("control_boids").obstacle(wall(-4.0)).step(&alone);
        close(w.velocity(0), alone[0].1);
    }

    #[test]
    fn supplied_wander_turns_the_lone_and_nobody_passes_a_wall() {
        let w = Oracle::new("control_boids").inject("wander", &[0.3]).step(&[([0.0, 0.0], [0.65, 0.0])]);
        close(w.velocity(0), [0.65 * 0.3f64.cos(), 0.65 * 0.3f64.sin()]);
        let mut w = Oracle::new("control_boids")
            .set("w_o", 0.0)
            .obstacle(wall(2.0))
            .world(&[([0.0, 0.0], [0.65, 0.0]), ([1.4, 1.0], [0.65, 0.0])]);
        for _ in 0..50 {
            w.step();
            assert!((0..2).all(|id| w.position(id)[0] <= 1.5 + 1e-9));
        }
    }

    #[test]
    fn the_presets_name_parameters_that_exist() {
        for (name, values) in PRESETS {
            let values = values.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
            assert!(ControlBoids::<f64>::from_values(&values).is_ok(), "{name}");
        }
    }

    #[test]
    fn bodies_push_each_other_apart_only_where_they_collide() {
        // both want to keep their heading, side by side at distance 0.6, twice the radius being 1
        for (collide, distance) in [(false, 0.6), (true, 1.0)] {
            let mut still = Oracle::new("control_boids").set("bodies_collide", collide).set("v", 0.0);
            still = still.set("w_s", 0.0).set("w_c", 0.0);
            let w = still.step(&[([0.0, 0.0], [0.65, 0.0]), ([0.0, 0.6], [0.65, 0.0])]);
            assert!((w.position(1)[1] - w.position(0)[1] - distance).abs() < 1e-9, "{collide}");
        }
    }
}
