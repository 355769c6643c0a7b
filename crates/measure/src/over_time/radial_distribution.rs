//! How many neighbours there are at a distance, in units of a group spread evenly: 1 where there is no structure.

use super::velocity_correlation::{BIN_WIDTH, BINS};
use crate::Sample;
use crate::hull::solid_hull;
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

takes! {
    /// `radial_distribution`.
    pub struct RadialDistribution { bin_width: BIN_WIDTH, bins: BINS }
}

impl TrackMetric for RadialDistribution {
    const CARD: TrackCard = TrackCard {
        id: "radial_distribution",
        title: "Radial distribution function",
        definition: "g(r) = pairs in the bin / pairs expected there: sum over frames of N (N - 1) / 2 times the \
                    volume of the shell over that of the group's room",
        variant: "room: the box where all axes are bounded, else the hull of the frame (on a line its length); no \
                    correction at its edge",
        source: "textbook",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::number("r_low", "length", "Lower end of the bin, included."),
            Field::number("r_high", "length", "Upper end of the bin."),
            Field::number("g", "1", "g(r)."),
            Field::count("pairs", "Pairs in the bin, of all frames."),
        ],
        edge: "NaN without room",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let bins = self.bins as usize;
        let (mut pairs, mut expected) = (vec![0.0; bins], 0.0);
        let mut sample = Sample::empty();
        for frame in 0..tracks.frames().len() {
            tracks.sample_into(frame, &mut sample);
            let Some(room) = room(&sample) else { continue };
            let n = sample.len() as f64;
            expected += n * (n - 1.0) / 2.0 / room;
            sample.each_pair(|_, _, distance| {
                if let Some(count) = pairs.get_mut((distance / self.bin_width).floor() as usize) {
                    *count += 1.0;
                }
            });
        }
        let ball = |r: f64| match D {
            1 => 2.0 * r,
            2 => core::f64::consts::PI * r * r,
            _ => 4.0 / 3.0 * core::f64::consts::PI * r * r * r,
        };
        for (bin, &count) in pairs.iter().enumerate() {
            let [low, high] = [bin as f64 * self.bin_width, (bin + 1) as f64 * self.bin_width];
            found.push([low, high, count / (expected * (ball(high) - ball(low))), count]);
        }
        Ok(found)
    }
}

/// The room of a group: of its box, or of its hull.
fn room<const D: usize>(sample: &Sample<D>) -> Option<f64> {
    let sides: Option<Vec<f64>> = (0..D).map(|a| sample.space().side(a)).collect();
    let room = match (sides, D) {
        (Some(sides), _) => sides.iter().product(),
        (None, 1) => sample.domains_of_danger()?.iter().sum(),
        (None, 2) => sample.hull()?.area,
        _ => solid_hull(&Vec::from_iter(sample.unwrapped()?.iter().map(|place| Vector::of(&place.0))))?.0,
    };
    (room > 0.0).then_some(room)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn a_ring_of_even_steps() -> Fine {
        // 10 on a ring of length 10: each has two at 1, two at 2, ...
        let found = RadialDistribution { bin_width: 1.0, bins: 4.0 };
        let found = found.on(&tracks(Space::periodic([10.0]), 1.0, 3, 10, |_, k| Some([f64::from(k)]))?)?;
        close(&found.columns[3], &[0.0, 30.0, 30.0, 30.0]);
        // expected in a shell of length 2: 45 pairs times 2/10
        close(&found.columns[2], &[0.0, 10.0 / 9.0, 10.0 / 9.0, 10.0 / 9.0]);
        let square = |_: i64, k: u32| Some([f64::from(k % 2), f64::from(k / 2)]);
        let open = RadialDistribution { bin_width: 2.0, bins: 1.0 }.on(&tracks(Space::open(), 1.0, 1, 4, square)?)?;
        close(&open.row(0), &[0.0, 2.0, 1.0 / (4.0 * core::f64::consts::PI), 6.0]);
        Ok(())
    }
}
