//! How many pass a line in a time.

use super::line::{Crossing, X1, X2, Y1, Y2, crossings, later, speed};
use crate::metric::takes;
use crate::sample::mean;
use crate::{Bounds, Parameter};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

/// Width of a window.
const WINDOW: Parameter = Parameter {
    name: "window",
    unit: "s",
    default: Some(4.0),
    bounds: Bounds::Positive,
    about: "Width of the windows.",
};

/// For the speed.
const SPEED_FRAMES: Parameter = Parameter {
    name: "speed_frames",
    unit: "1",
    default: Some(5.0),
    bounds: Bounds::Whole,
    about: "A speed is the way from so many frames before to so many after, over the time; who is not found in both has none.",
};

takes! {
    /// `flow`.
    pub struct Flow { x1: X1, y1: Y1, x2: X2, y2: Y2, window: WINDOW, speed_frames: SPEED_FRAMES }
}

impl TrackMetric for Flow {
    const CARD: TrackCard = TrackCard {
        id: "flow",
        title: "Flow through a line",
        definition: "in each window: the number of individuals that pass for the first time / time from the last \
                    passage before the window (before the first passage of all: from the frame before it) to the \
                    last one in it; the first row is of all: (number - 1) / time from the first to the last passage",
        variant: "first passage of each individual, in either direction; windows follow each other from the first \
                    passage, which is in the first of them",
        source: "as the package PedPy counts",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::number("from", "s", "Begin of the window."),
            Field::number("to", "s", "End of the window."),
            Field::count("passages", "Individuals that pass."),
            Field::number("flow", "1/s", "Individuals in a second."),
            Field::number("specific_flow", "1/(s length)", "The same for each unit of length of the line."),
            Field::number(
                "mean_speed",
                "length/s",
                "Mean speed of those who pass, between speed_frames before and after.",
            ),
        ],
        edge: "no row for fewer than two passages; no flow in a window without one",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut passed = vec![false; tracks.names().len()];
        let first_time = |crossing: &Crossing| !std::mem::replace(&mut passed[crossing.individual], true);
        let passages: Vec<Crossing> =
            crossings(tracks, [self.x1, self.y1], [self.x2, self.y2]).into_iter().filter(first_time).collect();
        let (Some(first), Some(last)) = (passages.first(), passages.last()) else { return Ok(found) };
        let Some(interval) = tracks.interval() else { return Ok(found) };
        let length = Vector([self.x2 - self.x1, self.y2 - self.y1]).length();
        let time = |crossing: &Crossing| tracks.times()[crossing.frame];
        let speed = |passages: &[Crossing]| {
            let frames = self.speed_frames as i64;
            let of = |passage: &Crossing| {
                let place = |shift| later(tracks, passage.frame, passage.individual, shift);
                Some(speed(tracks, place(-frames)?, place(frames)?))
            };
            mean(passages.iter().filter_map(of)).unwrap_or(f64::NAN)
        };
        if passages.len() > 1 {
            let flow = (passages.len() as f64 - 1.0) / (time(last) - time(first));
            found.push([time(first), time(last), passages.len() as f64, flow, flow / length, speed(&passages)]);
        }
        let (mut from, mut to, mut before) =
            (time(first) - interval, time(first) + self.window, time(first) - interval);
        while to <= time(last) + 1e-9 {
            let inside = |passage: &&Crossing| time(passage) > from + 1e-9 && time(passage) <= to + 1e-9;
            let window: Vec<Crossing> = passages.iter().filter(inside).cloned().collect();
            let flow = window.last().map_or(0.0, |last| window.len() as f64 / (time(last) - before));
            before = window.last().map_or(before, time);
            found.push([from, to, window.len() as f64, flow, flow / length, speed(&window)]);
            (from, to) = (to, to + self.window);
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
    fn one_in_two_seconds() -> Fine {
        // individual k passes from frame 2 k + 1 to 2 k + 2
        let place = |frame: i64, k: u32| Some([0.0, frame as f64 - 2.0 * f64::from(k) - 1.5]);
        let flow = Flow { x1: -1.0, y1: 0.0, x2: 1.0, y2: 0.0, window: 4.0, speed_frames: 1.0 };
        let found = flow.on(&tracks(Space::open(), 1.0, 14, 5, place)?)?;
        close(&found.row(0), &[2.0, 10.0, 5.0, 0.5, 0.25, 1.0]);
        // from 2 to 6: passages at 2, 4 and 6; after that to 10: at 8 and 10
        close(&found.row(1), &[1.0, 6.0, 3.0, 0.6, 0.3, 1.0]);
        close(&found.row(2), &[6.0, 10.0, 2.0, 0.5, 0.25, 1.0]);
        assert_eq!(found.len(), 3);
        Ok(())
    }
}
