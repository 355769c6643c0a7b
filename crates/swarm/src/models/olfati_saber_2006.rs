//! A lattice of given spacing, agreement on velocity, obstacles as virtual members, and a common target.
//!
//! R. Olfati-Saber (2006), Flocking for multi-agent dynamic systems: algorithms and theory, IEEE Transactions on Automatic
//! Control 51:401 (algorithms 1 to 3 by the choice of gains).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `olfati_saber_2006`.
    pub struct OlfatiSaber2006 {
        /// Desired distance between neighbours.
        spacing alias "d": R = 7.0, "d", "length", Positive, Paper;
        /// Radius within which others are neighbours.
        interaction_radius alias "r": R = 8.4, "r", "length", Positive, Paper;
        /// Constant of the sigma-norm.
        norm_constant alias "eps": R = 0.1, "epsilon", "1/length^2", Positive, Paper;
        /// Largest attraction between two members.
        attraction_limit alias "a": R = 5.0, "a", "1", Positive, Paper;
        /// Largest repulsion between two members.
        repulsion_limit alias "b": R = 5.0, "b", "1", Positive, Paper;
        /// Share of the range (in the sigma-norm) up to which neighbours count fully.
        neighbour_plateau alias "h_alpha": R = 0.2, "h_alpha", "1", Within(0.0, 1.0), Paper;
        /// Gain of the pair force.
        neighbour_position_gain alias "c1_alpha": R = 1.0, "c1_alpha", "length/time^2", NonNegative, Ours;
        /// Gain of the agreement on velocity.
        neighbour_velocity_gain alias "c2_alpha": R = 1.0, "c2_alpha", "1/time", NonNegative, Ours;
        /// Desired distance to obstacles.
        obstacle_spacing alias "d_beta": R = 4.2, "d'", "length", Positive, Paper;
        /// Distance within which obstacles matter.
        obstacle_range alias "r_beta": R = 5.04, "r'", "length", NonNegative, Paper;
        /// Share of the desired distance (in the sigma-norm) up to which obstacles count fully.
        obstacle_plateau alias "h_beta": R = 0.9, "h_beta", "1", Within(0.0, 1.0), Paper;
        /// Gain of the repulsion by obstacles.
        obstacle_position_gain alias "c1_beta": R = 1.0, "c1_beta", "length/time^2", NonNegative, Ours;
        /// Gain of the agreement with the velocity along an obstacle.
        obstacle_velocity_gain alias "c2_beta": R = 1.0, "c2_beta", "1/time", NonNegative, Ours;
        /// Gain of the way to the target.
        target_position_gain alias "c1_gamma": R = 0.0, "c1_gamma", "1/time^2", NonNegative, Ours;
        /// Gain of the agreement with the target's velocity.
        target_velocity_gain alias "c2_gamma": R = 0.0, "c2_gamma", "1/time", NonNegative, Ours;
        /// Place of the target, or one for each member; none where empty.
        target_position alias "target_pos": Points<R> = [0.0; 0], "q_r", "length", Any, Ours;
        /// Velocity of the target, or one for each member; none where empty.
        target_velocity alias "target_vel": Points<R> = [0.0; 0], "p_r", "length/time", Any, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.02, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for OlfatiSaber2006<R> {
    const CARD: Card = Card {
        id: "olfati_saber_2006",
        title: "Olfati-Saber 2006",
        about: "Members keep a spacing to their neighbours and agree with them on a velocity, keep away from obstacles, and may \
                pursue a target.",
        reference: "R. Olfati-Saber (2006). Flocking for multi-agent dynamic systems: algorithms and theory. IEEE \
                    Transactions on Automatic Control 51, 401-420. doi:10.1109/TAC.2005.864190",
        equations: "|z|_s = (sqrt(1 + epsilon z^2) - 1)/epsilon;  n_ij = d_ij/sqrt(1 + epsilon rho_ij^2);  \
                    s1(z) = z/sqrt(1 + z^2)\n\
                    bump(z, h) = 1 for z < h, (1 + cos(pi (z - h)/(1 - h)))/2 up to z = 1, 0 beyond\n\
                    phi(z) = ((a + b) s1(z + c) + a - b)/2,  c = |a - b|/sqrt(4 a b);  w = bump(|rho_ij|_s/|r|_s, h_alpha)\n\
                    u = sum_{j in I} [c1_alpha w phi(|rho_ij|_s - |d|_s) n_ij + c2_alpha w (v_j - v_i)] + u_beta + u_gamma\n\
                    u_beta = sum over nearest points q of obstacles, moving with p, wb = bump(|q - x_i|_s/|d'|_s, h_beta):\n\
                    c1_beta wb (s1(|q - x_i|_s - |d'|_s) - 1) (q - x_i)/sqrt(1 + epsilon |q - x_i|^2) + \
                    c2_beta wb (p - v_i)\n\
                    p = v_i - (n.v_i) n, n the normal;  for a ball of radius R that times R/(R + distance)\n\
                    u_gamma = -c1_gamma (x_i - q_r) - c2_gamma (v_i - p_r)\n\
                    v_i' = v_i + u Dt;  x_i' = x_i + v_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, r)",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "nearest point of every obstacle and wall within r', as a virtual member",
        },
        departures: "the source's table drops the desired distance from phi and writes an acceleration as a velocity; obstacles \
                     are taken from the paper; besides its balls and planes every shape is an obstacle, flat at its nearest point; \
                     the target stands still",
        edge: "no neighbour: no such term; at a ball's centre that ball is left out; inside a solid the formula holds unchanged",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, false, true],
            validation: "MS",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded obstacles",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn obstacle_reach(&self) -> Option<R> {
        Some(self.obstacle_range)
    }
    fn check(&self, members: usize) -> Result<(), String> {
        self.target_position.check("target_position", members)?;
        self.target_velocity.check("target_velocity", members)
    }
}

impl<R: Scalar> OlfatiSaber2006<R> {
    /// `sqrt(1 + epsilon z^2)`, given `z^2`.
    fn stretch(&self, squared: R) -> R {
        (R::ONE + self.norm_constant * squared).root()
    }
    /// The sigma-norm of a length whose stretch is given.
    fn norm(&self, stretch: R) -> R {
        (stretch - R::ONE) / self.norm_constant
    }
    /// The sigma-norm of a length.
    fn norm_of(&self, length: R) -> R {
        self.norm(self.stretch(length * length))
    }
    /// Attraction (positive) or repulsion between members by their excess distance in the sigma-norm.
    fn pair_force(&self, excess: R) -> R {
        let (a, b) = (self.attraction_limit, self.repulsion_limit);
        let shift = (a - b).abs() / (R::of(4.0) * a * b).root();
        ((a + b) * sigmoid(excess + shift) + (a - b)) * R::HALF
    }
}

/// `z/sqrt(1 + z^2)`.
fn sigmoid<R: Scalar>(z: R) -> R {
    z / (R::ONE + z * z).root()
}

/// From 1 up to `plateau` smoothly to 0 at 1.
fn bump<R: Scalar>(z: R, plateau: R) -> R {
    if z < plateau {
        R::ONE
    } else if z > R::ONE {
        R::ZERO
    } else if plateau < R::ONE {
        (R::ONE + (R::PI * (z - plateau) / (R::ONE - plateau)).cos()) * R::HALF
    } else {
        R::ONE
    }
}

impl<R: Scalar, const D: usize> Model<R, D> for OlfatiSaber2006<R> {
    fn sets(&self) -> Vec<NamedSet<R, D>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.interaction_radius))]
    }
    fn decide(&self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, _: &Draws<'_>) -> Motion<R, D> {
        let velocity = me.velocity;
        let (range, spacing) = (self.norm_of(self.interaction_radius), self.norm_of(self.spacing));
        let mut lattice = Vector::ZERO;
        let mut consensus = Vector::ZERO;
        for k in seen.set(0) {
            let stretch = self.stretch(seen.squared[k]);
            let length = self.norm(stretch);
            let weight = bump(length / range, self.neighbour_plateau);
            lattice += seen.offset(k) * (weight * self.pair_force(length - spacing) / stretch);
            consensus += (seen.velocity(k) - velocity) * weight;
        }
        let lattice = lattice * self.neighbour_position_gain;
        let consensus = consensus * self.neighbour_velocity_gain;

        let spacing = self.norm_of(self.obstacle_spacing);
        let mut avoidance = Vector::ZERO;
        for near in me.around.obstacles {
            let squared = near.offset.length_squared();
            let mut along = velocity - near.away * near.away.dot(velocity);
            if near.radius.finite() {
                let from_centre = near.radius + near.distance;
                if from_centre <= R::TINY {
                    continue;
                }
                along = along * (near.radius / from_centre);
            }
            if squared >= self.obstacle_range * self.obstacle_range {
                continue;
            }
            let stretch = self.stretch(squared);
            let length = self.norm(stretch);
            let weight = bump(length / spacing, self.obstacle_plateau);
            let push = (sigmoid(length - spacing) - R::ONE) / stretch;
            avoidance += near.offset * (self.obstacle_position_gain * weight * push)
                + (along - velocity) * (self.obstacle_velocity_gain * weight);
        }

        let mut pursuit = Vector::ZERO;
        if let Some(place) = self.target_position.of(me.member()) {
            pursuit += me.around.space.offset(me.position, place) * self.target_position_gain;
        }
        if let Some(wanted) = self.target_velocity.of(me.member()) {
            pursuit += (wanted - velocity) * self.target_velocity_gain;
        }
        me.unit("length/time^2");
        me.note("lattice", lattice);
        me.note("consensus", consensus);
        me.note("obstacles", avoidance);
        me.note("target", pursuit);
        let acceleration = lattice + consensus + avoidance + pursuit;
        me.sum(acceleration);
        Motion::new_velocity(velocity + acceleration * self.time_step, self.time_step)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Vector;
    use space::shape::Shape;

    #[test]
    fn at_the_desired_spacing_there_is_no_force_and_nearer_there_is_repulsion() {
        let pair = |distance: f64| {
            Oracle::new("olfati_saber_2006").step(&[([0.0, 0.0], [1.0, 0.0]), ([0.0, distance], [1.0, 0.0])])
        };
        close(pair(7.0).velocity(0), [1.0, 0.0]);
        close(pair(7.0).position(1), [1.0 * 0.02, 7.0]);
        close(pair(9.0).velocity(0), [1.0, 0.0]);
        // |1|_s = 10 (sqrt(1.1) - 1) lies on the plateau: weight 1
        let norm = |z: f64| 10.0 * ((1.0 + 0.1 * z * z).sqrt() - 1.0);
        let excess = norm(1.0) - norm(7.0);
        let push = 5.0 * excess / (1.0 + excess * excess).sqrt() / 1.1f64.sqrt();
        close(pair(1.0).velocity(0), [1.0, 0.02 * push]);
        close(pair(1.0).velocity(1), [1.0, -0.02 * push]);
        assert!(push < -4.0);
    }

    #[test]
    fn a_plane_takes_away_the_speed_towards_it_and_a_ball_slows_along_itself() {
        // from the brink of a plane, where the virtual member is at the same place
        let floor = Shape::new_plane(Vector([0.0, 0.0]), Vector([0.0, 2.0])).unwrap();
        let w = Oracle::new("olfati_saber_2006").obstacle(floor).step(&[([0.0, 0.0], [3.0, 1.0])]);
        close(w.velocity(0), [3.0, 1.0 - 0.02]);
        // at 2 from a ball of radius 2: p is half the speed, and the push is 2 (s1 - 1)/sqrt(1.4) along x
        let ball = Shape::new_ball(Vector([4.0, 0.0]), 2.0).unwrap();
        let w = Oracle::new("olfati_saber_2006").obstacle(ball).step(&[([0.0, 0.0], [0.0, 1.0])]);
        close(w.velocity(0), [-0.066_898_9, 1.0 - 0.02 * 0.5]);
    }

    #[test]
    fn a_target_of_place_or_velocity_alone() {
        let lone = [([1.0, 2.0], [1.0, 0.0])];
        let model = || Oracle::new("olfati_saber_2006").set("c1_gamma", 2.0).set("c2_gamma", 3.0);
        close(model().set("target_pos", [5.0, 2.0]).step(&lone).velocity(0), [1.0 + 0.02 * 8.0, 0.0]);
        close(model().set("target_vel", [1.0, 1.0]).step(&lone).velocity(0), [1.0, 0.02 * 3.0]);
        close(model().step(&lone).velocity(0), [1.0, 0.0]);
    }
}
