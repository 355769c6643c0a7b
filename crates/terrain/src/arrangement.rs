//! Whether straight walls shut a point in: exactly, whatever way they touch, cross or overlap.
//!
//! All walls are cut where they meet. Their connected components divide the plane into faces, and a component shuts a
//! point in exactly where the walk around one of its faces winds around the point: the walk around the face that holds
//! it once, and with it the walk around the outside the other way. So it is enough to look for any walk that winds,
//! and components that are apart cannot shut in together what none does alone. No coordinate of a crossing is ever
//! computed: crossings are compared with each other, and with the height of the point, by the exact signs of
//! [`space::exact`].

use crate::geometry::Point;
use space::Segment;
use space::exact::{Crossing, compare, side, turn};
use space::segment::{Relation, same};
use std::cmp::Ordering;
use std::collections::HashMap;

/// Where on a wall something meets it.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// In an end of a wall.
    End(Point),
    /// In a crossing with another wall.
    Crossing(Crossing),
}

impl Place {
    /// The exact order of one coordinate and a number.
    fn compare(&self, axis: usize, number: f64) -> Ordering {
        match self {
            Self::End(p) => compare(p[axis], number),
            Self::Crossing(crossing) => crossing.compare(axis, number),
        }
    }
}

/// A meeting on a wall: where, and the number of the corner it is.
#[derive(Clone, Copy, Debug)]
struct Stop {
    place: Place,
    corner: usize,
}

/// The corners in which walls meet; those that turn out to be one place are joined.
#[derive(Default)]
struct Corners {
    parent: Vec<usize>,
    ends: HashMap<[u64; 2], usize>,
}

impl Corners {
    fn new_one(&mut self) -> usize {
        self.parent.push(self.parent.len());
        self.parent.len() - 1
    }
    fn of_end(&mut self, p: Point) -> usize {
        // adding 0 makes one number of 0 and -0
        let key = p.0.map(|c| if compare(c, 0.0) == Ordering::Equal { 0 } else { (c + 0.0).to_bits() });
        if let Some(&known) = self.ends.get(&key) {
            return known;
        }
        let new = self.new_one();
        self.ends.insert(key, new);
        new
    }
    fn root(&self, mut corner: usize) -> usize {
        while self.parent[corner] != corner {
            corner = self.parent[corner];
        }
        corner
    }
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }
}

/// A piece of a wall between two neighbouring corners, as seen from one of them.
#[derive(Clone, Copy, Debug)]
struct Half {
    to: usize,
    /// Points that give its direction and its line.
    from_point: Point,
    to_point: Point,
    /// Number of the half that goes back.
    twin: usize,
    /// Whether its first corner is above the point that is asked about.
    above: bool,
    used: bool,
}

/// Whether a point can get away from closed walls: it lies in the unbounded face of the plane without them. A point on a
/// wall cannot.
///
/// Walls with coordinates beyond 1e70 or not finite are as if not there.
pub fn escapes(walls: &[Segment], point: Point) -> bool {
    let walls: Vec<Segment> = walls.iter().copied().filter(Segment::exact).collect();
    if walls.iter().any(|wall| wall.contains(point)) {
        return false;
    }
    let walls: Vec<Segment> = walls.into_iter().filter(|wall| !wall.is_point()).collect();
    let (stops, mut corners) = meetings(&walls);
    let mut halves: Vec<Half> = Vec::new();
    let mut around: HashMap<usize, Vec<usize>> = HashMap::new();
    for (wall, mut stops) in walls.iter().zip(stops) {
        sort_along(wall, &mut stops);
        join_equal(wall, &stops, &mut corners);
        // joins by other walls may come later: corners are looked up when all are known
        halves.extend(pieces(wall, &stops, point));
    }
    connect(&mut halves, &corners, &mut around);
    around.values_mut().for_each(|leaving| leaving.sort_by(|&a, &b| by_direction(&halves[a], &halves[b])));
    !(0..halves.len()).any(|first| winds(first, &mut halves, &around, point))
}

/// The stops on every wall, not yet in order, and the corners they are.
fn meetings(walls: &[Segment]) -> (Vec<Vec<Stop>>, Corners) {
    let mut corners = Corners::default();
    let mut stops: Vec<Vec<Stop>> = Vec::with_capacity(walls.len());
    for wall in walls {
        stops.push(
            [wall.from, wall.to].map(|end| Stop { place: Place::End(end), corner: corners.of_end(end) }).to_vec(),
        );
    }
    for (i, j) in near_pairs(walls) {
        let (one, two) = (&walls[i], &walls[j]);
        match one.relation(two) {
            Relation::Apart => {}
            Relation::Proper => {
                let corner = corners.new_one();
                stops[i].push(Stop { place: Place::Crossing(one.crossing(two)), corner });
                stops[j].push(Stop { place: Place::Crossing(two.crossing(one)), corner });
            }
            Relation::Touch | Relation::Overlap => {
                for (k, wall, other) in [(i, one, two), (j, two, one)] {
                    for end in [other.from, other.to].into_iter().filter(|&end| wall.contains(end)) {
                        stops[k].push(Stop { place: Place::End(end), corner: corners.of_end(end) });
                    }
                }
            }
        }
    }
    (stops, corners)
}

/// Pairs of walls whose boxes meet, found by a sweep along x.
pub(crate) fn near_pairs(walls: &[Segment]) -> Vec<(usize, usize)> {
    let range = |k: usize, axis: usize| {
        let (a, b) = (walls[k].from[axis], walls[k].to[axis]);
        (a.min(b), a.max(b))
    };
    let mut order: Vec<usize> = (0..walls.len()).collect();
    order.sort_by(|&a, &b| range(a, 0).0.total_cmp(&range(b, 0).0).then(a.cmp(&b)));
    let mut pairs = Vec::new();
    for (n, &i) in order.iter().enumerate() {
        let (right, y) = (range(i, 0).1, range(i, 1));
        // what counts as 0 may still differ: hence `compare`
        for &j in order[n + 1..].iter().take_while(|&&j| compare(range(j, 0).0, right) != Ordering::Greater) {
            let other = range(j, 1);
            if compare(other.0, y.1) != Ordering::Greater && compare(y.0, other.1) != Ordering::Greater {
                pairs.push((i.min(j), i.max(j)));
            }
        }
    }
    pairs
}

/// The exact order of two stops of a wall from its first end to its second.
fn along(wall: &Segment, a: &Stop, b: &Stop) -> Ordering {
    let axis = wall.axis();
    let forward = match (a.place, b.place) {
        (Place::Crossing(one), Place::Crossing(two)) => return one.order(&two),
        (place, Place::End(p)) => place.compare(axis, p[axis]),
        (Place::End(p), place) => place.compare(axis, p[axis]).reverse(),
    };
    if compare(wall.from[axis], wall.to[axis]) == Ordering::Greater { forward.reverse() } else { forward }
}

fn sort_along(wall: &Segment, stops: &mut [Stop]) {
    stops.sort_by(|a, b| along(wall, a, b));
}

/// Joins the corners of stops that are one place.
fn join_equal(wall: &Segment, stops: &[Stop], corners: &mut Corners) {
    for two in stops.windows(2) {
        if along(wall, &two[0], &two[1]) == Ordering::Equal {
            corners.join(two[0].corner, two[1].corner);
        }
    }
}

/// The pieces of a wall between its stops, each forth and back, with unjoined corners: `to`, and in `twin` the corner it
/// leaves from, until [`connect`] knows better.
fn pieces<'a>(wall: &'a Segment, stops: &'a [Stop], point: Point) -> impl Iterator<Item = Half> + 'a {
    let above = move |stop: &Stop| stop.place.compare(1, point[1]) == Ordering::Greater;
    stops.windows(2).filter(|two| along(wall, &two[0], &two[1]) != Ordering::Equal).flat_map(move |two| {
        let half = |from: &Stop, to: &Stop, ends: (Point, Point)| Half {
            to: to.corner,
            from_point: ends.0,
            to_point: ends.1,
            twin: from.corner,
            above: above(from),
            used: false,
        };
        [half(&two[0], &two[1], (wall.from, wall.to)), half(&two[1], &two[0], (wall.to, wall.from))]
    })
}

/// Leaves one of several pieces that lie on each other, and finds for each half its twin and where it leaves from.
fn connect(halves: &mut Vec<Half>, corners: &Corners, around: &mut HashMap<usize, Vec<usize>>) {
    let mut known: HashMap<(usize, usize), ()> = HashMap::new();
    let mut kept: Vec<Half> = Vec::with_capacity(halves.len());
    for pair in halves.chunks_exact(2) {
        let (from, to) = (corners.root(pair[0].twin), corners.root(pair[0].to));
        if known.insert((from.min(to), from.max(to)), ()).is_some() {
            continue;
        }
        let first = kept.len();
        kept.push(Half { to, twin: first + 1, ..pair[0] });
        kept.push(Half { to: from, twin: first, ..pair[1] });
        around.entry(from).or_default().push(first);
        around.entry(to).or_default().push(first + 1);
    }
    *halves = kept;
}

/// Counter-clockwise from the x axis, exactly.
fn by_direction(a: &Half, b: &Half) -> Ordering {
    let lower = |half: &Half| {
        let y = compare(half.to_point[1], half.from_point[1]);
        y == Ordering::Less || y == Ordering::Equal && compare(half.to_point[0], half.from_point[0]) == Ordering::Less
    };
    lower(a).cmp(&lower(b)).then_with(|| turn(a.from_point, a.to_point, b.from_point, b.to_point).reverse())
}

/// Whether the walk along a half, always taking the next piece clockwise from the way back, winds around the point.
fn winds(first: usize, halves: &mut [Half], around: &HashMap<usize, Vec<usize>>, point: Point) -> bool {
    let (mut at, mut winding) = (first, 0);
    while !halves[at].used {
        halves[at].used = true;
        let half = halves[at];
        let end_above = halves[half.twin].above;
        if half.above != end_above {
            let left = side(half.from_point, half.to_point, point);
            // the piece passes to the right of the point where the point is left of it going up, right of it going down
            if end_above && left == Ordering::Greater {
                winding += 1;
            } else if !end_above && left == Ordering::Less {
                winding -= 1;
            }
        }
        let leaving = &around[&half.to];
        let back = leaving.iter().position(|&other| other == half.twin).unwrap_or(0);
        at = leaving[(back + leaving.len() - 1) % leaving.len()];
    }
    winding != 0
}

/// The corners of the convex hull of points, counter-clockwise, without points on its sides; fewer than three where all
/// lie on one line.
pub fn hull(points: &[Point]) -> Vec<Point> {
    let mut sorted: Vec<Point> = points.iter().copied().filter(|p| p.finite()).collect();
    sorted.sort_by(|a, b| compare(a[0], b[0]).then(compare(a[1], b[1])));
    sorted.dedup_by(|a, b| same(*a, *b));
    if sorted.len() < 3 {
        return sorted;
    }
    let half = |points: &mut dyn Iterator<Item = &Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for &p in points {
            while let [.., a, b] = chain[..]
                && side(a, b, p) != Ordering::Greater
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut sorted.iter());
    hull.extend(half(&mut sorted.iter().rev()));
    hull
}

/// Whether a point lies strictly inside the convex hull of others: not on its boundary, and never where all of them lie
/// on one line.
pub fn in_hull(points: &[Point], point: Point) -> bool {
    let hull = hull(points);
    hull.len() > 2
        && crate::geometry::closed(&hull).iter().all(|edge| side(edge.from, edge.to, point) == Ordering::Greater)
}

/// What walls make of the place of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corral {
    /// Whether the marker is strictly inside the convex hull.
    pub in_hull: bool,
    /// Whether there is a way from the marker to the outside.
    pub escapes: bool,
}

impl Corral {
    /// What these walls make of this place.
    pub fn of(walls: &[Segment], marker: Point) -> Self {
        let ends: Vec<Point> = walls.iter().flat_map(|wall| [wall.from, wall.to]).collect();
        Self { in_hull: in_hull(&ends, marker), escapes: escapes(walls, marker) }
    }
    /// Both.
    pub fn pass(&self) -> bool {
        self.in_hull && self.escapes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clearance::escapes_with_clearance;
    use crate::draws::Draws;
    use space::Vector;

    fn walls(list: &[[f64; 4]]) -> Vec<Segment> {
        list.iter().map(|&[x0, y0, x1, y1]| Segment::new([x0, y0], [x1, y1])).collect()
    }
    const ORIGIN: Point = Vector([0.0, 0.0]);

    #[test]
    fn closed_open_and_nearly_closed() {
        let square = [[3., -3., 3., 3.], [3., 3., -3., 3.], [-3., 3., -3., -3.], [-3., -3., 3., -3.]];
        assert!(!escapes(&walls(&square), ORIGIN));
        assert!(escapes(&walls(&square), Vector([4.0, 0.0])));
        assert!(escapes(&walls(&square[..3]), ORIGIN));
        assert!(!escapes(&walls(&square), Vector([3.0, 1.0])), "on a wall");
        let ajar =
            [[3., -3., 3., 3.], [3., 3., -3., 3.], [-3., 3., -3., -3.], [-3., -3., 2.999_999_999_999_999_5, -3.]];
        assert!(escapes(&walls(&ajar), ORIGIN), "one bit is a gap for a point");
        assert!(escapes(&[], ORIGIN));
    }

    #[test]
    fn walls_that_cross_touch_or_overlap_close() {
        // a square of four walls that cross at their corners
        let crossed = [[3., -5., 3., 5.], [5., 3., -5., 3.], [-3., 5., -3., -5.], [-5., -3., 5., -3.]];
        assert!(!escapes(&walls(&crossed), ORIGIN));
        // ends that stand on other walls
        let standing = [[-9., -3., 9., -3.], [-3., -3., -3., 9.], [9., -3., 9., 3.], [-3., 3., 9., 3.]];
        assert!(!escapes(&walls(&standing), ORIGIN));
        // a side made of two overlapping walls, one inside the other, and a point of no length
        let doubled = [
            [3., -3., 3., 1.],
            [3., 3., 3., -1.],
            [3., 0., 3., 0.5],
            [7., 7., 7., 7.],
            [3., 3., -3., 3.],
            [-3., 3., -3., -3.],
            [-3., -3., 3., -3.],
        ];
        assert!(!escapes(&walls(&doubled), ORIGIN));
        // three walls through one point, of which floating point has no number: (1, 1/3)
        let fan = [[0., 0., 3., 1.], [0., 1., 3., -1.], [1., -1., 1., 1.]];
        assert!(escapes(&walls(&fan), Vector([1.5, 0.4])));
        let closed = [[0., 0., 3., 1.], [0., 1., 3., -1.], [1., -1., 1., 1.], [3., 1., 3., -1.]];
        assert!(!escapes(&walls(&closed), Vector([2.0, 1.0 / 3.0])));
        assert!(escapes(&walls(&closed), Vector([0.5, 1.0 / 3.0])));
    }

    #[test]
    fn nested_components_and_trees_inside_do_not_confuse() {
        let square = |r: f64| [[r, -r, r, r], [r, r, -r, r], [-r, r, -r, -r], [-r, -r, r, -r]];
        let mut list = square(9.0).to_vec();
        list.extend(square(1.0));
        list.push([3.0, 0.0, 5.0, 0.0]);
        list.push([4.0, 0.0, 4.0, 2.0]);
        assert!(!escapes(&walls(&list), ORIGIN));
        assert!(!escapes(&walls(&list), Vector([2.0, 0.0])));
        assert!(escapes(&walls(&list), Vector([10.0, 0.0])));
        let open: Vec<_> = list.iter().copied().filter(|wall| *wall != square(9.0)[0]).collect();
        assert!(escapes(&walls(&open), Vector([2.0, 0.0])));
        assert!(!escapes(&walls(&open), ORIGIN));
        // two halves that are apart do not close, though each bends around
        let halves = [[-3., -3., -3., 3.], [-3., 3., 2., 3.], [3., 3.5, 3., -3.5], [3., -3.5, -2., -3.5]];
        assert!(escapes(&walls(&halves), ORIGIN));
        // the point in a dead end beside a loop of the same component
        let spiral = [
            [2., 0., 4., 0.],
            [4., 0., 4., 2.],
            [4., 2., 2., 2.],
            [2., 2., 2., 0.],
            [2., 1., -2., 1.],
            [-2., 1., -2., -1.],
        ];
        assert!(escapes(&walls(&spiral), ORIGIN));
        assert!(!escapes(&walls(&spiral), Vector([3.0, 1.0])));
    }

    #[test]
    fn the_answer_does_not_depend_on_order_direction_or_scale() {
        let mut shut = 0;
        for attempt in 0..400 {
            let draws = Draws::new(5, attempt, 0);
            // few whole coordinates, so that walls touch, overlap, and pass through common points
            let coordinate = |k: u32| (draws.uniform("c", k) * 7.0).floor() - 3.0;
            let list: Vec<[f64; 4]> = (0..12).map(|k| core::array::from_fn(|c| coordinate(4 * k + c as u32))).collect();
            let point = Vector([0.25, 0.4]);
            let expected = escapes(&walls(&list), point);
            shut += usize::from(!expected);
            let turned: Vec<_> = list.iter().rev().map(|&[a, b, c, d]| [c, d, a, b]).collect();
            assert_eq!(escapes(&walls(&turned), point), expected, "{list:?}");
            let scaled: Vec<_> = list.iter().map(|wall| wall.map(|c| c * 2f64.powi(-30))).collect();
            assert_eq!(escapes(&walls(&scaled), point * 2f64.powi(-30)), expected);
            // a quarter turn and a mirror image
            let quarter: Vec<_> = list.iter().map(|&[a, b, c, d]| [-b, a, -d, c]).collect();
            assert_eq!(escapes(&walls(&quarter), Vector([-point[1], point[0]])), expected);
            let mirror: Vec<_> = list.iter().map(|&[a, b, c, d]| [a, -b, c, -d]).collect();
            assert_eq!(escapes(&walls(&mirror), Vector([point[0], -point[1]])), expected);
        }
        assert!(shut > 40 && shut < 360, "{shut} shut in");
    }

    #[test]
    fn exact_and_flood_agree_where_no_gap_is_narrow() {
        // walls along the lines of a lattice of spacing 1: a gap is at least 1 wide, and cells are 1/20
        let mut shut = 0;
        for attempt in 0..120 {
            let draws = Draws::new(6, attempt, 0);
            let mut list = Vec::new();
            for x in -2..3 {
                for y in -2..3 {
                    let (x, y) = (f64::from(x), f64::from(y));
                    let name = format!("{x} {y}");
                    for (n, wall) in [[x, y, x + 1.0, y], [x, y, x, y + 1.0]].into_iter().enumerate() {
                        if draws.uniform(&name, n as u32) < 0.5 {
                            list.push(wall);
                        }
                    }
                }
            }
            let (walls, point) = (walls(&list), Vector([0.5, 0.5]));
            let exact = escapes(&walls, point);
            assert_eq!(escapes_with_clearance(&walls, point, 0.2), Ok(exact), "{list:?}");
            shut += usize::from(!exact);
        }
        assert!(shut > 15 && shut < 105, "{shut} shut in");
    }

    #[test]
    fn strictly_inside_the_hull() {
        let square = [[0., 0.], [4., 0.], [4., 4.], [0., 4.], [2., 2.], [2., 0.]].map(Vector);
        assert_eq!(hull(&square).len(), 4, "without the point on a side");
        assert!(in_hull(&square, Vector([1.0, 3.0])));
        assert!(!in_hull(&square, Vector([2.0, 0.0])) && !in_hull(&square, Vector([4.0, 4.0])));
        assert!(!in_hull(&square, Vector([5.0, 2.0])));
        let line = [[0., 0.], [1., 1.], [2., 2.]].map(Vector);
        assert!(!in_hull(&line, Vector([1.0, 1.0])));
        assert!(!in_hull(&[], ORIGIN) && !in_hull(&line[..1], ORIGIN));
    }
}
