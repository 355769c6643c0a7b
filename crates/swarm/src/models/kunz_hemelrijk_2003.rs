//! Fish with zones of different shapes: repulsion in an ellipse, alignment at the sides, attraction ahead and far away.
//!
//! H. Kunz, C. K. Hemelrijk (2003), Artificial fish schools: collective effects of school size, body size, and body form,
//! Artificial Life 9:237.

use crate::card::*;
use crate::models::families::angles::{angle_noise, bearing, facing, turned};
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;

parameters! {
    /// Parameters of `kunz_hemelrijk_2003`.
    pub struct KunzHemelrijk2003 {
        /// Size of the repulsion ellipse.
        repulsion_radius alias "r_r": R = 0.6, "r_r", "length", Positive, Ours;
        /// Distance below which a neighbour at the side is aligned with.
        alignment_radius alias "r_p": R = 2.0, "r_p", "length", NonNegative, Ours;
        /// Distance below which others attract.
        attraction_radius alias "r_a": R = 5.0, "r_a", "length", NonNegative, Ours;
        /// Form of the repulsion ellipse: so many times longer along the body, and thinner across.
        body_form alias "ecc": R = 1.5, "e", "1", Positive, Ours;
        /// Half-angle ahead in which neighbours attract and are not aligned with.
        front_half_angle alias "front_deg": R = 30.0, "-", "deg", Within(0.0, 180.0), Ours;
        /// Full blind angle behind.
        blind_angle alias "blind_deg": R = 60.0, "-", "deg", Within(0.0, 360.0), Ours;
        /// Weight of repulsion.
        repulsion_weight alias "w_r": R = 1.0, "w_r", "1", NonNegative, Ours;
        /// Weight of alignment.
        alignment_weight alias "w_p": R = 0.5, "w_p", "1", NonNegative, Ours;
        /// Weight of attraction.
        attraction_weight alias "w_a": R = 0.3, "w_a", "1", NonNegative, Ours;
        /// Largest turning rate.
        turning_rate alias "turn_max_deg": R = 60.0, "-", "deg/time", NonNegative, Ours;
        /// Speed, the same for all.
        speed: R = 1.0, "v0", "length/time", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.2, "Dt", "time", Positive, Ours;
        /// Standard deviation of the random angle.
        noise_deviation: R = 0.0, "-", "rad", NonNegative, Ours;
    }
}

impl<R: Scalar> Law<R> for KunzHemelrijk2003<R> {
    const CARD: Card = Card {
        id: "kunz_hemelrijk_2003",
        title: "Kunz and Hemelrijk 2003",
        about: "Fish turn away from others in an ellipse about the body, along with those at their sides, and to those ahead or \
                far away.",
        reference: "H. Kunz, C. K. Hemelrijk (2003). Artificial fish schools: collective effects of school size, body size, and \
                    body form. Artificial Life 9, 237-253. doi:10.1162/106454603322392451",
        equations: "rho_e = hypot(rho cos(phi)/e, rho sin(phi) e)\n\
                    rho_e < r_r:  r = -sgn(phi) 90 deg (1 - rho_e/r_r),  sgn(0) = 1, also behind\n\
                    else |phi| > 180 deg - blind/2:  unseen\n\
                    else rho < r_p and |phi| >= front:  p = wrap(theta_j - theta_i);  else rho < r_a:  a = phi\n\
                    turn = clamp(w_r mean r + w_p mean p + w_a mean a, +-turn_max Dt) + noise_i\n\
                    theta_i' = wrap(theta_i + turn);  x_i' = x_i + v0 h(theta_i') Dt",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = distance_based(0, the farthest of the three zones); of these by zones",
            motion: "heading",
            physics: "turn-limited, constant speed",
            obstacles: "",
        },
        departures: "an interpretation: the shapes are those of the source's figure (attraction in front, alignment at the sides)",
        edge: "empty zones add nothing; a coincident neighbour lies straight ahead and repels fully, to the right; noise comes \
               after the limit; at rest the heading is angle 0 \
               and nobody is unseen",
        random: &[RandomQuantity {
            name: "noise",
            about: "angle, normal with SD noise_deviation; behaviour slots 0 and 1",
        }],
        taxonomy: Taxonomy {
            composition: Composition::Heterogeneous,
            idealized: true,
            discrete: true,
            avoidance: Avoidance::Member,
            identification: false,
            uses: [true, false, true],
            validation: "S",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "unbounded free",
        },
    };
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
}

/// Sum of what neighbours in a zone ask for, and how many they are.
#[derive(Clone, Copy)]
struct Zone<R> {
    sum: R,
    count: R,
}

impl<R: Scalar> Zone<R> {
    const EMPTY: Self = Self { sum: R::ZERO, count: R::ZERO };

    fn add(&mut self, turn: R) {
        self.sum += turn;
        self.count += R::ONE;
    }
    fn mean(self) -> R {
        if self.count > R::ZERO { self.sum / self.count } else { R::ZERO }
    }
}

impl<R: Scalar> Model<R, 2> for KunzHemelrijk2003<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        // half the long axis of the ellipse, and a little more than that
        let long = self.repulsion_radius * self.body_form.most(R::ONE / self.body_form) * R::of(1.000_001);
        let reach = long.most(self.alignment_radius).most(self.attraction_radius);
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, reach))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let theta = me.velocity.angle();
        let (front, view) = (self.front_half_angle.radians(), R::PI - self.blind_angle.radians() * R::HALF);
        let [mut repulsion, mut alignment, mut attraction] = [Zone::EMPTY; 3];
        for k in seen.set(0) {
            let (phi, distance) = (bearing(seen, k, theta), seen.distance(k));
            let (sin, cos) = phi.sin_cos();
            let along = Vector([distance * cos / self.body_form, distance * sin * self.body_form]).length();
            if along < self.repulsion_radius {
                let side = if phi < R::ZERO { R::ONE } else { -R::ONE };
                repulsion.add(side * R::PI * R::HALF * (R::ONE - along / self.repulsion_radius));
            } else if phi.abs() > view && !me.velocity.is_tiny() {
            } else if distance < self.alignment_radius && phi.abs() >= front {
                alignment.add((seen.velocity(k).angle() - theta).wrapped());
            } else if distance < self.attraction_radius {
                attraction.add(phi);
            }
        }
        let parts = [
            ("turn by repulsion", repulsion.mean() * self.repulsion_weight),
            ("turn by alignment", alignment.mean() * self.alignment_weight),
            ("turn by attraction", attraction.mean() * self.attraction_weight),
        ];
        let mut turn = R::ZERO;
        for (name, part) in parts {
            me.value(name, part, "rad");
            turn += part;
        }
        let most = self.turning_rate.radians() * self.time_step;
        me.value("turn allowed", most, "rad");
        let turn = turn.clamped(-most, most) + angle_noise(self.noise_deviation, me, draws);
        let velocity = facing(turned(theta, turn)) * self.speed;
        me.unit("length/time");
        me.note("turned heading", velocity);
        me.sum(velocity);
        Motion::new_velocity(velocity, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    /// The turn, in degrees, of a member that heads along x, with one other that heads up.
    #[track_caller]
    fn expect(oracle: Oracle<2>, other: [f64; 2], degrees: f64) {
        let w = oracle.step(&[([0.0, 0.0], [1.0, 0.0]), (other, [0.0, 1.0])]);
        let going = [degrees.to_radians().cos(), degrees.to_radians().sin()];
        close(w.velocity(0), going);
        close(w.position(0), going.map(|v| 0.2 * v));
    }

    /// Turns without a limit.
    fn free() -> Oracle<2> {
        Oracle::new("kunz_hemelrijk_2003").set("turn_max_deg", 1e4)
    }

    #[test]
    fn each_zone_asks_for_its_turn() {
        // in the ellipse: 0.45 ahead is 0.3 of 0.6, 0.2 at the side is 0.3 too; behind as well
        expect(free(), [0.45, 0.0], -45.0);
        expect(free(), [0.0, -0.2], 45.0);
        expect(free(), [-0.45, 0.0], -45.0);
        expect(free(), [0.0, 0.0], -90.0);
        // at the side along with it, ahead or farther towards it, behind unseen
        expect(free(), [0.0, 1.0], 45.0);
        expect(free(), [1.5, 0.0], 0.0);
        expect(free(), [0.0, 3.0], 27.0);
        expect(free(), [-1.5, 0.1], 0.0);
        expect(free(), [0.0, 5.0], 0.0);
    }

    #[test]
    fn at_rest_it_sees_all_round() {
        let w = free().set("w_a", 1.0).step(&[([0.0, 0.0], [0.0, 0.0]), ([-1.5, 0.1], [0.0, 1.0])]);
        close(w.velocity(0), [0.5f64.sqrt(), 0.5f64.sqrt()]);
    }

    #[test]
    fn the_turn_is_limited_before_the_noise() {
        expect(Oracle::new("kunz_hemelrijk_2003"), [0.0, 1.0], 12.0);
        expect(Oracle::new("kunz_hemelrijk_2003"), [0.45, 0.0], -12.0);
        let noisy = Oracle::new("kunz_hemelrijk_2003").inject("noise", &[0.5, 0.0]);
        expect(noisy, [0.0, 1.0], 12.0 + 0.5f64.to_degrees());
        // a form of 1 is a circle
        expect(free().set("ecc", 1.0), [0.0, -0.3], 45.0);
        expect(free().set("ecc", 1.0), [0.3, 0.0], -45.0);
    }
}
