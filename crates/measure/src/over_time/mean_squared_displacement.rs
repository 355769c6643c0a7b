//! How far individuals get in a time: slope 2 on log-log axes where they go straight, 1 in a random walk.

use super::lags::{LAGS, MAX_LAG, at, lags, over_pairs, unwrapped};
use crate::Ground;
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

takes! {
    /// `mean_squared_displacement`.
    pub struct MeanSquaredDisplacement { max_lag: MAX_LAG, lags: LAGS }
}

impl TrackMetric for MeanSquaredDisplacement {
    const CARD: TrackCard = TrackCard {
        id: "mean_squared_displacement",
        title: "Mean squared displacement",
        definition: "MSD(lag) = mean over individuals and starts t of |x(t + lag) - x(t)|^2",
        variant: "overlapping windows, direct; every pair of moments of an individual that far apart, gaps left \
                    out; on periodic axes along the way, on the globe the geodesic",
        source: "textbook",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::number("lag", "s", "The lag."),
            Field::count("frames", "The lag in frames."),
            Field::number("msd", "length^2", "Mean squared displacement."),
            Field::count("pairs", "Pairs of moments that were averaged."),
        ],
        edge: "no row without two frames (an error that says so)",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let (lags, interval) = lags(Self::CARD.id, tracks, self.max_lag, self.lags)?;
        let places = unwrapped(tracks);
        let square = |from: Vector<f64, D>, to: Vector<f64, D>| match tracks.ground() {
            Ground::Plane(_) => (to - from).length_squared(),
            Ground::Globe => tracks.offset(from, to).length_squared(),
        };
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
    fn straight_walks_and_gaps() -> Fine {
        let ring = Space::periodic([10.0, 10.0]);
        let straight = |frame: i64, _: u32| (frame != 4).then_some([(1.5 * frame as f64) % 10.0, 0.0]);
        let tracks = tracks(ring, 2.0, 9, 1, straight)?;
        let found = MeanSquaredDisplacement { max_lag: 1.5, lags: 9.0 }.on(&tracks)?;
        close(&found.row(0), &[0.5, 1.0, 2.25, 6.0]);
        close(&found.row(2), &[1.5, 3.0, 20.25, 4.0]);
        assert_eq!(found.len(), 3);
        let few = MeanSquaredDisplacement { max_lag: 4.0, lags: 2.0 }.on(&tracks)?;
        close(&few.columns[1], &[4.0, 8.0]);
        Ok(())
    }

    #[test]
    fn the_lag_must_be_told() -> Fine {
        let tracks = tracks(Space::open(), 1.0, 3, 1, |frame, _| Some([frame as f64]))?;
        let error = MeanSquaredDisplacement::default().on(&tracks).map(drop).map_err(|error| error.to_string());
        assert!(error.is_err_and(|error| error.contains("needs a value for `max_lag`")));
        assert!(MeanSquaredDisplacement { max_lag: 0.5, lags: 9.0 }.on(&tracks).is_err());
        Ok(())
    }
}
