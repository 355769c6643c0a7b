//! `itb`: a sequence of anchored walls for trajectory tasks (the source's algorithm 8). Its pseudocode names its input
//! `angle` and uses theta: here they are one quantity, in degrees from the x axis.

use super::anchored;
use crate::schema::{Domain, Parameter, Schema, SchemaCard};
use crate::{Construct, Draws, TerrainError, Workspace};
use space::Vector;

/// `itb`.
#[derive(Clone, Copy, Debug)]
pub struct Itb {
    /// Number of walls.
    pub walls: usize,
}

impl Default for Itb {
    fn default() -> Self {
        Self { walls: 1 }
    }
}

impl Schema for Itb {
    fn card(&self) -> SchemaCard {
        let wall = |k: usize| {
            let parameter = |name: &str, unit, domain, default, about| Parameter {
                name: format!("{name}{}", k + 1).into(),
                unit,
                domain,
                default,
                about,
            };
            [
                parameter("x", "length", Domain::Range(-1e3, 1e3), 0.0, "Where the wall is anchored, along x."),
                parameter("y", "length", Domain::Range(-1e3, 1e3), 0.0, "Where the wall is anchored, along y."),
                parameter("angle", "deg", Domain::Periodic(0.0, 360.0), 45.0, "Direction of the wall from its anchor."),
                parameter("length", "length", Domain::Range(0.25, 4.0), 2.0, "Length of the wall."),
            ]
        };
        SchemaCard {
            id: "itb",
            about: "A sequence of walls, each from an anchor of its own at an angle.",
            source: "algorithm 8; several walls are an addition of ours",
            version: 1,
            units: None,
            parameters: (0..self.walls).flat_map(wall).collect(),
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let walls = values.chunks_exact(4).map(|wall| anchored(Vector([wall[0], wall[1]]), wall[2], wall[3]));
        Ok(Construct::of_walls(workspace.units, walls))
    }
}
