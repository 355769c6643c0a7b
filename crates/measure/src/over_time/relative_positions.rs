//! Where the members of each group stand in their cluster: histograms in the frame of the cluster.

use super::groups::cell_of;
use crate::Kind;
use crate::metric::takes;
use crate::metrics::group_count::LINKING_DISTANCE;
use crate::standing::standing;
use crate::{Bounds, Counted, Field, Listing, MeasureError, Parameter, Takes, TrackCard, TrackMetric, Tracks};
use space::Vector;
use std::collections::BTreeMap;

const RELATIVE_CELL: Parameter = Parameter {
    name: "relative_cell",
    unit: "1",
    default: Some(0.5),
    bounds: Bounds::Positive,
    about: "Side of the cells, in units of the root of the expanse.",
};

takes! {
    /// `relative_positions`.
    pub struct RelativePositions { linking_distance: LINKING_DISTANCE, relative_cell: RELATIVE_CELL }
}

impl TrackMetric for RelativePositions {
    const CARD: TrackCard = TrackCard {
        id: "relative_positions",
        title: "Relative positions",
        definition: "of each group and each cell in the frame of a cluster (origin at its centre, first axis along its mean \
                    heading, in units of the root of its expanse): how often a member was found there, over all frames, and that \
                    over all finds of the group",
        variant: "clusters by single linkage over everyone; left is horizontal in space; cells where none was found have no row",
        source: "mean relative positions within a school, as asked for by a thesis on behaviour selection in collective motion in three dimensions, whose text at hand names no author",
        counted: Counted::Velocities,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field { name: "group", unit: "", kind: Kind::Group, about: "The group." },
            Field::number("ahead", "1", "Middle of the cell along the mean heading."),
            Field::number("left", "1", "To the left of it; 0 on a line."),
            Field::number("up", "1", "Above it; 0 in fewer than three dimensions."),
            Field::count("found", "Members found in the cell, over all frames."),
            Field::number("share", "1", "Their share of all that were found of the group."),
        ],
        edge: "members alone in a cluster, and clusters in one point or without a mean heading, are not counted; an error on \
               the globe",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let crate::Ground::Plane(space) = tracks.ground() else {
            return Err(MeasureError::Unfit { metric: Self::CARD.id, needs: "a plane" });
        };
        let mut counts: BTreeMap<(u32, [i64; 3]), u64> = BTreeMap::new();
        let mut all = vec![0u64; tracks.group_names().len()];
        for frame in 0..tracks.frames().len() {
            let known = |row: usize| Some((row, tracks.velocity(row)?)).filter(|_| tracks.position(row).finite());
            let (rows, velocities): (Vec<usize>, Vec<_>) = tracks.rows(frame).filter_map(known).unzip();
            let places: Vec<_> = rows.iter().map(|&row| space.place(tracks.position(row))).collect();
            let found = standing(space, &places, &velocities, self.linking_distance);
            for (&row, place) in rows.iter().zip(found) {
                let Some(place) = place else { continue };
                let group = tracks.groups()[tracks.individuals()[row] as usize];
                *counts.entry((group, cell_of(Vector(place), self.relative_cell))).or_default() += 1;
                all[group as usize] += 1;
            }
        }
        let mut found = Listing::new(&Self::CARD);
        for ((group, cell), count) in counts {
            let middle = |a: usize| if a < D { (cell[a] as f64 + 0.5) * self.relative_cell } else { 0.0 };
            let share = count as f64 / all[group as usize] as f64;
            found.push([f64::from(group), middle(0), middle(1), middle(2), count as f64, share]);
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
    fn one_leads_and_one_follows() -> Fine {
        // both go along x by 1 a frame, 4 apart
        let place = |frame: i64, k: u32| Some([frame as f64 + 4.0 * f64::from(k), 0.0]);
        let tracks = tracks(Space::open(), 1.0, 5, 2, place)?;
        let tracks = tracks.with_groups(vec!["behind".into(), "ahead".into()], vec![0, 1])?;
        let found = RelativePositions { linking_distance: 5.0, relative_cell: 0.4 }.on(&tracks)?;
        // at -1 and 1: cells -3 and 2, whose middles are -1 and 1; the first frame has no velocity yet
        close(&found.row(0), &[0.0, -1.0, 0.2, 0.0, 4.0, 1.0]);
        close(&found.row(1), &[1.0, 1.0, 0.2, 0.0, 4.0, 1.0]);
        Ok(())
    }
}
