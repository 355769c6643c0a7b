//! Constructs that are not built quite as they were drawn: by how much a wall may be off before a group no longer does what is
//! wanted.

use crate::construct::{Construct, Piece};
use crate::draws::Draws;
use crate::geometry::{Geometry, Point, Pose, sin_cos, turned};
use space::{Real, Segment, Vector};

/// How a construct is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Perturbation {
    /// Each joint (a point at which walls begin or end) is displaced by at most `size`, uniformly in a disc.
    Joints,
    /// All of it is displaced by `size` in one random direction.
    Shift,
    /// All of it is turned about the middle of its bounds by at most `size` degrees, to either side.
    Turn,
    /// Each wall loses the share `size` of its length, at its far end.
    Shorten,
    /// So many pieces, drawn at random, are missing.
    Remove,
}

impl Perturbation {
    /// The changed construct. Markers stay where they are: what is wanted does not move with the walls.
    #[must_use]
    pub fn apply(self, construct: &Construct, size: f64, draws: &Draws) -> Construct {
        let mut changed = construct.clone();
        match self {
            Self::Joints => {
                let mut joints: Vec<Point> = Vec::new();
                let mut displaced = |p: Point| {
                    let k = joints.iter().position(|joint| *joint == p).unwrap_or_else(|| {
                        joints.push(p);
                        joints.len() - 1
                    });
                    let distance = size * draws.uniform("distance", k as u32).root();
                    p + towards(draws.uniform("direction", k as u32)) * distance
                };
                for geometry in changed.pieces.iter_mut().flat_map(|piece| &mut piece.geometry) {
                    match geometry {
                        Geometry::Wall(wall) => *wall = Segment { from: displaced(wall.from), to: displaced(wall.to) },
                        Geometry::Disc { centre, .. } | Geometry::Circle { centre, .. } => *centre = displaced(*centre),
                        Geometry::Polygon(corners) => {
                            corners.iter_mut().for_each(|corner| *corner = displaced(*corner))
                        }
                    }
                }
            }
            Self::Shift => {
                let at = towards(draws.uniform("direction", 0)) * size;
                changed.pieces = construct.moved(&Pose { at, heading: 0.0 }).pieces;
            }
            Self::Turn => {
                let Some((low, high)) = construct.bounds() else { return changed };
                let (middle, heading) = ((low + high) * 0.5, size * (2.0 * draws.uniform("angle", 0) - 1.0));
                let at = middle - turned(middle, heading);
                changed.pieces = construct.moved(&Pose { at, heading }).pieces;
            }
            Self::Shorten => {
                for geometry in changed.pieces.iter_mut().flat_map(|piece| &mut piece.geometry) {
                    if let Geometry::Wall(wall) = geometry {
                        wall.to = wall.to + (wall.from - wall.to) * size.clamp(0.0, 1.0);
                    }
                }
            }
            Self::Remove => {
                for k in 0..size.max(0.0) as u32 {
                    if !changed.pieces.is_empty() {
                        let place = (draws.uniform("piece", k) * changed.pieces.len() as f64) as usize;
                        let _: Piece = changed.pieces.remove(place.min(changed.pieces.len() - 1));
                    }
                }
            }
        }
        changed
    }
}

/// The unit vector at a share of the whole turn.
fn towards(share: f64) -> Point {
    let (sin, cos) = sin_cos(360.0 * share);
    Vector([cos, sin])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Units;

    #[test]
    fn what_is_changed_is_changed_by_no_more() {
        let corner = [Segment::new([0.0, 0.0], [4.0, 0.0]), Segment::new([4.0, 0.0], [4.0, 3.0])];
        let construct = Construct::of_walls(Units::Field, corner);
        for attempt in 0..50 {
            let draws = Draws::new(1, attempt, 0);
            let of = |by: Perturbation, size| by.apply(&construct, size, &draws);
            let joints = of(Perturbation::Joints, 0.5).walls();
            assert_eq!(joints[0].to, joints[1].from, "a joint stays a joint");
            for (wall, was) in joints.iter().zip(corner) {
                assert!((wall.from - was.from).length() <= 0.5 && (wall.to - was.to).length() <= 0.5);
            }
            let shifted = of(Perturbation::Shift, 2.0).walls();
            assert!(((shifted[0].from - corner[0].from).length() - 2.0).abs() < 1e-12);
            assert!((shifted[1].length() - 3.0).abs() < 1e-12);
            let turned = of(Perturbation::Turn, 30.0);
            let middle = |construct: &Construct| construct.walls()[0].from + construct.walls()[1].to;
            assert!((middle(&turned) - middle(&construct)).length() < 1e-12, "it turns about its middle");
            assert!((of(Perturbation::Shorten, 0.25).material() - 0.75 * 7.0).abs() < 1e-12);
            assert_eq!(of(Perturbation::Remove, 1.0).pieces.len(), 1);
            assert_eq!(of(Perturbation::Remove, 9.0).pieces.len(), 0);
            for by in [Perturbation::Joints, Perturbation::Shift, Perturbation::Turn, Perturbation::Shorten] {
                assert!(of(by, 0.0).walls().iter().zip(corner).all(|(a, b)| (a.to - b.to).length() < 1e-12));
            }
        }
    }
}
