//! How long individuals keep their heading: exp(-lag/P) in a walk of persistence P.

use super::lags::{LAGS, MAX_LAG, lags, over_pairs};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

takes! {
    /// `heading_autocorrelation`.
    pub struct HeadingAutocorrelation { max_lag: MAX_LAG, lags: LAGS }
}

impl TrackMetric for HeadingAutocorrelation {
    const CARD: TrackCard = TrackCard {
        id: "heading_autocorrelation",
        title: "Heading autocorrelation",
        definition: "C(lag) = mean over individuals and times t of h(t) . h(t + lag),  h = v/|v|",
        variant: "overlapping windows, direct; every pair of moments of an individual that far apart, gaps left \
                    out; unit headings, individuals at rest left out",
        source: "textbook",
        counted: Counted::Headings,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::number("lag", "s", "The lag."),
            Field::count("frames", "The lag in frames."),
            Field::number("correlation", "1", "Mean cosine of the angle between the headings."),
            Field::count("pairs", "Pairs of moments that were averaged."),
        ],
        edge: "no row without two frames (an error that says so)",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let (mut lags, interval) = lags(Self::CARD.id, tracks, self.max_lag, self.lags)?;
        lags.insert(0, 0);
        let cosine = |one: Vector<f64, D>, other: Vector<f64, D>| one.dot(other);
        for lagged in over_pairs(tracks, &lags, interval, |row| tracks.heading(row), cosine) {
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
    fn a_circle_turns_back() -> Fine {
        let place = |frame: i64, _: u32| {
            let angle = (30.0 * frame as f64).to_radians();
            Some([angle.cos(), angle.sin()])
        };
        let found =
            HeadingAutocorrelation { max_lag: 6.0, lags: 9.0 }.on(&tracks(Space::open(), 1.0, 20, 1, place)?)?;
        let cosines: Vec<f64> = (0..7).map(|k| (30.0 * f64::from(k)).to_radians().cos()).collect();
        close(&found.columns[2], &cosines);
        close(&found.columns[3], &[19.0, 18.0, 17.0, 16.0, 15.0, 14.0, 13.0]);
        Ok(())
    }
}
