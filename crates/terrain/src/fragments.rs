//! Fragments of a construct: the lines that its walls make, and what of the construct lies inside a window that slides along them.

use crate::geometry::{Geometry, Point, Pose, along};
use space::{Real, Segment, Vector};

/// Ends of walls that are this close, in shares of their coordinates, are one corner.
const SAME: f64 = 1e-9;

/// A line of straight walls, by its corners; a disc is a line of one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// The corners, in order.
    pub points: Vec<Point>,
    /// Whether the last corner is joined to the first.
    pub closed: bool,
}

fn near(a: Point, b: Point) -> bool {
    (a - b).length() <= SAME * (1.0 + a.length().max(b.length()))
}

/// The turn from one direction to another, counter-clockwise, degrees in (-180, 180]; 0 where either has no length.
pub fn turn(from: Point, to: Point) -> f64 {
    let (cross, dot) = (from[0] * to[1] - from[1] * to[0], from.dot(to));
    if cross == 0.0 && dot == 0.0 { 0.0 } else { Real::atan2(cross, dot).to_degrees() }
}

impl Polyline {
    /// Its length.
    pub fn length(&self) -> f64 {
        self.stations().last().map_or(0.0, |last| last.0)
    }
    /// Arc lengths with the corners that lie there; of a closed line the first corner stands at both ends.
    fn stations(&self) -> Vec<(f64, Point)> {
        let mut at = 0.0;
        let mut stations: Vec<(f64, Point)> = Vec::with_capacity(self.points.len() + 1);
        for &point in self.points.iter().chain(self.points.first().filter(|_| self.closed)) {
            at += stations.last().map_or(0.0, |last| (point - last.1).length());
            stations.push((at, point));
        }
        stations
    }
    /// The point at an arc length. Beyond its ends: of a closed line the way goes on, of an open one it is the end.
    pub fn at(&self, arc: f64) -> Point {
        let stations = self.stations();
        let (Some(first), Some(last)) = (stations.first(), stations.last()) else { return Vector::ZERO };
        if last.0 <= 0.0 {
            return first.1;
        }
        let arc = if self.closed { arc.rem_euclid(last.0) } else { arc.clamp(0.0, last.0) };
        let after = stations.partition_point(|station| station.0 < arc).clamp(1, stations.len() - 1);
        let (from, to) = (stations[after - 1], stations[after]);
        let share = if to.0 > from.0 { (arc - from.0) / (to.0 - from.0) } else { 0.0 };
        from.1 + (to.1 - from.1) * share
    }
    /// The points between two arc lengths, both ends included.
    pub fn between(&self, from: f64, to: f64) -> Vec<Point> {
        let stations = self.stations();
        let length = self.length();
        let rounds: &[f64] = if self.closed { &[-1.0, 0.0, 1.0] } else { &[0.0] };
        let mut inside: Vec<(f64, Point)> = Vec::new();
        for round in rounds {
            // the first corner of a closed line is also its last: once is enough
            for &(arc, point) in &stations[usize::from(self.closed && *round > -1.0)..] {
                let arc = arc + round * length;
                if from < arc && arc < to {
                    inside.push((arc, point));
                }
            }
        }
        let mut points = vec![self.at(from)];
        points.extend(inside.into_iter().map(|(_, point)| point));
        points.push(self.at(to));
        points.dedup_by(|a, b| near(*a, *b));
        points
    }
    /// How far it turns in all between two arc lengths, counter-clockwise, degrees.
    pub fn turning(&self, from: f64, to: f64) -> f64 {
        self.between(from, to).windows(3).map(|three| turn(three[1] - three[0], three[2] - three[1])).sum()
    }
    /// Arc lengths of the peaks of curvature: in each run of places around which the line turns by at least `corner` degrees within a
    /// length of `over`, the corner that turns most; of equals the middle one.
    pub fn peaks(&self, corner: f64, over: f64) -> Vec<f64> {
        let stations = self.stations();
        let length = self.length();
        let last = stations.len().saturating_sub(1);
        let at = |k: usize| stations[k].1;
        // the corner at its seam belongs to a closed line, the ends of an open one turn nowhere
        let corners = (usize::from(!self.closed)..last).map(|k| {
            let before = if k > 0 { at(k - 1) } else { at(last - 1) };
            (stations[k].0, turn(at(k) - before, at(k + 1) - at(k)).abs())
        });
        let sharp = |arc: f64| self.turning(arc - over / 2.0, arc + over / 2.0).abs() >= corner;
        let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
        for own in corners.filter(|corner| corner.1 > 0.0 && sharp(corner.0)) {
            match runs.last_mut() {
                Some(run) if run.last().is_some_and(|before| own.0 - before.0 < over) => run.push(own),
                _ => runs.push(vec![own]),
            }
        }
        let peak = |run: &Vec<(f64, f64)>| {
            let most = run.iter().map(|corner| corner.1).fold(0.0, f64::max);
            let equal: Vec<f64> =
                run.iter().filter(|corner| corner.1 >= most * (1.0 - 1e-9)).map(|corner| corner.0).collect();
            equal[equal.len() / 2]
        };
        let mut peaks: Vec<f64> = runs.iter().map(peak).collect();
        peaks.retain(|peak| self.closed || (*peak > 0.0 && *peak < length));
        peaks
    }
    /// The stretches between the peaks of curvature, each from one arc length to another; all of the line where there is none.
    pub fn stretches(&self, corner: f64, over: f64) -> Vec<(f64, f64)> {
        let (mut ends, length) = (self.peaks(corner, over), self.length());
        match (self.closed, ends.first().copied()) {
            (true, Some(first)) => ends.push(first + length),
            _ => {
                ends.insert(0, 0.0);
                ends.push(length);
            }
        }
        ends.windows(2).map(|two| (two[0], two[1])).filter(|(from, to)| to > from).collect()
    }
    /// Arc lengths at which windows of a width have their middles, a stride apart: the first and the last window reach the ends of
    /// an open line; one that is no longer than the window has one in its middle.
    pub fn middles(&self, width: f64, stride: f64) -> Vec<f64> {
        let length = self.length();
        if self.closed && length > width {
            let count = (length / stride).ceil().max(1.0) as usize;
            return (0..count).map(|k| k as f64 * stride).collect();
        }
        if length <= width {
            return vec![length / 2.0];
        }
        let count = ((length - width) / stride + 1e-9).floor() as usize;
        let mut middles: Vec<f64> = (0..=count).map(|k| width / 2.0 + k as f64 * stride).collect();
        let last = length - width / 2.0;
        if middles.last().is_some_and(|middle| last - middle > 1e-9 * length) {
            middles.push(last);
        }
        middles
    }
}

/// The lines that geometry makes: walls are joined where exactly two of them meet with their ends. Circles and polygons are closed
/// lines, discs lines of one point; walls without length are none.
pub fn polylines<'a>(geometry: impl IntoIterator<Item = &'a Geometry>) -> Vec<Polyline> {
    let (mut lines, mut walls): (Vec<Polyline>, Vec<Segment>) = (Vec::new(), Vec::new());
    for one in geometry {
        match one {
            Geometry::Wall(wall) if wall.is_point() => {}
            Geometry::Wall(wall) => walls.push(*wall),
            Geometry::Disc { centre, .. } => lines.push(Polyline { points: vec![*centre], closed: false }),
            Geometry::Circle { .. } | Geometry::Polygon(_) => {
                let points = one.segments().iter().map(|side| side.from).collect();
                lines.push(Polyline { points, closed: true });
            }
        }
    }
    let meet = |p: Point| walls.iter().filter(|wall| near(wall.from, p) || near(wall.to, p)).count();
    let mut used = vec![false; walls.len()];
    let mut chains = Vec::new();
    for first in 0..walls.len() {
        if std::mem::replace(&mut used[first], true) {
            continue;
        }
        let mut points = vec![walls[first].from, walls[first].to];
        // to the one end, then to the other
        for _ in 0..2 {
            while let Some(&end) = points.last().filter(|&&end| meet(end) == 2) {
                let next = (0..walls.len()).find(|&k| !used[k] && (near(walls[k].from, end) || near(walls[k].to, end)));
                let Some(next) = next else { break };
                used[next] = true;
                points.push(if near(walls[next].from, end) { walls[next].to } else { walls[next].from });
            }
            points.reverse();
        }
        let closed = points.len() > 3 && near(points[0], points[points.len() - 1]);
        if closed {
            points.pop();
        }
        chains.push(Polyline { points, closed });
    }
    chains.extend(lines);
    chains
}

/// What of a construct lies inside a window on one of its lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Fragment {
    /// Number of the line.
    pub line: usize,
    /// Width of the window.
    pub width: f64,
    /// Arc length of its middle.
    pub middle: f64,
    /// Where it is in the construct: the middle of its walls by their lengths, and the direction of the line through the window.
    pub pose: Pose,
    /// The walls and discs inside the window, in the frame of the pose.
    pub geometry: Vec<Geometry>,
    /// Greatest distance of them from the origin of that frame.
    pub radius: f64,
    /// Length of wall.
    pub length: f64,
    /// How far the line turns within the window, counter-clockwise, degrees.
    pub turning: f64,
}

/// The part of a wall inside a disc; none where it is not, or only touches.
fn inside(wall: &Segment, centre: Point, radius: f64) -> Option<Segment> {
    let (along, off) = (wall.to - wall.from, wall.from - centre);
    let (a, b, c) = (along.length_squared(), off.dot(along), off.length_squared() - radius * radius);
    let under = b * b - a * c;
    if a <= 0.0 || under <= 0.0 {
        return None;
    }
    let root = under.sqrt();
    let (from, to) = (((-b - root) / a).max(0.0), ((-b + root) / a).min(1.0));
    let point = |share: f64| if share == 1.0 { wall.to } else { wall.from + along * share };
    ((to - from) * a.sqrt() > SAME * (1.0 + radius)).then(|| Segment { from: point(from), to: point(to) })
}

/// The fragment of geometry in a window of a width (the diameter of a disc) about a point of one of its lines; none where nothing
/// is inside.
pub fn fragment<'a>(
    geometry: impl IntoIterator<Item = &'a Geometry>,
    lines: &[Polyline],
    number: usize,
    middle: f64,
    width: f64,
) -> Option<Fragment> {
    let line = lines.get(number)?;
    let (about, half) = (line.at(middle), width / 2.0);
    let mut parts = Vec::new();
    for one in geometry {
        match one {
            Geometry::Disc { centre, .. } if (*centre - about).length() <= half => parts.push(one.clone()),
            Geometry::Disc { .. } => {}
            _ => parts.extend(one.segments().iter().filter_map(|wall| inside(wall, about, half)).map(Geometry::Wall)),
        }
    }
    of_parts(parts, line, number, (middle - half, middle + half), width)
}

/// The fragment that is a stretch of a line alone; none of a line without length.
pub fn stretch(lines: &[Polyline], number: usize, from: f64, to: f64) -> Option<Fragment> {
    let line = lines.get(number)?;
    of_parts(along(&line.between(from, to)), line, number, (from, to), to - from)
}

fn of_parts(parts: Vec<Geometry>, line: &Polyline, number: usize, ends: (f64, f64), width: f64) -> Option<Fragment> {
    let weighed = |part: &Geometry| match part {
        Geometry::Wall(wall) => (wall.length(), (wall.from + wall.to) * 0.5),
        Geometry::Disc { centre, radius } | Geometry::Circle { centre, radius } => (2.0 * radius, *centre),
        Geometry::Polygon(_) => (0.0, Vector::ZERO),
    };
    let length: f64 = parts.iter().map(|part| weighed(part).0).sum();
    if length <= 0.0 {
        return None;
    }
    let centre = parts.iter().map(weighed).fold(Vector::ZERO, |sum, (weight, at)| sum + at * weight) / length;
    let heading = turn(Vector([1.0, 0.0]), line.at(ends.1) - line.at(ends.0));
    let pose = Pose { at: centre, heading };
    let back = pose.inverse();
    let geometry: Vec<Geometry> = parts.iter().map(|part| part.moved(&back, [1.0, 1.0])).collect();
    let reach = |part: &Geometry| match part {
        Geometry::Disc { centre, radius } => centre.length() + radius,
        other => other.points().iter().map(|point| point.length()).fold(0.0, f64::max),
    };
    Some(Fragment {
        line: number,
        width,
        middle: (ends.0 + ends.1) / 2.0,
        pose,
        radius: geometry.iter().map(reach).fold(0.0, f64::max),
        geometry,
        length,
        turning: line.turning(ends.0, ends.1),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn wall(numbers: [f64; 4]) -> Geometry {
        let [x0, y0, x1, y1] = numbers;
        Geometry::wall(Vector([x0, y0]), Vector([x1, y1]))
    }

    #[test]
    fn walls_are_joined_where_two_of_them_meet() {
        let corner = [wall([0., 0., 4., 0.]), wall([9., 9., 9., 8.]), wall([4., 3., 4., 0.])];
        let lines = polylines(&corner);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0].points, [[0., 0.], [4., 0.], [4., 3.]].map(Vector));
        assert_eq!((lines[0].length(), lines[0].turning(0.0, 7.0), lines[0].at(5.0)), (7.0, 90.0, Vector([4.0, 1.0])));
        assert_eq!(lines[0].turning(4.5, 7.0), 0.0);
        // at a fork nothing is joined, and a ring is closed
        assert_eq!(polylines(&[wall([0., 0., 1., 0.]), wall([1., 0., 2., 1.]), wall([1., 0., 2., -1.])]).len(), 3);
        let ring = polylines(&[wall([0., 0., 1., 0.]), wall([1., 0., 1., 1.]), wall([1., 1., 0., 0.])]);
        assert!(ring.len() == 1 && ring[0].closed && ring[0].points.len() == 3);
        let square = polylines(&[Geometry::Polygon([[0., 0.], [1., 0.], [1., 1.], [0., 1.]].map(Vector).to_vec())]);
        assert_eq!(
            (square[0].length(), square[0].at(4.5), square[0].at(-0.5)),
            (4., Vector([0.5, 0.]), Vector([0., 0.5]))
        );
        assert_eq!(square[0].turning(-0.5, 3.5), 360.0);
        assert_eq!(square[0].between(3.5, 4.5), [[0., 0.5], [0., 0.], [0.5, 0.]].map(Vector));
    }

    #[test]
    fn windows_reach_both_ends() {
        let line = Polyline { points: vec![Vector([0., 0.]), Vector([10., 0.])], closed: false };
        assert_eq!(line.middles(4.0, 1.0), [2., 3., 4., 5., 6., 7., 8.]);
        assert_eq!(line.middles(7.0, 2.0), [3.5, 5.5, 6.5]);
        assert_eq!(line.middles(12.0, 3.0), [5.0]);
    }

    #[test]
    fn lines_are_split_at_their_peaks_of_curvature() {
        let points = [[0., 0.], [4., 0.], [8., 0.4], [8., 5.]].map(Vector).to_vec();
        let line = Polyline { points: points.clone(), closed: false };
        let corner = 4.0 + (points[2] - points[1]).length();
        assert_eq!(line.peaks(30.0, 1.0), [corner], "the slight bend is none");
        assert_eq!(line.stretches(30.0, 1.0), [(0.0, corner), (corner, line.length())]);
        let own = stretch(std::slice::from_ref(&line), 0, corner, line.length()).unwrap();
        assert_eq!((own.geometry.len(), own.turning, own.pose.heading), (1, 0.0, 90.0));
        // an arc is split in its middle, a square at its corners
        let (lead, arc) =
            ([[-3., 1.]], (0..=18).map(|k| crate::geometry::turned(Vector([0., 1.]), -5.0 * f64::from(k)).0));
        let round = Polyline { points: lead.into_iter().chain(arc).map(Vector).collect(), closed: false };
        let peaks = round.peaks(30.0, 0.8);
        assert!(peaks.len() == 1 && (peaks[0] - 3.8).abs() < 0.1, "{peaks:?}");
        let square = Polyline { points: [[0., 0.], [2., 0.], [2., 2.], [0., 2.]].map(Vector).to_vec(), closed: true };
        assert_eq!(square.stretches(45.0, 0.5), [(0., 2.), (2., 4.), (4., 6.), (6., 8.)]);
    }

    #[test]
    fn a_fragment_is_what_the_window_shows() {
        let all = [wall([0., 0., 10., 0.]), wall([10., 0., 10., 10.]), wall([0., 1., 20., 1.])];
        let lines = polylines(&all);
        let own = fragment(&all, &lines, 0, 5.0, 4.0).unwrap();
        assert_eq!((own.geometry.len(), own.turning), (2, 0.0));
        let across = 2.0 * 3f64.sqrt();
        assert!((own.length - 4.0 - across).abs() < 1e-12);
        assert!((own.pose.at - Vector([5.0, across / (4.0 + across)])).length() < 1e-12 && own.pose.heading == 0.0);
        let corner = fragment(&all, &lines, 0, 10.0, 1.5).unwrap();
        assert_eq!((corner.turning, corner.pose.heading), (90.0, 45.0));
        // in its frame it lies the same wherever the construct stands
        let away = Pose::new([3.0, -7.0], 90.0);
        let moved: Vec<Geometry> = all.iter().map(|one| one.moved(&away, [1.0, 1.0])).collect();
        let same = fragment(&moved, &polylines(&moved), 0, 10.0, 1.5).unwrap();
        for (a, b) in corner.geometry.iter().zip(&same.geometry) {
            assert!(a.points().iter().zip(b.points()).all(|(a, b)| (*a - b).length() < 1e-12));
        }
        assert!(fragment(&all, &lines, 7, 0.0, 1.0).is_none());
    }
}
