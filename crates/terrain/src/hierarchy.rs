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

    fn port(x: f64, y: f64, heading: f64) -> Port {
        let region = Shape::Ball { centre: Vector([x, y]), radius: 0.4 };
        Port { pose: Pose::new([x, y], heading), region }
    }
    fn stage(name: &str, construct: Construct, entry: Port, exit: Port) -> Stage {
        Stage { name: name.into(), construct, entry, exit: Some(exit), clearance: 0.2 }
    }
    fn funnel() -> Stage {
        let construct = Funnel.construct(&[4.0, 1.0, 45.0, 2.0], &workspaces::arena(10.0), 0, 0).unwrap();
        stage("funnel", construct, port(-2.0, 0.0, 0.0), port(2.5, 0.0, 0.0))
    }
    fn sieve() -> Stage {
        let construct = Sieve.construct(&[5.0, 0.5, 0.0, 0.1], &workspaces::arena(10.0), 0, 0).unwrap();
        stage("sieve", construct, port(0.0, -1.0, 90.0), port(0.0, 1.0, 90.0))
    }
    fn walls(lines: &[[f64; 4]]) -> Construct {
        Construct::of_walls(Units::Metres, lines.iter().map(|&[a, b, c, d]| Segment::new([a, b], [c, d])))
    }

    #[test]
    fn stages_stand_one_behind_the_other() {
        let whole = compose(&[funnel(), sieve()]).unwrap();
        assert_eq!(whole.construct.pieces.len(), funnel().construct.pieces.len() + 5);
        // the sieve is turned so that its entry, one below it, lies on the exit
        let posts: Vec<Point> =
            whole.construct.geometry().filter(|g| g.segments().is_empty()).map(|g| g.points()[0]).collect();
        assert!(posts.iter().all(|post| (post[0] - 3.6).abs() < 0.11), "{posts:?}");
        assert!(whole.entries[1].contains(Vector([2.5, 0.0])));
        assert_eq!(whole.construct.provenance.schema, "funnel -> sieve");
        assert_eq!(compose(&[funnel()]).unwrap().construct.walls(), funnel().construct.walls());
        assert_eq!(whole.construct.marker("entry sieve").unwrap().pose.at, Vector([2.5, 0.0]));
        // without an exit the last stage still stands
        let last = Stage { exit: None, ..sieve() };
        assert_eq!(compose(&[funnel(), last]).unwrap().construct, whole.construct);
    }

    /// Corridors that turn and go on: what was an end in one is a beginning in the next, by a rigid motion alone.
    #[test]
    fn corridors_meet_end_to_end() {
        let corridor = |k: usize, turn: f64| {
            let lines = walls(&[[0.0, 0.5, 2.0, 0.5], [0.0, -0.5, 2.0, -0.5]]);
            stage(&format!("{k}"), lines, port(0.05, 0.0, 0.0), port(2.05, 0.0, turn))
        };
        let turns = [90.0, 37.0, -90.0, 10.0];
        let whole = compose(&turns.map(|turn| corridor(0, turn))).unwrap();
        assert_eq!(whole.construct.walls()[2].from, Vector([1.55, -0.05]), "a quarter turn is exact");
        let mut heading = 0.0;
        for (k, part) in whole.parts.iter().enumerate() {
            let [upper, lower] = <[Segment; 2]>::try_from(part.walls()).unwrap();
            assert!((upper.length() - 2.0).abs() < 1e-12 && ((upper.from - lower.from).length() - 1.0).abs() < 1e-12);
            let along = (upper.to - upper.from).unit();
            assert!((along - crate::geometry::turned(Vector([1.0, 0.0]), heading)).length() < 1e-12);
            if k > 0 {
                let exit = whole.poses[k - 1].place(Vector([2.05, 0.0]));
                let entry = whole.poses[k].place(Vector([0.05, 0.0]));
                assert!((exit - entry).length() < 1e-12);
            }
            heading += turns[k];
        }
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let error = |stages: &[Stage]| compose(stages).unwrap_err();
        let told = |stages: &[Stage]| error(stages).to_string();
        assert!(told(&[]).contains("no stage"));
        assert!(told(&[Stage { exit: None, ..funnel() }, sieve()]).contains("`funnel` has no exit"));
        let mut field = sieve();
        field.construct.units = Units::Field;
        assert!(told(&[funnel(), field]).contains("field"));
        let mut early = funnel();
        early.exit = Some(port(-1.5, 0.0, 180.0));
        let mut wall = stage("wall", walls(&[[-2.1, -5.0, -2.1, 5.0]]), port(-2.0, 0.0, 0.0), port(9.0, 0.0, 0.0));
        wall.entry.region = Shape::Ball { centre: Vector([-3.0, 0.0]), radius: 0.4 };
        let misfit = error(&[early, wall]);
        assert_eq!(misfit, TerrainError::Misfit("a wall of `wall` stands where `funnel` hands over".into()));
        // a post counts as a wall does
        let mut posts = sieve();
        posts.entry = port(0.0, -0.3, 90.0);
        posts.entry.region = Shape::Ball { centre: Vector([0.0, -0.3]), radius: 0.05 };
        let mut wide = funnel();
        wide.exit.as_mut().unwrap().region = Shape::Ball { centre: Vector([2.5, 0.0]), radius: 0.25 };
        assert!(told(&[wide, posts]).contains("a wall of `sieve` stands where `funnel` hands over"));
        // the neck is 1 wide
        let closing = stage("shut", walls(&[[0.0, -0.4, 0.0, 0.4]]), port(0.45, 0.0, 0.0), port(1.0, 0.0, 0.0));
        let closed = error(&[funnel(), Stage { entry: port(0.5, 0.0, 0.0), ..closing }, sieve()]);
        assert_eq!(
            closed,
            TerrainError::Misfit("no body fits through from the entry of `funnel` to that of `shut`".into())
        );
        let thick = Stage { clearance: 0.6, ..funnel() };
        assert!(told(&[thick, sieve()]).contains("no body fits"));
        assert!(compose(&[Stage { clearance: 0.0, ..funnel() }, sieve()]).is_err());
    }
}
