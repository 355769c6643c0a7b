//! Everyone steps in a direction drawn anew each time, away from walls and discs.
//!
//! B. T. Fine, D. A. Shell (2013), Eliciting collective behaviors through automatically generated environments; avoidance of the
//! environment is ours, the source names it only.

use crate::card::*;
use crate::models::families::environment::Environment;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `rm_plus`.
    pub struct RmPlus {
        /// Distance moved per update.
        step_length alias "step": R = 1.0, "l", "body length", NonNegative, Ours;
        /// Distance below which walls and discs are avoided.
        environment_range alias "r_env": R = 3.0, "r_env", "length", NonNegative, Ours;
        /// Weight of their avoidance.
        environment_weight alias "w_env": R = 2.0, "w_env", "1", NonNegative, Ours;
    }
}

impl<R: Scalar> RmPlus<R> {
    fn environment(&self) -> Environment<R> {
        Environment { range: self.environment_range, weight: self.environment_weight }
    }
}

impl<R: Scalar> Law<R> for RmPlus<R> {
    const CARD: Card = Card {
        id: "rm_plus",
        title: "Fine and Shell 2013, random motion with avoidance",
        about: "Members step in random directions, turned away from walls and discs.",
        reference: "B. T. Fine, D. A. Shell (2013). Eliciting collective behaviors through automatically generated environments; \
                    after S. V. Viscido, M. Miller, D. S. Wethey (2002). Journal of Theoretical Biology 217, 183-194. \
                    doi:10.1006/jtbi.2002.3025",
        equations: "u = l (cos angle_i, sin angle_i)\n\
                    a = sum over walls and discs with rho_o < r_env of (1 - max(rho_o, 0)/r_env) unit(x - q_o)\n\
                    u' = |u| unit(unit(u) + w_env a);  x_i' = x_i + u' unless the way is blocked",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "none",
            motion: "target point",
            physics: "ideal; a move into a wall or disc is not made",
            obstacles: "nearest point of every wall and disc nearer than r_env",
        },
        departures: "the source has no formula: direction, avoidance and its values are ours",
        edge: "intention and way out cancel: the heading is kept; a wall touched exactly adds nothing; inside a disc the way \
               out has its full weight",
        random: &[RandomQuantity { name: "angle", about: "direction, uniform in [-pi, pi); behaviour slot 0" }],
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
    fn velocity_is_step(&self) -> bool {
        true
    }
    fn obstacle_reach(&self) -> Option<R> {
        self.environment().reach()
    }
}

impl<R: Scalar> Model<R, 2> for RmPlus<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("nobody", Perception::KNearest(0))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, _: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let turn = core::f64::consts::TAU;
        let angle: R = draws.number("angle", 0.0, |s| turn * (s.uniform(0) - 0.5));
        me.value("angle", angle, "rad");
        Motion::step(self.environment().steer(me, Vector::at_angle(angle) * self.step_length))
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Vector;
    use space::shape::Shape;

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn supplied_angles_are_the_directions() {
        let w = Oracle::new("rm_plus").set("step", 2.0).inject("angle", &[0.5, -2.0]).step(&[([0.0, 0.0], REST); 2]);
        close(w.position(0), [2.0 * 0.5f64.cos(), 2.0 * 0.5f64.sin()]);
        close(w.velocity(1), [2.0 * 2f64.cos(), -2.0 * 2f64.sin()]);
    }

    #[test]
    fn walls_and_discs_turn_and_stop() {
        // the disc's rim is 1.5 away: half of the range, a = (-1/2, 0), so unit((1, 0) + 2 a) is 0 and the heading is kept
        let disc = || Shape::Ball { centre: Vector([2.5, 0.0]), radius: 1.0 };
        let go = |angle: f64, velocity| {
            Oracle::new("rm_plus").obstacle(disc()).inject("angle", &[angle]).step(&[([0.0, 0.0], velocity)])
        };
        close(go(0.0, [0.0, 3.0]).position(0), [0.0, 1.0]);
        close(go(0.0, REST).position(0), [0.0, 0.0]);
        let quarter = core::f64::consts::FRAC_PI_2;
        close(go(quarter, REST).position(0), [-(0.5f64.sqrt()), 0.5f64.sqrt()]);
        // inside it has its full weight, and the rim may be left
        let w = Oracle::new("rm_plus").obstacle(disc()).inject("angle", &[quarter]).step(&[([2.0, 0.0], REST)]);
        close(w.position(0), [2.0 - 2.0 / 5f64.sqrt(), 1.0 / 5f64.sqrt()]);
        // without avoidance the way is blocked: nothing moves
        let w = Oracle::new("rm_plus").set("w_env", 0.0).set("step", 2.0).obstacle(disc()).step(&[([0.0, 0.0], REST)]);
        close(w.position(0), [0.0, 0.0]);
        close(w.velocity(0), [0.0, 0.0]);
    }
}
