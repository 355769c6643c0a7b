//! The walls as a group meets them: how near they are in each sector around its centroid, in its own frame.

use space::Vector;
use terrain::{Geometry, Point};

/// A straight wall: one end, and from there to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// One end.
    pub from: Point,
    /// From it to the other.
    pub along: Point,
}

/// The straight walls of geometry; discs have their circles.
pub fn walls<'a>(geometry: impl IntoIterator<Item = &'a Geometry>) -> Vec<Wall> {
    let segments = geometry.into_iter().flat_map(|geometry| match *geometry {
        Geometry::Disc { centre, radius } => Geometry::Circle { centre, radius }.segments(),
        _ => geometry.segments(),
    });
    segments.map(|segment| Wall { from: segment.from, along: segment.to - segment.from }).collect()
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Which share of a step is free of walls; 1 where none is in the way. A step that begins on a wall is not held by it.
pub fn free(at: Point, step: Point, walls: &[Wall]) -> f64 {
    let mut free = 1.0f64;
    for wall in walls {
        let turning = cross(step, wall.along);
        if turning == 0.0 {
            continue;
        }
        let offset = wall.from - at;
        let (share, place) = (cross(offset, wall.along) / turning, cross(offset, step) / turning);
        if share > 0.0 && share < free && (0.0..=1.0).contains(&place) {
            free = share;
        }
    }
    free
}

/// Sectors of equal size, the first about the heading, on to the left.
#[derive(Clone, Debug)]
pub struct Sectors {
    /// Directions of their lower edges in the group's frame, unit vectors; the last ends where the first begins.
    edges: Vec<Point>,
    reach: f64,
}

impl Sectors {
    /// So many (three or more), that see so far.
    pub fn new(count: usize, reach: f64) -> Self {
        let edge = |k: usize| Vector::at_angle((k as f64 - 0.5) * core::f64::consts::TAU / count as f64);
        Self { edges: (0..count).map(edge).collect(), reach }
    }
    /// How near the nearest wall in each is: 1 at the centroid, 0 at the reach or beyond.
    pub fn nearness(&self, at: Point, heading: Point, walls: &[Wall]) -> Vec<f64> {
        let count = self.edges.len();
        let mut nearest = vec![self.reach * self.reach; count];
        for wall in walls {
            let (from, to) = (wall.from - at, wall.from + wall.along - at);
            // the whole wall out of reach?
            let squared = wall.along.length_squared();
            let share = if squared > 0.0 { (-from.dot(wall.along) / squared).clamp(0.0, 1.0) } else { 0.0 };
            if (from + wall.along * share).length_squared() >= self.reach * self.reach {
                continue;
            }
            let seen = |p: Point| Vector([p.dot(heading), p.dot(heading.left())]);
            let (from, to) = (seen(from), seen(to));
            let along = to - from;
            for k in 0..count {
                let (lower, upper) = (self.edges[k], self.edges[(k + 1) % count]);
                // the part of the wall between both edges
                let (mut first, mut last) = (0.0f64, 1.0f64);
                for (start, change) in
                    [(cross(lower, from), cross(lower, along)), (cross(from, upper), cross(along, upper))]
                {
                    if change == 0.0 {
                        if start < 0.0 {
                            last = -1.0;
                        }
                    } else if change > 0.0 {
                        first = first.max(-start / change);
                    } else {
                        last = last.min(-start / change);
                    }
                }
                if first <= last {
                    let p = from + along * share.clamp(first, last);
                    nearest[k] = nearest[k].min(p.length_squared());
                }
            }
        }
        nearest.into_iter().map(|squared| 1.0 - squared.sqrt() / self.reach).collect()
    }
}
