//! Domains of danger: the ground that lies nearer to a member than to any other, within an arena.
//!
//! W. D. Hamilton (1971), Geometry for the selfish herd, Journal of Theoretical Biology 31:295. A predator that appears anywhere
//! in the arena and takes the nearest member takes each with a probability proportional to its domain.

use space::voronoi::{Scratch, neighbours};
use space::{Edge, Space, Vector};

type Point = Vector<f64, 2>;

/// Lengths of the domains of members on a line, `[places]`: half the gap to either side. Together they fill a ring or the way
/// between walls; in open space the way from the first member to the last.
pub fn on_line(edge: Edge<f64>, places: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_unstable_by(|&i, &j| places[i].total_cmp(&places[j]).then(i.cmp(&j)));
    let (Some(&first), Some(&last)) = (order.first(), order.last()) else { return Vec::new() };
    let (before, after) = match edge {
        Edge::Periodic(length) => {
            let gap = places[first] + length - places[last];
            (gap / 2.0, gap / 2.0)
        }
        Edge::Walls(length) => (places[first].max(0.0), (length - places[last]).max(0.0)),
        Edge::Open => (0.0, 0.0),
    };
    let mut domains = vec![0.0; places.len()];
    domains[first] += before;
    domains[last] += after;
    for pair in order.windows(2) {
        let half = (places[pair[1]] - places[pair[0]]) / 2.0;
        domains[pair[0]] += half;
        domains[pair[1]] += half;
    }
    let same = |i: usize, j: usize| places[i] == places[j];
    share(&order, same, &mut domains);
    domains
}

/// Areas of the domains of members in a convex arena, `[places]`; `arena` has its corners counter-clockwise. Together they fill
/// it. Coincident members share theirs alike.
pub fn in_arena(places: &[Point], arena: &[Point]) -> Vec<f64> {
    let mut scratch = Scratch::default();
    let mut offsets = Vec::with_capacity(places.len());
    let domain = |(i, &here): (usize, &Point)| {
        offsets.clear();
        offsets.extend(places.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, &there)| there - here));
        share_of(cell(arena.iter().map(|&corner| corner - here), &offsets, &mut scratch))
    };
    places.iter().enumerate().map(domain).collect()
}

/// Areas of the domains of members in a box whose axes are walled or periodic, `[places]`. `None` where an axis is open.
pub fn in_box(space: &Space<f64, 2>, places: &[Point]) -> Option<Vec<f64>> {
    let sides = [space.side(0)?, space.side(1)?];
    let shifts = space.periods().map(|period| period.map_or(vec![0.0], |length| vec![0.0, -length, length]));
    let mut scratch = Scratch::default();
    let mut offsets = Vec::with_capacity(places.len() * shifts[0].len() * shifts[1].len());
    let domain = |(i, &here): (usize, &Point)| {
        offsets.clear();
        for (j, &there) in places.iter().enumerate() {
            let offset = space.offset(here, there);
            for &x in &shifts[0] {
                // of the images of the member itself the box takes care
                let images = shifts[1].iter().filter(|_| j != i).map(|&y| offset + Vector([x, y]));
                offsets.extend(images);
            }
        }
        // from wall to wall, or to half way to the next image of the member itself
        let ends = |a: usize| match space.periods()[a] {
            Some(length) => [-length / 2.0, length / 2.0],
            None => [-here.0[a], sides[a] - here.0[a]],
        };
        let ([left, right], [low, high]) = (ends(0), ends(1));
        let corners = [[left, low], [right, low], [right, high], [left, high]].map(Vector);
        share_of(cell(corners.into_iter(), &offsets, &mut scratch))
    };
    Some(places.iter().enumerate().map(domain).collect())
}

/// The area that each of those who share a cell has.
fn share_of((cell, sharers): (Vec<Point>, f64)) -> f64 {
    area(&cell) / sharers
}

/// The part of a convex arena that is nearer to the origin than to any of the others, by their offsets, as a polygon; and how many
/// share it, the one at the origin included.
pub(crate) fn cell(arena: impl Iterator<Item = Point>, others: &[Point], scratch: &mut Scratch) -> (Vec<Point>, f64) {
    let mut near = Vec::new();
    // fails only in dimensions other than one and two
    let _ = neighbours(others, scratch, &mut near);
    let mut polygon: Vec<Point> = arena.collect();
    let mut cut = Vec::with_capacity(polygon.len() + near.len());
    let mut sharers = 1.0;
    for &other in &near {
        let other = others[other as usize];
        if other.is_tiny() {
            sharers += 1.0;
            continue;
        }
        // the line half way
        cut_off(&polygon, other, other.length_squared() / 2.0, &mut cut);
        core::mem::swap(&mut polygon, &mut cut);
    }
    (polygon, sharers)
}

/// The part of a convex polygon where `place . normal <= limit`, into `part`.
fn cut_off(polygon: &[Point], normal: Point, limit: f64, part: &mut Vec<Point>) {
    part.clear();
    for (&here, &next) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (a, b) = (here.dot(normal) - limit, next.dot(normal) - limit);
        if a <= 0.0 {
            part.push(here);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            part.push(here + (next - here) * (a / (a - b)));
        }
    }
}

/// What two convex polygons have in common; the corners of both stand counter-clockwise.
pub fn common(one: &[Point], other: &[Point]) -> Vec<Point> {
    let mut polygon = one.to_vec();
    let mut part = Vec::new();
    for (&here, &next) in other.iter().zip(other.iter().cycle().skip(1)) {
        let outward = -(next - here).left();
        cut_off(&polygon, outward, here.dot(outward), &mut part);
        core::mem::swap(&mut polygon, &mut part);
    }
    polygon
}

/// Area of a polygon whose corners stand counter-clockwise.
pub fn area(polygon: &[Point]) -> f64 {
    let Some(&first) = polygon.first() else { return 0.0 };
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    sides.map(|(&here, &next)| (here - first).left().dot(next - first)).sum::<f64>() / 2.0
}

/// Gives members that are the same, next to each other in an order, the mean of what they have.
fn share(order: &[usize], same: impl Fn(usize, usize) -> bool, amounts: &mut [f64]) {
    for together in order.chunk_by(|&i, &j| same(i, j)) {
        let mean = together.iter().map(|&k| amounts[k]).sum::<f64>() / together.len() as f64;
        together.iter().for_each(|&k| amounts[k] = mean);
    }
}

/// The middle of some numbers: the mean of the two middle ones of an even number. `None` of none.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 { upper } else { (values[middle - 1] + upper) / 2.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9 * expected.max(1.0), "found {found}, expected {expected}");
        }
    }

    #[test]
    fn lines_and_rings() {
        let places = [0.0, 40.0, 100.0, 130.0, 250.0];
        close(&on_line(Edge::Periodic(360.0), &places), &[75.0, 50.0, 45.0, 75.0, 115.0]);
        close(&on_line(Edge::Open, &places), &[20.0, 50.0, 45.0, 75.0, 60.0]);
        close(&on_line(Edge::Walls(300.0), &places), &[20.0, 50.0, 45.0, 75.0, 110.0]);
        close(&on_line(Edge::Walls(10.0), &[4.0]), &[10.0]);
        close(&on_line(Edge::Periodic(10.0), &[4.0]), &[10.0]);
        close(&on_line(Edge::Periodic(10.0), &[4.0, 6.0, 4.0]), &[2.5, 5.0, 2.5]);
        close(&on_line(Edge::Open, &[]), &[]);
    }

    #[test]
    fn squares() {
        let arena = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(Vector);
        close(&in_arena(&[Vector([1.0, 1.0])], &arena), &[16.0]);
        close(&in_arena(&[[1.0, 1.0], [3.0, 1.0], [1.0, 3.0], [3.0, 3.0]].map(Vector), &arena), &[4.0; 4]);
        close(&in_arena(&[[1.0, 2.0], [2.0, 2.0]].map(Vector), &arena), &[6.0, 10.0]);
        close(&in_arena(&[[1.0, 2.0], [2.0, 2.0], [2.0, 2.0]].map(Vector), &arena), &[6.0, 5.0, 5.0]);
        let ring = Space::periodic([4.0, 4.0]);
        close(&in_box(&ring, &[[1.0, 2.0], [2.0, 2.0]].map(Vector)).unwrap_or_default(), &[8.0, 8.0]);
        close(&in_box(&ring, &[[1.0, 3.9]].map(Vector)).unwrap_or_default(), &[16.0]);
        let channel = Space { edges: [Edge::Periodic(4.0), Edge::Walls(4.0)] };
        close(&in_box(&channel, &[[1.0, 1.0], [1.0, 2.0]].map(Vector)).unwrap_or_default(), &[6.0, 10.0]);
        assert_eq!(in_box(&Space::open(), &[]), None);
    }

    #[test]
    fn domains_fill_the_arena() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            10.0 * (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let places: Vec<Point> = (0..80).map(|_| Vector([next(), next()])).collect();
        for space in [Space::periodic([10.0; 2]), Space::walled([10.0; 2])] {
            let domains = in_box(&space, &places).unwrap_or_default();
            close(&[domains.iter().sum()], &[100.0]);
        }
        let Some(hull) = crate::hull::flat_hull(&places) else { return };
        let corners: Vec<Point> = hull.corners.iter().map(|&k| places[k]).collect();
        let domains = in_arena(&places, &corners);
        close(&[domains.iter().sum()], &[hull.area]);
        // by counting a fine lattice of places by their nearest member
        let mut counts = vec![0.0; places.len()];
        let fine = 400;
        for k in 0..fine * fine {
            let spot = Vector([k % fine, k / fine].map(|c| (f64::from(c) + 0.5) * 10.0 / f64::from(fine)));
            let nearest = |best: (f64, usize), i: usize| {
                let squared = (places[i] - spot).length_squared();
                if squared < best.0 { (squared, i) } else { best }
            };
            counts[(0..places.len()).fold((f64::INFINITY, 0), nearest).1] += 100.0 / f64::from(fine * fine);
        }
        let walled = in_box(&Space::walled([10.0; 2]), &places).unwrap_or_default();
        for (found, counted) in walled.iter().zip(&counts) {
            assert!((found - counted).abs() < 0.03, "{found} {counted}");
        }
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![]), None);
    }
}
