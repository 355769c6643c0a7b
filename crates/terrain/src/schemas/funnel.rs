//! `funnel`: two walls that converge along x, and a chute behind their neck.

use super::length;
use crate::construct::{Marker, Piece};
use crate::geometry::{Geometry, Pose, sin_cos};
use crate::schema::{Domain, Parameter, Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Workspace};
use space::Vector;

/// `funnel`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Funnel;

/// Two walls that converge along x towards a neck at x = 0, and go on along a chute.
pub(super) fn converging(mouth: f64, neck: f64, half_angle: f64, chute: f64) -> Vec<Geometry> {
    let (sin, cos) = sin_cos(half_angle);
    let depth = (mouth - neck) / 2.0 * cos / sin;
    let mut walls = Vec::with_capacity(4);
    for hand in [1.0, -1.0] {
        let end = Vector([0.0, hand * neck / 2.0]);
        if mouth > neck {
            walls.push(Geometry::wall(Vector([-depth, hand * mouth / 2.0]), end));
        }
        if chute > 0.0 {
            walls.push(Geometry::wall(end, Vector([chute, hand * neck / 2.0])));
        }
    }
    walls
}

impl Schema for Funnel {
    fn card(&self) -> SchemaCard {
        SchemaCard {
            id: "funnel",
            about: "Two walls that converge along x, and a chute behind their neck, which is at the origin.",
            source: "named by the source; the geometry is a decision of ours",
            version: 1,
            units: None,
            parameters: vec![
                length("mouth", 1e-3, 6.0, "Width where one comes in."),
                length("neck", 1e-3, 1.0, "Width where one goes out."),
                Parameter::new(
                    "half_angle",
                    "deg",
                    Domain::Range(1.0, 89.0),
                    30.0,
                    "Angle of each wall to the x axis.",
                ),
                length("chute", 0.0, 0.0, "Length of the chute behind the neck."),
            ],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let [mouth, neck, half_angle, chute] = known(values);
        if neck > mouth {
            return Err(TerrainError::range("neck", format!("at most the mouth, {mouth}"), neck));
        }
        let piece = |wall| Piece { name: "wall".into(), geometry: vec![wall] };
        let walls = converging(mouth, neck, half_angle, chute).into_iter().map(piece).collect();
        let mut construct = Construct::new(workspace.units, walls);
        construct.markers.push(Marker { name: "exit".into(), pose: Pose::new([chute, 0.0], 0.0) });
        Ok(construct)
    }
}
