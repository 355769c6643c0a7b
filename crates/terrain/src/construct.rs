//! What the generation rules made, where it came from, and the environment it becomes in a workspace.

use crate::TerrainError;
use crate::draws::Fnv;
use crate::geometry::{Geometry, Point, Pose, Units, bounds};
use crate::grammar::Derivation;
use crate::workspace::Workspace;
use space::shape::{Shape, ShapeError};
use space::{Segment, Vector};

/// A built piece: what agents sense and bump into.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Name of its shape or primitive type: `wall`, `post`...
    pub name: String,
    /// Its geometry.
    pub geometry: Vec<Geometry>,
}

/// A mark that is never built, for behaviours and filters to read.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub pose: Pose,
}

/// Where a construct came from: enough to make it again.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Provenance {
    /// Name of the schema or grammar.
    pub schema: String,
    /// Version of the schema.
    pub version: u32,
    /// Parameters by name.
    pub parameters: Vec<(String, f64)>,
    /// Seed of the set of candidates.
    pub seed: u64,
    /// Number of the attempt under that seed.
    pub attempt: u64,
    /// The steps of the derivation, where a grammar made it.
    pub derivation: Option<Derivation>,
}

/// What the generation rules made, alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Construct {
    /// In what lengths are measured.
    pub units: Units,
    /// What is built, in the order of creation.
    pub pieces: Vec<Piece>,
    /// What is marked.
    pub markers: Vec<Marker>,
    /// Where it came from.
    pub provenance: Provenance,
}

impl Construct {
    /// A construct of pieces, without markers and provenance.
    pub fn new(units: Units, pieces: Vec<Piece>) -> Self {
        Self { units, pieces, markers: Vec::new(), provenance: Provenance::default() }
    }
    /// A construct of straight walls.
    pub fn of_walls(units: Units, walls: impl IntoIterator<Item = Segment>) -> Self {
        let piece = |wall| Piece { name: "wall".into(), geometry: vec![Geometry::Wall(wall)] };
        Self::new(units, walls.into_iter().map(piece).collect())
    }
    /// All geometry that is built.
    pub fn geometry(&self) -> impl Iterator<Item = &Geometry> {
        self.pieces.iter().flat_map(|piece| &piece.geometry)
    }
    /// All straight walls.
    pub fn walls(&self) -> Vec<Segment> {
        self.geometry().flat_map(Geometry::segments).collect()
    }
    /// The marker of a name.
    pub fn marker(&self, name: &str) -> Option<&Marker> {
        self.markers.iter().find(|marker| marker.name == name)
    }
    /// Length of wall that it takes.
    pub fn material(&self) -> f64 {
        self.geometry().map(Geometry::length).sum()
    }
    /// The box around what is built; `None` where nothing is.
    pub fn bounds(&self) -> Option<(Point, Point)> {
        bounds(self.geometry().flat_map(Geometry::points))
    }
    /// A fingerprint of the geometry: equal geometry in equal order, equal hash.
    pub fn hash(&self) -> u64 {
        let mut hash = Fnv::default();
        for piece in &self.pieces {
            hash.take(piece.name.as_bytes());
            for number in piece.geometry.iter().flat_map(Geometry::numbers) {
                // 0 and -0 are one place
                hash.take(&(number + 0.0).to_bits().to_le_bytes());
            }
        }
        hash.0
    }
    /// The same, turned about the origin and moved, rigidly.
    #[must_use]
    pub fn moved(&self, by: &Pose) -> Self {
        let piece = |piece: &Piece| Piece {
            name: piece.name.clone(),
            geometry: piece.geometry.iter().map(|geometry| geometry.moved(by, [1.0, 1.0])).collect(),
        };
        let marker = |marker: &Marker| Marker { name: marker.name.clone(), pose: by.then(&marker.pose) };
        Self {
            units: self.units,
            pieces: self.pieces.iter().map(piece).collect(),
            markers: self.markers.iter().map(marker).collect(),
            provenance: self.provenance.clone(),
        }
    }
}

/// What becomes of the parts of a construct that lie outside the workspace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Placement {
    /// They remain, and have no effect.
    #[default]
    Keep,
    /// Walls are cut at the walls of the workspace: what is beyond them as seen from the first end is left out.
    Clip,
    /// The construct is refused.
    Reject,
}

/// When parts of an environment are there.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TimePlan {
    /// Events, in order of time.
    pub events: Vec<TimeEvent>,
}

/// A piece appears, disappears, or is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeEvent {
    /// Index of the piece of the construct.
    pub piece: usize,
    /// When, in the times of the units.
    pub time: f64,
    /// What happens.
    pub change: Change,
}

/// What happens to a piece at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// It is there from now on.
    Appears,
    /// It is there no longer.
    Disappears,
    /// From now on it stands this far from where it was drawn.
    Moves(Point),
}

impl TimePlan {
    /// Where a piece is at a time, as the offset from its drawn place; `None` while it is not there.
    ///
    /// A piece whose first event is that it appears is not there before.
    pub fn offset(&self, piece: usize, time: f64) -> Option<Point> {
        let mut events = self.events.iter().filter(|event| event.piece == piece);
        let first = events.clone().find(|event| !matches!(event.change, Change::Moves(_)));
        let mut there = !first.is_some_and(|event| event.change == Change::Appears);
        let mut offset = Vector::ZERO;
        for event in events.by_ref().take_while(|event| event.time <= time) {
            match event.change {
                Change::Appears => there = true,
                Change::Disappears => there = false,
                Change::Moves(to) => offset = to,
            }
        }
        there.then_some(offset)
    }
}

/// A construct placed into a workspace.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// What is there already.
    pub workspace: Workspace,
    /// What was made.
    pub construct: Construct,
    /// When its parts are there; without a plan always.
    pub schedule: Option<TimePlan>,
}

impl Environment {
    /// Places a construct into a workspace; `None` where the placement refuses it.
    ///
    /// # Errors
    /// Where the two are in different units.
    pub fn place(
        workspace: &Workspace,
        mut construct: Construct,
        placement: Placement,
    ) -> Result<Option<Self>, TerrainError> {
        if workspace.units != construct.units {
            return Err(TerrainError::Units {
                first: format!("a construct in {} units", construct.units.word()),
                second: format!("the workspace `{}` in {} units", workspace.name, workspace.units.word()),
            });
        }
        match placement {
            Placement::Keep => {}
            Placement::Reject if !construct.geometry().all(|geometry| workspace.holds(geometry)) => return Ok(None),
            Placement::Reject => {}
            Placement::Clip => {
                let walls = workspace.walls();
                for geometry in construct.pieces.iter_mut().flat_map(|piece| &mut piece.geometry) {
                    if let Geometry::Wall(wall) = geometry {
                        *wall = clipped(wall, &walls);
                    }
                }
            }
        }
        Ok(Some(Self { workspace: workspace.clone(), construct, schedule: None }))
    }
    /// All geometry: the workspace's, then the construct's.
    pub fn geometry(&self) -> impl Iterator<Item = &Geometry> {
        self.workspace.geometry.iter().chain(self.construct.geometry())
    }
    /// Everything in the way at the start, as obstacles of a world.
    ///
    /// # Errors
    /// Where a coordinate or radius is none that an obstacle may have.
    pub fn shapes(&self) -> Result<Vec<Shape<f64, 2>>, ShapeError> {
        let mut shapes = Vec::new();
        for geometry in self.geometry() {
            shapes.extend(geometry.shapes()?);
        }
        Ok(shapes)
    }
}

/// A wall up to where it first meets another beyond its own first end.
fn clipped(wall: &Segment, walls: &[Segment]) -> Segment {
    use space::segment::Relation;
    let mut cut = *wall;
    for other in walls {
        let meets = match wall.relation(other) {
            Relation::Proper => Some(wall.crossing(other).place()),
            // an end of the other wall on this one; what merely begins or ends at a wall needs no cut
            Relation::Touch => [other.from, other.to].into_iter().find(|&end| wall.contains(end)),
            Relation::Apart | Relation::Overlap => None,
        };
        if let Some(place) = meets
            && (place - wall.from).length() > 0.0
            && (place - wall.from).length() < (cut.to - wall.from).length()
        {
            cut.to = place;
        }
    }
    cut
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::workspaces;

    fn wall(numbers: [f64; 4]) -> Construct {
        let [x0, y0, x1, y1] = numbers;
        Construct::of_walls(Units::Metres, [Segment::new([x0, y0], [x1, y1])])
    }

    #[test]
    fn placement_keeps_clips_or_rejects() {
        let arena = workspaces::arena(10.0);
        let through = wall([0.0, 0.0, 9.0, 0.0]);
        let placed = |placement| Environment::place(&arena, through.clone(), placement).unwrap();
        assert_eq!(placed(Placement::Keep).unwrap().construct, through);
        assert_eq!(placed(Placement::Reject), None);
        assert_eq!(placed(Placement::Clip).unwrap().construct.walls()[0].numbers(), [0.0, 0.0, 5.0, 0.0]);
        let inside = wall([0.0, 0.0, 4.0, 0.0]);
        for placement in [Placement::Clip, Placement::Reject] {
            let kept = Environment::place(&arena, inside.clone(), placement).unwrap().unwrap();
            assert_eq!(kept.construct, inside);
        }
        let anchored = wall([5.0, 1.0, 2.0, 1.0]);
        let kept = Environment::place(&arena, anchored.clone(), Placement::Clip).unwrap().unwrap();
        assert_eq!(kept.construct, anchored, "a wall that begins at the boundary is not cut away");
        let field = Construct::of_walls(Units::Field, []);
        assert!(Environment::place(&arena, field, Placement::Keep).unwrap_err().to_string().contains("field"));
    }

    #[test]
    fn hashes_tell_geometry_apart() {
        assert_eq!(wall([0.0, 0.0, 1.0, 0.0]).hash(), wall([-0.0, 0.0, 1.0, -0.0]).hash());
        assert_ne!(wall([0.0, 0.0, 1.0, 0.0]).hash(), wall([0.0, 0.0, 0.0, 1.0]).hash());
        assert_eq!(wall([0.0, 0.0, 3.0, 4.0]).material(), 5.0);
        assert_eq!(Construct::new(Units::Field, Vec::new()).bounds(), None);
    }

    #[test]
    fn pieces_come_and_go_in_time() {
        let event = |piece, time, change| TimeEvent { piece, time, change };
        let far = Vector([3.0, 0.0]);
        let plan = TimePlan {
            events: vec![
                event(0, 5.0, Change::Appears),
                event(1, 6.0, Change::Moves(far)),
                event(0, 9.0, Change::Disappears),
            ],
        };
        let there = |piece, time| plan.offset(piece, time);
        assert_eq!([there(0, 0.0), there(0, 5.0), there(0, 9.0)], [None, Some(Vector::ZERO), None]);
        assert_eq!([there(1, 0.0), there(1, 6.0), there(2, 6.0)], [Some(Vector::ZERO), Some(far), Some(Vector::ZERO)]);
    }
}
