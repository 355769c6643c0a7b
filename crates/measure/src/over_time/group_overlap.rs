//! How much of the ground that two groups hold is the same.

use super::groups::{CELL_SIZE, cells};
use crate::domains::{area, common};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use crate::{Kind, Sample};
use space::Vector;

takes! {
    /// `group_overlap`.
    pub struct GroupOverlap { cell_size: CELL_SIZE }
}

impl TrackMetric for GroupOverlap {
    const CARD: TrackCard = TrackCard {
        id: "group_overlap",
        title: "Overlap of groups",
        definition: "of each two groups in each frame: the area in both convex hulls, and the area of the cells in \
                    which both have members",
        variant: "hulls and cells, as in occupied_area",
        source: "competing flocks, section 5",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field { name: "group", unit: "", kind: Kind::Group, about: "The one group." },
            Field { name: "other", unit: "", kind: Kind::Group, about: "The other group." },
            Field::number("hulls", "length^2", "Area in both hulls."),
            Field::number("cells", "length^2", "Area of the cells in which both have members."),
        ],
        edge: "hulls NaN where one of them has none",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let groups = tracks.group_names().len();
        for (frame, &number) in tracks.frames().iter().enumerate() {
            let part = |group: usize| {
                let mut sample = Sample::empty();
                tracks.sample_of(
                    frame,
                    |individual| tracks.groups()[individual as usize] as usize == group,
                    &mut sample,
                );
                (outline(&sample), cells(&sample, self.cell_size))
            };
            let parts: Vec<_> = (0..groups).map(part).collect();
            for one in 0..groups {
                for other in one + 1..groups {
                    let hulls = match (&parts[one].0, &parts[other].0) {
                        (Some(one), Some(other)) => area(&common(one, other)),
                        _ => f64::NAN,
                    };
                    let shared = parts[one].1.intersection(&parts[other].1).count() as f64;
                    let shared = shared * self.cell_size * self.cell_size;
                    found.push([number as f64, tracks.times()[frame], one as f64, other as f64, hulls, shared]);
                }
            }
        }
        Ok(found)
    }
}

/// The hull of a group in its plane, as a polygon without seams. `None` where it has none.
fn outline<const D: usize>(sample: &Sample<D>) -> Option<Vec<Vector<f64, 2>>> {
    let places = sample.unwrapped()?;
    Some(sample.hull()?.corners.iter().map(|&corner| Vector::of(&places[corner].0)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn two_squares() -> Fine {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let place = |frame: i64, k: u32| {
            let shift = if k < 4 { 0.0 } else { 3.0 + 2.0 * frame as f64 };
            Some(corners[k as usize % 4].map(|x| x + shift))
        };
        let tracks = tracks(Space::open(), 1.0, 2, 8, place)?;
        let tracks = tracks.with_groups(vec!["a".into(), "b".into()], vec![0, 0, 0, 0, 1, 1, 1, 1])?;
        let found = GroupOverlap { cell_size: 2.0 }.on(&tracks)?;
        close(&found.row(0), &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0]);
        close(&found.row(1), &[1.0, 1.0, 0.0, 1.0, 0.0, 4.0]);
        Ok(())
    }
}
