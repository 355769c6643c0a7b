//! When groups start, stop, split and merge.

use crate::metric::takes;
use crate::metrics::group_count::LINKING_DISTANCE;
use crate::sample::mean;
use crate::{Bounds, Kind, Parameter, Sample};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;

/// What happens.
const EVENTS: [&str; 4] = ["start", "stop", "split", "merge"];
const SPLIT: usize = 2;
const MERGE: usize = 3;

/// From which speed on a group moves.
const MOVING_SPEED: Parameter = Parameter {
    name: "moving_speed",
    unit: "length/s",
    default: None,
    bounds: Bounds::Positive,
    about: "From this mean speed on a group moves.",
};

/// For how long.
const AT_LEAST: Parameter = Parameter {
    name: "at_least",
    unit: "s",
    default: Some(1.0),
    bounds: Bounds::Positive,
    about: "A start or stop counts where it lasts so long.",
};

takes! {
    /// `group_events`.
    pub struct GroupEvents { linking_distance: LINKING_DISTANCE, moving_speed: MOVING_SPEED, at_least: AT_LEAST }
}

impl TrackMetric for GroupEvents {
    const CARD: TrackCard = TrackCard {
        id: "group_events",
        title: "Group events",
        definition: "start and stop: the mean speed of the individuals rises to moving_speed, or falls below it, and \
                    stays so for at_least seconds; split: members of one group of group_count are in two or more in \
                    the next frame; merge: those of two or more are in one",
        variant: "single linkage; only individuals found in both frames count, who comes or goes neither splits \
                    nor merges",
        source: "start and stop by mean speed, split and merge by common members: ours",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field { name: "event", unit: "", kind: Kind::Label(&EVENTS), about: "What happened." },
            Field::count("members", "Individuals concerned."),
            Field::count("parts", "Groups that one fell into, or that became one; 1 for start and stop."),
        ],
        edge: "no row where nothing happens",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sample = Sample::empty();
        let mut before: Vec<Option<usize>> = Vec::new();
        let (mut moving, mut changing): (Option<bool>, Option<(usize, f64)>) = (None, None);
        let mut events: Vec<(usize, usize, usize, usize)> = Vec::new();
        for frame in 0..tracks.frames().len() {
            tracks.sample_into(frame, &mut sample);
            if let Some(speed) = mean(sample.velocities().map(Vector::length)) {
                let now = speed >= self.moving_speed;
                let was = *moving.get_or_insert(now);
                if now == was {
                    changing = None;
                } else {
                    let (since, time) = *changing.get_or_insert((frame, tracks.times()[frame]));
                    if tracks.times()[frame] - time >= self.at_least * (1.0 - 1e-9) {
                        events.push((since, usize::from(!now), sample.len(), 1));
                        (moving, changing) = (Some(now), None);
                    }
                }
            }
            let groups = sample.groups(self.linking_distance);
            let mut after = vec![None; tracks.names().len()];
            tracks.rows(frame).zip(groups.iter()).for_each(|(row, &group)| {
                after[tracks.individuals()[row] as usize] = Some(group);
            });
            for (members, parts) in divided(&before, &after) {
                events.push((frame, SPLIT, members, parts));
            }
            for (members, parts) in divided(&after, &before) {
                events.push((frame, MERGE, members, parts));
            }
            before = after;
        }
        events.sort_unstable();
        for (frame, event, members, parts) in events {
            let number = tracks.frames()[frame] as f64;
            found.push([number, tracks.times()[frame], event as f64, members as f64, parts as f64]);
        }
        Ok(found)
    }
}

/// The groups whose members are in two or more groups of the other frame: how many of them are in both frames, and in how many groups.
fn divided(groups: &[Option<usize>], other: &[Option<usize>]) -> Vec<(usize, usize)> {
    let both: Vec<(usize, usize)> =
        groups.iter().zip(other).filter_map(|(one, other)| Some(((*one)?, (*other)?))).collect();
    let most = both.iter().map(|pair| pair.0 + 1).max().unwrap_or(0);
    let parts = |group: usize| {
        let mut parts: Vec<usize> = both.iter().filter(|pair| pair.0 == group).map(|pair| pair.1).collect();
        let members = parts.len();
        parts.sort_unstable();
        parts.dedup();
        (members, parts.len())
    };
    (0..most).map(parts).filter(|&(_, parts)| parts > 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn two_that_part_and_meet() -> Fine {
        // at rest, then apart and back, then at rest
        let way = [0.0, 0.0, 2.0, 4.0, 6.0, 4.0, 2.0, 0.0, 0.0, 0.0];
        let place = |frame: i64, k: u32| Some([if k == 0 { way[frame as usize] } else { -way[frame as usize] }]);
        let tracks = tracks(Space::open(), 1.0, 10, 2, place)?;
        let found = GroupEvents { linking_distance: 9.0, moving_speed: 1.0, at_least: 1.0 }.on(&tracks)?;
        close(&found.columns[0], &[2.0, 4.0, 5.0, 8.0]);
        close(&found.columns[2], &[0.0, 2.0, 3.0, 1.0]);
        close(&found.columns[4], &[1.0, 2.0, 2.0, 1.0]);
        Ok(())
    }
}
