//! Hierarchical schemas: stages that are built one behind the other, each with an entry and an exit.

use crate::clearance::escapes_with_clearance;
use crate::geometry::Pose;
use crate::{Construct, TerrainError};
use space::shape::Shape;
use space::{Segment, Vector};

/// A part of a larger environment.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its name, for messages and provenance.
    pub name: String,
    /// What it is built of, in its own frame.
    pub construct: Construct,
    /// Where a group comes in.
    pub entry: Pose,
    /// The region in which it is taken over there.
    pub entry_region: Shape<f64, 2>,
    /// Where a group goes out.
    pub exit: Pose,
    /// The region in which it is handed over there.
    pub exit_region: Shape<f64, 2>,
}

/// Stages put together.
#[derive(Clone, Debug, PartialEq)]
pub struct Composition {
    /// The geometry of all, those of the first stage first.
    pub construct: Construct,
    /// The pose that each stage was moved by, `[stages]`.
    pub poses: Vec<Pose>,
    /// The entry region of each stage where it now is, `[stages]`: each stage's behaviour begins when the group is inside.
    pub entries: Vec<Shape<f64, 2>>,
}

/// A region elsewhere. Boxes are turned into polygons, since they need not stay along the axes.
fn moved(region: &Shape<f64, 2>, by: &Pose) -> Shape<f64, 2> {
    match region {
        Shape::Ball { centre, radius } => Shape::Ball { centre: by.place(*centre), radius: *radius },
        Shape::Segment { from, to } => Shape::Segment { from: by.place(*from), to: by.place(*to) },
        Shape::Polygon { vertices } => Shape::Polygon { vertices: vertices.iter().map(|&v| by.place(v)).collect() },
        Shape::Cuboid { low, high } => {
            let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
            Shape::Polygon { vertices: corners.map(|corner| by.place(Vector(corner))).to_vec() }
        }
        Shape::Plane { point, normal } => {
            let origin = by.place(Vector::ZERO);
            Shape::Plane { point: by.place(*point), normal: by.place(*normal) - origin }
        }
    }
}

/// Whether a wall comes into a region.
fn meets(wall: &Segment, region: &Shape<f64, 2>) -> bool {
    region.contains(wall.from) || region.contains(wall.to) || region.block(wall.from, wall.to).is_some()
}

/// Puts stages one behind the other: each is turned and moved so that its entry comes to lie on the exit of the one
/// before, facing the same way.
///
/// # Errors
/// No stages; stages in different units; a wall of one stage in a region where others hand over; no way of the width of a
/// body from exit to entry.
pub fn compose(stages: &[Stage], body_radius: f64) -> Result<Composition, TerrainError> {
    let Some(first) = stages.first() else { return Err(TerrainError::Stages("there is no stage".into())) };
    let mut poses: Vec<Pose> = vec![Pose::ORIGIN];
    for two in stages.windows(2) {
        if two[1].construct.units != first.construct.units {
            return Err(TerrainError::Units {
                first: format!("the stage `{}` in {} units", two[1].name, two[1].construct.units.word()),
                second: format!("`{}` in {} units", first.name, first.construct.units.word()),
            });
        }
        let exit = poses[poses.len() - 1].then(&two[0].exit);
        poses.push(exit.then(&two[1].entry.inverse()));
    }
    let parts: Vec<Construct> = stages.iter().zip(&poses).map(|(stage, pose)| stage.construct.moved(pose)).collect();
    for (k, (stage, pose)) in stages.iter().zip(&poses).enumerate() {
        for region in [&stage.entry_region, &stage.exit_region] {
            let region = moved(region, pose);
            for (j, other) in parts.iter().enumerate().filter(|&(j, _)| j != k) {
                if other.walls().iter().any(|wall| meets(wall, &region)) {
                    let (there, here) = (&stages[j].name, &stage.name);
                    return Err(TerrainError::Stages(format!("a wall of `{there}` stands where `{here}` hands over")));
                }
            }
        }
    }
    let mut construct = Construct::new(first.construct.units, Vec::new());
    for part in &parts {
        construct.pieces.extend(part.pieces.iter().cloned());
        construct.markers.extend(part.markers.iter().cloned());
    }
    let walls = construct.walls();
    for (k, pose) in poses.iter().enumerate().skip(1) {
        let entry = pose.then(&stages[k].entry).at;
        if !escapes_with_clearance(&walls, entry, body_radius)? {
            let (from, to) = (&stages[k - 1].name, &stages[k].name);
            return Err(TerrainError::Stages(format!("no body fits between the exit of `{from}` and `{to}`")));
        }
    }
    construct.provenance.schema = stages.iter().map(|stage| stage.name.as_str()).collect::<Vec<_>>().join(" -> ");
    let entries = stages.iter().zip(&poses).map(|(stage, pose)| moved(&stage.entry_region, pose)).collect();
    Ok(Composition { construct, poses, entries })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::Units;
    use crate::geometry::Point;
    use crate::schema::Schema;
    use crate::schemas::funnel::Funnel;
    use crate::schemas::sieve::Sieve;
    use crate::workspaces;

    fn disc(x: f64, y: f64) -> Shape<f64, 2> {
        Shape::Ball { centre: Vector([x, y]), radius: 0.4 }
    }
    fn funnel() -> Stage {
        let construct = Funnel.construct(&[4.0, 1.0, 45.0, 2.0], &workspaces::arena(10.0), 0, 0).unwrap();
        let (entry, exit) = (Pose::new([-2.0, 0.0], 0.0), Pose::new([2.5, 0.0], 0.0));
        Stage {
            name: "funnel".into(),
            construct,
            entry,
            entry_region: disc(-2.0, 0.0),
            exit,
            exit_region: disc(2.5, 0.0),
        }
    }
    fn sieve() -> Stage {
        let construct = Sieve.construct(&[5.0, 0.5, 0.0, 0.1], &workspaces::arena(10.0), 0, 0).unwrap();
        let (entry, exit) = (Pose::new([0.0, -1.0], 90.0), Pose::new([0.0, 1.0], 90.0));
        Stage {
            name: "sieve".into(),
            construct,
            entry,
            entry_region: disc(0.0, -1.0),
            exit,
            exit_region: disc(0.0, 1.0),
        }
    }

    #[test]
    fn stages_stand_one_behind_the_other() {
        let whole = compose(&[funnel(), sieve()], 0.2).unwrap();
        assert_eq!(whole.construct.pieces.len(), funnel().construct.pieces.len() + 5);
        // the sieve is turned so that its entry, one below it, lies on the exit
        let posts: Vec<Point> =
            whole.construct.geometry().filter(|g| g.segments().is_empty()).map(|g| g.points()[0]).collect();
        assert!(posts.iter().all(|post| (post[0] - 3.6).abs() < 0.11), "{posts:?}");
        assert!(whole.entries[1].contains(Vector([2.5, 0.0])));
        assert_eq!(whole.construct.provenance.schema, "funnel -> sieve");
        assert_eq!(compose(&[funnel()], 0.2).unwrap().construct.walls(), funnel().construct.walls());
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let error = |stages: &[Stage]| compose(stages, 0.2).unwrap_err().to_string();
        assert!(error(&[]).contains("no stage"));
        let mut field = sieve();
        field.construct.units = Units::Field;
        assert!(error(&[funnel(), field]).contains("field"));
        let mut early = funnel();
        early.exit = Pose::new([-1.5, 0.0], 180.0);
        early.exit_region = disc(-1.5, 0.0);
        let mut wall = funnel();
        wall.name = "wall".into();
        wall.construct = Construct::of_walls(Units::Metres, [Segment::new([-2.1, -5.0], [-2.1, 5.0])]);
        wall.entry_region = disc(-3.0, 0.0);
        assert!(error(&[early, wall]).contains("a wall of `wall` stands where `funnel` hands over"));
        let mut shut = sieve();
        let square = [[-1., -1.6, 1., -1.6], [1., -1.6, 1., 1.], [1., 1., -1., 1.], [-1., 1., -1., -1.6]];
        shut.construct = Construct::of_walls(Units::Metres, square.map(|[a, b, c, d]| Segment::new([a, b], [c, d])));
        assert!(error(&[funnel(), shut]).contains("no body fits"));
        assert!(compose(&[funnel(), sieve()], 0.0).is_err());
    }
}
