//! How often each group is in each part of space: histograms over cells, in any number of dimensions.

use super::groups::{CELL_SIZE, cell_of};
use crate::Kind;
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use std::collections::BTreeMap;

takes! {
    /// `occupancy`.
    pub struct Occupancy { cell_size: CELL_SIZE }
}

impl TrackMetric for Occupancy {
    const CARD: TrackCard = TrackCard {
        id: "occupancy",
        title: "Occupancy",
        definition: "of each group and each cell in which any of its members was ever found: how often one was found there \
                    (one member in one frame counts once), and that over all finds of the group",
        variant: "square cells (cubes in space, lengths on a line) that begin at the origin of the axes; cells where none of \
                  the group was found have no row",
        source: "histograms of many species in space, as by Husselmann and Hawick 2011",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field { name: "group", unit: "", kind: Kind::Group, about: "The group." },
            Field::number("x", "length", "Middle of the cell along the first axis."),
            Field::number("y", "length", "Along the second axis; 0 on a line."),
            Field::number("z", "length", "Along the third axis; 0 in fewer dimensions."),
            Field::count("found", "Members found in the cell, over all frames."),
            Field::number("share", "1", "Their share of all that were found of the group."),
        ],
        edge: "no rows where nobody was found; an error on the globe",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let crate::Ground::Plane(space) = tracks.ground() else {
            return Err(MeasureError::Unfit { metric: Self::CARD.id, needs: "a plane" });
        };
        let mut counts: BTreeMap<(u32, [i64; D]), u64> = BTreeMap::new();
        let mut all = vec![0u64; tracks.group_names().len()];
        for frame in 0..tracks.frames().len() {
            for row in tracks.rows(frame) {
                let place = space.place(tracks.position(row));
                if !place.finite() {
                    continue;
                }
                let group = tracks.groups()[tracks.individuals()[row] as usize];
                *counts.entry((group, cell_of(place, self.cell_size))).or_default() += 1;
                all[group as usize] += 1;
            }
        }
        let mut found = Listing::new(&Self::CARD);
        for ((group, cell), count) in counts {
            let middle = |a: usize| if a < D { (cell[a] as f64 + 0.5) * self.cell_size } else { 0.0 };
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
    fn two_species_in_space() -> Fine {
        // one stays, one goes along x by 1 a frame
        let place = |frame: i64, k: u32| Some(if k == 0 { [0.5, 0.5, 3.5] } else { [frame as f64, 2.0, -0.5] });
        let tracks = tracks(Space::open(), 1.0, 4, 2, place)?;
        let tracks = tracks.with_groups(vec!["a".into(), "b".into()], vec![0, 1])?;
        let found = Occupancy { cell_size: 2.0 }.on(&tracks)?;
        close(&found.row(0), &[0.0, 1.0, 1.0, 3.0, 4.0, 1.0]);
        close(&found.row(1), &[1.0, 1.0, 3.0, -1.0, 2.0, 0.5]);
        close(&found.row(2), &[1.0, 3.0, 3.0, -1.0, 2.0, 0.5]);
        assert_eq!(found.columns[0].len(), 3);
        Ok(())
    }
}
