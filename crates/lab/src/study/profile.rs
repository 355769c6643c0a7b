//! How uneven the density of a group is along its mean heading, or across it: where there are bands, and which way they lie.

use super::form::Statistic;
use super::trial::{Look, Reader, Values};
use crate::form;
use space::{Edge, Real, Vector};
use swarm::World;
use swarm::parameters::Scalar;

form! {
    /// How uneven the density is along the mean heading: the greatest over the mean of so many strips of a square about the middle of the
    /// space, turned to the mean heading and as wide as the space; members beyond a periodic edge count with their images (2-D).
    pub struct ProfileReading {
        /// Whether the strips follow each other across the mean heading, in place of along it.
        across: bool = [false], "", Any;
        /// Number of strips.
        strips: usize = [32usize], "1", Within(2.0, 1000.0);
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// What is made of its values.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

/// A side of the space, and whether it goes round.
type Side = (f64, bool);

/// The greatest number of members in a strip over the mean number. `None` where there is no mean heading, or nobody in the square.
fn unevenness(
    places: &[Vector<f64, 2>],
    velocities: &[Vector<f64, 2>],
    sides: [Side; 2],
    across: bool,
    strips: usize,
) -> Option<f64> {
    let headings = velocities.iter().fold(Vector::ZERO, |sum, velocity| sum + velocity.unit());
    let along = (headings / places.len().max(1) as f64).unit();
    if along.is_tiny() {
        return None;
    }
    let along = if across { along.left() } else { along };
    let side = sides[0].0.min(sides[1].0);
    let images = |(length, round): Side| {
        let shifts: &[f64] = if round { &[-1.0, 0.0, 1.0] } else { &[0.0] };
        shifts.iter().map(move |shift| (shift - 0.5) * length)
    };
    let mut counts = vec![0u32; strips];
    for place in places {
        for x in images(sides[0]) {
            for y in images(sides[1]) {
                let from_middle = *place + Vector([x, y]);
                let [ahead, aside] = [along, along.left()].map(|axis| from_middle.dot(axis) / side + 0.5);
                if (0.0..1.0).contains(&ahead) && (0.0..1.0).contains(&aside) {
                    counts[((ahead * strips as f64) as usize).min(strips - 1)] += 1;
                }
            }
        }
    }
    let (all, most) = (counts.iter().sum::<u32>(), counts.iter().max()?);
    (all > 0).then(|| f64::from(*most) * strips as f64 / f64::from(all))
}

pub(super) struct Profile {
    sides: [Side; 2],
    reading: ProfileReading,
    values: Values,
}

impl Profile {
    /// # Errors
    /// Another number of dimensions, or a space without an end.
    pub(super) fn new<R: Scalar, const D: usize>(
        reading: &ProfileReading,
        world: &World<R, D>,
    ) -> Result<Self, String> {
        if D != 2 {
            return Err(format!("the profile of density is defined in 2 dimensions, found {D}"));
        }
        let side = |axis: usize| match world.frame().space.edges[axis] {
            Edge::Open => Err("the profile of density needs a space that ends on both axes".to_owned()),
            Edge::Walls(length) => Ok((Real::to_f64(length), false)),
            Edge::Periodic(length) => Ok((Real::to_f64(length), true)),
        };
        let values = Values::new(reading.statistic);
        Ok(Self { sides: [side(0)?, side(1)?], reading: reading.clone(), values })
    }
}

impl<R: Scalar, const D: usize> Reader<R, D> for Profile {
    fn look(&mut self, look: &Look<'_, R, D>) {
        if look.window {
            let flat = |v: &Vector<f64, D>| Vector([v.0[0], v.0[D - 1]]);
            let places: Vec<_> = look.positions.iter().map(flat).collect();
            let velocities: Vec<_> = look.velocities.iter().map(flat).collect();
            let ProfileReading { across, strips, .. } = self.reading;
            self.values.add(unevenness(&places, &velocities, self.sides, across, strips));
        }
    }
    fn value(&self, _: &World<R, D>) -> Option<f64> {
        self.values.value().map(|value| self.reading.scale * value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice of 40 by 40 in a box of 40, of which everyone beyond `from` along x is moved into a band as wide as 4.
    fn unevenness_of(heading: Vector<f64, 2>, from: f64, across: bool) -> Option<f64> {
        let place = |k: u32| {
            let (x, y) = (f64::from(k % 40) + 0.5, f64::from(k / 40) + 0.5);
            Vector([if x > from { from + (x - from) * 4.0 / (40.0 - from) } else { x }, y])
        };
        let places: Vec<_> = (0..1600).map(place).collect();
        unevenness(&places, &vec![heading; 1600], [(40.0, true); 2], across, 10)
    }

    #[test]
    fn a_band_and_an_even_lattice() {
        // half of everyone in a tenth of the length: 5 times the mean, along the heading and not across it
        let right = Vector([1.0, 0.0]);
        assert_eq!(unevenness_of(right, 20.0, false), Some(5.0));
        assert_eq!(unevenness_of(right, 20.0, true), Some(1.0));
        // the same band seen by members who move along it
        assert_eq!(unevenness_of(Vector([0.0, -2.0]), 20.0, true), Some(5.0));
        assert_eq!(unevenness_of(Vector([0.0, -2.0]), 20.0, false), Some(1.0));
        // an even lattice is nearly even in a square that is turned, images and all
        let turned = unevenness_of(Vector([3.0, 1.0]), 39.9, false);
        assert!(turned.is_some_and(|most| (1.0..1.1).contains(&most)), "{turned:?}");
    }

    #[test]
    fn no_common_heading_no_profile() {
        let places = [Vector([1.0, 1.0]), Vector([2.0, 1.0])];
        let opposed = [Vector([1.0, 0.0]), Vector([-1.0, 0.0])];
        assert_eq!(unevenness(&places, &opposed, [(10.0, true); 2], false, 4), None);
        assert_eq!(unevenness(&[], &[], [(10.0, true); 2], false, 4), None);
    }
}
