//! When bodies begin to overlap.

use crate::Sample;
use crate::metric::takes;
use crate::metrics::view_groups_literal::BODY_RADIUS;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `collisions`.
    pub struct Collisions { body_radius: BODY_RADIUS }
}

impl TrackMetric for Collisions {
    const CARD: TrackCard = TrackCard {
        id: "collisions",
        title: "Collisions",
        definition: "each moment from which on |d_ij| < 2 body_radius, not so in the frame before",
        variant: "events, not pairs in a frame (overlapping_pairs); one that goes on is one; whoever overlaps when \
                    first seen counts",
        source: "catalogue of models, section 5 (collision rate)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::individual("individual", "The one."),
            Field::individual("other", "The other."),
        ],
        edge: "no row without overlap",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let reach = 2.0 * self.body_radius;
        let mut sample = Sample::empty();
        let mut before: Vec<(u32, u32)> = Vec::new();
        for (frame, &number) in tracks.frames().iter().enumerate() {
            tracks.sample_into(frame, &mut sample);
            let members = &tracks.individuals()[tracks.rows(frame)];
            let mut now: Vec<(u32, u32)> = Vec::new();
            sample.pairs_within(reach, &mut |i, j| {
                if sample.distance(i, j) < reach {
                    now.push((members[i], members[j]));
                }
            });
            now.sort_unstable();
            for &(one, other) in now.iter().filter(|pair| before.binary_search(pair).is_err()) {
                found.push([number as f64, tracks.times()[frame], f64::from(one), f64::from(other)]);
            }
            before = now;
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
    fn one_that_goes_on_is_one() -> Fine {
        let place = |frame: i64, k: u32| Some([if k == 0 { [9.0, 1.0, 1.5, 2.0, 1.0][frame as usize] } else { 0.0 }]);
        let found = Collisions { body_radius: 1.0 }.on(&tracks(Space::open(), 2.0, 5, 2, place)?)?;
        close(&found.columns[0], &[1.0, 4.0]);
        close(&found.row(1), &[4.0, 2.0, 0.0, 1.0]);
        Ok(())
    }
}
