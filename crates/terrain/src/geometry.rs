//! What environments are made of: points with a body, circles, straight walls and polygons, and where they stand.

use space::shape::{Shape, ShapeError};
use space::{Real, Segment, Vector};

/// A point or displacement of the plane.
pub type Point = Vector<f64, 2>;

/// In what lengths and times are measured. The two are never mixed: that is an error, not a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// Field units and iterations.
    Field,
    /// Metres and seconds.
    Metres,
}

impl Units {
    /// Its name in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Field => "field",
            Self::Metres => "metres",
        }
    }
}

/// A place and the direction one faces there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The place, length.
    pub at: Point,
    /// Counter-clockwise from the x axis, degrees.
    pub heading: f64,
}

impl Pose {
    /// At the origin, facing along the x axis.
    pub const ORIGIN: Self = Self { at: Vector([0.0, 0.0]), heading: 0.0 };

    /// A pose.
    pub fn new(at: [f64; 2], heading: f64) -> Self {
        Self { at: Vector(at), heading }
    }
    /// The point that has these coordinates in the frame of the pose (x ahead, y to the left).
    pub fn place(&self, local: Point) -> Point {
        self.at + turned(local, self.heading)
    }
    /// The pose that is this one in the frame of `self`.
    pub fn then(&self, local: &Self) -> Self {
        Self { at: self.place(local.at), heading: self.heading + local.heading }
    }
    /// The pose whose frame undoes this one: `pose.then(&pose.inverse())` is the origin.
    pub fn inverse(&self) -> Self {
        Self { at: -turned(self.at, -self.heading), heading: -self.heading }
    }
}

/// A vector turned counter-clockwise by an angle in degrees. Quarter turns are exact.
pub fn turned(v: Point, degrees: f64) -> Point {
    let (sin, cos) = sin_cos(degrees);
    Vector([v[0] * cos - v[1] * sin, v[0] * sin + v[1] * cos])
}

/// Sine and cosine of an angle in degrees. Those of quarter turns are exact, so that a drawing along the axes is
/// one, whatever headings it went through.
pub fn sin_cos(degrees: f64) -> (f64, f64) {
    let rest = degrees % 360.0;
    let rest = if rest < 0.0 { rest + 360.0 } else { rest };
    if rest == 0.0 || rest == 360.0 {
        (0.0, 1.0)
    } else if rest == 90.0 {
        (1.0, 0.0)
    } else if rest == 180.0 {
        (0.0, -1.0)
    } else if rest == 270.0 {
        (-1.0, 0.0)
    } else {
        degrees.radians().sin_cos()
    }
}

/// A piece of geometry (lengths).
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// A straight thin wall.
    Wall(Segment),
    /// A disc that is in the way: a post, a peg, a robot.
    Disc {
        /// Its middle.
        centre: Point,
        /// Its radius.
        radius: f64,
    },
    /// A circle of thin wall, which may be inside as well as outside.
    Circle {
        /// Its middle.
        centre: Point,
        /// Its radius.
        radius: f64,
    },
    /// A closed line of thin walls; the last corner is joined to the first.
    Polygon(Vec<Point>),
}

/// Into how many straight walls a circle is made for sensing and collision.
pub const CIRCLE_SIDES: usize = 48;

impl Geometry {
    /// A wall between two points.
    pub fn wall(from: Point, to: Point) -> Self {
        Self::Wall(Segment { from, to })
    }
    /// The straight walls that make it; none for a disc.
    pub fn segments(&self) -> Vec<Segment> {
        match self {
            Self::Wall(segment) => vec![*segment],
            Self::Disc { .. } => Vec::new(),
            Self::Circle { centre, radius } => closed(&regular(*centre, *radius, CIRCLE_SIDES)),
            Self::Polygon(corners) => closed(corners),
        }
    }
    /// What is in the way, as obstacles of a world.
    ///
    /// # Errors
    /// Where a coordinate or radius is none that an obstacle may have.
    pub fn shapes(&self) -> Result<Vec<Shape<f64, 2>>, ShapeError> {
        match self {
            Self::Disc { centre, radius } => Ok(vec![Shape::new_ball(*centre, *radius)?]),
            _ => self.segments().iter().map(|s| Shape::new_segment(s.from, s.to)).collect(),
        }
    }
    /// The points that it is drawn by: ends, corners, the four utmost points of a disc.
    pub fn points(&self) -> Vec<Point> {
        match self {
            Self::Wall(segment) => vec![segment.from, segment.to],
            Self::Disc { centre, radius } | Self::Circle { centre, radius } => regular(*centre, *radius, 4),
            Self::Polygon(corners) => corners.clone(),
        }
    }
    /// Length of wall that it takes; a disc takes its diameter.
    pub fn length(&self) -> f64 {
        match self {
            Self::Wall(segment) => segment.length(),
            Self::Disc { radius, .. } => 2.0 * radius,
            Self::Circle { radius, .. } => std::f64::consts::TAU * radius,
            Self::Polygon(_) => self.segments().iter().map(Segment::length).sum(),
        }
    }
    /// The same, elsewhere: its frame, stretched by `stretch` along x, put where the pose is. Under an unequal
    /// stretch discs and circles stay round: they keep the y factor.
    #[must_use]
    pub fn moved(&self, pose: &Pose, stretch: [f64; 2]) -> Self {
        let place = |p: Point| pose.place(Vector([p[0] * stretch[0], p[1] * stretch[1]]));
        match self {
            Self::Wall(s) => Self::wall(place(s.from), place(s.to)),
            Self::Disc { centre, radius } => Self::Disc { centre: place(*centre), radius: radius * stretch[1] },
            Self::Circle { centre, radius } => Self::Circle { centre: place(*centre), radius: radius * stretch[1] },
            Self::Polygon(corners) => Self::Polygon(corners.iter().map(|&corner| place(corner)).collect()),
        }
    }
    /// The numbers that make it, with one that tells the kind, for comparison and hashing.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let (kind, mut rest) = match self {
            Self::Wall(segment) => (0.0, segment.numbers().to_vec()),
            Self::Disc { centre, radius } => (1.0, vec![centre[0], centre[1], *radius]),
            Self::Circle { centre, radius } => (2.0, vec![centre[0], centre[1], *radius]),
            Self::Polygon(corners) => (3.0, corners.iter().flat_map(|corner| corner.0).collect()),
        };
        rest.insert(0, kind);
        rest
    }
}

/// The corners of a regular polygon of so many sides, counter-clockwise from the x axis.
pub fn regular(centre: Point, radius: f64, sides: usize) -> Vec<Point> {
    let corner = |k: usize| {
        let (sin, cos) = sin_cos(360.0 * k as f64 / sides as f64);
        centre + Vector([radius * cos, radius * sin])
    };
    (0..sides).map(corner).collect()
}

/// The sides of a closed line.
pub fn closed(corners: &[Point]) -> Vec<Segment> {
    match corners {
        [] => Vec::new(),
        [only] => vec![Segment { from: *only, to: *only }],
        _ => {
            let following = corners.iter().cycle().skip(1);
            corners.iter().zip(following).map(|(&from, &to)| Segment { from, to }).collect()
        }
    }
}

/// The walls along an open line of points.
pub fn along(points: &[Point]) -> Vec<Geometry> {
    points.windows(2).map(|two| Geometry::wall(two[0], two[1])).collect()
}

/// The box around points: least and greatest coordinates; `None` of no points.
pub fn bounds(points: impl IntoIterator<Item = Point>) -> Option<(Point, Point)> {
    points.into_iter().fold(None, |found, p| {
        let (low, high) = found.unwrap_or((p, p));
        let least = Vector([low[0].min(p[0]), low[1].min(p[1])]);
        let greatest = Vector([high[0].max(p[0]), high[1].max(p[1])]);
        Some((least, greatest))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_compose_and_undo_each_other() {
        let pose = Pose::new([3.0, -2.0], 37.0);
        let back = pose.then(&pose.inverse());
        assert!(back.at.length() < 1e-15 && back.heading == 0.0);
        assert_eq!(
            Pose::new([1.0, 1.0], 90.0).place(Vector([2.0, 0.5])),
            Vector([0.5, 3.0]),
            "quarter turns are exact"
        );
        assert_eq!(Pose::new([0.0, 0.0], -270.0).place(Vector([1.0, 0.0])), Vector([0.0, 1.0]));
        assert_eq!(sin_cos(-0.0), (0.0, 1.0));
        assert_eq!(sin_cos(720.0), (0.0, 1.0));
    }

    #[test]
    fn lengths_and_lowering() {
        let square = Geometry::Polygon(vec![Vector([0., 0.]), Vector([2., 0.]), Vector([2., 2.]), Vector([0., 2.])]);
        assert_eq!((square.length(), square.segments().len()), (8.0, 4));
        let moved = square.moved(&Pose::new([1.0, 0.0], 90.0), [1.0, 1.0]);
        assert_eq!(moved.points()[2], Vector([-1.0, 2.0]));
        let disc = Geometry::Disc { centre: Vector([0.0, 0.0]), radius: 0.5 };
        assert_eq!((disc.segments().len(), disc.length()), (0, 1.0));
        let circle = Geometry::Circle { centre: Vector([0.0, 0.0]), radius: 1.0 };
        assert!(circle.segments().iter().all(|s| s.from.length() < 1.0 + 1e-12));
        assert_eq!(closed(&[]), []);
    }
}
