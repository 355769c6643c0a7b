//! How many people there are in an area.

use super::line::{X1, X2, Y1, Y2, corners};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `classic_density`.
    pub struct ClassicDensity { x1: X1, y1: Y1, x2: X2, y2: Y2 }
}

impl TrackMetric for ClassicDensity {
    const CARD: TrackCard = TrackCard {
        id: "classic_density",
        title: "Classic density",
        definition: "number of individuals in the rectangle from (x1, y1) to (x2, y2) / its area",
        variant: "counts centres; who is on the edge is outside",
        source: "textbook; as the package PedPy counts",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::number("density", "1/length^2", "Individuals per area."),
            Field::count("individuals", "Individuals inside."),
        ],
        edge: "0 where nobody is inside",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let (low, high) = corners(self.x1, self.y1, self.x2, self.y2);
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        for (frame, &number) in tracks.frames().iter().enumerate() {
            let inside =
                |row: &usize| (0..2).all(|a| low[a] < tracks.positions(a)[*row] && tracks.positions(a)[*row] < high[a]);
            let count = tracks.rows(frame).filter(inside).count() as f64;
            found.push([number as f64, tracks.times()[frame], count / area, count]);
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
        let place = |frame: i64, k: u32| Some([f64::from(k) + frame as f64, 1.0]);
        let area = ClassicDensity { x1: 3.5, y1: 0.0, x2: 0.5, y2: 2.0 };
        let found = area.on(&tracks(Space::open(), 1.0, 3, 3, place)?)?;
        close(&found.columns[2], &[2.0 / 6.0, 3.0 / 6.0, 2.0 / 6.0]);
        Ok(())
    }
}
