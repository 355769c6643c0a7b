//! Straight pieces of the plane: how two of them meet, and who walks through one. Exact for any coordinates.

use crate::exact::{Crossing, FARTHEST, compare, side};
use crate::{Real, Vector};
use core::cmp::Ordering;

/// A closed straight piece of the plane; a point where both ends are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// One end.
    pub from: Vector<f64, 2>,
    /// The other end.
    pub to: Vector<f64, 2>,
}

/// How two segments meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// They have no point in common.
    Apart,
    /// Their interiors cross in one point.
    Proper,
    /// They have exactly one point in common, an end of at least one of them.
    Touch,
    /// They have a piece of positive length in common.
    Overlap,
}

impl Relation {
    /// Its name in files: `none`, `proper`, `touch`, `overlap`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Apart => "none",
            Self::Proper => "proper",
            Self::Touch => "touch",
            Self::Overlap => "overlap",
        }
    }
}

/// The side to which a path goes through a gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passage {
    /// From the right of the gate to its left: +1.
    ToLeft,
    /// From the left of the gate to its right: -1.
    ToRight,
}

impl Passage {
    /// +1 or -1.
    pub fn sign(self) -> i8 {
        match self {
            Self::ToLeft => 1,
            Self::ToRight => -1,
        }
    }
}

impl Segment {
    /// A segment between two points.
    pub fn new(from: [f64; 2], to: [f64; 2]) -> Self {
        Self { from: Vector(from), to: Vector(to) }
    }
    /// The ends as one list of numbers `[x0, y0, x1, y1]`.
    pub fn numbers(&self) -> [f64; 4] {
        [self.from[0], self.from[1], self.to[0], self.to[1]]
    }
    /// Whether the coordinates are numbers of which exact geometry can be made: none is beyond 1e70.
    pub fn exact(&self) -> bool {
        self.numbers().iter().all(|c| c.abs() <= FARTHEST)
    }
    /// Both ends in one place.
    pub fn is_point(&self) -> bool {
        same(self.from, self.to)
    }
    /// Distance between the ends.
    pub fn length(&self) -> f64 {
        (self.to - self.from).length()
    }
    /// The point at a share of the way from one end to the other.
    pub fn at(&self, share: f64) -> Vector<f64, 2> {
        self.from + (self.to - self.from) * share
    }
    /// The point of the segment nearest to `p`, by projection.
    pub fn nearest(&self, p: Vector<f64, 2>) -> Vector<f64, 2> {
        let along = self.to - self.from;
        let squared = along.length_squared();
        if squared == 0.0 {
            return self.from;
        }
        self.at(((p - self.from).dot(along) / squared).clamped(0.0, 1.0))
    }
    /// Distance from `p` to the nearest point of the segment.
    pub fn distance(&self, p: Vector<f64, 2>) -> f64 {
        (p - self.nearest(p)).length()
    }
    /// Distance between the nearest points of two segments; 0 where they meet.
    pub fn distance_to(&self, other: &Self) -> f64 {
        if self.relation(other) != Relation::Apart {
            return 0.0;
        }
        let ends =
            [self.distance(other.from), self.distance(other.to), other.distance(self.from), other.distance(self.to)];
        ends.into_iter().fold(f64::INFINITY, f64::min)
    }
    /// Whether `p` lies on the closed segment, exactly.
    pub fn contains(&self, p: Vector<f64, 2>) -> bool {
        if self.is_point() {
            return same(self.from, p);
        }
        side(self.from, self.to, p) == Ordering::Equal
            && (0..2).all(|a| {
                let (low, high) = (self.from[a].min(self.to[a]), self.from[a].max(self.to[a]));
                compare(low, p[a]) != Ordering::Greater && compare(p[a], high) != Ordering::Greater
            })
    }
    /// How two segments meet, exactly. A segment without length is a point, and can only touch.
    pub fn relation(&self, other: &Self) -> Relation {
        let touch = |meet| if meet { Relation::Touch } else { Relation::Apart };
        if self.is_point() {
            return touch(other.contains(self.from));
        }
        if other.is_point() {
            return touch(self.contains(other.from));
        }
        let theirs = [side(self.from, self.to, other.from), side(self.from, self.to, other.to)];
        if theirs == [Ordering::Equal; 2] {
            return self.relation_on_one_line(other);
        }
        if theirs[0] == theirs[1] {
            return Relation::Apart;
        }
        let ours = [side(other.from, other.to, self.from), side(other.from, other.to, self.to)];
        if ours[0] == ours[1] {
            return Relation::Apart;
        }
        let ends = theirs.into_iter().chain(ours).any(|side| side == Ordering::Equal);
        if ends { Relation::Touch } else { Relation::Proper }
    }
    /// The relation of two segments on one line.
    fn relation_on_one_line(&self, other: &Self) -> Relation {
        let axis = self.axis();
        let range = |s: &Self| (s.from[axis].min(s.to[axis]), s.from[axis].max(s.to[axis]));
        let (one, two) = (range(self), range(other));
        match compare(one.0.max(two.0), one.1.min(two.1)) {
            Ordering::Less => Relation::Overlap,
            Ordering::Equal => Relation::Touch,
            Ordering::Greater => Relation::Apart,
        }
    }
    /// An axis along which the ends differ, where they do.
    pub fn axis(&self) -> usize {
        usize::from(compare(self.from[0], self.to[0]) == Ordering::Equal)
    }
    /// Where the lines of two segments cross, which must not be parallel.
    pub fn crossing(&self, other: &Self) -> Crossing {
        Crossing::new([self.from, self.to], [other.from, other.to])
    }
    /// Whether a straight step goes through this segment as a gate, and to which side: its ends lie on different
    /// sides of the gate's line, where a point on the line counts as left, and the step meets the closed gate.
    pub fn passage(&self, from: Vector<f64, 2>, to: Vector<f64, 2>) -> Option<Passage> {
        let left = |p| side(self.from, self.to, p) != Ordering::Less;
        let passage = match (left(from), left(to)) {
            (false, true) => Passage::ToLeft,
            (true, false) => Passage::ToRight,
            _ => return None,
        };
        (Self { from, to }.relation(self) != Relation::Apart).then_some(passage)
    }
    /// Every passage of a path through this segment as a gate: the index of the point arrived at, and the side.
    pub fn passages(&self, path: &[Vector<f64, 2>]) -> Vec<(usize, Passage)> {
        let step = |(k, step): (usize, &[Vector<f64, 2>])| Some((k + 1, self.passage(step[0], step[1])?));
        path.windows(2).enumerate().filter_map(step).collect()
    }
}

/// Whether two points are one, as exact geometry sees them.
pub fn same(a: Vector<f64, 2>, b: Vector<f64, 2>) -> bool {
    (0..2).all(|axis| compare(a[axis], b[axis]) == Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, uniform};

    fn relation(a: [f64; 4], b: [f64; 4]) -> Relation {
        let segment = |[x0, y0, x1, y1]: [f64; 4]| Segment::new([x0, y0], [x1, y1]);
        segment(a).relation(&segment(b))
    }

    #[test]
    fn every_way_two_segments_can_meet() {
        use Relation::{Apart, Overlap, Proper, Touch};
        assert_eq!(relation([0., 0., 4., 4.], [0., 4., 4., 0.]), Proper);
        assert_eq!(relation([0., 0., 4., 0.], [2., 0., 2., 3.]), Touch, "an end on an interior");
        assert_eq!(relation([0., 0., 4., 0.], [4., 0., 6., 2.]), Touch, "a common end");
        assert_eq!(relation([0., 0., 4., 0.], [4., 0., 9., 0.]), Touch, "in a row");
        assert_eq!(relation([0., 0., 4., 0.], [3., 0., 9., 0.]), Overlap);
        assert_eq!(relation([0., 0., 4., 0.], [0., 0., 4., 0.]), Overlap);
        assert_eq!(relation([0., 0., 4., 0.], [3., 0., 1., 0.]), Overlap, "one inside the other");
        assert_eq!(relation([0., 0., 4., 0.], [5., 0., 9., 0.]), Apart);
        assert_eq!(relation([0., 0., 4., 0.], [0., 1., 4., 1.]), Apart);
        assert_eq!(relation([0., 0., 4., 0.], [5., -1., 5., 1.]), Apart, "the line alone is crossed");
        assert_eq!(relation([2., 0., 2., 0.], [0., 0., 4., 0.]), Touch, "a point on it");
        assert_eq!(relation([2., 1., 2., 1.], [0., 0., 4., 0.]), Apart);
        assert_eq!(relation([2., 1., 2., 1.], [2., 1., 2., 1.]), Touch, "one point twice");
        assert_eq!(relation([2., 1., 2., 1.], [2., 2., 2., 2.]), Apart);
        assert_eq!(relation([0., -0., 0., 1.], [-0., 0., 1., 0.]), Touch, "0 is -0");
        assert_eq!(relation([0., 0., 1., 1.], [0.1 + 0.2, 0.3, 0.3, 0.1 + 0.2]), Proper);
        assert_eq!(relation([0., 0., 1., 1.], [0.1 + 0.2, 0.3, 1., 0.]), Apart, "one bit below the line");
    }

    /// The relation in whole numbers, by clipping the parameters of the common line or solving for both.
    fn by_whole_numbers(a: [i64; 4], b: [i64; 4]) -> Relation {
        let on = |[x0, y0, x1, y1]: [i64; 4], px: i64, py: i64| {
            (x1 - x0) * (py - y0) == (y1 - y0) * (px - x0)
                && px >= x0.min(x1)
                && px <= x0.max(x1)
                && py >= y0.min(y1)
                && py <= y0.max(y1)
        };
        // the ends that lie on the other, as a set of points
        let mut ends = std::collections::BTreeSet::new();
        for (s, t) in [(a, b), (b, a)] {
            for (x, y) in [(s[0], s[1]), (s[2], s[3])] {
                if on(t, x, y) {
                    ends.insert((x, y));
                }
            }
        }
        let cross = (a[2] - a[0]) * (b[3] - b[1]) - (a[3] - a[1]) * (b[2] - b[0]);
        if ends.len() > 1 {
            return Relation::Overlap;
        }
        if ends.len() == 1 {
            return Relation::Touch;
        }
        if cross == 0 {
            return Relation::Apart;
        }
        let t = (b[0] - a[0]) * (b[3] - b[1]) - (b[1] - a[1]) * (b[2] - b[0]);
        let u = (b[0] - a[0]) * (a[3] - a[1]) - (b[1] - a[1]) * (a[2] - a[0]);
        let inside = |n: i64| n * cross.signum() > 0 && n * cross.signum() < cross.abs();
        if inside(t) && inside(u) { Relation::Proper } else { Relation::Apart }
    }

    #[test]
    fn relations_are_those_of_whole_numbers_in_any_order_and_at_any_scale() {
        let mut seen = [0; 4];
        for round in 0..20_000u64 {
            let limit = if round % 3 == 0 { 3.0 } else { 6.0 };
            let n: [i64; 8] =
                core::array::from_fn(|k| (uniform(9, Purpose::Obstacles, round, k as u32) * limit) as i64);
            let (a, b) = ([n[0], n[1], n[2], n[3]], [n[4], n[5], n[6], n[7]]);
            let expected = by_whole_numbers(a, b);
            seen[expected as usize] += 1;
            for scale in [1.0, 2f64.powi(-40), 1e-3 * 2f64.powi(90)] {
                let scaled = |s: [i64; 4]| s.map(|c| c as f64 * scale);
                let turned = |[x0, y0, x1, y1]: [f64; 4]| [x1, y1, x0, y0];
                let (a, b) = (scaled(a), scaled(b));
                for (a, b) in [(a, b), (b, a), (turned(a), b), (a, turned(b))] {
                    assert_eq!(relation(a, b), expected, "{a:?} {b:?}");
                }
            }
        }
        assert!(seen.iter().all(|&count| count > 300), "{seen:?}");
    }

    #[test]
    fn distances_are_clamped_projections() {
        let s = Segment::new([0.0, 0.0], [4.0, 0.0]);
        assert_eq!(s.distance(Vector([1.0, 2.0])), 2.0);
        assert_eq!(s.distance(Vector([-3.0, 4.0])), 5.0);
        assert_eq!(s.distance(Vector([7.0, 4.0])), 5.0);
        assert_eq!(Segment::new([1.0, 1.0], [1.0, 1.0]).distance(Vector([4.0, 5.0])), 5.0, "a point");
        assert_eq!(s.distance_to(&Segment::new([5.0, 1.0], [9.0, 1.0])), 2f64.sqrt());
        assert_eq!(s.distance_to(&Segment::new([2.0, -1.0], [2.0, 1.0])), 0.0);
        // shorter than the length of a vector that counts as zero, and a segment still
        let tiny = Segment::new([0.0, 0.0], [1e-20, 0.0]);
        assert_eq!(tiny.distance(Vector([1.0, 0.0])), 1.0);
    }

    #[test]
    fn gates_are_passed_by_what_crosses_their_line_within_them() {
        let gate = Segment::new([2.0, 0.0], [2.0, 2.0]);
        let passages = |path: &[[f64; 2]]| {
            let path: Vec<_> = path.iter().map(|&p| Vector(p)).collect();
            gate.passages(&path).into_iter().map(|(k, passage)| (k, passage.sign())).collect::<Vec<_>>()
        };
        assert_eq!(passages(&[[0., 1.], [1., 1.], [3., 1.]]), [(2, -1)]);
        assert_eq!(passages(&[[3., 1.], [1., 1.], [3., 1.]]), [(1, 1), (2, -1)]);
        assert_eq!(passages(&[[0., 3.], [4., 3.]]), [], "beside it");
        assert_eq!(passages(&[[0., 2.], [4., 2.]]), [(1, -1)], "at its end");
        assert_eq!(passages(&[[0., 1.], [2., 1.], [3., 1.]]), [(2, -1)], "on the line is left of it");
        assert_eq!(passages(&[[3., 1.], [2., 1.], [3., 1.]]), [(1, 1), (2, -1)], "up to it and back");
        assert_eq!(passages(&[[0., 1.], [2., 1.], [0., 1.]]), []);
        assert_eq!(passages(&[[2., -1.], [2., 1.]]), [], "along the line");
        assert_eq!(passages(&[[1., 1.]]), []);
        let nowhere = Segment::new([1.0, 1.0], [1.0, 1.0]);
        assert_eq!(nowhere.passage(Vector([0.0, 1.0]), Vector([2.0, 1.0])), None, "a point has no sides");
    }
}
