//! What is there already: walls, the boundary, and the named places that schemas and behaviours refer to.

use crate::TerrainError;
use crate::geometry::{Geometry, Point, Units};
use space::Segment;
use space::exact::side;
use space::shape::Shape;
use std::cmp::Ordering;

/// What is there before anything is generated (lengths in its units).
#[derive(Clone, Debug, PartialEq)]
pub struct Workspace {
    /// Its name.
    pub name: String,
    /// In what lengths are measured.
    pub units: Units,
    /// Walls and discs that are there.
    pub geometry: Vec<Geometry>,
    /// The corners of the polygon that constructs are to stay inside of; without it they may be anywhere.
    pub boundary: Option<Vec<Point>>,
    /// Points at which walls may be anchored, by name.
    pub anchors: Vec<(String, Point)>,
    /// Regions by name; groups begin in `start` and are wanted in `goal` where those are given.
    pub regions: Vec<(String, Shape<f64, 2>)>,
    /// Gates by name: through which side a group passes counts.
    pub gates: Vec<(String, Segment)>,
}

impl Workspace {
    /// An empty workspace.
    pub fn empty(name: &str, units: Units) -> Self {
        Self {
            name: name.to_owned(),
            units,
            geometry: Vec::new(),
            boundary: None,
            anchors: Vec::new(),
            regions: Vec::new(),
            gates: Vec::new(),
        }
    }
    /// The straight walls.
    pub fn walls(&self) -> Vec<Segment> {
        self.geometry.iter().flat_map(Geometry::segments).collect()
    }
    /// The anchor of a name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn anchor(&self, name: &str) -> Result<Point, TerrainError> {
        named("anchor", &self.anchors, name).copied()
    }
    /// The region of a name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn region(&self, name: &str) -> Result<&Shape<f64, 2>, TerrainError> {
        named("region", &self.regions, name)
    }
    /// The gate of a name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn gate(&self, name: &str) -> Result<Segment, TerrainError> {
        named("gate", &self.gates, name).copied()
    }
    /// Whether all points by which a piece is drawn lie inside the boundary or on it.
    pub fn holds(&self, geometry: &Geometry) -> bool {
        self.boundary.as_ref().is_none_or(|corners| geometry.points().iter().all(|&p| within(corners, p)))
    }
}

fn named<'a, T>(kind: &'static str, list: &'a [(String, T)], name: &str) -> Result<&'a T, TerrainError> {
    match list.iter().find(|(known, _)| known == name) {
        Some((_, found)) => Ok(found),
        None => Err(TerrainError::unknown(kind, name, list.iter().map(|(known, _)| known.as_str()))),
    }
}

/// Whether a point lies inside a polygon or on it, exactly (even-odd rule).
pub fn within(corners: &[Point], p: Point) -> bool {
    let sides = crate::geometry::closed(corners);
    if sides.iter().any(|side| side.contains(p)) {
        return true;
    }
    let mut inside = false;
    for edge in sides {
        let up = edge.to[1] > p[1];
        if (edge.from[1] > p[1]) != up {
            // the edge crosses the ray to the right of p where p is left of it as it goes up
            inside ^= (side(edge.from, edge.to, p) == Ordering::Greater) == up;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::Vector;

    #[test]
    fn inside_is_closed() {
        let triangle = [Vector([0.0, 0.0]), Vector([4.0, 0.0]), Vector([0.0, 4.0])];
        for (p, expected) in [
            ([1.0, 1.0], true),
            ([2.0, 2.0], true),
            ([0.0, 0.0], true),
            ([4.0, 0.0], true),
            ([3.0, 3.0], false),
            ([-1.0, 0.0], false),
            ([5.0, 0.0], false),
            ([0.3, 3.7 + 1e-15], false),
        ] {
            assert_eq!(within(&triangle, Vector(p)), expected, "{p:?}");
        }
        assert!(!within(&[], Vector([0.0, 0.0])));
    }

    #[test]
    fn names_that_are_not_there() {
        let mut workspace = Workspace::empty("field", Units::Field);
        workspace.anchors.push(("north".into(), Vector([0.0, 1.0])));
        assert_eq!(workspace.anchor("north"), Ok(Vector([0.0, 1.0])));
        let error = workspace.anchor("nort").map_err(|error| error.to_string());
        assert_eq!(error, Err("unknown anchor `nort`; did you mean `north`?".into()));
    }
}
