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

    /// Numbers in [0, 1), the same in every run (splitmix64).
    fn number(place: u64) -> f64 {
        let mut z = place.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The places of walkers who turn by an angle uniform in +- `turn` before each step of 1.
    fn walks(walkers: u64, steps: i64, turn: f64) -> Vec<Vec<[f64; 2]>> {
        let walk = |walker: u64| {
            let mut at = [0.0, 0.0];
            let mut angle = number(walker + 1) * core::f64::consts::TAU;
            let one = |step: i64| {
                let here = at;
                angle += (2.0 * number((walker << 32) + step as u64 + 7) - 1.0) * turn;
                at = [at[0] + angle.cos(), at[1] + angle.sin()];
                here
            };
            (0..steps).map(one).collect()
        };
        (0..walkers).map(walk).collect()
    }

    #[test]
    fn persistent_walks_turn_from_straight_to_random() -> Fine {
        // headings a step apart have the mean cosine sin(a)/a, and so persist for P = -1/ln(sin(a)/a) steps
        let turn = 0.5f64;
        let cosine = turn.sin() / turn;
        let places = walks(300, 601, turn);
        let place = |frame: i64, k: u32| Some(places[k as usize][frame as usize]);
        let found = MeanSquaredDisplacement { max_lag: 300.0, lags: 300.0 }.on(&tracks(
            Space::open(),
            1.0,
            601,
            300,
            place,
        )?)?;
        for lag in [1usize, 5, 20, 100, 300] {
            let n = lag as f64;
            // exact for steps; 2 v^2 P (t - P (1 - exp(-t/P))) where steps are short beside P
            let steps =
                n * (1.0 + cosine) / (1.0 - cosine) - 2.0 * cosine * (1.0 - cosine.powf(n)) / (1.0 - cosine).powi(2);
            let persistence = -1.0 / cosine.ln();
            let formula = 2.0 * persistence * (n - persistence * (1.0 - (-n / persistence).exp()));
            let msd = found.columns[2][lag - 1];
            assert!((msd / steps - 1.0).abs() < 0.08, "lag {lag}: {msd}, expected {steps}");
            assert!((msd / formula - 1.0).abs() < 0.08, "lag {lag}: {msd}, expected {formula}");
        }
        Ok(())
    }

    #[test]
    fn slopes_of_unbiased_and_of_confined_walks() -> Fine {
        let places = walks(300, 401, core::f64::consts::PI);
        let free = |frame: i64, k: u32| Some(places[k as usize][frame as usize]);
        // folded into a box of side 6 by mirrors: a plateau of twice the variance of both axes, 2 * 2 * 36 / 12
        let fold = |x: f64| {
            let x = x.rem_euclid(12.0);
            x.min(12.0 - x)
        };
        let confined = |frame: i64, k: u32| Some(places[k as usize][frame as usize].map(fold));
        let metric = MeanSquaredDisplacement { max_lag: 200.0, lags: 200.0 };
        let free = metric.on(&tracks(Space::open(), 1.0, 401, 300, free)?)?;
        let slope = (free.columns[2][99] / free.columns[2][3]).ln() / 25f64.ln();
        assert!((slope - 1.0).abs() < 0.05, "{slope}");
        let confined = metric.on(&tracks(Space::open(), 1.0, 401, 300, confined)?)?;
        for lag in [99, 149, 199] {
            let plateau = confined.columns[2][lag];
            assert!((plateau / 12.0 - 1.0).abs() < 0.05, "{plateau}");
        }
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
