//! The workspaces of the source's experiments. Dimensions that it does not print are decisions, and parameters here.

use crate::geometry::{Geometry, Point, Units, along};
use crate::workspace::Workspace;
use space::shape::Shape;
use space::{Segment, Vector};

/// On which side of the crossbar of a T-junction the stem is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Stem {
    /// Below: the group goes up, and anchor 4 is the corner opposite the turn to the right.
    #[default]
    South,
    /// Above: anchor 4 is then a re-entrant corner. The source does not exclude this reading.
    North,
}

/// Nothing but the plane.
pub fn empty(units: Units) -> Workspace {
    Workspace::empty("empty", units)
}

/// An open field; with `side`, a solid square boundary about the origin.
pub fn field(side: Option<f64>) -> Workspace {
    let mut workspace = Workspace::empty("field", Units::Field);
    if let Some(side) = side {
        fence(&mut workspace, side, side);
    }
    workspace
}

/// A square arena of this side about the origin, with solid walls (metres).
pub fn arena(side: f64) -> Workspace {
    let mut workspace = Workspace::empty("arena", Units::Metres);
    fence(&mut workspace, side, side);
    workspace
}

fn fence(workspace: &mut Workspace, width: f64, height: f64) {
    let (w, h) = (width / 2.0, height / 2.0);
    let corners = vec![Vector([-w, -h]), Vector([w, -h]), Vector([w, h]), Vector([-w, h])];
    workspace.geometry.push(Geometry::Polygon(corners.clone()));
    workspace.boundary = Some(corners);
}

/// A straight corridor along y, open at both ends: walls at `x = -width/2` and `x = width/2`, `0 <= y <= length`
/// (metres; the source's flocking trials used about seven robot diameters, 2.4 m).
pub fn corridor(width: f64, length: f64) -> Workspace {
    let mut workspace = Workspace::empty("corridor", Units::Metres);
    let half = width / 2.0;
    sides(&mut workspace, half, 0.0, length);
    workspace.gates.push(("exit".into(), Segment::new([half, length], [-half, length])));
    workspace
}

fn sides(workspace: &mut Workspace, half: f64, low: f64, high: f64) {
    for x in [-half, half] {
        workspace.geometry.push(Geometry::wall(Vector([x, low]), Vector([x, high])));
    }
    let corners = [[-half, low], [half, low], [half, high], [-half, high]];
    workspace.boundary = Some(corners.map(Vector).to_vec());
}

/// The corridor of the two-wall schema: 16 m wide, walls from y = -30 to 40, anchors `left` and `right` opposite each
/// other at y = 0 (metres).
pub fn dsdr_corridor() -> Workspace {
    let mut workspace = Workspace::empty("dsdr-corridor", Units::Metres);
    sides(&mut workspace, 8.0, -30.0, 40.0);
    workspace.anchors = vec![("left".into(), Vector([-8.0, 0.0])), ("right".into(), Vector([8.0, 0.0]))];
    workspace.regions.push(("start".into(), rectangle([-6.0, -7.5], [6.0, -4.5])));
    workspace
}

/// A box along the axes, as a region.
fn rectangle(low: [f64; 2], high: [f64; 2]) -> Shape<f64, 2> {
    Shape::Cuboid { low: Vector(low), high: Vector(high) }
}

/// The T-junction: corridors of width `w` (2 m in the experiments), a stem of 6 m that is closed at its end, and a
/// crossbar `0 <= y <= w`, `|x| <= w/2 + 5`, open at both ends (metres).
///
/// The anchors `1` to `4` are the corners of the junction: `1 = (-w/2, 0)`, `2 = (w/2, 0)`, `3 = (-w/2, w)`,
/// `4 = (w/2, w)`. The gates `right` and `left` stand 1 m into the arms; a group that leaves through them passes from
/// their left to their right. With the stem in the north all is mirrored at the middle of the crossbar but the names
/// of the anchors.
pub fn t_junction(width: f64, stem: Stem) -> Workspace {
    let half = width / 2.0;
    let end = half + 5.0;
    let mirrored = |[x, y]: [f64; 2]| match stem {
        Stem::South => Vector([x, y]),
        Stem::North => Vector([x, width - y]),
    };
    let mut workspace = Workspace::empty("t-junction", Units::Metres);
    let line = |points: &[[f64; 2]]| along(&points.iter().map(|&p| mirrored(p)).collect::<Vec<Point>>());
    workspace.geometry.extend(line(&[[-end, 0.0], [-half, 0.0], [-half, -6.0], [half, -6.0], [half, 0.0], [end, 0.0]]));
    workspace.geometry.extend(line(&[[-end, width], [end, width]]));
    let outline =
        [[-end, 0.], [-half, 0.], [-half, -6.], [half, -6.], [half, 0.], [end, 0.], [end, width], [-end, width]];
    workspace.boundary = Some(outline.map(mirrored).to_vec());
    let anchors = [("1", [-half, 0.0]), ("2", [half, 0.0]), ("3", [-half, width]), ("4", [half, width])];
    workspace.anchors = anchors.map(|(name, at)| (name.to_owned(), Vector(at))).to_vec();
    let gate = half + 1.0;
    workspace.gates = vec![
        ("right".into(), Segment::new([gate, 0.0], [gate, width])),
        ("left".into(), Segment::new([-gate, width], [-gate, 0.0])),
    ];
    let [low, high] = [mirrored([-half, -5.0]), mirrored([half, -3.0])];
    let (bottom, top) = (low[1].min(high[1]), low[1].max(high[1]));
    workspace.regions.push(("start".into(), rectangle([low[0], bottom], [high[0], top])));
    workspace
}

/// The workspaces by the names they have in files, at the dimensions of the experiments.
pub fn all() -> Vec<Workspace> {
    vec![
        empty(Units::Field),
        field(None),
        corridor(2.4, 12.0),
        t_junction(2.0, Stem::South),
        dsdr_corridor(),
        arena(10.0),
    ]
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn a_group_that_turns_right_passes_the_right_gate_to_its_right_side() {
        for stem in [Stem::South, Stem::North] {
            let junction = t_junction(2.0, stem);
            for (name, x) in [("right", 3.0), ("left", -3.0)] {
                let passages = junction.gate(name).unwrap().passages(&[Vector([0.0, 1.0]), Vector([x, 1.0])]);
                assert_eq!(passages.iter().map(|(k, p)| (*k, p.sign())).collect::<Vec<_>>(), [(1, -1)]);
            }
            assert_eq!(junction.anchor("4"), Ok(Vector([1.0, 2.0])));
        }
        // the diagonal that closes the left arm
        let junction = t_junction(2.0, Stem::South);
        let wall = Segment::new([1.0, 2.0], [-1.0, 0.0]);
        let closing = junction.walls().iter().filter(|other| other.contains(wall.to)).count();
        assert_eq!(closing, 2, "it ends in the corner of stem and left arm");
    }

    #[test]
    fn names_are_different_and_starts_lie_inside() {
        let all = all();
        for (k, workspace) in all.iter().enumerate() {
            assert!(all[..k].iter().all(|other| other.name != workspace.name), "{}", workspace.name);
            if let (Ok(start), Some(corners)) = (workspace.region("start"), &workspace.boundary) {
                let (low, high) = start.bounds();
                for p in [low, high] {
                    assert!(crate::workspace::within(corners, p), "{}", workspace.name);
                }
            }
        }
        let north = t_junction(2.0, Stem::North);
        assert_eq!(north.region("start").unwrap().bounds(), (Vector([-1.0, 5.0]), Vector([1.0, 7.0])));
    }
}
