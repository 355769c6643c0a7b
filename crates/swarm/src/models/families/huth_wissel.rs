//! The fish schools of Huth and Wissel: each of a few neighbours in order of priority asks for a turn, and the turns are combined.

use super::angles::{angle_noise, bearing, facing, turned};
use crate::choice;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use core::cmp::Ordering;

choice! {
    /// In which order neighbours count.
    pub enum Priority {
        /// The nearest first.
        Distance = "distance",
        /// Those most straight ahead first.
        Front = "front",
    }
}

/// How the turns that neighbours ask for are combined.
#[derive(Clone, Copy, Debug)]
pub enum Combination {
    /// Their mean.
    Mean,
    /// Their mean with weights 1, 1/2, 1/4, ... in the order of priority.
    Halved,
    /// One of them, with these weights as probabilities.
    One,
}

/// The law.
#[derive(Debug)]
pub struct School<R> {
    /// Distance below which a member swims across.
    pub repulsion_radius: R,
    /// Distance below which it swims in parallel.
    pub alignment_radius: R,
    /// Distance below which it swims up.
    pub attraction_radius: R,
    /// So many neighbours count.
    pub neighbour_count: usize,
    /// Full blind angle behind, rad.
    pub blind_angle: R,
    /// In which order they count.
    pub priority: Priority,
    /// Speed, the same for all.
    pub speed: R,
    /// Length of a step.
    pub time_step: R,
    /// Standard deviation of the random angle, rad.
    pub noise_deviation: R,
    /// How their turns are combined.
    pub combination: Combination,
}

impl<R: Scalar> School<R> {
    /// The turn that percept `k` asks for: across, in parallel, or up to it.
    fn turn(&self, seen: &Percepts<'_, R, 2>, k: usize, theta: R) -> R {
        let (phi, distance) = (bearing(seen, k, theta), seen.distance(k));
        if distance < self.repulsion_radius {
            let quarter = R::PI * R::HALF;
            if phi >= R::ZERO { phi - quarter } else { phi + quarter }
        } else if distance < self.alignment_radius {
            (seen.velocity(k).angle() - theta).wrapped()
        } else {
            phi
        }
    }
    /// The percept of the highest priority below that of `last`; ties go to the lower id.
    fn next(&self, seen: &Percepts<'_, R, 2>, theta: R, last: Option<(R, u32)>) -> Option<(usize, (R, u32))> {
        let mut best: Option<(usize, (R, u32))> = None;
        for k in seen.set(0) {
            let rank = match self.priority {
                Priority::Distance => seen.squared[k],
                Priority::Front => bearing(seen, k, theta).abs(),
            };
            let key = (rank, seen.id(k));
            let after = last.is_none_or(|last| key.partial_cmp(&last) == Some(Ordering::Greater));
            if after && best.is_none_or(|(_, best)| key < best) {
                best = Some((k, key));
            }
        }
        best
    }
    /// The turns of the first neighbours, combined; `None` where there is none.
    fn combined(&self, seen: &Percepts<'_, R, 2>, theta: R, draws: &Draws<'_>) -> Option<R> {
        let first = self.next(seen, theta, None)?;
        let visit = |each: &mut dyn FnMut(usize, R)| {
            let (mut at, mut weight) = (Some(first), R::ONE);
            for _ in 0..self.neighbour_count {
                let Some((k, key)) = at else { break };
                each(k, weight);
                if !matches!(self.combination, Combination::Mean) {
                    weight *= R::HALF;
                }
                at = self.next(seen, theta, Some(key));
            }
        };
        let (mut sum, mut total) = (R::ZERO, R::ZERO);
        visit(&mut |k, weight| {
            sum += self.turn(seen, k, theta) * weight;
            total += weight;
        });
        if total <= R::ZERO {
            return None;
        }
        if !matches!(self.combination, Combination::One) {
            return Some(sum / total);
        }
        let (mut left, mut chosen) = (draws.number::<R>("u", 1.0, |s| s.uniform(3)) * total, R::ZERO);
        visit(&mut |k, weight| {
            if left >= R::ZERO {
                chosen = self.turn(seen, k, theta);
            }
            left -= weight;
        });
        Some(chosen)
    }
}

impl<R: Scalar> Model<R, 2> for School<R> {
    fn sets(&self) -> Vec<NamedSet<R, 2>> {
        let view = Perception::angle(R::TAU - self.blind_angle);
        vec![NamedSet::new("neighbours", Perception::distance(R::ZERO, self.attraction_radius).both(view))]
    }
    fn decide(&self, me: &mut Me<'_, R, 2>, seen: &Percepts<'_, R, 2>, draws: &Draws<'_>) -> Motion<R, 2> {
        let theta = me.velocity.angle();
        let asked = self.combined(seen, theta, draws);
        me.either(["follow neighbours", "search"], usize::from(asked.is_none()));
        let turn = match asked {
            Some(turn) => turn,
            None => draws.number("search", 0.0, |s| core::f64::consts::TAU * (0.5 - s.uniform(2))),
        };
        me.value("turn", turn, "rad");
        let noise = angle_noise(self.noise_deviation, me, draws);
        let velocity = facing(turned(theta, turn + noise)) * self.speed;
        me.unit("length/time");
        me.note("turned heading", velocity);
        me.sum(velocity);
        Motion::new_velocity(velocity, self.time_step)
    }
}
