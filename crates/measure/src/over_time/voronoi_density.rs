//! How crowded an area is, by the room that each person has.
//!
//! B. Steffen, A. Seyfried (2010), Methods for measuring pedestrian density, flow, speed and direction with minimal scatter, Physica A 389:1902.

use super::line::{X1, X2, Y1, Y2, corners};
use crate::metric::takes;
use crate::{Bounds, Parameter, domains};
use crate::{Counted, Field, Listing, MeasureError, Takes, TrackCard, TrackMetric, Tracks};
use space::voronoi::Scratch;
use space::{Real, Vector};

/// How far a cell reaches.
const CUTOFF: Parameter = Parameter {
    name: "cutoff",
    unit: "length",
    default: Some(1.0),
    bounds: Bounds::Positive,
    about: "A cell reaches no farther than this.",
};

/// Sides of the polygon.
const SIDES: Parameter = Parameter {
    name: "sides",
    unit: "1",
    default: Some(12.0),
    bounds: Bounds::Whole,
    about: "Sides of the polygon that stands for the circle of the cut-off (12 are 3 in a quarter); 3 or more.",
};

takes! {
    /// `voronoi_density`.
    pub struct VoronoiDensity { x1: X1, y1: Y1, x2: X2, y2: Y2, cutoff: CUTOFF, sides: SIDES }
}

impl TrackMetric for VoronoiDensity {
    const CARD: TrackCard = TrackCard {
        id: "voronoi_density",
        title: "Voronoi density",
        definition: "sum_i |A_i and M| / |A_i| / |M|,  A_i the Voronoi cell of i within a polygon of so many sides \
                    about it (cut-off), M the rectangle from (x1, y1) to (x2, y2)",
        variant: "cells end at the cut-off, not at walls",
        source: "Steffen and Seyfried 2010; as the package PedPy does",
        counted: Counted::Positions,
        dimensions: &[2],
        parameters: Self::PARAMETERS,
        fields: &[
            Field::frame(),
            Field::time(),
            Field::number("density", "1/length^2", "Individuals per area."),
            Field::count("individuals", "Individuals whose cells reach the area."),
        ],
        edge: "0 where no cell reaches the rectangle",
    };
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        let mut found = Listing::new(&Self::CARD);
        let (low, high) = corners(self.x1, self.y1, self.x2, self.y2);
        let area = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(Vector);
        let sides = self.sides as usize;
        let corner = |k: usize| Vector::<f64, 2>::at_angle(f64::TAU * k as f64 / sides as f64) * self.cutoff;
        let cutoff: Vec<_> = (0..sides).map(corner).collect();
        let mut scratch = Scratch::default();
        for (frame, &number) in tracks.frames().iter().enumerate() {
            let places: Vec<Vector<f64, 2>> =
                tracks.rows(frame).map(|row| Vector::of(&tracks.position(row).0)).collect();
            let (mut density, mut count) = (0.0, 0.0);
            for (i, &here) in places.iter().enumerate() {
                // cells of those who are farther away end before the area
                if (0..2).any(|a| here.0[a] < low[a] - self.cutoff || here.0[a] > high[a] + self.cutoff) {
                    continue;
                }
                let others: Vec<_> =
                    places.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, &there)| there - here).collect();
                let (cell, _) = domains::cell(cutoff.iter().copied(), &others, &mut scratch);
                let inside = domains::area(&domains::common(&cell, &area.map(|corner| corner - here)));
                if inside > 0.0 {
                    density += inside / domains::area(&cell);
                    count += 1.0;
                }
            }
            let room = (high[0] - low[0]) * (high[1] - low[1]);
            found.push([number as f64, tracks.times()[frame], density / room, count]);
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
    fn alone_and_in_a_crowd() -> Fine {
        let area = VoronoiDensity { x1: -4.0, y1: -4.0, x2: 4.0, y2: 4.0, cutoff: 1.0, sides: 12.0 };
        let alone = area.on(&tracks(Space::open(), 1.0, 1, 1, |_, _| Some([0.0, 0.0]))?)?;
        close(&alone.row(0), &[0.0, 0.0, 1.0 / 64.0, 1.0]);
        // a lattice of unit cells: 1 for each unit of area, whatever the area
        let lattice =
            tracks(Space::open(), 1.0, 1, 144, |_, k| Some([f64::from(k % 12) - 5.5, f64::from(k / 12) - 5.5]))?;
        let odd = VoronoiDensity { x1: -1.3, y1: -2.2, x2: 2.1, y2: 0.4, ..area };
        close(&odd.on(&lattice)?.columns[2], &[1.0]);
        Ok(())
    }
}
