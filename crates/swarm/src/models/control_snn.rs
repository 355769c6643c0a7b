//! Members of the selfish herd for group control: towards the nearest until it is near, with walls that steer.
//!
//! The SNN+ model of the group-control experiments of B. T. Fine (2015), Constructing geometries for group control; the formulas
//! and values are a reconstruction calibrated on its tables.

use crate::card::*;
use crate::models::families::control;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::physics::Contact;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `control_snn`.
    pub struct ControlSnn {
        /// Interaction radius.
        radius alias "R": R = 7.0, "R", "length", Positive, Ours;
        /// Full field of view.
        field_of_view alias "fov_deg": R = 360.0, "alpha", "deg", Within(0.0, 360.0), Ours;
        /// Distance at which the neighbour is near enough.
        repulsion_distance alias "r_rep": R = 2.0, "r_rho", "length", NonNegative, Ours;
        /// Weight of wall avoidance.
        wall_weight alias "w_o": R = 2.0, "w_o", "1", NonNegative, Ours;
        /// Distance below which walls and discs repel.
        wall_distance alias "d_w": R = 8.0, "d_w", "length", NonNegative, Ours;
        /// A wall counts only while the cosine between the way away from it and the heading is below this.
        leaving_cosine: R = 0.2, "-", "1", Within(-1.0, 1.000001), Ours;
        /// Distance moved in a step.
        step_length alias "v": R = 1.0, "v", "length", NonNegative, Ours;
        /// Largest turn in a step.
        largest_turn alias "turn_max": R = 0.5, "theta_max", "rad", NonNegative, Ours;
        /// Standard deviation of the wander of who sees nobody, in a step.
        wander_deviation alias "eta": R = 0.1, "eta", "rad", NonNegative, Ours;
        /// Body radius.
        body_radius alias "rho": R = 0.5, "rho", "length", NonNegative, Ours;
        /// Whether bodies push each other apart (walls stop them in any case).
        bodies_collide: bool = false, "-", "-", Any, Ours;
        /// Length of a step in time.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for ControlSnn<R> {
    const CARD: Card = Card {
        id: "control_snn",
        title: "Simple nearest neighbour for group control",
        about: "Members turn to their nearest neighbour and step on until it is near; walls turn them, and who sees nobody wanders.",
        reference: "B. T. Fine (2015). Constructing geometries for group control, section 6.3.3 and Tables 3.3 and A.1; after \
                    S. V. Viscido, M. Miller, D. S. Wethey (2002). Journal of Theoretical Biology 217, 183-194. \
                    doi:10.1006/jtbi.2002.3025",
        equations: "o = sum_{walls, d < d_w, u.h_i < 0.2} u (d_w - d)/d_w,  u from the wall to the member\n\
                    k = nearest(I);  rho_ik > r_rho:  D = e_ik + w_o o\n\
                    rho_ik <= r_rho:  D = h_i + w_o o, and no step;  nobody:  D = rot(h_i, wander) + w_o o,  wander = eta N(0,1)\n\
                    h_i' = turn_toward(h_i, unit(D), theta_max);  x_i' = x_i + v h_i'",
        stages: Stages {
            sensing: "ideal within the radius; hidden behind walls and discs, unless the group's sensing says otherwise",
            detection: "ideal",
            selection: "neighbours = distance_based(0, R), R included, within angle(alpha), of these the nearest",
            motion: "weighted unit vectors",
            physics: "turn-limited; slides along walls, pushed out to its radius",
            obstacles: "walls and discs nearer than d_w, unless the member is leaving them",
        },
        departures: "a reconstruction: the source names the model only; values were calibrated on its tables. The line of sight is the group's \
                     ideal sensing with occlusion, where a file says nothing else. Who is near enough keeps its velocity, as the bearer of its heading, and does \
                     not move",
        edge: "the nearest coincident: near; zero D: keeps its heading; nobody seen: on, with wander and walls",
        random: &[RandomQuantity {
            name: "wander",
            about: "angle where nobody is seen, normal with SD eta; behaviour slots 0 and 1",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Environment,
            identification: false,
            uses: [true, false, false],
            validation: "SP",
            synchronous: true,
            information: [Information::Global, Information::None, Information::None],
            environment: "bounded obstacles",
        },
    };
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn blinded_by_obstacles() -> bool {
        true
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

impl<R: Scalar> Model<R, 2> for ControlSnn<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        let view = Perception::angle(self.field_of_view.radians());
        let seen = Perception::distance(R::ZERO, control::past(self.radius)).both(view);
        vec![NamedSet::new("neighbours", Perception::Sequence(vec![seen, Perception::Nearest]))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let heading = me.heading();
        let (case, aim) = match seen.nearest(0) {
            Some(k) if seen.distance(k) > self.repulsion_distance => (0, seen.direction(k)),
            Some(_) => (1, heading),
            None => (2, heading.turned_by(control::wander(self.wander_deviation, me, draws), R::ZERO)),
        };
        let walls = control::walls(me, self.wall_distance, self.leaving_cosine) * self.wall_weight;
        me.either(["approach", "stay", "wander"], case);
        me.note("aim", aim);
        me.note("walls", walls);
        me.sum(aim + walls);
        let step = control::turn(me, aim + walls, self.largest_turn) * self.step_length;
        let displacement = if case == 1 { Vector::ZERO } else { step };
        Motion { velocity: step / self.time_step, displacement }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Vector;
    use space::shape::Shape;

    fn wall(x: f64) -> Shape<f64, 2> {
        Shape::Segment { from: Vector([x, -20.0]), to: Vector([x, 20.0]) }
    }

    #[test]
    fn towards_the_nearest_until_it_is_near() {
        let first = |place: [f64; 2]| Oracle::new("control_snn").step(&[([0.0, 0.0], [1.0, 0.0]), (place, [1.0, 0.0])]);
        // within half a radian at once, else by half a radian
        let (sin, cos) = 0.3f64.sin_cos();
        close(first([5.0 * cos, 5.0 * sin]).position(0), [cos, sin]);
        close(first([0.0, 5.0]).position(0), [0.5f64.cos(), 0.5f64.sin()]);
        // near enough: it stays, and keeps its heading
        close(first([2.0, 0.0]).position(0), [0.0, 0.0]);
        close(first([2.0, 0.0]).velocity(0), [1.0, 0.0]);
        // at the edge of sight, and out of it: on
        close(first([0.0, 7.0]).position(0), [0.5f64.cos(), 0.5f64.sin()]);
        close(first([0.0, 7.0 + 1e-9]).position(0), [1.0, 0.0]);
        let w = Oracle::new("control_snn").inject("wander", &[0.2]).step(&[([0.0, 0.0], [1.0, 0.0])]);
        close(w.position(0), [0.2f64.cos(), 0.2f64.sin()]);
    }

    #[test]
    fn walls_turn_who_stays_too_and_nobody_passes_one() {
        // 4 from the wall: o = (-1/2, 0), so D = (0.8, 0.6) + 2 o points up and back
        let agents = [([0.0, 0.0], [0.8, 0.6]), ([0.0, 1.0], [0.8, 0.6])];
        let w = Oracle::new("control_snn").obstacle(wall(4.0)).step(&agents);
        let angle = 0.6f64.atan2(0.8) + 0.5;
        close(w.velocity(0), [angle.cos(), angle.sin()]);
        close(w.position(0), [0.0, 0.0]);
        // one that is being left does not turn
        close(Oracle::new("control_snn").obstacle(wall(-4.0)).step(&agents).velocity(0), [0.8, 0.6]);
        let mut w = Oracle::new("control_snn").set("w_o", 0.0).obstacle(wall(2.0)).world(&[([0.0, 0.0], [1.0, 0.0])]);
        for _ in 0..20 {
            w.step();
            assert!(w.position(0)[0] <= 1.5 + 1e-9);
        }
    }
}
