//! Kobots of which some know where to go.
//!
//! F. Gokce, E. Sahin (2009), To flock or not to flock: the pros and cons of flocking in long-range "migration" of mobile robot
//! swarms, AAMAS 2009.

use crate::card::*;
use crate::models::families::facing;
use crate::models::families::kobot::Kobot;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{PerAgent, Points, Scalar};
use space::Column;

parameters! {
    /// Parameters of `gokce_sahin_2009`.
    pub struct GokceSahin2009 {
        /// Distance below which headings are heard.
        heading_range alias "range_vhs": R = 20.0, "-", "m", Positive, Paper;
        /// Distance below which infrared sees.
        infrared_range alias "range_ir": R = 0.2, "-", "m", Positive, Paper;
        /// Desired distance to other robots.
        desired_distance alias "r_des": R = 0.12, "r_rho", "m", NonNegative, Ours;
        /// What squared differences of distance are divided by.
        force_divisor alias "C": R = 0.0064, "C", "m^2", Positive, Ours;
        /// Weight of proximal control.
        proximal_weight alias "beta": R = 12.0, "beta", "1", NonNegative, Ours;
        /// Weight of the target, or one for each robot; 0 for those that know none.
        target_weight alias "gamma": PerAgent<R> = 0.1, "gamma", "1", NonNegative, Ours;
        /// Target, or one for each robot; none where empty.
        target: Points<R> = [100.0, 0.0], "x_*", "m", Any, Ours;
        /// Highest forward speed.
        highest_speed alias "u_max": R = 0.07, "u_max", "m/s", NonNegative, Paper;
        /// Gain of turning.
        turning_gain alias "k_p": R = 0.5, "K_p", "1/s", NonNegative, Paper;
        /// Length of a step.
        time_step alias "dt": R = 0.1, "Dt", "s", Positive, Ours;
        /// Standard deviation of the error of a heard heading.
        noise_deviation: R = 0.0, "-", "rad", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for GokceSahin2009<R> {
    const CARD: Card = Card {
        id: "gokce_sahin_2009",
        title: "Gokce and Sahin 2009, migrating Kobots",
        about: "Robots turn to the mean heading of those they hear, keep a distance by infrared, and turn to a target.",
        reference: "F. Gokce, E. Sahin (2009). To flock or not to flock: the pros and cons of flocking in long-range \"migration\" of \
                    mobile robot swarms. Proceedings of AAMAS 2009, 65-72",
        equations: "hv = unit(sum_j h(theta_j + vhs_noise_j)), own heading if none is heard\n\
                    f_k, nearest thing in sector k of 8 at o:  robot -(o - r_rho)^2/C if o < r_rho, else +(o - r_rho)^2/C;\n\
                    obstacle -(range_ir - o)^2/C;  nothing 0;  P = (1/8) sum f_k h(theta_i + k 45 deg)\n\
                    a = unit(hv + beta P + gamma (unit(x_* - x_i) - h(theta_i)));  al = wrap(angle(a) - theta_i)\n\
                    u = max(0, u_max cos(al));  theta_i' = wrap(theta_i + Dt K_p al);  v_i' = u h(theta_i');  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "infrared ring and exchange of headings",
            detection: "ideal; obstacles told from robots",
            selection: "heard = distance_based(0, range_vhs); near = distance_based(0, range_ir), of these the nearest thing in \
                        each of 8 sectors",
            motion: "desired direction",
            physics: "differential drive (forward speed and turning rate)",
            obstacles: "obstacles within range_ir of their rim",
        },
        departures: "as turgut_2008; the difference of directions of the table is kept; gains are renamed",
        edge: "a = 0: straight on; coincident robots, and obstacles that one is inside of, are unseen by infrared; distances to \
               obstacles are to the rim, bearings to the centre; of a robot and an obstacle at the same distance the robot counts; \
               sectors are half open; h is that of the orientation theta, also at rest; an empty target drops the gamma term",
        random: &[RandomQuantity {
            name: "vhs_noise",
            about: "error of the heading heard from j, normal with SD noise_deviation; behaviour slots 0 and 1 about j; supplied \
                    as one number for each member heard",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, true, true],
            validation: "SP",
            synchronous: false,
            information: [Information::Global, Information::None, Information::Local],
            environment: "bounded free",
        },
    };
    fn columns() -> &'static [Column] {
        &[facing::THETA]
    }
    fn needs(&self) -> Needs {
        Needs { identity: true, state: true, ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn obstacle_reach(&self) -> Option<R> {
        Some(self.infrared_range)
    }
    fn initial_speed(&self) -> R {
        self.highest_speed
    }
    fn check(&self, members: usize) -> Result<(), String> {
        self.target_weight.check("target_weight", members)?;
        self.target.check("target", members)
    }
}

impl<R: Scalar> Variant<R> for GokceSahin2009<R> {
    type Shared = Kobot<R>;
    fn shared(&self) -> Self::Shared {
        Kobot {
            heading_range: self.heading_range,
            infrared_range: self.infrared_range,
            desired_distance: self.desired_distance,
            force_divisor: self.force_divisor,
            proximal_weight: self.proximal_weight,
            highest_speed: self.highest_speed,
            turning_gain: self.turning_gain,
            target_weight: self.target_weight.clone(),
            target: self.target.clone(),
            noise_deviation: self.noise_deviation,
            time_step: self.time_step,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    /// Velocity after a step that turns by `turn`, and the turn that was asked for.
    fn driven(theta: f64, asked: f64) -> [f64; 2] {
        let (speed, theta) = ((0.07 * asked.cos()).max(0.0), theta + 0.05 * asked);
        [speed * theta.cos(), speed * theta.sin()]
    }

    #[test]
    fn the_target_turns_by_a_difference_of_directions() {
        // alone: (1, 0) + 0.5 ((0, 1) - (1, 0))
        let alone = [([0.0, 0.0], [0.07, 0.0])];
        let model = || Oracle::new("gokce_sahin_2009").set("gamma", 0.5).set("target", [0.0, 9.0]);
        close(model().step(&alone).velocity(0), driven(0.0, core::f64::consts::FRAC_PI_4));
        close(model().set("gamma", 0.0).step(&alone).velocity(0), driven(0.0, 0.0));
        // at the target it has no direction: half of the own heading is left
        close(model().set("target", [0.0, 0.0]).step(&alone).velocity(0), driven(0.0, 0.0));
        let none = crate::parameters::Value::List(Vec::new());
        close(model().set("target", none).step(&alone).velocity(0), driven(0.0, 0.0));
    }

    #[test]
    fn who_has_no_weight_follows_what_it_hears() {
        let agents = [([0.0, 0.0], [0.07, 0.0]), ([1.0, 0.0], [0.07, 0.0])];
        let w = Oracle::new("gokce_sahin_2009").set("gamma", [0.0, 1.0]).set("target", [1.0, 9.0]).step(&agents);
        close(w.velocity(0), driven(0.0, 0.0));
        // (1, 0) + ((0, 1) - (1, 0)) is straight up: it stands and turns
        close(w.velocity(1), [0.0, 0.0]);
        assert!((w.state(1, "theta").unwrap_or(9.0) - 0.05 * core::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }
}
