//! `galton`: a board of pegs below a funnel, with bins below. Row i, from 0, has i + 1 pegs, each row half a pitch beside
//! the last; there is one bin more than rows. Walkers come down, along -y.

use super::funnel::converging;
use super::length;
use crate::construct::{Marker, Piece};
use crate::geometry::{Geometry, Point, Pose};
use crate::schema::{Domain, Parameter, Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Workspace};
use space::Vector;

/// `galton`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Galton;

/// The pegs of a board, row by row from the top, each from the left.
pub fn pegs(rows: usize, pitch: f64) -> Vec<Point> {
    let row = |i: usize| (0..=i).map(move |j| Vector([(j as f64 - i as f64 / 2.0) * pitch, -(i as f64 + 1.0) * pitch]));
    (0..rows).flat_map(row).collect()
}

/// The bin (from 0, at the left) in which a walker ends that comes straight down at `x` below the last row of pegs; one
/// beside all bins ends in the last on its side.
pub fn bin(x: f64, rows: usize, pitch: f64) -> usize {
    let place = x / pitch + (rows as f64 + 1.0) / 2.0;
    (place.floor().max(0.0) as usize).min(rows)
}

impl Schema for Galton {
    fn card(&self) -> SchemaCard {
        SchemaCard {
            id: "galton",
            about: "A funnel, a triangle of pegs below it, and bins below that.",
            source: "section 6.1.2 names it; all numbers are decisions of ours",
            version: 1,
            units: None,
            parameters: vec![
                Parameter::new("rows", "1", Domain::Whole(1.0, 100.0), 8.0, "Rows of pegs."),
                length("pitch", 1e-3, 2.0, "Distance between neighbouring pegs of a row, and between rows."),
                length("peg_radius", 0.0, 0.2, "Radius of a peg."),
                length("funnel_mouth", 1e-3, 10.0, "Width of the funnel at its top."),
                length("funnel_neck", 1e-3, 1.0, "Width of the funnel at its bottom, above the first peg."),
                length("bin_depth", 0.0, 4.0, "Depth of the bins."),
            ],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let [rows, pitch, peg_radius, mouth, neck, depth] = known(values);
        let count = rows as usize;
        if neck > mouth {
            return Err(TerrainError::range("funnel_neck", format!("at most the mouth, {mouth}"), neck));
        }
        let mut pieces: Vec<Piece> = Vec::new();
        let top = Pose::new([0.0, 0.0], -90.0);
        for wall in converging(mouth, neck, 45.0, 0.0) {
            pieces.push(Piece { name: "funnel".into(), geometry: vec![wall.moved(&top, [1.0, 1.0])] });
        }
        let peg = |centre| Piece { name: "peg".into(), geometry: vec![Geometry::Disc { centre, radius: peg_radius }] };
        pieces.extend(pegs(count, pitch).into_iter().map(peg));
        let (upper, lower) = (-(rows + 1.0) * pitch, -(rows + 1.0) * pitch - depth);
        let divider = |k: usize| (k as f64 - (rows + 1.0) / 2.0) * pitch;
        let mut walls: Vec<Geometry> =
            (0..=count + 1).map(|k| Geometry::wall(Vector([divider(k), upper]), Vector([divider(k), lower]))).collect();
        walls.push(Geometry::wall(Vector([divider(0), lower]), Vector([divider(count + 1), lower])));
        pieces.extend(walls.into_iter().map(|wall| Piece { name: "bin".into(), geometry: vec![wall] }));
        let mut construct = Construct::new(workspace.units, pieces);
        let middle = |k: usize| Vector([divider(k) + pitch / 2.0, (upper + lower) / 2.0]);
        let marker = |k| Marker { name: format!("bin {k}"), pose: Pose { at: middle(k), heading: -90.0 } };
        construct.markers = (0..=count).map(marker).collect();
        Ok(construct)
    }
}
