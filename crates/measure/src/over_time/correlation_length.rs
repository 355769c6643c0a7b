//! How far an individual's departure from the common motion reaches: where the velocity correlation falls to zero.

use super::velocity_correlation::{BIN_WIDTH, BINS, Correlation};
use crate::Sample;
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `correlation_length`.
    pub struct CorrelationLength { bin_width: BIN_WIDTH, bins: BINS }
}

/// The distance at which the velocity correlation of a moment first falls to zero. `None` where it never does.
pub fn first_zero<const D: usize>(sample: &Sample<D>, bin_width: f64, bins: f64) -> Option<f64> {
    let mut sums = Correlation::new(bins);
    sums.add(sample, bin_width);
    let middle = |bin: usize| ((bin as f64 + 0.5) * bin_width, sums.of(bin));
    let known: Vec<(f64, f64)> = (0..sums.sums.len()).map(middle).filter(|(_, c)| c.is_finite()).collect();
    let falls = known.windows(2).find(|pair| pair[0].1 > 0.0 && pair[1].1 <= 0.0)?;
    let [(near, high), (far, low)] = [falls[0], falls[1]];
    Some(near + (far - near) * high / (high - low))
}

impl TrackMetric for CorrelationLength {
    const CARD: TrackCard = TrackCard {
        id: "correlation_length",
        title: "Correlation length",
        definition: "the distance at which C(r) of velocity_correlation in one frame first falls to zero, straight \
                    between the middles of the bins",
        variant: "first zero, frame by frame",
        source: "Cavagna et al. 2010",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::number("correlation_length", "length", "The first zero of C(r)."),
            Field::count("individuals", "Individuals with a velocity."),
        ],
        edge: "NaN where C never falls below zero",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sample = Sample::empty();
        for (frame, &number) in tracks.frames().iter().enumerate() {
            tracks.sample_into(frame, &mut sample);
            let length = first_zero(&sample, self.bin_width, self.bins).unwrap_or(f64::NAN);
            let members = sample.velocities().count() as f64;
            found.push([number as f64, tracks.times()[frame], length, members]);
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn half_way_between_alike_and_opposed() -> Fine {
        let place = |frame: i64, k: u32| {
            let side = if k < 2 { -1.0 } else { 1.0 };
            Some([side * (10.0 + frame as f64) + f64::from(k % 2), 0.0])
        };
        let found = CorrelationLength { bin_width: 5.0, bins: 6.0 }.on(&tracks(Space::open(), 1.0, 2, 4, place)?)?;
        // 1 at 2.5, -1 at 22.5
        close(&found.columns[2], &[f64::NAN, 12.5]);
        close(&found.columns[3], &[0.0, 4.0]);
        Ok(())
    }
}
