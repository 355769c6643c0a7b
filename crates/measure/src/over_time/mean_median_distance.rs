//! How far the middle individual is from the centre in the last frame. The mean median distance (MMD) is its mean over runs; see `over_runs`.

use crate::Metric;
use crate::metric::takes;
use crate::metrics::median_distance_to_centre::MedianDistanceToCentre;
use crate::sample::mean;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `mean_median_distance`.
    pub struct MeanMedianDistance {  }
}

impl TrackMetric for MeanMedianDistance {
    const CARD: TrackCard = TrackCard {
        id: "mean_median_distance",
        title: "Median distance in the last frame",
        definition: "median_i |x_i - c| in the last frame that has anyone",
        variant: "the median of one run; the MMD is the mean over runs",
        source: "catalogue of models, section 5 (MMD)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::number("median_distance", "length", "Median distance to the centre."),
            Field::count("individuals", "Individuals in the frame."),
        ],
        edge: "no row without anyone",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        if let Some(frame) = (0..tracks.frames().len()).rev().find(|&frame| !tracks.rows(frame).is_empty()) {
            let sample = tracks.sample(frame);
            let distance = MedianDistanceToCentre.on(&sample).unwrap_or(f64::NAN);
            found.push([tracks.frames()[frame] as f64, tracks.times()[frame], distance, sample.len() as f64]);
        }
        Ok(found)
    }
}

/// The mean median distance (MMD): the mean over runs of the median distance to the centre in the last frame. `None` without runs.
pub fn over_runs<const D: usize>(runs: &[Tracks<D>]) -> Option<f64> {
    let last = |run: &Tracks<D>| MeanMedianDistance {}.listing(run).ok()?.columns[2].first().copied();
    mean(runs.iter().filter_map(last).filter(|distance| distance.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn the_worked_example_over_two_runs() -> Fine {
        let places = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [10.0, 10.0]];
        let run = |scale: f64| {
            tracks(Space::open(), 1.0, 2, 4, move |frame, k| {
                Some(places[k as usize].map(|x| x * if frame == 0 { 50.0 } else { scale }))
            })
        };
        let median = (10f64.sqrt() + 18f64.sqrt()) / 2.0;
        close(&MeanMedianDistance {}.on(&run(1.0)?)?.row(0), &[1.0, 1.0, median, 4.0]);
        close(&[over_runs(&[run(1.0)?, run(3.0)?]).unwrap_or(0.0)], &[2.0 * median]);
        assert_eq!(over_runs::<2>(&[]), None);
        Ok(())
    }
}
