//! How alike two individuals depart from the common motion, by their distance.
//!
//! A. Cavagna, A. Cimarelli, I. Giardina, G. Parisi, R. Santagati, F. Stefanini, M. Viale (2010), Scale-free correlations in starling
//! flocks, PNAS 107:11865.

use crate::metric::takes;
use crate::sample::mean_vector;
use crate::{Bounds, Parameter, Sample};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

/// Width of a bin.
pub(super) const BIN_WIDTH: Parameter = Parameter {
    name: "bin_width",
    unit: "length",
    default: None,
    bounds: Bounds::Positive,
    about: "Width of a bin of distances.",
};

/// Number of bins.
pub(super) const BINS: Parameter = Parameter {
    name: "bins",
    unit: "1",
    default: Some(50.0),
    bounds: Bounds::Whole,
    about: "Number of bins; pairs beyond them are left out.",
};

/// What a frame adds to the correlation.
#[derive(Clone, Debug, Default)]
pub(super) struct Correlation {
    /// Sum of du_i . du_j by bin.
    pub(super) sums: Vec<f64>,
    /// Pairs by bin.
    pub(super) pairs: Vec<f64>,
    /// Sum of |du|^2.
    pub(super) squares: f64,
    /// Individuals with a velocity.
    pub(super) members: f64,
}

impl Correlation {
    pub(super) fn new(bins: f64) -> Self {
        let zeros = vec![0.0; bins as usize];
        Self { sums: zeros.clone(), pairs: zeros, squares: 0.0, members: 0.0 }
    }
    /// Adds the pairs of a frame.
    pub(super) fn add<const D: usize>(&mut self, sample: &Sample<D>, width: f64) {
        let Some(mean) = mean_vector(sample.velocities()) else { return };
        let fluctuation: Vec<_> = sample.known_velocities().iter().map(|v| v.map(|v| v - mean)).collect();
        for (i, du) in fluctuation.iter().enumerate() {
            let Some(du) = *du else { continue };
            self.squares += du.length_squared();
            self.members += 1.0;
            for (j, other) in fluctuation.iter().enumerate().skip(i + 1) {
                let Some(other) = *other else { continue };
                let bin = (sample.distance(i, j) / width).floor() as usize;
                if let (Some(sum), Some(pairs)) = (self.sums.get_mut(bin), self.pairs.get_mut(bin)) {
                    *sum += du.dot(other);
                    *pairs += 1.0;
                }
            }
        }
    }
    /// C of a bin; NaN without pairs or without fluctuations.
    pub(super) fn of(&self, bin: usize) -> f64 {
        self.sums[bin] / self.pairs[bin] / (self.squares / self.members)
    }
}

takes! {
    /// `velocity_correlation`.
    pub struct VelocityCorrelation { bin_width: BIN_WIDTH, bins: BINS }
}

impl TrackMetric for VelocityCorrelation {
    const CARD: TrackCard = TrackCard {
        id: "velocity_correlation",
        title: "Velocity correlation",
        definition: "C(r) = mean of du_i . du_j over pairs whose distance is in the bin / mean |du|^2,  du = v - mean \
                    v of the frame; pairs and individuals of all frames together",
        variant: "of whole velocities, not of directions; normed by the mean |du|^2, so that C is negative at \
                    large r",
        source: "Cavagna et al. 2010",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::number("r_low", "length", "Lower end of the bin, included."),
            Field::number("r_high", "length", "Upper end of the bin."),
            Field::number("correlation", "1", "C(r)."),
            Field::count("pairs", "Pairs in the bin, of all frames."),
        ],
        edge: "NaN in bins without pairs; no fluctuations: NaN",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sums = Correlation::new(self.bins);
        let mut sample = Sample::empty();
        for frame in 0..tracks.frames().len() {
            tracks.sample_into(frame, &mut sample);
            sums.add(&sample, self.bin_width);
        }
        for bin in 0..sums.sums.len() {
            let low = bin as f64 * self.bin_width;
            found.push([low, low + self.bin_width, sums.of(bin), sums.pairs[bin]]);
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
    fn two_halves_that_part() -> Fine {
        // the left pair goes left, the right pair right: alike within 1, opposed beyond
        let place = |frame: i64, k: u32| {
            let side = if k < 2 { -1.0 } else { 1.0 };
            Some([side * (10.0 + frame as f64) + f64::from(k % 2), 0.0])
        };
        let found = VelocityCorrelation { bin_width: 5.0, bins: 6.0 }.on(&tracks(Space::open(), 1.0, 2, 4, place)?)?;
        close(&found.columns[2], &[1.0, f64::NAN, f64::NAN, f64::NAN, -1.0, f64::NAN]);
        close(&found.columns[3], &[2.0, 0.0, 0.0, 0.0, 4.0, 0.0]);
        Ok(())
    }
}
