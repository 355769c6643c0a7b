//! Hierarchical schemas: stages that are built one behind the other, each with an entry and an exit.

use crate::clearance::way_with_clearance;
use crate::geometry::{Geometry, Pose, closed, regular};
use crate::{Construct, Marker, TerrainError};
use space::shape::Shape;
use space::{Segment, Vector};

/// Where one goes in or out.
#[derive(Clone, Debug, PartialEq)]
pub struct Port {
    /// The place, and the direction in which one passes it.
    pub pose: Pose,
    /// The region in which the group is handed over.
    pub region: Shape<f64, 2>,
}

/// A part of a larger environment.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its name, for messages and provenance.
    pub name: String,
    /// What it is built of, in its own frame.
    pub construct: Construct,
    /// Where a group comes in.
    pub entry: Port,
    /// Where a group goes out; the last stage may have none.
    pub exit: Option<Port>,
    /// Radius of the bodies that must find a way from its entry to its exit.
    pub clearance: f64,
}

/// Stages put together.
#[derive(Clone, Debug, PartialEq)]
pub struct Composition {
    /// The geometry of all, those of the first stage first; the markers `entry NAME` are where stages begin.
    pub construct: Construct,
    /// What each stage is built of, where it now is, `[stages]`.
    pub parts: Vec<Construct>,
    /// The pose that each stage was moved by, `[stages]`.
    pub poses: Vec<Pose>,
    /// The entry region of each stage where it now is, `[stages]`: each stage's behaviour begins when the group is inside.
    pub entries: Vec<Shape<f64, 2>>,
}

/// A region elsewhere. Boxes are turned into polygons, since they need not stay along the axes.
pub fn moved(region: &Shape<f64, 2>, by: &Pose) -> Shape<f64, 2> {
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

/// Whether something built comes into a region.
fn meets(built: &Geometry, region: &Shape<f64, 2>) -> bool {
    if let Geometry::Disc { centre, radius } = built {
        return region.contains(*centre) || region.nearest(*centre).distance < *radius;
    }
    let meets = |wall: &Segment| {
        region.contains(wall.from) || region.contains(wall.to) || region.block(wall.from, wall.to).is_some()
    };
    built.segments().iter().any(meets)
}

/// What keeps bodies away, as walls: a disc by its outline.
fn outlines(construct: &Construct) -> Vec<Segment> {
    let outline = |geometry: &Geometry| match geometry {
        Geometry::Disc { centre, radius } => closed(&regular(*centre, *radius, 12)),
        other => other.segments(),
    };
    construct.geometry().flat_map(outline).collect()
}

/// Puts stages one behind the other: each is turned and moved so that its entry comes to lie on the exit of the one
/// before, facing the same way.
///
/// # Errors
/// No stages; a stage before another without an exit; stages in different units. What other constructs of the same stages
/// may not have is a [`TerrainError::Misfit`]: something of one stage in a region where another hands over, and no way for
/// a body from the entry of a stage to that of the next.
pub fn compose(stages: &[Stage]) -> Result<Composition, TerrainError> {
    let Some(first) = stages.first() else { return Err(TerrainError::Stages("there is no stage".into())) };
    let mut poses: Vec<Pose> = vec![Pose::ORIGIN];
    for two in stages.windows(2) {
        if two[1].construct.units != first.construct.units {
            return Err(TerrainError::Units {
                first: format!("the stage `{}` in {} units", two[1].name, two[1].construct.units.word()),
                second: format!("`{}` in {} units", first.name, first.construct.units.word()),
            });
        }
        let Some(exit) = &two[0].exit else {
            let what = format!("`{}` has no exit to which `{}` could be joined", two[0].name, two[1].name);
            return Err(TerrainError::Stages(what));
        };
        let exit = poses[poses.len() - 1].then(&exit.pose);
        poses.push(exit.then(&two[1].entry.pose.inverse()));
    }
    let parts: Vec<Construct> = stages.iter().zip(&poses).map(|(stage, pose)| stage.construct.moved(pose)).collect();
    for (k, (stage, pose)) in stages.iter().zip(&poses).enumerate() {
        for port in [Some(&stage.entry), stage.exit.as_ref()].into_iter().flatten() {
            let region = moved(&port.region, pose);
            for (j, other) in parts.iter().enumerate().filter(|&(j, _)| j != k) {
                if other.geometry().any(|built| meets(built, &region)) {
                    let (there, here) = (&stages[j].name, &stage.name);
                    return Err(TerrainError::Misfit(format!("a wall of `{there}` stands where `{here}` hands over")));
                }
            }
        }
    }
    let mut construct = Construct::new(first.construct.units, Vec::new());
    for part in &parts {
        construct.pieces.extend(part.pieces.iter().cloned());
        construct.markers.extend(part.markers.iter().cloned());
    }
    let walls = outlines(&construct);
    for (k, pose) in poses.iter().enumerate().skip(1) {
        let (before, stage) = (&stages[k - 1], &stages[k]);
        let from = poses[k - 1].then(&before.entry.pose).at;
        if !way_with_clearance(&walls, from, pose.then(&stage.entry.pose).at, before.clearance)? {
            let what = format!("no body fits through from the entry of `{}` to that of `{}`", before.name, stage.name);
            return Err(TerrainError::Misfit(what));
        }
    }
    for (stage, pose) in stages.iter().zip(&poses) {
        let pose = pose.then(&stage.entry.pose);
        construct.markers.push(Marker { name: format!("entry {}", stage.name), pose });
    }
    construct.provenance.schema = stages.iter().map(|stage| stage.name.as_str()).collect::<Vec<_>>().join(" -> ");
    let entries = stages.iter().zip(&poses).map(|(stage, pose)| moved(&stage.entry.region, pose)).collect();
    Ok(Composition { construct, parts, poses, entries })
}
