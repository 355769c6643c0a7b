//! Where a group goes, seen from a direction.

use super::trial::{Look, Reader};
use crate::{form, words};
use space::Vector;
use swarm::World;
use swarm::parameters::Scalar;

words! {
    /// What is read off the way of a group.
    pub enum BearingQuantity {
        /// Cosine of the angle between its way and the direction: 1 for straight on. Its mean over trials is an accuracy.
        Cosine = "cosine",
        /// That angle, from 0 to 180 degrees.
        Angle = "angle",
    }
}

form! {
    /// Which way the centre of the members went from the first look to the last.
    pub struct BearingReading {
        /// The direction from which it is measured, as a vector of any length.
        direction: Vec<f64> = need, "1", Any;
        /// What.
        quantity: BearingQuantity = [BearingQuantity::Cosine], "", Any;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
    }
}

pub(super) struct Bearing<const D: usize> {
    reading: BearingReading,
    direction: Vector<f64, D>,
    group: Option<usize>,
    /// Ids and places at the first look.
    first: Option<Vec<(usize, Vector<f64, D>)>>,
    /// The sum of the ways of those who are still there.
    way: Vector<f64, D>,
}

impl<const D: usize> Bearing<D> {
    /// # Errors
    /// A direction of another number of components, or of no length.
    pub(super) fn new(reading: &BearingReading, group: Option<usize>) -> Result<Self, String> {
        if reading.direction.len() != D {
            let found = reading.direction.len();
            return Err(format!("`direction` has {found} components in {D} dimensions"));
        }
        let direction = Vector::<f64, D>::of(&reading.direction).unit();
        if direction.is_tiny() {
            return Err("`direction` has no length".into());
        }
        Ok(Self { reading: reading.clone(), direction, group, first: None, way: Vector::ZERO })
    }
    fn of(&self, way: Vector<f64, D>) -> Option<f64> {
        (!way.is_tiny()).then(|| match self.reading.quantity {
            BearingQuantity::Cosine => way.unit().dot(self.direction),
            BearingQuantity::Angle => way.angle_to(self.direction).to_degrees(),
        })
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Bearing<D> {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if !look.window {
            return;
        }
        let Some(first) = &self.first else {
            self.first = Some(look.members(self.group).iter().map(|&k| (look.ids[k], look.positions[k])).collect());
            return;
        };
        self.way = Vector::ZERO;
        for &(id, place) in first {
            if let Ok(k) = look.ids.binary_search(&id) {
                self.way += look.space.offset(place, look.positions[k]);
            }
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.of(self.way).map(|value| self.reading.scale * value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_from_a_direction() {
        let reading = |direction: &[f64], quantity| BearingReading {
            direction: direction.to_vec(),
            quantity,
            scale: 1.0,
            group: None,
        };
        let of = |quantity, way: [f64; 2]| {
            let bearing = Bearing::<2>::new(&reading(&[3.0, 0.0], quantity), None).ok()?;
            bearing.of(Vector(way))
        };
        assert_eq!(of(BearingQuantity::Cosine, [5.0, 0.0]), Some(1.0));
        assert_eq!(of(BearingQuantity::Cosine, [-5.0, 0.0]), Some(-1.0));
        let angle = of(BearingQuantity::Angle, [2.0, -2.0]);
        assert!(angle.is_some_and(|angle| (angle - 45.0).abs() < 1e-9), "{angle:?}");
        assert_eq!(of(BearingQuantity::Angle, [0.0, 0.0]), None, "nobody went anywhere");
        let wrong = |direction: &[f64]| Bearing::<2>::new(&reading(direction, BearingQuantity::Angle), None).err();
        assert!(wrong(&[1.0]).is_some_and(|what| what.contains("1 components in 2 dimensions")));
        assert!(wrong(&[0.0, 0.0]).is_some_and(|what| what.contains("no length")));
    }
}
