//! Random walkers for group control: a heading that errs every step, and walls that steer.
//!
//! The RM+ model of the group-control experiments of B. T. Fine (2015), Constructing geometries for group control; the formulas
//! and values are a reconstruction calibrated on its tables.

use crate::card::*;
use crate::models::families::angles::with_noise;
use crate::models::families::control;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::physics::Contact;
use crate::selection::{NamedSet, Perception};

parameters! {
    /// Parameters of `control_random`.
    pub struct ControlRandom {
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
        /// Standard deviation of the heading's error in a step.
        noise_deviation alias "sigma": R = 0.6, "sigma", "rad", NonNegative, Ours;
        /// Body radius.
        body_radius alias "rho": R = 0.5, "rho", "length", NonNegative, Ours;
        /// Whether bodies push each other apart (walls stop them in any case).
        bodies_collide: bool = false, "-", "-", Any, Ours;
        /// Length of a step in time.
        time_step alias "dt": R = 1.0, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for ControlRandom<R> {
    const CARD: Card = Card {
        id: "control_random",
        title: "Random motion for group control",
        about: "Members walk on with an error of their heading every step; walls turn them.",
        reference: "B. T. Fine (2015). Constructing geometries for group control, section 6.3.3 and Tables 3.3 and A.1; after \
                    S. V. Viscido, M. Miller, D. S. Wethey (2002). Journal of Theoretical Biology 217, 183-194. \
                    doi:10.1006/jtbi.2002.3025",
        equations: "o = sum_{walls, d < d_w, u.h_i < 0.2} u (d_w - d)/d_w,  u from the wall to the member\n\
                    D = h_i + w_o o;  h_i' = turn_toward(h_i, unit(D), theta_max) turned by noise = sigma N(0,1)\n\
                    x_i' = x_i + v h_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "none",
            motion: "weighted unit vectors",
            physics: "turn-limited; slides along walls, pushed out to its radius",
            obstacles: "walls and discs nearer than d_w, unless the member is leaving them",
        },
        departures: "a reconstruction: the source names the model only; values were calibrated on its tables. The error follows the \
                     turn, and may be larger than it",
        edge: "zero D: keeps its heading, turned by the noise",
        random: &[RandomQuantity { name: "noise", about: "angle, normal with SD sigma; behaviour slots 0 and 1" }],
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

impl<R: Scalar> Model<R, 2> for ControlRandom<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("nobody", Perception::KNearest(0))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, _: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let heading = me.heading();
        let walls = control::walls(me, self.wall_distance, self.leaving_cosine) * self.wall_weight;
        me.note("own heading", heading);
        me.note("walls", walls);
        me.sum(heading + walls);
        let turned = control::turn(me, heading + walls, self.largest_turn);
        let step = with_noise(turned, self.noise_deviation, me, draws) * self.step_length;
        Motion { velocity: step / self.time_step, displacement: step }
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
    fn supplied_noise_turns_beyond_the_limit() {
        let w = Oracle::new("control_random").inject("noise", &[0.9]).step(&[([0.0, 0.0], [1.0, 0.0])]);
        close(w.position(0), [0.9f64.cos(), 0.9f64.sin()]);
        // neighbours do not matter
        let w = Oracle::new("control_random").step(&[([0.0, 0.0], [1.0, 0.0]), ([1.0, 1.0], [0.0, 1.0])]);
        close(w.position(0), [1.0, 0.0]);
    }

    #[test]
    fn walls_turn_and_stop() {
        let alone = [([0.0, 0.0], [0.8, 0.6])];
        let w = Oracle::new("control_random").obstacle(wall(4.0)).inject("noise", &[0.1]).step(&alone);
        let angle = 0.6f64.atan2(0.8) + 0.6;
        close(w.position(0), [angle.cos(), angle.sin()]);
        close(Oracle::new("control_random").obstacle(wall(-4.0)).step(&alone).position(0), [0.8, 0.6]);
        let mut w = Oracle::new("control_random").live().obstacle(wall(2.0)).world(&alone);
        for _ in 0..200 {
            w.step();
            assert!(w.position(0)[0] <= 1.5 + 1e-9);
        }
    }
}
