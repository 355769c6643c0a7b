//! How much ground each group holds.

use super::groups::{CELL_SIZE, cells};
use crate::metric::takes;
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use crate::{Kind, Sample};

takes! {
    /// `occupied_area`.
    pub struct OccupiedArea { cell_size: CELL_SIZE }
}

impl TrackMetric for OccupiedArea {
    const CARD: TrackCard = TrackCard {
        id: "occupied_area",
        title: "Occupied area",
        definition: "of each group in each frame: the area of its convex hull, and the area of the square cells \
                    (cubes in space, lengths on a line) in which it has members",
        variant: "hull and cells; cells begin at the origin of the axes (on the globe of the frame's plane)",
        source: "competing flocks, section 5",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field { name: "group", unit: "", kind: Kind::Group, about: "The group." },
            Field::count("members", "Members found."),
            Field::number("hull", "length^2", "Area of the convex hull."),
            Field::number("cells", "length^D", "Area of the cells with members."),
        ],
        edge: "hull NaN where all are on one line (in dimensions other than two always)",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let mut sample = Sample::empty();
        for (frame, &number) in tracks.frames().iter().enumerate() {
            for group in 0..tracks.group_names().len() {
                tracks.sample_of(
                    frame,
                    |individual| tracks.groups()[individual as usize] as usize == group,
                    &mut sample,
                );
                let hull = sample.hull().map_or(f64::NAN, |hull| hull.area);
                let area = cells(&sample, self.cell_size).len() as f64 * self.cell_size.powi(D as i32);
                found.push([number as f64, tracks.times()[frame], group as f64, sample.len() as f64, hull, area]);
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
    fn two_groups() -> Fine {
        let places = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0], [0.5, 0.5], [7.0, 7.0]];
        let tracks = tracks(Space::open(), 1.0, 1, 5, |_, k| Some(places[k as usize]))?;
        let tracks = tracks.with_groups(vec!["a".into(), "b".into()], vec![0, 0, 0, 0, 1])?;
        let found = OccupiedArea { cell_size: 1.0 }.on(&tracks)?;
        close(&found.row(0), &[0.0, 0.0, 0.0, 4.0, 6.0, 3.0]);
        close(&found.row(1), &[0.0, 0.0, 1.0, 1.0, f64::NAN, 1.0]);
        Ok(())
    }
}
