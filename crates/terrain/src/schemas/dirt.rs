//! `dirt`: one wall from an anchor, by angle and length (the source's algorithm 6).

use super::{anchor, anchor_parameter, anchored, angle};
use crate::schema::{Domain, Parameter, Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Workspace};

/// `dirt`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dirt;

impl Schema for Dirt {
    fn card(&self) -> SchemaCard {
        SchemaCard {
            id: "dirt",
            about: "One wall from an anchor, at an angle.",
            source: "algorithm 6; the range of lengths is a decision of ours",
            version: 1,
            units: None,
            parameters: vec![
                angle("angle", 225.0),
                Parameter::new("length", "length", Domain::Range(0.25, 4.0), 2.5, "Length of the wall."),
                anchor_parameter(4.0),
            ],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let [angle, length, number] = known(values);
        Ok(Construct::of_walls(workspace.units, [anchored(anchor(workspace, number)?, angle, length)]))
    }
}
