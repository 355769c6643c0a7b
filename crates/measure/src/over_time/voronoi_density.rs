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

/// A coordinate of a corner of the floor.
const fn floor(name: &'static str, default: f64, about: &'static str) -> Parameter {
    Parameter { name, unit: "length", default: Some(default), bounds: Bounds::Any, about }
}

const FLOOR_X1: Parameter = floor(
    "floor_x1",
    f64::NEG_INFINITY,
    "x of one corner of the floor, at whose edges cells end; left out, there is none.",
);
const FLOOR_Y1: Parameter =
    floor("floor_y1", f64::NEG_INFINITY, "y of one corner of the floor; left out, there is no edge.");
const FLOOR_X2: Parameter = floor("floor_x2", f64::INFINITY, "x of its opposite corner; left out, there is no edge.");
const FLOOR_Y2: Parameter = floor("floor_y2", f64::INFINITY, "y of its opposite corner; left out, there is no edge.");

takes! {
    /// `voronoi_density`.
    pub struct VoronoiDensity {
        x1: X1, y1: Y1, x2: X2, y2: Y2, cutoff: CUTOFF, sides: SIDES,
        floor_x1: FLOOR_X1, floor_y1: FLOOR_Y1, floor_x2: FLOOR_X2, floor_y2: FLOOR_Y2,
    }
}

impl TrackMetric for VoronoiDensity {
    const CARD: TrackCard = TrackCard {
        id: "voronoi_density",
        title: "Voronoi density",
        definition: "sum_i |A_i and M| / |A_i| / |M|,  A_i the Voronoi cell of i within a polygon of so many sides \
                    about it (cut-off), M the rectangle from (x1, y1) to (x2, y2)",
        variant: "cells end at the cut-off and at the edges of the floor, a rectangle; at no other walls",
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
        let area = rectangle(low, high);
        let floor = corners(self.floor_x1, self.floor_y1, self.floor_x2, self.floor_y2);
        // the floor seen from someone, no farther than a cell can reach
        let around = |here: Vector<f64, 2>| {
            let edge = |edge: f64, a: usize| (edge - here.0[a]).clamp(-2.0 * self.cutoff, 2.0 * self.cutoff);
            let side = |corner: [f64; 2]| [edge(corner[0], 0), edge(corner[1], 1)];
            rectangle(side(floor.0), side(floor.1))
        };
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
                let reach = domains::common(&cutoff, &around(here));
                let (cell, _) = domains::cell(reach.into_iter(), &others, &mut scratch);
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

/// The corners of a rectangle, counter-clockwise from its lower one.
fn rectangle(low: [f64; 2], high: [f64; 2]) -> [Vector<f64, 2>; 4] {
    [low, [high[0], low[1]], high, [low[0], high[1]]].map(Vector)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::over_time::sketch::{Fine, close, tracks};
    use space::Space;

    #[test]
    fn alone_and_in_a_crowd() -> Fine {
        let area = VoronoiDensity { x1: -4.0, y1: -4.0, x2: 4.0, y2: 4.0, ..VoronoiDensity::default() };
        let alone = area.on(&tracks(Space::open(), 1.0, 1, 1, |_, _| Some([0.0, 0.0]))?)?;
        close(&alone.row(0), &[0.0, 0.0, 1.0 / 64.0, 1.0]);
        // a lattice of unit cells: 1 for each unit of area, whatever the area
        let lattice =
            tracks(Space::open(), 1.0, 1, 144, |_, k| Some([f64::from(k % 12) - 5.5, f64::from(k / 12) - 5.5]))?;
        let odd = VoronoiDensity { x1: -1.3, y1: -2.2, x2: 2.1, y2: 0.4, ..area };
        close(&odd.on(&lattice)?.columns[2], &[1.0]);
        Ok(())
    }

    #[test]
    fn cells_end_at_the_edges_of_the_floor() -> Fine {
        // four sides of a square with corners one away, cut by a wall through its middle: a quarter of it is in the area
        let area = VoronoiDensity { x1: 0.0, y1: 0.0, x2: 4.0, y2: 4.0, sides: 4.0, ..VoronoiDensity::default() };
        let alone = tracks(Space::open(), 1.0, 1, 1, |_, _| Some([0.0, 0.0]))?;
        close(&area.on(&alone)?.columns[2], &[0.25 / 16.0]);
        close(&VoronoiDensity { floor_y1: 0.0, ..area }.on(&alone)?.columns[2], &[0.5 / 16.0]);
        // corners may be given in either order; of who stands off the floor the part of the cell on it counts, if any
        let off = VoronoiDensity { floor_x1: 3.0, floor_x2: 0.5, ..area };
        close(&off.on(&alone)?.row(0), &[0.0, 0.0, 0.5 / 16.0, 1.0]);
        close(&VoronoiDensity { floor_x1: 1.5, ..area }.on(&alone)?.row(0), &[0.0, 0.0, 0.0, 0.0]);
        Ok(())
    }
}
