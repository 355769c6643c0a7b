//! With how many others each individual is together.

use crate::Sample;
use crate::metric::takes;
use crate::metrics::group_count::LINKING_DISTANCE;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};

takes! {
    /// `group_membership`.
    pub struct GroupMembership { linking_distance: LINKING_DISTANCE }
}

impl TrackMetric for GroupMembership {
    const CARD: TrackCard = TrackCard {
        id: "group_membership",
        title: "Group membership",
        definition: "over frames: the mean size of the individual's group of group_count, the share of frames alone, \
                    the share in the largest group",
        variant: "single linkage at the fragmentation threshold",
        source: "catalogue of models, section 5 (group membership)",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::individual("individual", "The individual."),
            Field::number("mean_size", "1", "Mean size of its group, itself included."),
            Field::number("alone", "1", "Share of frames alone."),
            Field::number("in_largest", "1", "Share of frames in the largest group; of equally large ones the first."),
            Field::count("frames", "Frames in which it was found."),
        ],
        edge: "NaN for an individual that was never found",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sums = vec![[0.0; 4]; tracks.names().len()];
        let mut sample = Sample::empty();
        for frame in 0..tracks.frames().len() {
            tracks.sample_into(frame, &mut sample);
            let sizes = sample.group_sizes(self.linking_distance);
            let most = sizes.iter().copied().max();
            let largest = sizes.iter().position(|&size| Some(size) == most);
            let groups = sample.groups(self.linking_distance);
            for (row, &group) in tracks.rows(frame).zip(groups.iter()) {
                let sum = &mut sums[tracks.individuals()[row] as usize];
                let yes = |is: bool| f64::from(u8::from(is));
                let seen = [sizes[group] as f64, yes(sizes[group] == 1), yes(Some(group) == largest), 1.0];
                sum.iter_mut().zip(seen).for_each(|(sum, value)| *sum += value);
            }
        }
        for (individual, &[size, alone, largest, frames]) in sums.iter().enumerate() {
            found.push([individual as f64, size / frames, alone / frames, largest / frames, frames]);
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
        let place = |frame: i64, k: u32| (k < 3).then(|| [if k == 2 { 9.0 * frame as f64 } else { f64::from(k) }]);
        let found = GroupMembership { linking_distance: 2.0 }.on(&tracks(Space::open(), 1.0, 2, 4, place)?)?;
        close(&found.row(0), &[0.0, 2.5, 0.0, 1.0, 2.0]);
        close(&found.row(2), &[2.0, 2.0, 0.5, 0.5, 2.0]);
        close(&found.row(3), &[3.0, f64::NAN, f64::NAN, f64::NAN, 0.0]);
        Ok(())
    }
}
