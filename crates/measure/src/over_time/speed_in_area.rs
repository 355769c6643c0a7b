//! How fast people walk in an area.

use super::line::{X1, X2, Y1, Y2, corners, later, speed};
use crate::metric::takes;
use crate::sample::mean;
use crate::{Bounds, Parameter};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

/// For the speed.
const SPEED_FRAMES: Parameter = Parameter {
    name: "speed_frames",
    unit: "1",
    default: Some(5.0),
    bounds: Bounds::Whole,
    about: "A speed is the way from so many frames before to so many after, over the time.",
};

takes! {
    /// `speed_in_area`.
    pub struct SpeedInArea { x1: X1, y1: Y1, x2: X2, y2: Y2, speed_frames: SPEED_FRAMES }
}

impl TrackMetric for SpeedInArea {
    const CARD: TrackCard = TrackCard {
        id: "speed_in_area",
        title: "Speed in an area",
        definition: "mean over the individuals in the rectangle from (x1, y1) to (x2, y2) of \
                    |x(t + k) - x(t - k)| / 2k,  k the time of speed_frames",
        variant: "who is not found in one of the two frames: from, or to, the frame itself; who is on the edge is \
                    outside",
        source: "as the package PedPy counts, with single-sided borders",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::number("speed", "length/s", "Mean speed."),
            Field::count("individuals", "Individuals inside whose speed is known."),
        ],
        edge: "NaN where nobody is inside",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let (low, high) = corners(self.x1, self.y1, self.x2, self.y2);
        let frames = self.speed_frames as i64;
        for (frame, &number) in tracks.frames().iter().enumerate() {
            let inside =
                |row: &usize| (0..2).all(|a| low[a] < tracks.positions(a)[*row] && tracks.positions(a)[*row] < high[a]);
            let of = |row: usize| {
                let place = |shift| later(tracks, frame, tracks.individuals()[row] as usize, shift);
                let (from, to) = (place(-frames).unwrap_or((frame, row)), place(frames).unwrap_or((frame, row)));
                (from != to).then(|| speed(tracks, from, to))
            };
            let speeds: Vec<f64> = tracks.rows(frame).filter(inside).filter_map(of).collect();
            let speed = mean(speeds.iter().copied()).unwrap_or(f64::NAN);
            found.push([number as f64, tracks.times()[frame], speed, speeds.len() as f64]);
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
    fn squares_of_time() -> Fine {
        // x = t^2 at times 0, 1/2, ..., 2: the mean over [t - k, t + k] is 2 t, and at the borders that of half the time
        let place = |frame: i64, _: u32| Some([(frame * frame) as f64 / 4.0, 0.0]);
        let area = SpeedInArea { x1: -1.0, y1: -1.0, x2: 9.0, y2: 1.0, speed_frames: 2.0 };
        let found = area.on(&tracks(Space::open(), 2.0, 5, 1, place)?)?;
        close(&found.columns[2], &[1.0, 2.0, 2.0, 2.0, 3.0]);
        let part = SpeedInArea { x1: 0.5, ..area };
        let found = part.on(&tracks(Space::open(), 2.0, 5, 1, place)?)?;
        close(&found.columns[3], &[0.0, 0.0, 1.0, 1.0, 1.0]);
        assert!(found.columns[2][0].is_nan());
        Ok(())
    }
}
