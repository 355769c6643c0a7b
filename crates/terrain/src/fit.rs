//! Fitting a drawn line by straight pieces and arcs: least squares, split where that is not near enough.

use crate::fragments::{Polyline, turn};
use crate::geometry::{Geometry, Point, along, sin_cos};
use space::{Segment, Vector};

/// Points of a line between which a fit is judged.
const SAMPLES: usize = 65;
/// Fewest points of a piece that may still be split.
const FEWEST: usize = 5;
/// An arc is taken where it is nearer than a segment by this factor at least: else the simpler one.
const GAIN: f64 = 0.5;

/// A piece of a fit.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A straight wall.
    Segment(Segment),
    /// An arc of a circle, between two directions from its centre, degrees; counter-clockwise where `to` is the greater.
    Arc {
        /// Centre of the circle.
        centre: Point,
        /// Its radius.
        radius: f64,
        /// Direction of the first end.
        from: f64,
        /// Direction of the last end.
        to: f64,
    },
}

/// A piece with how far it is off.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The piece.
    pub shape: Shape,
    /// Root mean squared distance of the line from it.
    pub error: f64,
}

impl Shape {
    /// Its length.
    pub fn length(&self) -> f64 {
        match self {
            Self::Segment(segment) => segment.length(),
            Self::Arc { radius, from, to, .. } => radius * (to - from).abs().to_radians(),
        }
    }
    /// How far it turns, counter-clockwise, degrees.
    pub fn turning(&self) -> f64 {
        match self {
            Self::Segment(_) => 0.0,
            Self::Arc { from, to, .. } => to - from,
        }
    }
    /// Direction from its first to its last end, degrees.
    pub fn heading(&self) -> f64 {
        let points = self.points();
        match (points.first(), points.last()) {
            (Some(first), Some(last)) => turn(Vector([1.0, 0.0]), *last - *first),
            _ => 0.0,
        }
    }
    /// The points by which it is built: an arc in steps of at most ten degrees.
    pub fn points(&self) -> Vec<Point> {
        match self {
            Self::Segment(segment) => vec![segment.from, segment.to],
            Self::Arc { centre, radius, from, to } => {
                let steps = ((to - from).abs() / 10.0).ceil().max(1.0) as usize;
                let point = |k: usize| {
                    let (sin, cos) = sin_cos(from + (to - from) * k as f64 / steps as f64);
                    *centre + Vector([cos, sin]) * *radius
                };
                (0..=steps).map(point).collect()
            }
        }
    }
    /// The walls that make it.
    pub fn geometry(&self) -> Vec<Geometry> {
        along(&self.points())
    }
}

/// The part of a line between two arc lengths as segments and arcs, each at most `tolerance` off in the root mean square. What is
/// too far off is split where it is farthest off.
pub fn fit(line: &Polyline, from: f64, to: f64, tolerance: f64) -> Vec<Fit> {
    let at = |k: usize| line.at(from + (to - from) * k as f64 / (SAMPLES - 1) as f64);
    let points: Vec<Point> = (0..SAMPLES).map(at).collect();
    let mut pieces = Vec::new();
    piece(&points, tolerance, &mut pieces);
    pieces
}

fn piece(points: &[Point], tolerance: f64, pieces: &mut Vec<Fit>) {
    let straight = segment(points);
    let near = |fit: &Fit| fit.error <= tolerance;
    let round = arc(points).filter(|arc| near(arc) && arc.error < GAIN * straight.error);
    let best = if near(&straight) { Some(straight.clone()) } else { round };
    if let Some(best) = best {
        pieces.push(best);
        return;
    }
    if points.len() < 2 * FEWEST {
        pieces.push(straight);
        return;
    }
    // at the point farthest from the chord, but not so near an end that nothing is left
    let (first, last) = (points[0], points[points.len() - 1]);
    let chord = Segment { from: first, to: last };
    let inner = FEWEST - 1..points.len() - FEWEST + 1;
    let middle = points.len() / 2;
    let farthest = inner.map(|k| (k, chord.distance(points[k]))).fold((middle, 0.0), |best, one| {
        // where several are as far, a later one changes nothing
        if one.1 > best.1 * (1.0 + 1e-9) { one } else { best }
    });
    piece(&points[..=farthest.0], tolerance, pieces);
    piece(&points[farthest.0..], tolerance, pieces);
}

fn mean(points: &[Point]) -> Point {
    points.iter().fold(Vector::ZERO, |sum, point| sum + *point) / points.len() as f64
}

/// Total least squares: the line through the middle along which points vary most, between the feet of the first and the last.
fn segment(points: &[Point]) -> Fit {
    let middle = mean(points);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for point in points {
        let off = *point - middle;
        xx += off[0] * off[0];
        xy += off[0] * off[1];
        yy += off[1] * off[1];
    }
    // the greater eigenvalue of the scatter, and its vector by the longer of two equal expressions
    let root = ((xx - yy) * (xx - yy) + 4.0 * xy * xy).sqrt();
    let (a, b) = (Vector([xx - yy + root, 2.0 * xy]), Vector([2.0 * xy, yy - xx + root]));
    let way = if a.length() >= b.length() { a } else { b }.unit_or(Vector([1.0, 0.0]));
    let foot = |point: Point| middle + way * (point - middle).dot(way);
    let squares: f64 = points.iter().map(|point| (*point - middle).dot(way.left()).powi(2)).sum();
    let shape = Shape::Segment(Segment { from: foot(points[0]), to: foot(points[points.len() - 1]) });
    Fit { shape, error: (squares / points.len() as f64).sqrt() }
}

/// The circle of least squares of `x^2 + y^2 + ax + by + c` (Kasa 1976), between the directions of the first and the last point; none
/// of points on a line.
fn arc(points: &[Point]) -> Option<Fit> {
    let middle = mean(points);
    let offs: Vec<Point> = points.iter().map(|point| *point - middle).collect();
    let sum = |of: &dyn Fn(Point) -> f64| offs.iter().map(|off| of(*off)).sum::<f64>();
    let (xx, xy, yy) = (sum(&|p| p[0] * p[0]), sum(&|p| p[0] * p[1]), sum(&|p| p[1] * p[1]));
    let (u, v) = (sum(&|p| p[0] * p.length_squared()), sum(&|p| p[1] * p.length_squared()));
    let determinant = xx * yy - xy * xy;
    let scale = (xx + yy) * (xx + yy);
    if determinant <= 1e-12 * scale {
        return None;
    }
    let centre = Vector([(u * yy - v * xy) / (2.0 * determinant), (v * xx - u * xy) / (2.0 * determinant)]);
    let radius = (centre.length_squared() + (xx + yy) / points.len() as f64).sqrt();
    let squares: f64 = offs.iter().map(|off| ((*off - centre).length() - radius).powi(2)).sum();
    let directions: Vec<Point> = offs.iter().map(|off| *off - centre).collect();
    let from = turn(Vector([1.0, 0.0]), directions[0]);
    // step by step, so that an arc of more than half a circle is one
    let swept: f64 = directions.windows(2).map(|two| turn(two[0], two[1])).sum();
    let shape = Shape::Arc { centre: middle + centre, radius, from, to: from + swept };
    Some(Fit { shape, error: (squares / points.len() as f64).sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[[f64; 2]]) -> Polyline {
        Polyline { points: points.iter().map(|point| Vector(*point)).collect(), closed: false }
    }

    #[test]
    fn a_straight_line_is_itself_and_a_drawn_one_nearly() {
        let exact = line(&[[1.0, 2.0], [4.0, 6.0]]);
        let fits = fit(&exact, 0.0, 5.0, 0.01);
        assert_eq!(fits.len(), 1);
        assert!(fits[0].error < 1e-12 && (fits[0].shape.length() - 5.0).abs() < 1e-9);
        let points = fits[0].shape.points();
        assert!((points[0] - Vector([1.0, 2.0])).length() < 1e-9, "{points:?}");
        let drawn = line(&[[0.0, 0.0], [1.0, 0.05], [2.0, -0.05], [3.0, 0.0]]);
        let fits = fit(&drawn, 0.0, drawn.length(), 0.1);
        assert!(fits.len() == 1 && fits[0].error > 0.0 && (fits[0].shape.length() - 3.0).abs() < 0.01);
    }

    #[test]
    fn corners_are_split_and_arcs_found() {
        let corner = line(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]]);
        let fits = fit(&corner, 0.0, 8.0, 0.05);
        assert_eq!(fits.len(), 2, "{fits:?}");
        assert!((fits[0].shape.heading()).abs() < 1e-6 && (fits[1].shape.heading() - 90.0).abs() < 1e-6);
        let circle: Vec<[f64; 2]> = (0..=90)
            .map(|k| {
                let (sin, cos) = sin_cos(f64::from(k) * 3.0);
                [2.0 + 3.0 * cos, -1.0 + 3.0 * sin]
            })
            .collect();
        let drawn = line(&circle);
        let fits = fit(&drawn, 0.0, drawn.length(), 0.01);
        assert_eq!(fits.len(), 1, "{fits:?}");
        let Shape::Arc { centre, radius, .. } = &fits[0].shape else { unreachable!("{fits:?}") };
        assert!((*centre - Vector([2.0, -1.0])).length() < 1e-2 && (radius - 3.0).abs() < 1e-2);
        assert!((fits[0].shape.turning() - 270.0).abs() < 0.5);
    }
}
