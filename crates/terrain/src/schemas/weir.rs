//! `weir`: the classical fish trap along x: a straight leader, a round chamber that turns back whoever follows the leader,
//! and a pot behind it with a throat that points inwards.

use super::{arc, length};
use crate::construct::{Marker, Piece};
use crate::geometry::{Geometry, Pose, along, sin_cos};
use crate::schema::{Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Workspace};
use space::Vector;

/// `weir`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Weir;

/// Half the angle (degrees) under which a chord of this width is seen from the middle of a circle.
fn half_opening(width: f64, radius: f64) -> f64 {
    space::Real::asin(width / (2.0 * radius)).to_degrees()
}

impl Schema for Weir {
    fn card(&self) -> SchemaCard {
        SchemaCard {
            id: "weir",
            about: "A straight leader, a turn-back chamber with two doors beside the leader, and a pot with a throat.",
            source: "the classical fish trap; the geometry is a decision of ours",
            version: 1,
            units: None,
            parameters: vec![
                length("leader", 0.0, 8.0, "Length of the leader, which ends at the origin."),
                length("heart_radius", 1e-3, 3.0, "Radius of the turn-back chamber."),
                length("gate", 1e-3, 1.0, "Width of each door of the chamber, and of the throat."),
                length("pot_radius", 1e-3, 2.0, "Radius of the pot."),
                length("wings", 0.0, 2.0, "Length of the two walls that lead to the doors; 0 for none."),
            ],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let [leader, heart, gate, pot, wings] = known(values);
        if gate > heart || gate > pot {
            return Err(TerrainError::range("gate", format!("at most both radii, {}", heart.min(pot)), gate));
        }
        // the chamber begins where the leader ends: a door on either side of the leader, the throat opposite
        let centre = Vector([heart, 0.0]);
        let (doors, throat) = (half_opening(2.0 * gate, heart), half_opening(gate, heart));
        let far = heart + heart * sin_cos(throat).1;
        let pot_throat = half_opening(gate, pot);
        let pot_centre = Vector([far + pot * sin_cos(pot_throat).1, 0.0]);
        let mut parts: Vec<(&str, Vec<Geometry>)> = Vec::new();
        if leader > 0.0 {
            parts.push(("leader", vec![Geometry::wall(Vector([-leader, 0.0]), Vector([0.0, 0.0]))]));
        }
        for hand in [1.0, -1.0] {
            let side = arc(centre, heart, hand * throat, hand * (180.0 - doors));
            if let Some(&door) = side.last().filter(|_| wings > 0.0) {
                let (sin, cos) = sin_cos(135.0);
                parts.push(("wing", vec![Geometry::wall(door, door + Vector([wings * cos, hand * wings * sin]))]));
            }
            parts.push(("heart", along(&side)));
            let entrance = Vector([far, hand * gate / 2.0]);
            // the throat narrows to half its width inside the pot
            parts.push(("throat", vec![Geometry::wall(entrance, Vector([far + pot / 2.0, hand * gate / 4.0]))]));
        }
        let mut wall = arc(pot_centre, pot, -(180.0 - pot_throat), 180.0 - pot_throat);
        if let [first, .., last] = wall.as_mut_slice() {
            // the same points as those of the throat, to the last bit
            (*first, *last) = (Vector([far, -gate / 2.0]), Vector([far, gate / 2.0]));
        }
        parts.push(("pot", along(&wall)));
        let piece = |(name, geometry): (&str, Vec<Geometry>)| Piece { name: name.to_owned(), geometry };
        let mut construct = Construct::new(workspace.units, parts.into_iter().map(piece).collect());
        construct.markers.push(Marker { name: "pot".into(), pose: Pose { at: pot_centre, heading: 0.0 } });
        Ok(construct)
    }
}
