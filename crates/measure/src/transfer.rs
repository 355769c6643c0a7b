//! How a turn passes through a group: who turns when, after one of them has met something, and how far away.

use crate::statistics::spearman;
use space::{Space, Vector};

/// A member as it stood when it began.
#[derive(Clone, Debug)]
struct Member<const D: usize> {
    id: usize,
    place: Vector<f64, D>,
    heading: Vector<f64, D>,
    /// Time from the beginning to the look at which its heading had changed by the angle.
    turned: Option<f64>,
}

/// A turn that passes through a group. It begins with the first look at which somebody has met something; that one is the first. Each of
/// the others turns at the first look at which its heading differs by more than an angle from what it was at the beginning.
#[derive(Clone, Debug)]
pub struct Transfer<const D: usize> {
    angle: f64,
    began: Option<f64>,
    first: usize,
    members: Vec<Member<D>>,
}

impl<const D: usize> Transfer<D> {
    /// For turns by more than `angle` (rad).
    pub fn new(angle: f64) -> Self {
        Self { angle, began: None, first: 0, members: Vec::new() }
    }
    /// Takes in a look; `met` tells who has met something, by place. Members are known by id.
    pub fn look(
        &mut self,
        time: f64,
        ids: &[usize],
        places: &[Vector<f64, D>],
        velocities: &[Vector<f64, D>],
        met: impl Fn(usize) -> bool,
    ) {
        let Some(began) = self.began else {
            if let Some(first) = (0..ids.len()).find(|&k| met(k)) {
                self.began = Some(time);
                self.first = first;
                let member =
                    |k: usize| Member { id: ids[k], place: places[k], heading: velocities[k].unit(), turned: None };
                self.members = (0..ids.len()).map(member).collect();
            }
            return;
        };
        for member in self.members.iter_mut().filter(|member| member.turned.is_none()) {
            if let Ok(k) = ids.binary_search(&member.id)
                && member.heading.angle_to(velocities[k]) > self.angle
            {
                member.turned = Some(time - began);
            }
        }
    }
    /// Distance from the first at the beginning, and delay, of each other that has turned.
    pub fn delays(&self, space: &Space<f64, D>) -> Vec<(f64, f64)> {
        let Some(first) = self.members.get(self.first) else { return Vec::new() };
        let others = self.members.iter().enumerate().filter(|(k, _)| *k != self.first);
        others.filter_map(|(_, m)| Some((space.offset(first.place, m.place).length(), m.turned?))).collect()
    }
    /// Share of the others that have turned; none before it has begun, or where there are no others.
    pub fn share(&self) -> Option<f64> {
        let others = self.members.len().checked_sub(1).filter(|&others| others > 0)?;
        let turned = self.members.iter().enumerate().filter(|(k, m)| *k != self.first && m.turned.is_some()).count();
        Some(turned as f64 / others as f64)
    }
    /// Delay of the rearmost: of whom stood last along the mean heading at the beginning.
    pub fn rearmost(&self, space: &Space<f64, D>) -> Option<f64> {
        let first = self.members.get(self.first)?;
        let heading = self.members.iter().fold(Vector::ZERO, |sum, member| sum + member.heading);
        let along = |member: &Member<D>| space.offset(first.place, member.place).dot(heading);
        self.members.iter().min_by(|a, b| along(a).total_cmp(&along(b)))?.turned
    }
    /// Speed at which the turn spreads: of the line through the origin that gives delays from distances with the least squares.
    pub fn speed(&self, space: &Space<f64, D>) -> Option<f64> {
        let delays = self.delays(space);
        let (squares, products) = delays
            .iter()
            .fold((0.0, 0.0), |(s, p), &(distance, delay)| (s + distance * distance, p + distance * delay));
        (products > 0.0).then(|| squares / products)
    }
    /// Rank correlation of delay and distance.
    pub fn correlation(&self, space: &Space<f64, D>) -> Option<f64> {
        let (distances, delays): (Vec<f64>, Vec<f64>) = self.delays(space).into_iter().unzip();
        spearman(&distances, &delays, 0.95).ok().map(|found| found.r)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_through_a_row() {
        let space = Space::open();
        let places: Vec<_> = (0..5).map(|k| Vector([-3.0 * f64::from(k), 0.0])).collect();
        let mut turn = Transfer::new(0.5);
        // member k turns at look 2 k + 1, one every two looks of 0.5: 3 in 1
        for look in 0..=8 {
            let heading = |k: usize| if look > 2 * k { Vector([0.0, 2.0]) } else { Vector([2.0, 0.0]) };
            let velocities: Vec<_> = (0..5).map(heading).collect();
            turn.look(0.5 * look as f64, &[3, 4, 5, 6, 7], &places, &velocities, |k| k == 0);
        }
        assert_eq!(turn.share(), Some(0.75), "the last has not turned yet");
        let delays = turn.delays(&space);
        assert_eq!(delays, vec![(3.0, 1.5), (6.0, 2.5), (9.0, 3.5)]);
        assert_eq!(turn.rearmost(&space), None);
        assert!((turn.speed(&space).unwrap_or(0.0) - 126.0 / (4.5 + 15.0 + 31.5)).abs() < 1e-12);
        assert!((turn.correlation(&space).unwrap_or(0.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nobody_who_meets_anything_is_no_turn() {
        let mut turn = Transfer::<2>::new(0.5);
        turn.look(0.0, &[0], &[Vector::ZERO], &[Vector([1.0, 0.0])], |_| false);
        assert_eq!((turn.share(), turn.speed(&Space::open())), (None, None));
    }
}
