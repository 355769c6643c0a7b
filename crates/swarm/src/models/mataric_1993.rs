//! Robots that avoid whom they meet, else disperse, aggregate, go home and go on.
//!
//! M. J. Mataric (1993), Designing emergent behaviors: from local interactions to collective intelligence, From Animals to Animats 2.

use crate::card::*;
use crate::models::families::angles::{bearing, facing as heading_at, turned};
use crate::models::families::facing;
use crate::motion::*;
use crate::parameters;
use crate::parameters::{Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::{Column, Vector};

parameters! {
    /// Parameters of `mataric_1993`.
    pub struct Mataric1993 {
        /// Distance below which others are sensed for aggregation.
        range: R = 6.0, "beta", "m", Positive, Ours;
        /// Distance below which somebody ahead is avoided.
        avoidance_distance alias "r_avoid": R = 1.0, "-", "m", NonNegative, Ours;
        /// Distance below which a robot backs up.
        backing_distance alias "r_back": R = 0.4, "-", "m", NonNegative, Ours;
        /// Distance below which others disperse.
        dispersion_distance alias "r_disp": R = 2.0, "-", "m", NonNegative, Ours;
        /// Distance of the centre above which others aggregate.
        aggregation_distance alias "r_agg": R = 3.0, "-", "m", NonNegative, Ours;
        /// Weight of dispersion.
        dispersion_weight alias "w_disp": R = 1.0, "-", "1", NonNegative, Ours;
        /// Weight of aggregation.
        aggregation_weight alias "w_agg": R = 1.0, "-", "1", NonNegative, Ours;
        /// Weight of homing.
        homing_weight alias "w_home": R = 0.0, "-", "1", NonNegative, Ours;
        /// Weight of going on.
        forward_weight alias "w_fwd": R = 1.0, "-", "1", NonNegative, Ours;
        /// Home, or one for each member; none where empty.
        home: Points<R> = [0.0; 0], "-", "m", Any, Ours;
        /// Turn that avoidance asks for.
        avoidance_turn alias "avoid_deg": R = 45.0, "-", "deg", NonNegative, Ours;
        /// Largest turning rate.
        turning_rate alias "turn_deg": R = 45.0, "theta", "deg/s", NonNegative, Ours;
        /// Speed, the same for all.
        speed: R = 0.2, "v0", "m/s", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 1.0, "Dt", "s", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Mataric1993<R> {
    const CARD: Card = Card {
        id: "mataric_1993",
        title: "Mataric 1993",
        about: "Robots turn from whom they meet, back up when too near, and else sum dispersion, aggregation, homing and going on.",
        reference: "M. J. Mataric (1993). Designing emergent behaviors: from local interactions to collective intelligence. From \
                    Animals to Animats 2, MIT Press, 432-441",
        equations: "somebody ahead (|phi| <= 90 deg, rho < r_avoid):  desired = theta_i -+ avoid  (right if the nearest is on \
                    the left or straight ahead);\n\
                    speed -v0/2 if it is nearer than r_back, else v0\n\
                    else desired = w_fwd h_i - w_disp unit(mean d_ij, r_disp) + w_agg unit(mean d_ij, range; if that centre is \
                    beyond r_agg) + w_home unit(home - x_i)\n\
                    theta_i' = theta_i turned toward desired by at most turn Dt;  v_i' = s h(theta_i');  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal within range (stands for infrared, sonar, radio)",
            detection: "ideal",
            selection: "near = distance_based(0, r_avoid), of these those ahead; dispersion = distance_based(0, r_disp); \
                        aggregation = distance_based(0, range)",
            motion: "orientation and speed",
            physics: "turn-limited",
            obstacles: "",
        },
        departures: "an interpretation: phrases such as back up and turn became parameters; only the nearest of several is \
                     avoided, which settles the conflict of left and right. The rules concern robots; walls are the body's affair",
        edge: "desired = 0: straight on; a coincident robot lies straight ahead; ties go to the lower index; h is that of the \
               orientation theta, also at rest",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: false,
            discrete: false,
            avoidance: Avoidance::All,
            identification: false,
            uses: [true, false, false],
            validation: "P",
            synchronous: false,
            information: [Information::Local, Information::None, Information::Local],
            environment: "bounded free",
        },
    };
    fn columns() -> &'static [Column] {
        &[facing::THETA]
    }
    fn needs(&self) -> Needs {
        Needs::default()
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn initial_speed(&self) -> R {
        self.speed
    }
    fn check(&self, members: usize) -> Result<(), String> {
        self.home.check("home", members)
    }
}

const NEAR: usize = 0;
const DISPERSION: usize = 1;
const AGGREGATION: usize = 2;

impl<R: Scalar> Mataric1993<R> {
    /// The sum of the behaviours that are no avoidance.
    fn desired(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, theta: R) -> Vector<R, 2> {
        let centre = |set: usize| {
            let (mut sum, mut count) = (Vector::ZERO, R::ZERO);
            for k in seen.set(set) {
                sum += seen.offset(k);
                count += R::ONE;
            }
            if count > R::ZERO { sum / count } else { Vector::ZERO }
        };
        let together = centre(AGGREGATION);
        let far = together.length() > self.aggregation_distance;
        let space = me.around.space;
        let home = self.home.of(me.member()).map_or(Vector::ZERO, |place| space.offset(me.position, place));
        let mut desired = Vector::ZERO;
        for (name, part) in [
            ("forward", heading_at(theta) * self.forward_weight),
            ("dispersion", -(centre(DISPERSION).unit() * self.dispersion_weight)),
            ("aggregation", if far { together.unit() * self.aggregation_weight } else { Vector::ZERO }),
            ("homing", home.unit() * self.homing_weight),
        ] {
            me.note(name, part);
            desired += part;
        }
        me.sum(desired);
        desired
    }
}

impl<R: Scalar> Model<R, 2> for Mataric1993<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![
            NamedSet::new("near", Perception::ring(R::ZERO, self.avoidance_distance)),
            NamedSet::new("dispersion", Perception::ring(R::ZERO, self.dispersion_distance)),
            NamedSet::new("aggregation", Perception::distance(R::ZERO, self.range)),
        ]
    }
    fn complete(&self, start: &mut Start<'_, R, 2>) {
        facing::complete(start, self.speed);
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, 2>) {
        facing::performed(own, velocity);
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, _: &Draws<'_>) -> Motion<R, 2> {
        let theta = me.own[0];
        let met = facing::nearest_ahead(seen, NEAR, theta);
        me.either(["avoid", "sum of behaviours"], usize::from(met.is_none()));
        let (turn, speed) = match met {
            Some(k) => {
                let aside = self.avoidance_turn.radians();
                let turn = if bearing(seen, k, theta) >= R::ZERO { -aside } else { aside };
                me.note("away from the nearest ahead", heading_at(turned(theta, turn)));
                me.acts(&[NEAR]);
                let backs = seen.distance(k) < self.backing_distance;
                (turn, if backs { -self.speed * R::HALF } else { self.speed })
            }
            None => {
                let desired = self.desired(me, seen, theta);
                me.acts(&[DISPERSION, AGGREGATION]);
                let turn = if desired.is_tiny() { R::ZERO } else { (desired.angle() - theta).wrapped() };
                (turn, self.speed)
            }
        };
        let most = self.turning_rate.radians() * self.time_step;
        me.value("turn asked for", turn, "rad");
        me.value("turn allowed", most, "rad");
        me.own[0] = turned(theta, turn.clamped(-most, most));
        Motion::new_velocity(heading_at(me.own[0]) * speed, self.time_step)
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    #[test]
    fn worked_example_of_the_family() {
        let w = Oracle::new("mataric_1993").step(&[([0.0, 0.0], [0.2, 0.0]), ([0.8, 0.2], [0.0, 0.2])]);
        let half = 0.2 * 0.5f64.sqrt();
        close(w.velocity(0), [half, -half]);
        close(w.velocity(1), [0.123082, 0.157641]);
        close(w.position(0), [half, -half]);
        assert!((w.state(1, "theta").unwrap_or(9.0).to_degrees() - 52.02).abs() < 0.01);
    }

    #[test]
    fn too_near_it_backs_up_and_far_away_it_aggregates() {
        // on the right at 0.3: turn left by 45 degrees, and back
        let w = Oracle::new("mataric_1993").step(&[([0.0, 0.0], [0.2, 0.0]), ([0.2, -0.2], [0.2, 0.0])]);
        let half = 0.1 * 0.5f64.sqrt();
        close(w.velocity(0), [-half, -half]);
        assert_eq!(w.state(0, "theta"), Some(core::f64::consts::FRAC_PI_4));
        // a centre at 4: forward and aggregation, 45 degrees
        let w = Oracle::new("mataric_1993").step(&[([0.0, 0.0], [0.2, 0.0]), ([0.0, 4.0], [0.2, 0.0])]);
        close(w.velocity(0), [2.0 * half, 2.0 * half]);
        // at 2.5 neither dispersion nor aggregation
        let w = Oracle::new("mataric_1993").step(&[([0.0, 0.0], [0.2, 0.0]), ([0.0, 2.5], [0.2, 0.0])]);
        close(w.velocity(0), [0.2, 0.0]);
        // homing, within the turn allowed; who stands keeps its orientation
        let alone = [([0.0, 0.0], [0.0, 0.0])];
        let homing = Oracle::new("mataric_1993").set("w_home", 1.0).set("w_fwd", 0.0).set("home", [-9.0, 0.1]);
        close(homing.step(&alone).velocity(0), [2.0 * half, 2.0 * half]);
        let w = Oracle::new("mataric_1993").set("speed", 0.0).column("theta", &[2.0]).step(&alone);
        assert_eq!(w.state(0, "theta"), Some(2.0));
    }
}
