//! How much each individual speeds up, slows down and turns.

use super::lags::{each_step, which};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `acceleration`.
    pub struct Acceleration {  }
}

impl TrackMetric for Acceleration {
    const CARD: TrackCard = TrackCard {
        id: "acceleration",
        title: "Acceleration of individuals",
        definition: "mean and greatest of |a|,  a(t) = (v(t) - v(t-1)) / dt,  over frames that follow each other",
        variant: "length of the change of velocity, by backward difference; on the globe of its components east \
                    and north",
        source: "plain",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::individual("individual", "The individual; the last row is of all together."),
            Field::number("mean", "length/s^2", "Mean acceleration."),
            Field::number("max", "length/s^2", "Greatest acceleration."),
            Field::count("frames", "Frames with an acceleration."),
        ],
        edge: "NaN where no two velocities follow each other",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let count = tracks.names().len();
        let mut sums = vec![(0.0, f64::NAN, 0.0); count + 1];
        each_step(tracks, |individual, old, new, dt| {
            if let (Some(before), Some(now)) = (tracks.velocity(old), tracks.velocity(new)) {
                let length = ((now - before) / dt).length();
                for k in [individual, count] {
                    let (sum, most, frames) = sums[k];
                    sums[k] = (sum + length, most.max(length), frames + 1.0);
                }
            }
        });
        for (k, &(sum, most, frames)) in sums.iter().enumerate() {
            found.push([which(k, count), sum / frames, most, frames]);
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
    fn closed_forms() -> Fine {
        // x = t^2 with t = frame/2: differences of 1 in speed, times 2
        let place = |frame: i64, _: u32| Some([0.25 * (frame * frame) as f64]);
        let found = Acceleration {}.on(&tracks(Space::open(), 2.0, 5, 1, place)?)?;
        close(&found.row(0), &[0.0, 2.0, 2.0, 3.0]);
        close(&found.row(1), &[-1.0, 2.0, 2.0, 3.0]);
        Ok(())
    }
}
