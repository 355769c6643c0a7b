//! Who is nearest to whom.

use crate::metric::takes;
use crate::{Bounds, Counted, Field, Listing, MeasureError, Parameter, Sample, Takes, TrackCard, TrackMetric, Tracks};

/// How many are named.
const NEAREST: Parameter = Parameter {
    name: "nearest",
    unit: "1",
    default: None,
    bounds: Bounds::Whole,
    about: "So many of the nearest others are named.",
};

takes! {
    /// `nearest_neighbours`.
    pub struct NearestNeighbours { nearest: NEAREST }
}

impl TrackMetric for NearestNeighbours {
    const CARD: TrackCard = TrackCard {
        id: "nearest_neighbours",
        title: "Nearest neighbours",
        definition: "of each individual in each frame: the others j of the least |d_ij|, the nearest first, and how far they are",
        variant: "so many of them, whatever the distance; of equally near ones the first in the order of the individuals",
        source: "Clark and Evans (1954)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::individual("individual", "The individual."),
            Field::count("rank", "1 for the nearest other, 2 for the next."),
            Field::individual("neighbour", "The other."),
            Field::number("distance", "length", "How far it is."),
        ],
        edge: "as many as there are where they are fewer; no row for one who is alone",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sample = Sample::empty();
        for (frame, &number) in tracks.frames().iter().enumerate() {
            tracks.sample_into(frame, &mut sample);
            let count = (self.nearest as usize).min(sample.len().saturating_sub(1));
            let Some(nearest) = sample.nearest_others(count).filter(|_| count > 0) else { continue };
            let members = &tracks.individuals()[tracks.rows(frame)];
            for (&one, others) in members.iter().zip(nearest.chunks_exact(count)) {
                for (rank, &(distance, place)) in (1..).zip(others) {
                    let (one, other) = (f64::from(one), f64::from(members[place as usize]));
                    found.push([number as f64, tracks.times()[frame], one, f64::from(rank), other, distance]);
                }
            }
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
        // 1 is gone in frame 1: individuals are told apart from places in the frame
        let place = |frame: i64, k: u32| (frame == 0 || k != 1).then(|| [[0.0, 1.0, 3.0, 9.0][k as usize]]);
        let metric = NearestNeighbours { nearest: 1.0 };
        let found = metric.on(&tracks(Space::open(), 2.0, 2, 4, place)?)?;
        close(&found.columns[4], &[1.0, 0.0, 1.0, 2.0, 2.0, 0.0, 2.0]);
        close(&found.columns[5], &[1.0, 1.0, 2.0, 6.0, 3.0, 3.0, 6.0]);
        close(&found.row(6), &[1.0, 0.5, 3.0, 1.0, 2.0, 6.0]);
        let ring = tracks(Space::periodic([10.0]), 1.0, 1, 4, place)?;
        close(&metric.on(&ring)?.row(3), &[0.0, 0.0, 3.0, 1.0, 0.0, 1.0]);
        let more = NearestNeighbours { nearest: 7.0 }.on(&tracks(Space::open(), 1.0, 1, 4, place)?)?;
        close(&more.columns[4][..6], &[1.0, 2.0, 3.0, 0.0, 2.0, 3.0]);
        assert!(metric.on(&tracks(Space::open(), 1.0, 1, 1, place)?)?.is_empty());
        Ok(())
    }
}
