//! Computational schemas: one file each, one line each in the list below.

use crate::geometry::{Point, sin_cos};
use crate::schema::{Domain, Parameter, Schema};
use crate::{TerrainError, Workspace};
use space::{Segment, Vector};

macro_rules! schemas {
    ($($file:ident::$name:ident;)*) => {
        $(pub mod $file;)*
        /// All schemas, in the order of the list.
        pub fn all() -> Vec<Box<dyn Schema>> {
            vec![$(Box::new($file::$name::default())),*]
        }
    };
}

schemas! {
    dirt::Dirt;
    itb::Itb;
    dsdr::Dsdr;
    sirt::Sirt;
    galton::Galton;
    funnel::Funnel;
    weir::Weir;
    pen::Pen;
    sieve::Sieve;
}

/// The schema of an id.
///
/// # Errors
/// Where none has this id.
pub fn find(id: &str) -> Result<Box<dyn Schema>, TerrainError> {
    let mut all = all();
    match all.iter().position(|schema| schema.card().id == id) {
        Some(k) => Ok(all.swap_remove(k)),
        None => Err(TerrainError::unknown("schema", id, all.iter().map(|schema| schema.card().id))),
    }
}

/// The point at a distance in a direction (degrees) from another.
fn towards(from: Point, degrees: f64, distance: f64) -> Point {
    let (sin, cos) = sin_cos(degrees);
    from + Vector([cos, sin]) * distance
}

/// The wall of a length from an anchor at an angle (degrees): from A to A + length (cos, sin).
pub fn anchored(anchor: Point, degrees: f64, length: f64) -> Segment {
    Segment { from: anchor, to: towards(anchor, degrees, length) }
}

/// An angle of a wall, in degrees from the x axis.
fn angle(name: &'static str, default: f64) -> Parameter {
    Parameter::new(name, "deg", Domain::Periodic(0.0, 360.0), default, "Direction of the wall from its anchor.")
}

/// A length of at least so much.
fn length(name: &'static str, least: f64, default: f64, about: &'static str) -> Parameter {
    Parameter::new(name, "length", Domain::Range(least, 1e3), default, about)
}

/// The anchor by number: the anchor of the workspace whose name is that number.
fn anchor_parameter(default: f64) -> Parameter {
    Parameter::new("anchor", "1", Domain::Whole(1.0, 1e6), default, "The anchor of this number.")
}

/// The anchor of the workspace whose name is a number.
fn anchor(workspace: &Workspace, number: f64) -> Result<Point, TerrainError> {
    workspace.anchor(&number.to_string())
}

/// The points of an arc about a centre between two directions (degrees), in equal steps of at most ten degrees.
fn arc(centre: Point, radius: f64, from: f64, to: f64) -> Vec<Point> {
    let steps = ((to - from).abs() / 10.0).ceil().max(1.0) as usize;
    (0..=steps).map(|k| towards(centre, from + (to - from) * k as f64 / steps as f64, radius)).collect()
}

#[cfg(test)]
mod tests;
