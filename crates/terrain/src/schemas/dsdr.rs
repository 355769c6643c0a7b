//! `dsdr`: two walls that are anchored opposite each other on the side walls of a corridor.

use super::anchored;
use crate::schema::{Domain, Parameter, Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Units, Workspace};

/// `dsdr`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dsdr;

impl Schema for Dsdr {
    fn card(&self) -> SchemaCard {
        let angle = |name| {
            let about = "Angle of the wall from the inward normal of its side; positive leans the way the group goes.";
            Parameter::new(name, "deg", Domain::Range(-85.0, 85.0), 30.0, about)
        };
        let length = |name| Parameter::new(name, "length", Domain::Range(0.5, 8.0), 6.0, "Length of the wall.");
        SchemaCard {
            id: "dsdr",
            about: "Two walls opposite each other on the sides of a corridor along y.",
            source: "section 7.4.1 names it; the geometry is a decision of ours",
            version: 1,
            units: Some(Units::Metres),
            parameters: vec![angle("a1"), length("l1"), angle("a2"), length("l2")],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let [a1, l1, a2, l2] = known(values);
        let (left, right) = (workspace.anchor("left")?, workspace.anchor("right")?);
        Ok(Construct::of_walls(workspace.units, [anchored(left, a1, l1), anchored(right, 180.0 - a2, l2)]))
    }
}
