//! Kobots: robots that agree on heading, keep a distance by infrared, and turn with a differential drive.

use super::angles::{bearing, facing as heading_at, turned};
use super::facing;
use crate::motion::*;
use crate::parameters::{PerAgent, Points, Scalar};
use crate::selection::{NamedSet, Perception};
use space::Vector;

/// Infrared sensors, one for each sector of an eighth of a turn.
const SECTORS: usize = 8;

/// The law.
#[derive(Debug)]
pub struct Kobot<R> {
    /// Distance below which headings are heard.
    pub heading_range: R,
    /// Distance below which infrared sees.
    pub infrared_range: R,
    /// Desired distance to other robots.
    pub desired_distance: R,
    /// What squared differences of distance are divided by.
    pub force_divisor: R,
    /// Weight of proximal control.
    pub proximal_weight: R,
    /// Highest forward speed.
    pub highest_speed: R,
    /// Gain of turning.
    pub turning_gain: R,
    /// Weight of the target.
    pub target_weight: PerAgent<R>,
    /// Target, or one for each robot.
    pub target: Points<R>,
    /// Standard deviation of the error of a heard heading.
    pub noise_deviation: R,
    /// Length of a step.
    pub time_step: R,
}

const HEARD: usize = 0;
const NEAR: usize = 1;

/// The sector of a bearing: sector 0 is ahead, half open, and they count to the left.
fn sector<R: Scalar>(phi: R) -> usize {
    let eighth = R::PI / R::of(4.0);
    let place = ((phi + eighth * R::HALF) / eighth).floor();
    // from -4 to 4
    (place + R::of(SECTORS as f64)).index() % SECTORS
}

impl<R: Scalar> Kobot<R> {
    /// The sum of the heard headings, as a unit vector; the own one where none is heard.
    fn heard(&self, seen: &Percepts<'_, R, 2>, theta: R, draws: &Draws<'_>) -> Vector<R, 2> {
        let (mut sum, mut any) = (Vector::ZERO, false);
        let noisy = self.noise_deviation > R::ZERO || draws.injected.is_some();
        let deviation = self.noise_deviation.to_f64();
        for k in seen.set(HEARD) {
            let j = seen.id(k);
            let noise =
                if noisy { draws.number_about("vhs_noise", j, |s| deviation * s.normal_about(j, 0)) } else { R::ZERO };
            sum += heading_at(seen.state(k, 0) + noise);
            any = true;
        }
        if any { sum.unit() } else { heading_at(theta) }
    }
    /// Proximal control: what the nearest thing in each sector asks for, averaged.
    fn proximal(&self, me: &Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, theta: R) -> Vector<R, 2> {
        // distance, and whether it is a robot
        let mut nearest: [Option<(R, bool)>; SECTORS] = [None; SECTORS];
        for k in seen.set(NEAR) {
            let distance = seen.distance(k);
            if distance <= R::TINY {
                continue;
            }
            let place = &mut nearest[sector(bearing(seen, k, theta))];
            if place.is_none_or(|(best, _)| distance < best) {
                *place = Some((distance, true));
            }
        }
        for near in me.around.obstacles {
            // inside of one nothing is seen
            if near.distance < R::ZERO || near.distance >= self.infrared_range || near.away.is_tiny() {
                continue;
            }
            let place = &mut nearest[sector((near.away.angle() + R::PI - theta).wrapped())];
            if place.is_none_or(|(best, _)| near.distance < best) {
                *place = Some((near.distance, false));
            }
        }
        let mut sum = Vector::ZERO;
        for (k, thing) in nearest.into_iter().enumerate() {
            let Some((distance, robot)) = thing else { continue };
            let force = if robot {
                let excess = distance - self.desired_distance;
                excess * excess.abs()
            } else {
                -(self.infrared_range - distance).squared()
            };
            let direction = theta + R::count(k) * (R::PI / R::of(4.0));
            sum += heading_at(direction) * (force / self.force_divisor);
        }
        sum / R::of(SECTORS as f64)
    }
}

impl<R: Scalar> Model<R, 2> for Kobot<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        vec![
            NamedSet::new("heard", Perception::distance(R::ZERO, self.heading_range)),
            NamedSet::new("near", Perception::distance(R::ZERO, self.infrared_range)),
        ]
    }
    fn complete(&self, start: &mut Start<'_, R, 2>) {
        facing::complete(start, self.highest_speed);
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, 2>) {
        facing::performed(own, velocity);
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let theta = me.own[0];
        let heading = self.heard(seen, theta, draws);
        let proximal = self.proximal(me, seen, theta) * self.proximal_weight;
        let gamma = self.target_weight.of(me.member()).copied().unwrap_or(R::ZERO);
        let space = me.around.space;
        let target = match self.target.of(me.member()) {
            Some(place) => (space.offset(me.position, place).unit() - heading_at(theta)) * gamma,
            None => Vector::ZERO,
        };
        let mut wanted = Vector::ZERO;
        for (name, part) in [("heading of others", heading), ("proximal control", proximal), ("target", target)] {
            me.note(name, part);
            wanted += part;
        }
        me.sum(wanted);
        let turn = if wanted.is_tiny() { R::ZERO } else { (wanted.angle() - theta).wrapped() };
        me.value("turn asked for", turn, "rad");
        let speed = (self.highest_speed * turn.cos()).most(R::ZERO);
        me.own[0] = turned(theta, self.time_step * self.turning_gain * turn);
        Motion::new_velocity(heading_at(me.own[0]) * speed, self.time_step)
    }
}
