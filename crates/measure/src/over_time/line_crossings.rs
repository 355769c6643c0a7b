//! Who crosses a line, and when.

use super::line::{X1, X2, Y1, Y2, crossings};
use crate::Kind;
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `line_crossings`.
    pub struct LineCrossings { x1: X1, y1: Y1, x2: X2, y2: Y2 }
}

impl TrackMetric for LineCrossings {
    const CARD: TrackCard = TrackCard {
        id: "line_crossings",
        title: "Crossings of a line",
        definition: "each step from one frame to the next that leads across the line from (x1, y1) to (x2, y2): the \
                    frame is that of arrival",
        variant: "by the way between two frames; a place on the line is on its right; forwards is from right to \
                    left of the line",
        source: "as the package PedPy counts",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::individual("individual", "Who crosses."),
            Field::frame(),
            Field::time(),
            Field {
                name: "direction",
                unit: "",
                kind: Kind::Label(&["forwards", "backwards"]),
                about: "Which way: forwards from right to left.",
            },
        ],
        edge: "no row without a crossing",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        for crossing in crossings(tracks, [self.x1, self.y1], [self.x2, self.y2]) {
            let back = f64::from(u8::from(!crossing.forwards));
            let number = tracks.frames()[crossing.frame] as f64;
            found.push([crossing.individual as f64, number, tracks.times()[crossing.frame], back]);
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
    fn over_the_line_and_past_it() -> Fine {
        let xs = [0.5, 5.0, 0.5];
        let place =
            |frame: i64, k: u32| Some([xs[k as usize], if k == 2 { 1.5 - frame as f64 } else { frame as f64 - 1.0 }]);
        let line = LineCrossings { x1: 0.0, y1: 0.0, x2: 1.0, y2: 0.0 };
        let found = line.on(&tracks(Space::open(), 2.0, 4, 3, place)?)?;
        close(&found.row(0), &[0.0, 2.0, 1.0, 0.0]);
        close(&found.row(1), &[2.0, 2.0, 1.0, 1.0]);
        assert_eq!(found.len(), 2);
        Ok(())
    }
}
