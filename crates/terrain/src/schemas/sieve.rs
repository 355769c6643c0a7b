//! `sieve`: a row of posts through which only bodies narrower than the gap pass; wider ones slide along it.

use super::{length, towards};
use crate::construct::Piece;
use crate::geometry::Geometry;
use crate::schema::{Domain, Parameter, Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Workspace};
use space::Vector;

/// `sieve`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sieve;

impl Schema for Sieve {
    fn card(&self) -> SchemaCard {
        SchemaCard {
            id: "sieve",
            about: "A row of posts about the origin, with equal gaps.",
            source: "named by the source; the geometry is a decision of ours",
            version: 1,
            units: None,
            parameters: vec![
                Parameter::new("posts", "1", Domain::Whole(1.0, 1000.0), 9.0, "Number of posts."),
                length("gap", 0.0, 0.5, "Free width between two posts: bodies of a smaller diameter pass."),
                Parameter::new("angle", "deg", Domain::Periodic(0.0, 360.0), 60.0, "Direction of the row."),
                length("post_radius", 0.0, 0.1, "Radius of a post."),
            ],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, _: &Draws) -> Result<Construct, TerrainError> {
        let [posts, gap, angle, radius] = known(values);
        let pitch = gap + 2.0 * radius;
        let post = |k: usize| {
            let centre = towards(Vector([0.0, 0.0]), angle, (k as f64 - (posts - 1.0) / 2.0) * pitch);
            Piece { name: "post".into(), geometry: vec![Geometry::Disc { centre, radius }] }
        };
        Ok(Construct::new(workspace.units, (0..posts as usize).map(post).collect()))
    }
}
