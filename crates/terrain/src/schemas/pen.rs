//! `pen`: cattle handling along x: a converging alley, a curved single-file chute that turns left by a quarter, and a
//! straight with sorting gates in its outer wall.

use super::funnel::converging;
use super::{arc, length};
use crate::construct::{Marker, Piece};
use crate::geometry::{Geometry, Pose, along};
use crate::schema::{Domain, Parameter, Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Workspace};
use space::Vector;

/// `pen`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pen;

impl Schema for Pen {
    fn card(&self) -> SchemaCard {
        SchemaCard {
            id: "pen",
            about: "A converging alley, a curved chute, and a straight with sorting gates.",
            source: "cattle handling; the geometry is a decision of ours",
            version: 1,
            units: None,
            parameters: vec![
                length("mouth", 1e-3, 6.0, "Width of the alley where one comes in."),
                Parameter::new(
                    "half_angle",
                    "deg",
                    Domain::Range(1.0, 89.0),
                    30.0,
                    "Angle of the alley's walls to the x axis.",
                ),
                length("chute_width", 1e-3, 1.0, "Width of the chute."),
                length("curve_radius", 1e-3, 3.0, "Radius of the curve at the middle of the chute."),
                Parameter::new(
                    "gates",
                    "1",
                    Domain::Whole(0.0, 20.0),
                    2.0,
                    "Sorting gates in the outer wall behind the curve.",
                ),
            ],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let [mouth, half_angle, width, radius, gates] = known(values);
        if width > mouth {
            return Err(TerrainError::range("chute_width", format!("at most the mouth, {mouth}"), width));
        }
        if radius <= width / 2.0 {
            return Err(TerrainError::range(
                "curve_radius",
                format!("more than half the width, {}", width / 2.0),
                radius,
            ));
        }
        let centre = Vector([0.0, radius]);
        let (outer, inner) = (radius + width / 2.0, radius - width / 2.0);
        let mut parts: Vec<(&str, Geometry)> =
            converging(mouth, width, half_angle, 0.0).into_iter().map(|wall| ("alley", wall)).collect();
        for arc in [arc(centre, outer, -90.0, 0.0), arc(centre, inner, -90.0, 0.0)] {
            parts.extend(along(&arc).into_iter().map(|wall| ("chute", wall)));
        }
        // behind the curve: gates as wide as the chute, with walls as long between them
        let count = gates as usize;
        let end = radius + (2.0 * gates + 1.0) * width;
        parts.push(("chute", Geometry::wall(Vector([inner, radius]), Vector([inner, end]))));
        let mut construct = Construct::new(workspace.units, Vec::new());
        for k in 0..=count {
            let from = radius + 2.0 * k as f64 * width;
            parts.push(("chute", Geometry::wall(Vector([outer, from]), Vector([outer, from + width]))));
            if k < count {
                let at = Vector([outer, from + 1.5 * width]);
                construct.markers.push(Marker { name: format!("gate {}", k + 1), pose: Pose { at, heading: 0.0 } });
            }
        }
        construct.markers.push(Marker { name: "exit".into(), pose: Pose::new([radius, end], 90.0) });
        let piece = |(name, wall): (&str, Geometry)| Piece { name: name.to_owned(), geometry: vec![wall] };
        construct.pieces = parts.into_iter().map(piece).collect();
        Ok(construct)
    }
}
