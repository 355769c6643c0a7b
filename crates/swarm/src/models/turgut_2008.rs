//! Robots agree on heading and keep a distance by infrared.
//!
//! A. E. Turgut, H. Celikkanat, F. Gokce, E. Sahin (2008), Self-organized flocking in mobile robot swarms, Swarm Intelligence
//! 2:97.

use crate::card::*;
use crate::models::families::facing;
use crate::models::families::kobot::Kobot;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{PerAgent, Points, Scalar};
use space::Column;

parameters! {
    /// Parameters of `turgut_2008`.
    pub struct Turgut2008 {
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

impl<R: Scalar> Law<R> for Turgut2008<R> {
    const CARD: Card = Card {
        id: "turgut_2008",
        title: "Turgut et al. 2008, Kobots",
        about: "Robots turn to the mean heading of those they hear, and away from or towards what infrared shows in eight sectors.",
        reference: "A. E. Turgut, H. Celikkanat, F. Gokce, E. Sahin (2008). Self-organized flocking in mobile robot swarms. Swarm \
                    Intelligence 2, 97-120. doi:10.1007/s11721-008-0016-2",
        equations: "hv = unit(sum_j h(theta_j + vhs_noise_j)), own heading if none is heard\n\
                    f_k, nearest thing in sector k of 8 at o:  robot -(o - r_rho)^2/C if o < r_rho, else +(o - r_rho)^2/C;\n\
                    obstacle -(range_ir - o)^2/C;  nothing 0;  P = (1/8) sum f_k h(theta_i + k 45 deg)\n\
                    a = unit(hv + beta P);  al = wrap(angle(a) - theta_i)\n\
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
        departures: "the table puts distance where the paper has a sensor level (high is near) without flipping the sign: as printed robots \
                     would repel when far; exponents lack the imaginary unit; 4/pi k is pi/4 k; the angle in the frame of the robot \
                     is replaced by the global one; the own heading is not in hv",
        edge: "a = 0: straight on; coincident robots, and obstacles that one is inside of, are unseen by infrared; distances to \
               obstacles are to the rim, bearings to the centre; of a robot and an obstacle at the same distance the robot counts; \
               sectors are half open; h is that of the orientation theta, also at rest",
        random: &[RandomQuantity {
            name: "vhs_noise",
            about: "error of the heading heard from j, normal with SD noise_deviation; behaviour slots 0 and 1 about j; supplied \
                    as one number for each member heard",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: true,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, true, false],
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
}

impl<R: Scalar> Variant<R> for Turgut2008<R> {
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
            target_weight: PerAgent::One(R::ZERO),
            target: Points(Vec::new()),
            noise_deviation: self.noise_deviation,
            time_step: self.time_step,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};
    use space::Vector;
    use space::shape::Shape;

    /// Velocity after a step that turns by `turn`, and the turn that was asked for.
    fn driven(theta: f64, asked: f64) -> [f64; 2] {
        let (speed, theta) = ((0.07 * asked.cos()).max(0.0), theta + 0.05 * asked);
        [speed * theta.cos(), speed * theta.sin()]
    }

    #[test]
    fn headings_are_heard() {
        // beyond infrared: the other's heading alone, a quarter turn away, so that the robot stands and turns
        let w = Oracle::new("turgut_2008").step(&[([0.0, 0.0], [0.07, 0.0]), ([1.0, 0.0], [0.0, 0.07])]);
        close(w.velocity(0), [0.0, 0.0]);
        let quarter = core::f64::consts::FRAC_PI_2;
        assert!((w.state(0, "theta").unwrap_or(9.0) - 0.05 * quarter).abs() < 1e-12);
        // a supplied error belongs to the one who is heard
        let agents = [([0.0, 0.0], [0.07, 0.0]), ([1.0, 0.0], [0.07, 0.0])];
        let w = Oracle::new("turgut_2008").inject("vhs_noise", &[0.0, 0.4]).step(&agents);
        close(w.velocity(0), driven(0.0, 0.4));
        close(w.velocity(1), driven(0.0, 0.0));
        close(Oracle::new("turgut_2008").set("range_vhs", 1.0).step(&agents).velocity(0), driven(0.0, 0.0));
    }

    #[test]
    fn infrared_keeps_a_distance_in_sectors() {
        let first = |place: [f64; 2]| {
            Oracle::new("turgut_2008").step(&[([0.0, 0.0], [0.07, 0.0]), (place, [0.07, 0.0])]).velocity(0)
        };
        // at the side, nearer than 0.12 by 0.04: f = -1/4, a = (1, 0) + 12/8 (0, -1/4)
        close(first([0.0, 0.08]), driven(0.0, (-0.375f64).atan2(1.0)));
        close(first([0.0, 0.16]), driven(0.0, 0.375f64.atan2(1.0)));
        // at 40 degrees the sector is that at 45
        let (sin, cos) = 40f64.to_radians().sin_cos();
        let pull = 0.375 * 0.5f64.sqrt();
        close(first([0.16 * cos, 0.16 * sin]), driven(0.0, pull.atan2(1.0 + pull)));
        close(first([0.0, 0.2]), driven(0.0, 0.0));
        close(first([0.0, 0.0]), driven(0.0, 0.0));
        // behind: sector 4
        close(first([-0.08, 0.0]), driven(0.0, 0.0));
    }

    #[test]
    fn obstacles_push_and_the_nearer_thing_counts() {
        let disc = |y: f64| Shape::Ball { centre: Vector([0.0, y]), radius: 0.05 };
        // the rim at 0.12: -(0.08)^2/C = -1
        let w = Oracle::new("turgut_2008").obstacle(disc(0.17)).step(&[([0.0, 0.0], [0.07, 0.0])]);
        close(w.velocity(0), driven(0.0, (-1.5f64).atan2(1.0)));
        // a robot nearer in the same sector hides it
        let agents = [([0.0, 0.0], [0.07, 0.0]), ([0.0, 0.08], [0.07, 0.0])];
        let w = Oracle::new("turgut_2008").obstacle(disc(0.17)).step(&agents);
        close(w.velocity(0), driven(0.0, (-0.375f64).atan2(1.0)));
        // from inside it is unseen
        let w = Oracle::new("turgut_2008").obstacle(disc(0.02)).step(&agents[..1]);
        close(w.velocity(0), driven(0.0, 0.0));
    }
}
