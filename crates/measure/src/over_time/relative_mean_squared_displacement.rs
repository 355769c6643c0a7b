//! How far individuals get within their group: the displacement seen from the centre.

use super::lags::{LAGS, MAX_LAG, at, from_centre, lags, over_pairs};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

takes! {
    /// `relative_mean_squared_displacement`.
    pub struct RelativeMeanSquaredDisplacement { max_lag: MAX_LAG, lags: LAGS }
}

impl TrackMetric for RelativeMeanSquaredDisplacement {
    const CARD: TrackCard = TrackCard {
        id: "relative_mean_squared_displacement",
        title: "Mean squared displacement relative to the centre",
        definition: "MSD(lag) = mean over individuals and starts t of |r(t + lag) - r(t)|^2,  r = x - c,  c the \
                    centre of those found in the frame",
        variant: "overlapping windows, direct; every pair of moments of an individual that far apart, gaps left \
                    out; the centre changes where individuals come and go",
        source: "textbook",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::number("lag", "s", "The lag."),
            Field::count("frames", "The lag in frames."),
            Field::number("msd", "length^2", "Mean squared displacement relative to the centre."),
            Field::count("pairs", "Pairs of moments that were averaged."),
        ],
        edge: "no row without two frames (an error that says so)",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let (lags, interval) = lags(Self::CARD.id, tracks, self.max_lag, self.lags)?;
        let places = from_centre(tracks);
        let square = |from: Vector<f64, D>, to: Vector<f64, D>| (to - from).length_squared();
        for lagged in over_pairs(tracks, &lags, interval, |row| at(&places, row), square) {
            found.push([lagged.time, lagged.lag as f64, lagged.mean(), lagged.pairs as f64]);
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
    fn the_way_of_the_group_does_not_count() -> Fine {
        // two that drift together and part by 1 to either side in each frame
        let place = |frame: i64, k: u32| Some([7.0 * frame as f64 + if k == 0 { -1.0 } else { 1.0 } * frame as f64]);
        let found = RelativeMeanSquaredDisplacement { max_lag: 3.0, lags: 9.0 }.on(&tracks(
            Space::open(),
            1.0,
            6,
            2,
            place,
        )?)?;
        close(&found.columns[2], &[1.0, 4.0, 9.0]);
        close(&found.columns[3], &[10.0, 8.0, 6.0]);
        Ok(())
    }
}
