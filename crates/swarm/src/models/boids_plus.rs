//! Boids of the OpenSteer program that also steer clear of walls and discs, and never pass them.
//!
//! B. T. Fine (2015), Constructing geometries for group control (its BOIDS), after C. W. Reynolds (1987), Flocks, herds, and
//! schools: a distributed behavioral model, Computer Graphics 21:25.

use crate::card::*;
use crate::models::families::environment::Environment;
use crate::models::reynolds_opensteer::ReynoldsOpensteer;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::NamedSet;

parameters! {
    /// Parameters of `boids_plus`.
    pub struct BoidsPlus {
        /// Radius of separation.
        separation_radius alias "sep_radius": R = 5.0, "r_s", "length", NonNegative, Paper;
        /// Cosine of the half-angle of separation's cone.
        separation_cosine alias "sep_cos": R = -0.707, "-", "1", Within(-1.0, 1.0), Paper;
        /// Weight of separation.
        separation_weight alias "w_sep": R = 12.0, "w1", "force", NonNegative, Paper;
        /// Radius of alignment.
        alignment_radius alias "ali_radius": R = 7.5, "r_al", "length", NonNegative, Paper;
        /// Cosine of the half-angle of alignment's cone.
        alignment_cosine alias "ali_cos": R = 0.7, "-", "1", Within(-1.0, 1.0), Paper;
        /// Weight of alignment.
        alignment_weight alias "w_ali": R = 8.0, "w2", "force", NonNegative, Paper;
        /// Radius of cohesion.
        cohesion_radius alias "coh_radius": R = 9.0, "r_co", "length", NonNegative, Paper;
        /// Cosine of the half-angle of cohesion's cone.
        cohesion_cosine alias "coh_cos": R = -0.15, "-", "1", Within(-1.0, 1.0), Paper;
        /// Weight of cohesion.
        cohesion_weight alias "w_coh": R = 8.0, "w3", "force", NonNegative, Paper;
        /// Distance below which others count in any direction: three body radii.
        minimum_distance alias "min_dist": R = 1.5, "-", "length", NonNegative, Paper;
        /// Cap of the force.
        maximum_force alias "max_force": R = 27.0, "F_max", "force", NonNegative, Paper;
        /// Cap of the speed.
        maximum_speed alias "max_speed": R = 9.0, "v_max", "length/time", NonNegative, Paper;
        /// Mass.
        mass alias "m": R = 1.0, "m", "mass", Positive, Paper;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
        /// Distance below which walls and discs are avoided.
        environment_range alias "r_env": R = 3.0, "r_env", "length", NonNegative, Ours;
        /// Weight of their avoidance.
        environment_weight alias "w_env": R = 2.0, "w_env", "1", NonNegative, Ours;
    }
}

impl<R: Scalar> BoidsPlus<R> {
    fn environment(&self) -> Environment<R> {
        Environment { range: self.environment_range, weight: self.environment_weight }
    }
    fn boids(&self) -> ReynoldsOpensteer<R> {
        ReynoldsOpensteer {
            separation_radius: self.separation_radius,
            separation_cosine: self.separation_cosine,
            separation_weight: self.separation_weight,
            alignment_radius: self.alignment_radius,
            alignment_cosine: self.alignment_cosine,
            alignment_weight: self.alignment_weight,
            cohesion_radius: self.cohesion_radius,
            cohesion_cosine: self.cohesion_cosine,
            cohesion_weight: self.cohesion_weight,
            minimum_distance: self.minimum_distance,
            maximum_force: self.maximum_force,
            maximum_speed: self.maximum_speed,
            mass: self.mass,
            time_step: self.time_step,
        }
    }
}

impl<R: Scalar> Law<R> for BoidsPlus<R> {
    const CARD: Card = Card {
        id: "boids_plus",
        title: "Reynolds 1987 with avoidance of the environment",
        about: "Members steer away from, along with and towards those they see, and away from walls and discs.",
        reference: "B. T. Fine (2015). Constructing geometries for group control; after C. W. Reynolds (1987). Flocks, herds, and \
                    schools: a distributed behavioral model. Computer Graphics 21, 25-34. doi:10.1145/37402.37406",
        equations: "F = w1 unit(mean_s -d_ij/rho_ij^2) + w2 unit(mean_a h_j - h_i) + w3 unit(mean_c d_ij)\n\
                    u = Dt clip(v_i + Dt clip(F, F_max)/m, v_max)\n\
                    a = sum over walls and discs with rho_o < r_env of (1 - max(rho_o, 0)/r_env) unit(x - q_o)\n\
                    u' = |u| unit(unit(u) + w_env a);  v_i' = u'/Dt;  x_i' = x_i + u' unless the way is blocked",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "separation, alignment, cohesion: distance_based(0, min_dist), or distance_based(0, radius) within the \
                        cone h_i . e_ij > cosine, with a radius and a cosine each",
            motion: "steering force",
            physics: "speed cap; a move into a wall or disc is not made",
            obstacles: "nearest point of every wall and disc nearer than r_env",
        },
        departures: "as reynolds_opensteer; the avoidance of the environment is ours, the source names it only",
        edge: "as reynolds_opensteer; intention and way out cancel: the heading is kept; blocked: the place is kept, the velocity \
               is as computed; a wall touched exactly adds nothing; inside a disc the way out has its full weight",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: false,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, true, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded obstacles",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.boids().initial_speed()
    }
    fn obstacle_reach(&self) -> Option<R> {
        self.environment().reach()
    }
}

impl<R: Scalar> Model<R, 2> for BoidsPlus<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        Stream::<R, 2>::sets(&self.boids())
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let free = Summed(self.boids()).decide(me, seen, draws);
        let [_, away, turned] = self.environment().turned(me, free.displacement);
        me.length("way out of the environment", away, "1");
        me.turn("turn by the environment", free.displacement, turned);
        Motion::new_velocity(turned / self.time_step, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Vector;
    use space::shape::Shape;

    fn wall() -> Shape<f64, 2> {
        Shape::Segment { from: Vector([-50.0, -1.0]), to: Vector([50.0, -1.0]) }
    }

    #[test]
    fn without_obstacles_it_is_the_program() {
        let w = Oracle::new("boids_plus").step(&[([0.0, 0.0], [5.0, 0.0]), ([2.0, 0.0], [5.0, 0.0])]);
        close(w.velocity(0), [4.8, 0.0]);
        close(w.position(0), [0.24, 0.0]);
        close(w.velocity(1), [5.0, 0.0]);
    }

    #[test]
    fn walls_turn_and_block() {
        // the wall is 1 away: a third nearer than 3 leaves 2/3, twice: unit((1, 0) + (0, 4/3)) = (0.6, 0.8)
        let w = Oracle::new("boids_plus").obstacle(wall()).step(&[([0.0, 0.0], [5.0, 0.0])]);
        close(w.velocity(0), [3.0, 4.0]);
        close(w.position(0), [0.15, 0.2]);
        // blocked: the place stays, the velocity is as computed
        let w = Oracle::new("boids_plus").set("w_env", 0.0).obstacle(wall()).step(&[([0.0, -0.9], [0.0, -5.0])]);
        close(w.position(0), [0.0, -0.9]);
        close(w.velocity(0), [0.0, -5.0]);
    }
}
