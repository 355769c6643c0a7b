//! How fast each individual is, and how far it goes.

use super::lags::{each_step, which};
use crate::metric::takes;
use crate::sample::{mean, spread};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `speed`.
    pub struct Speed {  }
}

impl TrackMetric for Speed {
    const CARD: TrackCard = TrackCard {
        id: "speed",
        title: "Speed of individuals",
        definition: "mean, standard deviation (divisor n - 1) and greatest of |v| over the frames in which it is \
                    known; the way is the sum of |x(t) - x(t-1)| over frames that follow each other",
        variant: "of given velocities where the source gives them, else by backward difference",
        source: "plain",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::individual("individual", "The individual; the last row is of all together."),
            Field::number("mean", "length/s", "Mean speed."),
            Field::number("sd", "length/s", "Standard deviation over frames."),
            Field::number("max", "length/s", "Greatest speed."),
            Field::number("way", "length", "Length of the way, gaps left out."),
            Field::count("frames", "Frames with a velocity."),
        ],
        edge: "NaN where no velocity is known",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let count = tracks.names().len();
        let mut speeds: Vec<Vec<f64>> = vec![Vec::new(); count + 1];
        for (row, &individual) in tracks.individuals().iter().enumerate() {
            if let Some(v) = tracks.velocity(row) {
                speeds[individual as usize].push(v.length());
                speeds[count].push(v.length());
            }
        }
        let mut way = vec![0.0; count + 1];
        each_step(tracks, |individual, old, new, _| {
            let length = tracks.offset(tracks.position(old), tracks.position(new)).length();
            way[individual] += length;
            way[count] += length;
        });
        for (k, speeds) in speeds.iter().enumerate() {
            let mean = mean(speeds.iter().copied()).unwrap_or(f64::NAN);
            let sd = spread(speeds).map_or(f64::NAN, |spread| spread.1);
            let most = speeds.iter().copied().fold(f64::NAN, f64::max);
            found.push([which(k, count), mean, sd, most, way[k], speeds.len() as f64]);
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
        let place = |frame: i64, k: u32| Some([if k == 0 { (frame * frame) as f64 } else { 0.0 }]);
        let found = Speed {}.on(&tracks(Space::open(), 2.0, 4, 2, place)?)?;
        close(&found.row(0), &[0.0, 6.0, 4.0, 10.0, 9.0, 3.0]);
        close(&found.row(1), &[1.0, 0.0, 0.0, 0.0, 0.0, 3.0]);
        close(&found.row(2)[..2], &[-1.0, 3.0]);
        Ok(())
    }
}
