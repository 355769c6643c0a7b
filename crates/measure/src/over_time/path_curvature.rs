//! How much each individual turns on its way.

use super::lags::{each_step, which};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `path_curvature`.
    pub struct PathCurvature {  }
}

impl TrackMetric for PathCurvature {
    const CARD: TrackCard = TrackCard {
        id: "path_curvature",
        title: "Path curvature",
        definition: "sum of the angles between headings of frames that follow each other / sum of the ways between \
                    these frames: the mean absolute turning over the mean way",
        variant: "absolute turning per length, in degrees; individuals at rest left out",
        source: "catalogue of models, section 5; behaviour selection, section 7",
        counted: Counted::Headings,
        dimensions: &[2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::individual("individual", "The individual; the last row is of all together."),
            Field::number("curvature", "deg/length", "Absolute turning per length."),
            Field::number("turning", "deg", "Mean absolute turning from frame to frame."),
            Field::count("frames", "Frames with a turning."),
        ],
        edge: "NaN where no two headings follow each other",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let count = tracks.names().len();
        let mut sums = vec![[0.0; 3]; count + 1];
        each_step(tracks, |individual, old, new, _| {
            if let (Some(before), Some(now)) = (tracks.heading(old), tracks.heading(new)) {
                let turning = before.angle_to(now).to_degrees();
                let way = tracks.offset(tracks.position(old), tracks.position(new)).length();
                for k in [individual, count] {
                    sums[k] = [sums[k][0] + turning, sums[k][1] + way, sums[k][2] + 1.0];
                }
            }
        });
        for (k, &[turning, way, frames]) in sums.iter().enumerate() {
            found.push([which(k, count), turning / way, turning / frames, frames]);
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
    fn round_a_square() -> Fine {
        let place = |frame: i64, _: u32| Some([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]][frame as usize % 4]);
        let found = PathCurvature {}.on(&tracks(Space::open(), 1.0, 9, 1, place)?)?;
        close(&found.row(0), &[0.0, 45.0, 90.0, 7.0]);
        Ok(())
    }
}
