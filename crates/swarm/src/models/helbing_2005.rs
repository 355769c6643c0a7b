//! Pedestrians want a speed in a direction and are pushed away by others and by walls.
//!
//! D. Helbing, L. Buzna, A. Johansson, T. Werner (2005), Self-organized pedestrian crowd dynamics: experiments, simulations,
//! and design solutions, Transportation Science 39:1; social force after D. Helbing, P. Molnar (1995), Physical Review E
//! 51:4282.

use crate::card::*;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{PerAgent, Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `helbing_2005`.
    pub struct Helbing2005 {
        /// Desired speed, or one for each member.
        desired_speed alias "v0": PerAgent<R> = 1.34, "v0_i", "length/time", NonNegative, Paper;
        /// Where to go, or one place for each member; straight on where empty.
        target: Points<R> = [0.0; 0], "x_*", "length", Any, Ours;
        /// Time in which the desired velocity is approached.
        relaxation_time alias "tau": R = 0.5, "tau", "time", Positive, Paper;
        /// Strength of the repulsion by members that touch.
        member_strength alias "A": R = 3.0, "A", "length/time^2", NonNegative, Ours;
        /// Distance over which the repulsion by members decays.
        member_decay alias "B": R = 0.3, "B", "length", Positive, Ours;
        /// Weight of what is behind, relative to what is ahead.
        anisotropy alias "lam": R = 0.2, "lambda", "1", Within(0.0, 1.0), Ours;
        /// Radius of the body in the law, or one for each member.
        radius: PerAgent<R> = 0.3, "r_i", "length", NonNegative, Ours;
        /// Strength of the repulsion by walls that are touched.
        wall_strength alias "A_w": R = 5.0, "A_w", "length/time^2", NonNegative, Ours;
        /// Distance over which the repulsion by walls decays.
        wall_decay alias "B_w": R = 0.1, "B_w", "length", Positive, Ours;
        /// Distance beyond which walls are left out.
        wall_range: R = 10.0, "-", "length", NonNegative, Ours;
        /// Points that attract, each with its strength as [x, y, strength].
        attractions: Vec<Vec<R>> = [0.0; 0], "-", "length, length/time^2", Any, Ours;
        /// Highest speed as a multiple of the desired one.
        speed_limit_factor alias "vmax_factor": R = 1.3, "-", "1", NonNegative, Paper;
        /// Radius within which others are neighbours.
        interaction_range alias "range": R = 10.0, "-", "length", Positive, Ours;
        /// Standard deviation of each component of the random acceleration.
        noise_deviation: R = 0.0, "-", "length/time^2", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.05, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Helbing2005<R> {
    const CARD: Card = Card {
        id: "helbing_2005",
        title: "Helbing et al. 2005, social force",
        about: "Pedestrians accelerate to a desired velocity and are pushed away by others, most by those ahead, and by walls.",
        reference: "D. Helbing, L. Buzna, A. Johansson, T. Werner (2005). Self-organized pedestrian crowd dynamics: \
                    experiments, simulations, and design solutions. Transportation Science 39, 1-24. \
                    doi:10.1287/trsc.1040.0108",
        equations: "f = (v0_i e0 - v_i)/tau - sum_{j in I} A exp((r_i + r_j - rho_ij)/B) \
                    [lambda + (1 - lambda)(1 + face.e_ij)/2] e_ij\n\
                    + sum_walls A_w exp((r_i - rho_w)/B_w) unit(x_i - q_w) + sum strength unit(point - x_i) + noise_vec\n\
                    e0 = unit(target_i - x_i), or own heading;  face = own heading, or e0 at rest\n\
                    v_i' = clip(v_i + f Dt, vmax_factor v0_i);  x_i' = x_i + v_i' Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, range)",
            motion: "acceleration",
            physics: "ideal, speed-limited",
            obstacles: "nearest point of every obstacle and wall within wall_range",
        },
        departures: "an interpretation: the source notes that attraction and fluctuation are left undefined; here a constant \
                     pull and a random acceleration. Ours too: A, B, A_w, B_w, lambda; a range for walls (beyond the default \
                     one a wall pushes with less than 1e-40 of A_w); exponents end at 40 so that forces stay finite; \
                     members of other groups count with one's own radius where radii differ",
        edge: "coincident members push nobody; at the target the own heading is kept; inside a solid the push is out of it",
        random: &[RandomQuantity {
            name: "noise_vec",
            about: "acceleration, each component normal with SD noise_deviation; behaviour slots 0 to 3",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, true, false],
            validation: "SP",
            synchronous: false,
            information: [Information::Global, Information::Global, Information::None],
            environment: "bounded obstacles",
        },
    };
    fn needs(&self) -> Needs {
        Needs { identity: self.radius.count().is_some(), ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn obstacle_reach(&self) -> Option<R> {
        Some(self.wall_range)
    }
    fn initial_speed_of(&self, member: usize) -> R {
        self.desired_speed.of(member).copied().unwrap_or(R::ZERO)
    }
    fn check(&self, members: usize) -> Result<(), String> {
        self.desired_speed.check("desired_speed", members)?;
        self.radius.check("radius", members)?;
        self.target.check("target", members)?;
        if self.target.0.iter().any(|point| point.len() != 2) {
            return Err("`target` needs two coordinates for each point".into());
        }
        if self.attractions.iter().any(|attraction| attraction.len() != 3) {
            return Err("`attractions` needs [x, y, strength] for each".into());
        }
        Ok(())
    }
}

/// `exp(q)` up to `exp(40)`, so that forces stay finite in both precisions.
fn push<R: Scalar>(q: R) -> R {
    q.least(R::of(40.0)).exp()
}

impl<R: Scalar> Model<R, 2> for Helbing2005<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.interaction_range))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let member = me.member();
        let desired_speed = self.desired_speed.of(member).copied().unwrap_or(R::ZERO);
        let radius = self.radius.of(member).copied().unwrap_or(R::ZERO);
        let radius_of = |k: usize| match &self.radius {
            PerAgent::One(radius) => *radius,
            PerAgent::Each(radii) => {
                let other = seen.id(k).checked_sub(me.around.group.0);
                other.and_then(|other| radii.get(other as usize)).copied().unwrap_or(radius)
            }
        };
        let space = me.around.space;
        let heading = me.heading();
        let mut goal = self.target.of(member).map_or(heading, |target| space.offset(me.position, target).unit());
        if goal.is_tiny() {
            goal = heading;
        }
        let face = if heading.is_tiny() { goal } else { heading };

        let drive = (goal * desired_speed - me.velocity) / self.relaxation_time;
        let mut members = Vector::ZERO;
        for k in seen.set(0) {
            let direction = seen.direction(k);
            let ahead = (R::ONE + face.dot(direction)) * R::HALF;
            let attention = self.anisotropy + (R::ONE - self.anisotropy) * ahead;
            let strength = push((radius + radius_of(k) - seen.distance(k)) / self.member_decay);
            members -= direction * (self.member_strength * strength * attention);
        }
        let mut walls = Vector::ZERO;
        for near in me.around.obstacles {
            walls += near.away * (self.wall_strength * push((radius - near.distance) / self.wall_decay));
        }
        let mut attraction = Vector::ZERO;
        for entry in &self.attractions {
            if let [x, y, strength] = entry[..] {
                attraction += space.offset(me.position, Vector([x, y])).unit() * strength;
            }
        }
        let mut force = drive + members + walls + attraction;
        if self.noise_deviation > R::ZERO || draws.injected.is_some() {
            let noise: Vector<R, 2> =
                draws.vector("noise_vec", |s| Vector([0, 2].map(|slot| self.noise_deviation * R::of(s.normal(slot)))));
            me.note("noise", noise);
            force += noise;
        }
        me.unit("length/time^2");
        me.note("desired velocity", drive);
        me.note("members", members);
        me.note("walls", walls);
        me.note("attraction", attraction);
        me.sum(force);
        let velocity = (me.velocity + force * self.time_step).clip(self.speed_limit_factor * desired_speed);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use crate::parameters::Value;
    use space::Vector;
    use space::shape::Shape;

    #[test]
    fn the_lone_approach_their_speed_and_no_more_than_the_limit() {
        // (1.34 - 1)/0.5 for 0.05
        let w = Oracle::new("helbing_2005").step(&[([0.0, 0.0], [1.0, 0.0])]);
        close(w.velocity(0), [1.034, 0.0]);
        close(w.position(0), [0.0517, 0.0]);
        let w = Oracle::new("helbing_2005").set("target", [0.0, 9.0]).step(&[([0.0, 0.0], [0.0, 0.0])]);
        close(w.velocity(0), [0.0, 0.134]);
        let w = Oracle::new("helbing_2005").step(&[([0.0, 0.0], [9.0, 0.0])]);
        close(w.velocity(0), [1.3 * 1.34, 0.0]);
    }

    #[test]
    fn members_push_most_ahead() {
        // 0 faces 1, 1 turns its back: [..] is 1 and 0.2
        let ahead = 3.0 * ((0.6f64 - 1.0) / 0.3).exp();
        let w = Oracle::new("helbing_2005").step(&[([0.0, 0.0], [1.34, 0.0]), ([1.0, 0.0], [1.34, 0.0])]);
        close(w.velocity(0), [1.34 - 0.05 * ahead, 0.0]);
        close(w.velocity(1), [1.34 + 0.05 * 0.2 * ahead, 0.0]);
        // at rest without a target: 0.6; radii of their own; coincident members do not push
        let w = Oracle::new("helbing_2005")
            .set("radius", [0.1, 0.2])
            .step(&[([0.0, 0.0], [0.0, 0.0]), ([0.0, 0.9], [0.0, 0.0])]);
        close(w.velocity(0), [0.0, -0.05 * 0.6 * 3.0 * (-2.0f64).exp()]);
        let w = Oracle::new("helbing_2005").step(&[([0.0, 0.0], [0.0, 0.0]); 2]);
        close(w.velocity(0), [0.0, 0.0]);
    }

    #[test]
    fn walls_push_and_points_attract() {
        let wall = Shape::new_segment(Vector([-9.0, 0.0]), Vector([9.0, 0.0])).unwrap();
        let w = Oracle::new("helbing_2005").obstacle(wall).step(&[([0.0, 0.5], [0.0, 0.0])]);
        close(w.velocity(0), [0.0, 0.05 * 5.0 * (-2.0f64).exp()]);
        let pull = Value::List(vec![[3.0, 4.0, 10.0].into()]);
        let w = Oracle::new("helbing_2005").set("attractions", pull).step(&[([0.0, 0.0], [0.0, 0.0])]);
        close(w.velocity(0), [0.3, 0.4]);
    }
}
