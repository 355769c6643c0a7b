//! Robots in formation: to the goal, to the own place beside the centre, away from obstacles and other robots, and a little at random.
//!
//! T. Balch, R. C. Arkin (1998/1999), Behavior-based formation control for multirobot teams, IEEE Transactions on Robotics and
//! Automation 14:926 (reference to the centre).

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `arkin_balch_1999`.
    pub struct ArkinBalch1999 {
        /// Goal, or one for each robot; none where empty.
        goal: Points<R> = [100.0, 0.0], "g", "m", Any, Ours;
        /// Gain of the way to the goal.
        goal_gain alias "g_goal": R = 0.8, "-", "1", NonNegative, Paper;
        /// Gain of the way to the own place.
        formation_gain alias "g_form": R = 1.0, "-", "1", NonNegative, Paper;
        /// Gain of avoiding obstacles.
        obstacle_gain alias "g_obs": R = 1.5, "-", "1", NonNegative, Paper;
        /// Gain of avoiding robots.
        robot_gain alias "g_rob": R = 2.0, "-", "1", NonNegative, Paper;
        /// Gain of noise.
        noise_gain alias "g_noise": R = 0.1, "-", "1", NonNegative, Paper;
        /// Places beside the centre, forward and left, one for each robot; no formation where empty.
        offsets: Vec<Vec<R>> = [0.0; 0], "-", "m", Any, Ours;
        /// Distance from the own place below which it does not draw.
        dead_zone alias "dead": R = 0.0, "-", "m", NonNegative, Paper;
        /// Distance from the own place from which it draws fully.
        controlled_zone alias "control": R = 25.0, "-", "m", Positive, Paper;
        /// Distance to an obstacle's rim beyond which it is ignored.
        obstacle_sphere alias "obs_sphere": R = 50.0, "S", "m", Positive, Paper;
        /// Distance to an obstacle's rim up to which avoidance is greatest.
        obstacle_minimum alias "obs_min": R = 5.0, "M", "m", NonNegative, Paper;
        /// Distance to a robot beyond which it is ignored.
        robot_sphere alias "rob_sphere": R = 20.0, "S", "m", Positive, Paper;
        /// Distance to a robot up to which avoidance is greatest.
        robot_minimum alias "rob_min": R = 5.0, "M", "m", NonNegative, Paper;
        /// The greatest avoidance.
        cap: R = 10.0, "-", "1", NonNegative, Ours;
        /// Cap of the speed.
        maximum_speed alias "max_speed": R = 1.0, "v_max", "m/s", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "s", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for ArkinBalch1999<R> {
    const CARD: Card = Card {
        id: "arkin_balch_1999",
        title: "Balch and Arkin 1998/1999, formation",
        about: "Robots keep their places beside the centre of all on the way to a goal, and avoid obstacles and each other.",
        reference: "T. Balch, R. C. Arkin (1998; in the source's tables Arkin and Balch 1999). Behavior-based formation control for \
                    multirobot teams. IEEE Transactions on Robotics and Automation 14, 926-939. doi:10.1109/70.736776",
        equations: "V = g_goal unit(goal - x_i) + g_form mag unit(slot - x_i) + sum g_obs ramp(rho_o) unit(away)\n\
                    + sum g_rob ramp(rho_ij) (-e_ij) + g_noise noise_vec\n\
                    slot = centroid + offset turned to the direction from centroid to goal\n\
                    mag = 0 below dead, (q - dead)/(control - dead), 1 from control on,  q = |slot - x_i|\n\
                    ramp = 0 for rho > S;  cap for rho <= M;  (S - rho)/(S - M) between\n\
                    v_i' = v_max clip(V, 1);  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "robots = all",
            motion: "velocity",
            physics: "ideal, speed-limited",
            obstacles: "obstacles within obs_sphere of their rim",
        },
        departures: "places beside a leader or a neighbour are options of the paper left out; cap stands for its infinity",
        edge: "coincident robots have no direction; no offsets: no formation; the centroid at the goal, or no goal: the offsets \
               stay as they are; inside an obstacle the way out has the greatest weight",
        random: &[RandomQuantity {
            name: "noise_vec",
            about: "unit vector, uniform over directions, scaled by g_noise in the law; behaviour slot 0",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: false,
            avoidance: Avoidance::All,
            identification: true,
            uses: [true, false, false],
            validation: "SP",
            synchronous: false,
            information: [Information::Global, Information::None, Information::None],
            environment: "unbounded obstacles",
        },
    };
    fn needs(&self) -> Needs {
        Needs { identity: true, ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn obstacle_reach(&self) -> Option<R> {
        // up to the sphere itself
        Some(self.obstacle_sphere * R::of(1.000_001))
    }
    fn initial_speed(&self) -> R {
        self.maximum_speed
    }
    fn check(&self, members: usize) -> Result<(), String> {
        self.goal.check("goal", members)?;
        if !self.offsets.is_empty() && self.offsets.len() != members {
            return Err(format!("`offsets` needs one for each of {members} members, found {}", self.offsets.len()));
        }
        if self.offsets.iter().any(|offset| offset.len() != 2) {
            return Err("`offsets` needs [forward, left] for each".into());
        }
        if self.obstacle_minimum >= self.obstacle_sphere || self.robot_minimum >= self.robot_sphere {
            return Err("a minimum must be less than its sphere".into());
        }
        if self.dead_zone >= self.controlled_zone {
            return Err("the dead zone must be smaller than the controlled zone".into());
        }
        Ok(())
    }
}

/// Avoidance by distance: nothing beyond the sphere, `cap` up to the minimum.
fn ramp<R: Scalar>(distance: R, sphere: R, minimum: R, cap: R) -> R {
    if distance > sphere {
        R::ZERO
    } else if distance <= minimum {
        cap
    } else {
        (sphere - distance) / (sphere - minimum)
    }
}

impl<R: Scalar> ArkinBalch1999<R> {
    /// From me to my place in the formation, given the way to the goal and to the centroid.
    fn to_slot(&self, member: usize, goal: Vector<R, 2>, centroid: Vector<R, 2>) -> Option<Vector<R, 2>> {
        let [forward, left] = self.offsets.get(member)?.first_chunk().copied()?;
        let along = (goal - centroid).unit_or(Vector::axis(0));
        Some(centroid + along * forward + along.left() * left)
    }
}

impl<R: Scalar> Model<R, 2> for ArkinBalch1999<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("robots", Perception::All)]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let (mut centroid, mut count, mut robots) = (Vector::ZERO, R::ONE, Vector::ZERO);
        for k in seen.set(0) {
            centroid += seen.offset(k);
            count += R::ONE;
            robots -= seen.direction(k) * ramp(seen.distance(k), self.robot_sphere, self.robot_minimum, self.cap);
        }
        let centroid = centroid / count;
        let mut obstacles = Vector::ZERO;
        for near in me.around.obstacles {
            obstacles += near.away * ramp(near.distance, self.obstacle_sphere, self.obstacle_minimum, self.cap);
        }
        let space = me.around.space;
        let goal = self.goal.of(me.member()).map(|goal| space.offset(me.position, goal));
        let slot = self.to_slot(me.member(), goal.unwrap_or(centroid), centroid).unwrap_or(Vector::ZERO);
        let far = (slot.length() - self.dead_zone) / (self.controlled_zone - self.dead_zone);
        let noise = if self.noise_gain > R::ZERO { draws.vector("noise_vec", |s| s.unit(0)) } else { Vector::ZERO };
        let mut wanted = Vector::ZERO;
        for (name, part) in [
            ("goal", goal.map_or(Vector::ZERO, Vector::unit) * self.goal_gain),
            ("formation", slot.unit() * (far.clamped(R::ZERO, R::ONE) * self.formation_gain)),
            ("obstacles", obstacles * self.obstacle_gain),
            ("robots", robots * self.robot_gain),
            ("noise", noise * self.noise_gain),
        ] {
            me.note(name, part);
            wanted += part;
        }
        me.sum(wanted);
        Motion::new_velocity(wanted.clip(R::ONE) * self.maximum_speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    use crate::parameters::Value;
    use space::Vector;
    use space::shape::Shape;

    const REST: [f64; 2] = [0.0, 0.0];

    #[test]
    fn to_the_goal_and_away_from_robots() {
        let w = Oracle::new("arkin_balch_1999").set("goal", [0.0, 50.0]).step(&[([0.0, 0.0], REST)]);
        close(w.velocity(0), [0.0, 0.8]);
        close(w.position(0), [0.0, 0.8]);
        // at 17: 3/15 of the gain 2, away; at 5 and nearer the cap, clipped to 1; beyond 20 nothing
        let first = |x: f64| {
            Oracle::new("arkin_balch_1999")
                .set("goal", [0.0, 50.0])
                .step(&[([0.0, 0.0], REST), ([x, 0.0], REST)])
                .velocity(0)
        };
        close(first(17.0), [-0.4, 0.8]);
        close(first(5.0), [-20.0 / 400.64f64.sqrt(), 0.8 / 400.64f64.sqrt()]);
        close(first(20.1), [0.0, 0.8]);
        close(first(0.0), [0.0, 0.8]);
    }

    #[test]
    fn places_beside_the_centre_turn_to_the_goal() {
        // the centre is (0, 20), the goal above it: forward is up, left is to the left
        let offsets = Value::List(vec![[-10.0, 0.0].into(), [10.0, 5.0].into()]);
        let model = || {
            Oracle::new("arkin_balch_1999").set("g_rob", 0.0).set("goal", [0.0, 100.0]).set("offsets", offsets.clone())
        };
        let w = model().step(&[([0.0, 0.0], REST), ([0.0, 40.0], REST)]);
        // 0 is at 10 below its place: mag 0.4; 1 is at (5, 10) from its own: sqrt(125)/25
        close(w.velocity(0), Vector([0.0, 0.8 + 0.4]).clip(1.0).0);
        close(w.velocity(1), Vector([-5.0 / 25.0, 0.8 - 10.0 / 25.0]).clip(1.0).0);
        // within the dead zone nothing, and far away at most 1
        let w = model().set("dead", 10.0).step(&[([0.0, 0.0], REST), ([0.0, 40.0], REST)]);
        close(w.velocity(0), [0.0, 0.8]);
        let w = model().set("g_goal", 0.0).set("control", 2.0).step(&[([0.0, 0.0], REST), ([0.0, 40.0], REST)]);
        close(w.velocity(0), [0.0, 1.0]);
    }

    #[test]
    fn obstacles_by_their_rims_and_supplied_noise() {
        let disc = |x: f64| Shape::Ball { centre: Vector([x, 0.0]), radius: 2.0 };
        let model = || Oracle::new("arkin_balch_1999").set("goal", Value::List(Vec::new()));
        // the rim at 41: (50 - 41)/45 of 1.5
        close(model().obstacle(disc(43.0)).step(&[([0.0, 0.0], REST)]).velocity(0), [-0.3, 0.0]);
        close(model().obstacle(disc(53.0)).step(&[([0.0, 0.0], REST)]).velocity(0), [0.0, 0.0]);
        close(model().obstacle(disc(6.9)).step(&[([0.0, 0.0], REST)]).velocity(0), [-1.0, 0.0]);
        let w = model().inject_vectors("noise_vec", &[[0.0, 3.0]]).step(&[([0.0, 0.0], REST)]);
        close(w.velocity(0), [0.0, 0.3]);
    }
}
