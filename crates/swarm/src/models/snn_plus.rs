//! Everyone steps towards its nearest neighbour until that is near enough, away from walls and discs.
//!
//! B. T. Fine, D. A. Shell (2013), Eliciting collective behaviors through automatically generated environments; avoidance of the
//! environment is ours, the source names it only.

use crate::card::*;
use crate::models::families::environment::Environment;
use crate::models::families::nearest_neighbour::NearestNeighbour;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `snn_plus`.
    pub struct SnnPlus {
        /// Distance moved per update.
        step_length alias "step": R = 1.0, "l", "body length", NonNegative, Ours;
        /// Distance at which the neighbour is near enough.
        repulsion_distance alias "r_rep": R = 2.0, "r_rho", "length", NonNegative, Ours;
        /// Distance below which others are perceived.
        range: R = 25.0, "beta", "length", Positive, Ours;
        /// Distance below which walls and discs are avoided.
        environment_range alias "r_env": R = 3.0, "r_env", "length", NonNegative, Ours;
        /// Weight of their avoidance.
        environment_weight alias "w_env": R = 2.0, "w_env", "1", NonNegative, Ours;
    }
}

impl<R: Scalar> SnnPlus<R> {
    fn environment(&self) -> Environment<R> {
        Environment { range: self.environment_range, weight: self.environment_weight }
    }
}

impl<R: Scalar> Law<R> for SnnPlus<R> {
    const CARD: Card = Card {
        id: "snn_plus",
        title: "Fine and Shell 2013, simple nearest neighbour with avoidance",
        about: "Members step towards their nearest neighbour in range until it is near, turned away from walls and discs.",
        reference: "B. T. Fine, D. A. Shell (2013). Eliciting collective behaviors through automatically generated environments; \
                    after S. V. Viscido, M. Miller, D. S. Wethey (2002). Journal of Theoretical Biology 217, 183-194. \
                    doi:10.1006/jtbi.2002.3025",
        equations: "k = nearest(I);  u = l e_ik if rho_ik > r_rho, else 0\n\
                    a = sum over walls and discs with rho_o < r_env of (1 - max(rho_o, 0)/r_env) unit(x - q_o)\n\
                    u' = |u| unit(unit(u) + w_env a);  x_i' = x_i + u' unless the way is blocked",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range), of these the nearest",
            motion: "target point",
            physics: "ideal; a move into a wall or disc is not made",
            obstacles: "nearest point of every wall and disc nearer than r_env",
        },
        departures: "the source has no formula: avoidance and its values are ours; the range of 25 is the fragmentation \
                     threshold of the group-control experiments",
        edge: "nobody in range, or the nearest coincident or near: stays, also beside a wall; intention and way out cancel: the \
               heading is kept; a wall touched exactly adds nothing; inside a disc the way out has its full weight",
        random: &[],
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

impl<R: Scalar> Variant<R> for SnnPlus<R> {
    type Shared = NearestNeighbour<R>;
    fn shared(&self) -> Self::Shared {
        NearestNeighbour {
            range: Some(self.range),
            step_length: self.step_length,
            repulsion_distance: self.repulsion_distance,
            environment: Some(self.environment()),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Vector;
    use space::shape::Shape;

    const REST: [f64; 2] = [0.0, 0.0];

    fn wall() -> Shape<f64, 2> {
        Shape::Segment { from: Vector([-9.0, -1.0]), to: Vector([9.0, -1.0]) }
    }

    #[test]
    fn away_from_a_wall_on_the_way_to_the_nearest() {
        // the wall is 1 below: a = (0, 2/3), and the step goes along (1, 4/3)
        let w = Oracle::new("snn_plus").obstacle(wall()).step(&[([0.0, 0.0], REST), ([4.0, 0.0], REST)]);
        close(w.position(0), [0.6, 0.8]);
        // without a wall in range the plain step, and none within the repulsion distance
        close(Oracle::new("snn_plus").step(&[([0.0, 0.0], REST), ([4.0, 0.0], REST)]).position(0), [1.0, 0.0]);
        let w = Oracle::new("snn_plus").obstacle(wall()).step(&[([0.0, 0.0], REST), ([2.0, 0.0], REST)]);
        close(w.position(0), [0.0, 0.0]);
    }

    #[test]
    fn nobody_crosses_a_wall_and_who_is_blocked_has_made_no_step() {
        let mut w = Oracle::new("snn_plus")
            .set("w_env", 0.0)
            .obstacle(wall())
            .world(&[([0.0, -0.4], REST), ([0.0, -9.0], REST)]);
        w.step();
        close(w.position(0), [0.0, -0.4]);
        close(w.velocity(0), [0.0, 0.0]);
        for _ in 0..30 {
            w.step();
            assert!(w.position(0)[1] > -1.0 && w.position(1)[1] < -1.0);
        }
    }
}
