//! Voronoi neighbours of one member among others, and the area of its cell, from offsets alone.
//!
//! The focal member stands at the origin; the others are given by their offsets from it. So the same function serves
//! open space, periodic space (minimum-image offsets) and any detected subset of a group.
//!
//! **The geometry.** The cell of the origin is `{ x : x . p <= |p|^2 / 2 for every other p }`. Written with the
//! *inverse* `q = p / |p|^2` it is `{ x : x . q <= 1/2 }`, the polar of the convex hull of the inverses and the origin
//! (the inverse of "infinitely far"). Edges of positive length of the cell are therefore the vertices of that hull
//! other than the origin (de Berg, Cheong, van Kreveld and Overmars, *Computational Geometry*, 3rd ed., 2008, chapters
//! 7 and 11). One turn around the origin, in order of direction, finds them (Graham 1972): members hidden behind a
//! nearer one in the same direction drop out, and so does every `b` between `a` and `c` whose inverse does not stick
//! out, `turn(a, b, c) <= 0`. That turn is the in-circle determinant with the origin as fourth point; it and the order
//! of direction are evaluated exactly (Shewchuk 1997, *Discrete & Computational Geometry* 18:305-363: a floating-point
//! filter, then doubled precision, then expansions). So the answer is a function of the *set* of offsets: it depends
//! neither on the order of the members nor on the sets the search below tries on its way.
//!
//! **Periodic axes.** Copies of everyone stand a period away. Nearer to the origin than to its own copies are places at most half
//! a period from it along each such axis; at such a place, the nearest copy of a member whose offset is a minimum image is at most
//! one period from that image. So one copy on either side, of the others and of the origin itself, is exact.
//!
//! **Ties.** Where four or more members lie on one circle, cells may touch in a point. An edge of length zero is no
//! edge here: the diagonals of a square lattice are not neighbours.

use crate::exact::{Expansion, FARTHEST, order, product, significant, sum};
use crate::{Real, Vector};
use core::cmp::Ordering;
use core::fmt;

/// Members this close to each other stand in the same place (lengths).
const TINY: f64 = 1e-12;
/// Its square, for comparison with squared distances.
const TINY_SQUARED: f64 = TINY * TINY;
/// How many of the nearest members the search starts from.
const FIRST: usize = 16;
/// Relative rounding error of the forms of [`Edge`] and of [`turn`]: counting operations gives at most 10 units of
/// 2^-53 (and terms in its square); this is 16.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The same for [`turn_doubled`], whose errors are all of second order: at most some 40 units of 2^-106; this is 1024.
const ROUNDING_DOUBLED: f64 = 256.0 * f64::EPSILON * f64::EPSILON;

/// Why Voronoi neighbours cannot be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VoronoiError {
    /// The space has neither one nor two dimensions.
    Dimension,
}

impl fmt::Display for VoronoiError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dimension => f.write_str(
                "Voronoi neighbours are exact in one and two dimensions only; in three use k_nearest or distance_based",
            ),
        }
    }
}

impl core::error::Error for VoronoiError {}

/// Memory that calls reuse: one per worker thread. What it holds between calls has no influence on any result.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// The members one star is built from.
    near: Vec<Site>,
    /// The neighbours found, counter-clockwise.
    star: Vec<Site>,
    /// The sides of the hull of the inverses of the star (and of the origin where the cell is unbounded).
    edges: Vec<Edge>,
    /// The members that no bound on the distance excludes.
    around: Vec<Site>,
    /// Those of them whose inverses stick out of the hull.
    rest: Vec<Site>,
    /// The squared distance beyond which nobody is a neighbour.
    reach: f64,
}

/// Indices (into `offsets`) of the members whose Voronoi cell shares an edge with that of the member at the origin.
///
/// `offsets` has the shape `[others, D]` in any unit of length, each the other's position minus the focal one's; `out`
/// is cleared and filled in ascending order. Offsets that are not finite are skipped (in two dimensions those with a
/// component beyond 1e70 as well).
///
/// - One dimension: the members directly left and right.
/// - Two dimensions: the Delaunay neighbours, by exact arithmetic on the offsets as given. An edge of length zero does
///   not count (see the module text), so the result never depends on the order of the members. Where all members lie on
///   one line with the origin, to within rounding (steps from each to the next that stand at most 1e-9 radians to it in
///   f64, 1e-4 in f32), the neighbours are those directly before and behind along it.
/// - Members at most 1e-12 apart are in the same place: all of those at the origin are neighbours, and with a neighbour
///   so are all members in its place.
///
/// Source: the row `voronoi` of the perception functions; Gregoire, Chaté and Tu (2003) use it as interaction range.
///
/// # Errors
/// [`VoronoiError::Dimension`] unless `D` is 1 or 2.
pub fn neighbours<R: Real, const D: usize>(
    offsets: &[Vector<R, D>],
    scratch: &mut Scratch,
    out: &mut Vec<u32>,
) -> Result<(), VoronoiError> {
    out.clear();
    match D {
        1 => adjacent(offsets, out),
        2 => {
            build(offsets, scratch, |here| out.push(here));
            let Scratch { star, around, .. } = scratch;
            out.extend(around.iter().filter(|a| star.iter().any(|s| a.coincides(s))).map(|a| a.index));
            out.sort_unstable();
        }
        _ => return Err(VoronoiError::Dimension),
    }
    Ok(())
}

/// As [`neighbours`], in a space in which axes close on themselves after the given periods (units of the offsets). Offsets along
/// those axes are minimum images. A member is a neighbour where any of its copies shares an edge with the origin; `offsets` and
/// `out` are as there.
///
/// # Errors
/// As [`neighbours`].
pub fn neighbours_around<R: Real, const D: usize>(
    offsets: &[Vector<R, D>],
    periods: &[Option<R>; D],
    scratch: &mut Scratch,
    out: &mut Vec<u32>,
) -> Result<(), VoronoiError> {
    scratch.reach = f64::INFINITY;
    neighbours(offsets, scratch, out)?;
    // a copy that is no minimum image is half a period away at least, less what is rounded
    let half = periods.iter().flatten().map(|period| 0.499 * period.to_f64()).fold(f64::INFINITY, f64::min);
    if offsets.is_empty() || !half.is_finite() || scratch.reach < half * half {
        return Ok(());
    }
    let members = offsets.len();
    let mut copies = offsets.to_vec();
    let mut own = Vec::new();
    for shift in 1..3_u32.pow(D as u32) {
        // digits to the base of three: here, a period on, a period back
        let digit = |a: usize| [R::ZERO, R::ONE, -R::ONE][(shift / 3_u32.pow(a as u32) % 3) as usize];
        if (0..D).any(|a| digit(a) != R::ZERO && periods[a].is_none()) {
            continue;
        }
        let shift = Vector(core::array::from_fn(|a| digit(a) * periods[a].unwrap_or(R::ZERO)));
        copies.extend(offsets.iter().map(|&offset| offset + shift));
        own.push(shift);
    }
    let others = copies.len();
    copies.append(&mut own);
    neighbours(&copies, scratch, out)?;
    out.retain(|&copy| (copy as usize) < others);
    out.iter_mut().for_each(|copy| *copy %= members as u32);
    out.sort_unstable();
    out.dedup();
    Ok(())
}

/// Area (squared unit of length) of the Voronoi cell of the origin; `None` where the cell is unbounded, as for members
/// on the hull of the group, or its area too large for `R`.
///
/// `offsets` has the shape `[others, 2]`. Members within 1e-12 of the origin share its cell, which is not divided among
/// them; other offsets are read as by [`neighbours`], and collinear members have unbounded cells.
pub fn cell_area<R: Real>(offsets: &[Vector<R, 2>], scratch: &mut Scratch) -> Option<R> {
    if !build(offsets, scratch, |_| ()) {
        return None;
    }
    // the corner between the neighbours a and b is the centre of the circle through a, b and the origin
    let star = &scratch.star;
    let corner = |i: usize| {
        let (a, b) = (&star[i % star.len()], &star[(i + 1) % star.len()]);
        let twice = 2.0 * (a.x * b.y - a.y * b.x);
        ((a.squared * b.y - b.squared * a.y) / twice, (b.squared * a.x - a.squared * b.x) / twice)
    };
    let mut area = 0.0;
    let mut before = corner(0);
    for i in 1..=star.len() {
        let next = corner(i);
        area += 0.5 * (before.0 * next.1 - before.1 * next.0);
        before = next;
    }
    Some(R::of(area)).filter(|area| area.finite())
}

/// One dimension: members at the origin, the nearest on either side, and all in the same place as those.
fn adjacent<R: Real, const D: usize>(offsets: &[Vector<R, D>], out: &mut Vec<u32>) {
    let (mut left, mut right) = (f64::NEG_INFINITY, f64::INFINITY);
    for offset in offsets {
        let x = offset[0].to_f64();
        if x > TINY {
            right = right.min(x);
        } else if x < -TINY {
            left = left.max(x);
        }
    }
    let neighbour = |x: f64| x.is_finite() && (x.abs() <= TINY || x - right <= TINY && left - x <= TINY);
    // nothing finite lies strictly between the two bounds except at the origin
    out.extend((0u32..).zip(offsets).filter(|(_, offset)| neighbour(offset[0].to_f64())).map(|(i, _)| i));
}

/// A member in two dimensions, away from the origin.
#[derive(Clone, Copy, Debug)]
struct Site {
    x: f64,
    y: f64,
    /// Squared distance from the origin, rounded.
    squared: f64,
    index: u32,
}

impl Site {
    #[inline(always)]
    fn new<R: Real, const D: usize>(offset: &Vector<R, D>, index: u32) -> Option<Self> {
        let (x, y) = (significant(offset[0].to_f64()), significant(offset[1].to_f64()));
        (x.abs() <= FARTHEST && y.abs() <= FARTHEST).then_some(Self { x, y, squared: x * x + y * y, index })
    }
    /// In the same place as another.
    #[inline(always)]
    fn coincides(&self, other: &Self) -> bool {
        let (x, y) = (self.x - other.x, self.y - other.y);
        x * x + y * y <= TINY_SQUARED
    }
    /// Directions in [0, pi) before those in [pi, 2 pi).
    #[inline(always)]
    fn lower(&self) -> bool {
        self.y < 0.0 || self.y == 0.0 && self.x < 0.0
    }
    /// Counter-clockwise from the x axis, exactly; in the same direction the nearest first.
    #[inline(always)]
    fn by_direction(&self, other: &Self) -> Ordering {
        self.lower().cmp(&other.lower()).then_with(|| side(other, self)).then_with(|| {
            let by = |a: f64, b: f64| a.abs().total_cmp(&b.abs());
            by(self.x, other.x).then(by(self.y, other.y)).then(self.index.cmp(&other.index))
        })
    }
    /// Which is nearer to the origin, exactly.
    fn by_distance(&self, other: &Self) -> Ordering {
        let difference = self.squared - other.squared;
        if difference.abs() > ROUNDING * (self.squared + other.squared) {
            return order(difference, 0.0);
        }
        let mut total = Expansion::<8>::default();
        for (factor, site) in [(1.0, self), (-1.0, other)] {
            total.add_product(factor * site.x, site.x);
            total.add_product(factor * site.y, site.y);
        }
        total.sign()
    }
}

/// The members other than those at the origin, which `coincident` receives.
#[inline(always)]
fn sites<R: Real, const D: usize>(
    offsets: &[Vector<R, D>],
    mut coincident: impl FnMut(u32),
) -> impl Iterator<Item = Site> {
    (0u32..).zip(offsets).filter_map(move |(index, offset)| {
        let site = Site::new(offset, index)?;
        if site.squared <= TINY_SQUARED {
            coincident(index);
            return None;
        }
        Some(site)
    })
}

/// Leaves the neighbours (one for each place) in `scratch.star`, counter-clockwise, and in `scratch.around` at least
/// all members in the place of one. Returns whether the cell is bounded.
///
/// Not all members take part in the sort. The star of *any* set S is built first, here of the nearest few. With H the
/// hull of the origin and the inverses of S, a member whose inverse lies inside H is no vertex of the hull of all, and
/// leaving it out changes nothing. So the neighbours among all are the neighbours among the star of S together with the
/// members outside H, whichever S was chosen; there remains to list those outside.
///
/// *Each member outside lies within a known distance.* Let a, b follow each other in the star, less than half a turn
/// apart. `turn(a, b, p) = k |p|^2 + m . p`, with `k = a x b > 0`, is a line of H in terms of the inverse, and positive
/// inside. It is at least `|p| (k |p| - |m|)`, hence positive wherever `|p| > |m| / k`, the diameter of the circle
/// through a, b and the origin. If the origin is inside H all its sides are of that kind, and a member farther than the
/// largest diameter is inside H. (If it is not, two sides of H end at the origin and no distance is enough.) All
/// comparisons allow for the rounding of k, m and |p|, on the side of keeping a member.
fn build<R: Real, const D: usize>(
    offsets: &[Vector<R, D>],
    scratch: &mut Scratch,
    coincident: impl FnMut(u32),
) -> bool {
    let Scratch { near, star, edges, around, rest, reach: farthest } = scratch;
    let mut size = FIRST;
    let mut complete = nearest(sites(offsets, coincident), size, near);
    let mut bounded = turn_around(near, star);
    let reach = sides(star, bounded, edges);
    around.clear();
    around.extend(sites(offsets, |_| ()).filter(|site| site.squared <= reach));
    if !complete {
        rest.clear();
        rest.extend(around.iter().filter(|site| outside(site, edges, star)));
    }
    while !complete && !rest.is_empty() {
        size *= 4;
        complete = nearest(rest.iter().copied(), size, near);
        near.extend_from_slice(star);
        bounded = turn_around(near, star);
        if !complete {
            sides(star, bounded, edges);
            rest.retain(|site| outside(site, edges, star));
        }
    }
    let tolerance = if size_of::<R>() < size_of::<f64>() { 1e-4 } else { 1e-9 };
    if collinear(around, tolerance, near) {
        along_line(around, star);
        bounded = false;
    }
    *farthest = sides(star, bounded, edges);
    bounded
}

/// The `count` nearest into `out` (ties by no rule: the search does not depend on it); whether these are all.
#[inline(always)]
fn nearest(sites: impl Iterator<Item = Site>, count: usize, out: &mut Vec<Site>) -> bool {
    out.clear();
    let mut complete = true;
    let mut limit = f64::INFINITY;
    let shorten = |out: &mut Vec<Site>| {
        out.select_nth_unstable_by(count - 1, |a, b| a.squared.total_cmp(&b.squared));
        out.truncate(count);
        out[count - 1].squared
    };
    for site in sites {
        if site.squared < limit {
            out.push(site);
            if out.len() == 4 * count {
                limit = shorten(out);
                complete = false;
            }
        }
    }
    if out.len() > count {
        shorten(out);
        complete = false;
    }
    complete
}

/// The neighbours of the origin among `sites` (which it sorts and thins out), counter-clockwise, into `star`; whether
/// the cell is bounded. An unbounded one opens between the last and the first.
fn turn_around(sites: &mut Vec<Site>, star: &mut Vec<Site>) -> bool {
    star.clear();
    sites.sort_unstable_by(Site::by_direction);
    sites.dedup_by(|next, kept| next.lower() == kept.lower() && side(kept, next) == Ordering::Equal);
    let count = sites.len();
    // different directions now, so no left turn from one to the next means half a turn or more
    let opening = (0..count).find(|&i| side(&sites[i], &sites[(i + 1) % count]) != Ordering::Greater);
    // start from a vertex of the hull: the first after the opening, or the nearest, whose inverse is the farthest out
    let start = match opening {
        Some(last) => (last + 1) % count,
        None => (0..count).min_by(|&i, &j| sites[i].by_distance(&sites[j])).unwrap_or(0),
    };
    let bounded = opening.is_none() && count > 0;
    for i in 0..count + usize::from(bounded) {
        let site = sites[(start + i) % count];
        while let [.., a, b] = star.as_slice()
            && turn(a, b, &site) != Ordering::Greater
        {
            star.pop();
        }
        star.push(site);
    }
    if bounded {
        star.pop(); // the start, repeated to close the turn
    }
    bounded
}

/// A side of the hull of the inverses as a form in p, `lift |p|^2 + x p_x + y p_y`: positive inside.
#[derive(Clone, Copy, Debug)]
struct Edge {
    lift: f64,
    x: f64,
    y: f64,
    /// The same with every term taken absolutely: [`ROUNDING`] times this bounds the error.
    lift_size: f64,
    x_size: f64,
    y_size: f64,
}

impl Edge {
    /// `turn(a, b, p)`.
    fn between(a: &Site, b: &Site) -> Self {
        let difference = |p: f64, q: f64| (p - q, p.abs() + q.abs());
        let (lift, lift_size) = difference(a.x * b.y, a.y * b.x);
        let (x, x_size) = difference(b.squared * a.y, a.squared * b.y);
        let (y, y_size) = difference(a.squared * b.x, b.squared * a.x);
        Self { lift, x, y, lift_size, x_size, y_size }
    }
    /// `x p_x + y p_y`: a side that ends at the origin.
    fn through_origin(x: f64, y: f64) -> Self {
        Self { lift: 0.0, x, y, lift_size: 0.0, x_size: x.abs(), y_size: y.abs() }
    }
    /// Whether the inverse of a member is certainly inside.
    #[inline(always)]
    fn contains(&self, p: &Site) -> bool {
        let value = self.lift * p.squared + self.x * p.x + self.y * p.y;
        let size = self.lift_size * p.squared + self.x_size * p.x.abs() + self.y_size * p.y.abs();
        value > ROUNDING * size
    }
    /// Distance beyond which every inverse is inside; infinite if there is none.
    fn reach(&self) -> f64 {
        let slope = self.lift - ROUNDING * self.lift_size;
        let size = |x: f64, y: f64| (x * x + y * y).sqrt();
        if slope > 0.0 {
            (size(self.x, self.y) + ROUNDING * size(self.x_size, self.y_size)) / slope
        } else {
            f64::INFINITY
        }
    }
}

/// The sides of the hull of the origin and the inverses of `star`; returns the squared distance up to which there may
/// be inverses outside, or members in the place of a neighbour.
fn sides(star: &[Site], bounded: bool, edges: &mut Vec<Edge>) -> f64 {
    edges.clear();
    edges.extend(star.windows(2).map(|pair| Edge::between(&pair[0], &pair[1])));
    let ([first, ..], [.., last]) = (star, star) else { return f64::INFINITY };
    if !bounded {
        edges.push(Edge::through_origin(last.y, -last.x));
        edges.push(Edge::through_origin(-first.y, first.x));
        return f64::INFINITY;
    }
    edges.push(Edge::between(last, first));
    let reach = edges.iter().map(Edge::reach).fold(0.0, f64::max);
    (reach * (1.0 + TINY) + TINY).powi(2)
}

/// Whether the inverse of a member may stick out of the hull, the star itself excepted.
#[inline(always)]
fn outside(site: &Site, edges: &[Edge], star: &[Site]) -> bool {
    !edges.iter().all(|edge| edge.contains(site)) && star.iter().all(|s| s.index != site.index)
}

/// Whether all lie on one line through the origin: the line from each to the next along it stands at an angle of at
/// most `tolerance` (radians) to it. (Members placed along an oblique line are off it by rounding, and exact arithmetic
/// would then make neighbours of far members whose cells meet at some enormous distance.) `sorted` is scratch.
fn collinear(sites: &[Site], tolerance: f64, sorted: &mut Vec<Site>) -> bool {
    let Some(far) = sites.iter().max_by(|a, b| a.squared.total_cmp(&b.squared)) else { return false };
    let limit = tolerance * tolerance * far.squared;
    let aligned = |x: f64, y: f64| {
        let squared = x * x + y * y;
        (far.x * y - far.y * x).powi(2) <= limit * squared || squared <= TINY_SQUARED
    };
    if !sites.iter().all(|site| aligned(site.x, site.y)) {
        return false;
    }
    let along = |site: &Site| site.x * far.x + site.y * far.y;
    sorted.clear();
    sorted.extend_from_slice(sites);
    sorted.sort_unstable_by(|a, b| along(a).total_cmp(&along(b)));
    sorted.windows(2).all(|pair| aligned(pair[1].x - pair[0].x, pair[1].y - pair[0].y))
}

/// The nearest of `sites`, all on one line through the origin, before and behind it.
fn along_line(sites: &[Site], star: &mut Vec<Site>) {
    star.clear();
    let Some(&ahead) = sites.iter().min_by(|a, b| a.squared.total_cmp(&b.squared)) else { return };
    let behind = sites.iter().filter(|site| site.x * ahead.x + site.y * ahead.y < 0.0);
    star.push(ahead);
    star.extend(behind.min_by(|a, b| a.squared.total_cmp(&b.squared)));
}

/// On which side of the direction `a` the direction `b` is: the exact sign of `a x b`, `Greater` to the left.
#[inline(always)]
fn side(a: &Site, b: &Site) -> Ordering {
    let (left, right) = (a.x * b.y, a.y * b.x);
    if left != right {
        // rounding keeps order, so different rounded products have the order of the exact ones
        return order(left, right);
    }
    order(a.x.mul_add(b.y, -left), a.y.mul_add(b.x, -right))
}

/// The exact sign of `|a|^2 (b x c) + |b|^2 (c x a) + |c|^2 (a x b)`: `Greater` where the inverses of a, b, c turn
/// left. For a, b, c in counter-clockwise order it means that c is outside the circle through a, b and the origin.
#[inline(always)]
fn turn(a: &Site, b: &Site, c: &Site) -> Ordering {
    let term = |p: &Site, q: &Site, r: &Site| {
        let (left, right) = (q.x * r.y, q.y * r.x);
        (p.squared * (left - right), p.squared * (left.abs() + right.abs()))
    };
    let (one, two, three) = (term(a, b, c), term(b, c, a), term(c, a, b));
    let value = one.0 + two.0 + three.0;
    let size = one.1 + two.1 + three.1;
    if value.abs() > ROUNDING * size {
        return order(value, 0.0);
    }
    let value = turn_doubled(a, b, c);
    if value.abs() > ROUNDING_DOUBLED * size {
        return order(value, 0.0);
    }
    turn_exact(a, b, c)
}

/// The value of [`turn`] with twice the digits (Dekker 1971): for members on a circle, whose places are rounded.
#[cold]
fn turn_doubled(a: &Site, b: &Site, c: &Site) -> f64 {
    let (mut value, mut error) = (0.0, 0.0);
    for (p, q, r) in [(a, b, c), (b, c, a), (c, a, b)] {
        let difference = |[left, left_error]: [f64; 2], [right, right_error]: [f64; 2]| {
            let [rounded, rest] = sum(left, -right);
            [rounded, rest + (left_error - right_error)]
        };
        let square = difference(product(p.x, p.x), product(-p.y, p.y));
        let cross = difference(product(q.x, r.y), product(q.y, r.x));
        let [term, rest] = product(square[0], cross[0]);
        let [total, lost] = sum(value, term);
        value = total;
        error += lost + (rest + (square[0] * cross[1] + square[1] * cross[0]));
    }
    value + error
}

/// [`turn`] without rounding.
#[cold]
fn turn_exact(a: &Site, b: &Site, c: &Site) -> Ordering {
    // three times four by four products of two terms
    let mut total = Expansion::<96>::default();
    for (p, q, r) in [(a, b, c), (b, c, a), (c, a, b)] {
        let (xx, yy) = (product(p.x, p.x), product(p.y, p.y));
        let (left, right) = (product(q.x, r.y), product(-q.y, r.x));
        for square in xx.into_iter().chain(yy) {
            for cross in left.into_iter().chain(right) {
                total.add_product(square, cross);
            }
        }
    }
    total.sign()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use spade::{DelaunayTriangulation, Point2, Triangulation};

    /// Uniform numbers in [0, 1), multiples of 2^-20, so that differences of positions are exact in both precisions.
    struct Numbers(u64);
    impl Numbers {
        fn next(&mut self) -> f64 {
            // SplitMix64
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 44) as f64 / f64::from(1 << 20)
        }
        fn below(&mut self, limit: u32) -> f64 {
            (self.next() * f64::from(limit)).floor()
        }
    }

    type Positions = Vec<[f64; 2]>;

    fn offsets<R: Real>(positions: &[[f64; 2]], me: usize) -> (Vec<usize>, Vec<Vector<R, 2>>) {
        let others: Vec<usize> = (0..positions.len()).filter(|&j| j != me).collect();
        let from = |j: usize| Vector([0, 1].map(|a| R::of(positions[j][a] - positions[me][a])));
        let offsets = others.iter().map(|&j| from(j)).collect();
        (others, offsets)
    }

    /// Neighbours of every member, ascending.
    fn all<R: Real>(positions: &[[f64; 2]]) -> Vec<Vec<usize>> {
        let (mut scratch, mut out) = (Scratch::default(), Vec::new());
        let of = |me| {
            let (others, offsets) = offsets::<R>(positions, me);
            neighbours(&offsets, &mut scratch, &mut out).unwrap();
            out.iter().map(|&k| others[k as usize]).collect()
        };
        (0..positions.len()).map(of).collect()
    }

    fn of_offsets<R: Real, const D: usize>(offsets: &[[f64; D]]) -> Vec<u32> {
        let offsets: Vec<Vector<R, D>> = offsets.iter().map(|o| Vector::of(o)).collect();
        let mut out = vec![77];
        neighbours(&offsets, &mut Scratch::default(), &mut out).unwrap();
        out
    }

    fn area(offsets: &[[f64; 2]]) -> Option<f64> {
        let offsets: Vec<Vector<f64, 2>> = offsets.iter().map(|o| Vector::of(o)).collect();
        cell_area(&offsets, &mut Scratch::default())
    }

    /// Neighbours in a space that closes on itself, from the copies two periods far: more than can matter.
    fn around(positions: &[[f64; 2]], me: usize, periods: [Option<f64>; 2]) -> Vec<usize> {
        let mut others = Vec::new();
        let shifts = |a: usize| match periods[a] {
            Some(period) => (-2..=2).map(|k| f64::from(k) * period).collect(),
            None => vec![0.0],
        };
        for (j, there) in positions.iter().enumerate() {
            for x in shifts(0) {
                for y in shifts(1) {
                    if (j, x, y) != (me, 0.0, 0.0) {
                        others.push((j, Vector([there[0] - positions[me][0] + x, there[1] - positions[me][1] + y])));
                    }
                }
            }
        }
        let offsets: Vec<Vector<f64, 2>> = others.iter().map(|(_, offset)| *offset).collect();
        let mut out = Vec::new();
        neighbours(&offsets, &mut Scratch::default(), &mut out).unwrap();
        let mut found: Vec<usize> = out.iter().map(|&k| others[k as usize].0).filter(|&j| j != me).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    #[test]
    fn copies_in_periodic_space_are_neighbours_too() {
        let mut numbers = Numbers(11);
        let mut differ = 0;
        for trial in 0..400 {
            let count = 1 + trial % 24;
            let positions: Positions = (0..count).map(|_| [8.0 * numbers.next(), 2.0 * numbers.next()]).collect();
            for periods in [[Some(8.0), Some(2.0)], [Some(8.0), None], [None, Some(2.0)]] {
                for me in 0..count {
                    let (others, mut offsets) = offsets::<f64>(&positions, me);
                    for offset in &mut offsets {
                        for a in 0..2 {
                            if let Some(period) = periods[a] {
                                offset.0[a] -= period * (offset.0[a] / period).round();
                            }
                        }
                    }
                    let (mut scratch, mut out) = (Scratch::default(), Vec::new());
                    neighbours_around(&offsets, &periods, &mut scratch, &mut out).unwrap();
                    let found: Vec<usize> = out.iter().map(|&k| others[k as usize]).collect();
                    assert_eq!(found, around(&positions, me, periods), "{positions:?} {me} {periods:?}");
                    neighbours(&offsets, &mut scratch, &mut out).unwrap();
                    differ += usize::from(out.len() != found.len());
                }
            }
        }
        assert!(differ > 100, "minimum images alone are not enough: {differ}");
        // on a ring the last is beside the first
        let ring: Vec<Vector<f64, 1>> = [0.4, 0.3, -0.2].map(|x| Vector([x])).to_vec();
        let mut out = Vec::new();
        neighbours_around(&ring, &[Some(1.0)], &mut Scratch::default(), &mut out).unwrap();
        assert_eq!(out, [1, 2]);
        neighbours_around(&ring[..2], &[Some(1.0)], &mut Scratch::default(), &mut out).unwrap();
        assert_eq!(out, [0, 1]);
    }

    fn symmetric(neighbours: &[Vec<usize>]) -> bool {
        let holds = |(i, of_i): (usize, &Vec<usize>)| of_i.iter().all(|&j| neighbours[j].contains(&i));
        neighbours.iter().enumerate().all(holds)
    }

    /// The second opinion: one Delaunay triangulation of all positions (all different).
    fn triangulated(positions: &[[f64; 2]]) -> Vec<Vec<usize>> {
        let mut triangulation = DelaunayTriangulation::<Point2<f64>>::new();
        let mut member = vec![0; positions.len()];
        for (i, p) in positions.iter().enumerate() {
            member[triangulation.insert(Point2::new(p[0], p[1])).unwrap().index()] = i;
        }
        let mut out = vec![Vec::new(); positions.len()];
        for vertex in triangulation.vertices() {
            let of: &mut Vec<usize> = &mut out[member[vertex.fix().index()]];
            of.extend(vertex.out_edges().map(|edge| member[edge.to().fix().index()]));
            of.sort_unstable();
        }
        out
    }

    /// The plain definition for integer positions, exactly: the part of the perpendicular bisector of i and j that is
    /// no nearer to any other member k has positive length. Also whether it is a single point (a tie).
    fn by_definition(positions: &[[f64; 2]], i: usize, j: usize) -> (bool, bool) {
        let minus = |k: usize| [0, 1].map(|a| (positions[k][a] - positions[i][a]) as i128);
        let p = minus(j);
        if p == [0, 0] {
            return (true, false);
        }
        // points p/2 + t (-p_y, p_x); the condition of k is t slope <= rest / 2; fractions (numerator, denominator > 0)
        let (mut low, mut high) = (None::<(i128, i128)>, None::<(i128, i128)>);
        let less = |a: (i128, i128), b: (i128, i128)| a.0 * b.1 < b.0 * a.1;
        for k in (0..positions.len()).filter(|&k| k != i && k != j) {
            let q = minus(k);
            let (slope, rest) = (p[0] * q[1] - p[1] * q[0], q[0] * q[0] + q[1] * q[1] - p[0] * q[0] - p[1] * q[1]);
            if slope > 0 {
                let bound = (rest, slope);
                high = Some(high.map_or(bound, |h| if less(bound, h) { bound } else { h }));
            } else if slope < 0 {
                let bound = (-rest, -slope);
                low = Some(low.map_or(bound, |l| if less(l, bound) { bound } else { l }));
            } else if rest < 0 {
                return (false, false);
            }
        }
        match (low, high) {
            (Some(low), Some(high)) => (less(low, high), !less(low, high) && !less(high, low)),
            _ => (true, false),
        }
    }

    /// The plain definition in floating point for one member: for each other the length of the shared edge.
    fn edge_lengths(offsets: &[Vector<f64, 2>]) -> Vec<f64> {
        let of = |j: usize| {
            let p = offsets[j];
            let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
            for (_, &q) in offsets.iter().enumerate().filter(|&(k, _)| k != j) {
                let (slope, rest) = (p.left().dot(q), 0.5 * (q.dot(q) - p.dot(q)));
                if slope > 0.0 {
                    high = high.min(rest / slope);
                } else {
                    low = low.max(rest / slope);
                }
            }
            (high - low) * p.length()
        };
        (0..offsets.len()).map(of).collect()
    }

    /// Clouds of different positions: uniform, in clusters, along a line, on a ring, with a far outlier.
    fn clouds(count: usize, seed: u64) -> Vec<Positions> {
        let mut numbers = Numbers(seed);
        let centres: Positions = (0..5).map(|_| [numbers.next() - 0.5, numbers.next() - 0.5]).collect();
        let round = |x: f64| (x * f64::from(1 << 20)).round() / f64::from(1 << 20);
        let mut out = vec![Vec::new(); 5];
        for i in 0..count {
            let (a, b) = (numbers.next() - 0.5, numbers.next() - 0.5);
            let centre = centres[i % 5];
            let (sin, cos) = (a * core::f64::consts::TAU).sin_cos();
            out[0].push([a, b]);
            out[1].push([round(centre[0] + a / 32.0), round(centre[1] + b / 32.0)]);
            out[2].push([a, round(0.5 * a + b / 64.0)]);
            out[3].push([round(cos * (0.4 + b / 8.0)), round(sin * (0.4 + b / 8.0))]);
            out[4].push(if i == 0 { [0.5, 0.25] } else { [round(a / 64.0), round(b / 64.0)] });
        }
        for cloud in &mut out {
            cloud.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
            cloud.dedup();
            for i in (1..cloud.len()).rev() {
                let j = (numbers.next() * (i + 1) as f64) as usize;
                cloud.swap(i, j);
            }
        }
        out
    }

    #[test]
    fn one_dimension_gives_left_and_right() {
        let of = of_offsets::<f64, 1>;
        assert_eq!(of(&[]), []);
        assert_eq!(of(&[[3.0]]), [0]);
        assert_eq!(of(&[[3.0], [1.0], [-2.0], [-1.5], [7.0]]), [1, 3]);
        assert_eq!(of(&[[3.0], [1.0]]), [1]);
        assert_eq!(of(&[[1.0], [0.0], [-2.0], [5e-13], [1.0 + 1e-13], [-0.0], [2.0]]), [0, 1, 2, 3, 4, 5]);
        assert_eq!(of(&[[f64::NAN], [f64::INFINITY], [-4.0], [f64::NEG_INFINITY]]), [2]);
        assert_eq!(of_offsets::<f32, 1>(&[[3.0], [1.0], [-2.0], [1.0]]), [1, 2, 3]);
    }

    #[test]
    fn three_dimensions_are_refused() {
        let mut out = vec![1];
        let refused = neighbours(&[Vector([1.0, 0.0, 0.0])], &mut Scratch::default(), &mut out);
        assert_eq!(refused, Err(VoronoiError::Dimension));
        assert!(VoronoiError::Dimension.to_string().contains("use k_nearest or distance_based"));
        assert!(out.is_empty());
    }

    #[test]
    fn few_members() {
        let of = of_offsets::<f64, 2>;
        assert_eq!(of(&[]), []);
        assert_eq!(of(&[[0.3, -2.0]]), [0]);
        assert_eq!(of(&[[1.0, 0.0], [0.4, 2.0]]), [0, 1], "a triangle");
        assert_eq!(of(&[[1.0, 0.0], [-3.0, 0.0]]), [0, 1], "in the middle of a line");
        assert_eq!(of(&[[3.0, 3.0], [1.0, 1.0]]), [1], "at the end of a line");
        assert_eq!(of(&[[0.0, 0.0], [0.0, -0.0], [1e-13, 1e-13]]), [0, 1, 2], "all in one place");
        assert_eq!(of(&[[2.0, 0.0], [0.0, 0.0], [2.0, 1e-13], [4.0, 0.0], [0.0, 0.0]]), [0, 1, 2, 4]);
        assert_eq!(of(&[[f64::NAN, 0.0], [1.0, 0.0], [0.0, f64::INFINITY], [2.0, 0.0]]), [1]);
        assert_eq!(of(&[[1e-300, 1.0], [0.0, 2.0], [1e300, 0.0]]), [0], "beyond exact arithmetic");
        assert_eq!(area(&[]), None);
        assert_eq!(area(&[[1.0, 0.0], [0.4, 2.0]]), None);
    }

    #[test]
    fn collinear_members_are_sorted_along_the_line() {
        let direction = [0.6f64, 0.77];
        for shift in [0.0, 1000.0] {
            for count in [3, 10, 300] {
                let at = |i: usize| direction.map(|d| shift + d * (i as f64 * 0.1));
                let positions: Positions = (0..count).map(at).collect();
                for (i, found) in all::<f64>(&positions).iter().enumerate() {
                    let expected: Vec<usize> = [i.wrapping_sub(1), i + 1].into_iter().filter(|&j| j < count).collect();
                    assert_eq!(found, &expected, "member {i} of {count}, shifted by {shift}");
                }
            }
        }
        let small: Positions = (0..30).map(|i| direction.map(|d| f64::from((d * f64::from(i)) as f32))).collect();
        assert!(all::<f32>(&small).iter().enumerate().all(|(i, found)| found.iter().all(|j| j.abs_diff(i) == 1)));
        assert_eq!(of_offsets::<f32, 2>(&[[1e6, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]]), [1, 2, 3]);
    }

    #[test]
    fn lattices() {
        let mut square = Vec::new();
        let mut hexagonal = Vec::new();
        for i in -12..=12 {
            for j in -12..=12 {
                if (i, j) != (0, 0) {
                    let (i, j) = (f64::from(i), f64::from(j));
                    square.push([i * 0.5, j * 0.5]);
                    hexagonal.push([i + 0.5 * j, j * 0.75f64.sqrt()]);
                }
            }
        }
        let found = of_offsets::<f64, 2>(&square);
        let places: Vec<[f64; 2]> = found.iter().map(|&k| square[k as usize]).collect();
        assert_eq!(places, [[-0.5, 0.0], [0.0, -0.5], [0.0, 0.5], [0.5, 0.0]], "diagonal edges have no length");
        assert_eq!(found, of_offsets::<f32, 2>(&square));
        assert_eq!(area(&square), Some(0.25));
        let found = of_offsets::<f64, 2>(&hexagonal);
        assert_eq!(found.len(), 6);
        assert!(found.iter().all(|&k| (Vector(hexagonal[k as usize]).length() - 1.0).abs() < 1e-12));
        assert!((area(&hexagonal).unwrap() - 0.75f64.sqrt()).abs() < 1e-12);
        // the hull: three neighbours at a side of the square lattice, two at a corner
        let side: Positions = square.iter().copied().filter(|p| p[0] >= 0.0).collect();
        assert_eq!((of_offsets::<f64, 2>(&side).len(), area(&side)), (3, None));
        let corner: Positions = side.iter().copied().filter(|p| p[1] >= 0.0).collect();
        assert_eq!((of_offsets::<f64, 2>(&corner).len(), area(&corner)), (2, None));
    }

    #[test]
    fn integer_positions_with_ties_lines_and_shared_places_match_the_definition() {
        let mut numbers = Numbers(3);
        let (mut ties, mut pairs) = (0, 0);
        for round in 0..60 {
            let (width, height) = [(9, 9), (20, 3), (40, 40), (4, 4), (60, 1)][round % 5];
            let positions: Positions = (0..40 + round).map(|_| [numbers.below(width), numbers.below(height)]).collect();
            let found = all::<f64>(&positions);
            assert_eq!(found, all::<f32>(&positions));
            assert!(symmetric(&found));
            for i in 0..positions.len() {
                for j in (0..positions.len()).filter(|&j| j != i) {
                    let (neighbour, tie) = by_definition(&positions, i, j);
                    assert_eq!(found[i].contains(&j), neighbour, "round {round}, members {i} and {j}");
                    ties += usize::from(tie);
                    pairs += usize::from(neighbour);
                }
            }
        }
        assert!(ties > 1000 && pairs > 10_000, "{ties} ties and {pairs} pairs: the test must reach them");
    }

    #[test]
    fn the_local_search_matches_a_triangulation_of_all() {
        for count in [1, 2, 3, 4, 5, 17, 18, 60, 200, 500] {
            for seed in 0..(2000 / count as u64).clamp(1, 60) {
                for (kind, cloud) in clouds(count, 1000 * seed + count as u64).iter().enumerate() {
                    let found = all::<f64>(cloud);
                    assert_eq!(found, triangulated(cloud), "cloud {kind} of {count}, seed {seed}");
                    // (in f32, three members at less than 1e-4 radians count as collinear)
                    assert_eq!(found, all::<f32>(cloud), "in f32: cloud {kind} of {count}, seed {seed}");
                    assert!(symmetric(&found), "cloud {kind} of {count}, seed {seed}");
                }
            }
        }
    }

    #[test]
    fn the_local_search_matches_the_definition() {
        for seed in 0..3 {
            for (kind, cloud) in clouds(150, seed).iter().enumerate() {
                for (me, found) in all::<f64>(cloud).iter().enumerate() {
                    let (others, offsets) = offsets::<f64>(cloud, me);
                    for (j, length) in others.iter().zip(edge_lengths(&offsets)) {
                        if length.abs() > 1e-9 {
                            assert_eq!(found.contains(j), length > 0.0, "cloud {kind}, members {me} and {j}: {length}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn members_on_a_circle() {
        // neighbours along the circle are certain, and all others a matter of the last digit: those must agree in sign
        for count in [5, 60, 300] {
            let rounded = |x: f64| (x * f64::from(1 << 30)).round() / f64::from(1 << 30);
            let at = |i: usize| {
                let (sin, cos) = (core::f64::consts::TAU * i as f64 / count as f64).sin_cos();
                [rounded(cos), rounded(sin)]
            };
            let positions: Positions = (0..count).map(at).collect();
            let found = all::<f64>(&positions);
            assert!(symmetric(&found));
            assert!((0..count).all(|i| found[i].contains(&((i + 1) % count))));
            let ends: usize = found.iter().map(Vec::len).sum();
            assert!(ends <= 2 * (2 * count - 3), "edges cannot cross");
            let integers: Positions = positions.iter().map(|p| p.map(|x| x * f64::from(1 << 30))).collect();
            for i in (0..count).step_by(7) {
                for j in (0..count).filter(|&j| j != i) {
                    assert_eq!(found[i].contains(&j), by_definition(&integers, i, j).0, "{i} and {j} of {count}");
                }
            }
        }
    }

    #[test]
    fn the_nearest_alone_would_not_do() {
        // the test above can fail: without the search for members outside the hull there are wrong neighbours
        let cloud = &clouds(200, 5)[1];
        let truth = all::<f64>(cloud);
        let wrong = (0..cloud.len()).filter(|&me| {
            let (others, offsets) = offsets::<f64>(cloud, me);
            let (mut near, mut star) = (Vec::new(), Vec::new());
            nearest(sites(&offsets, |_| ()), FIRST, &mut near);
            turn_around(&mut near, &mut star);
            let mut found: Vec<usize> = star.iter().map(|s| others[s.index as usize]).collect();
            found.sort_unstable();
            found != truth[me]
        });
        assert!(wrong.count() > 10);
    }

    #[test]
    fn order_scale_and_used_memory_do_not_matter() {
        let (mut scratch, mut out) = (Scratch::default(), Vec::new());
        for cloud in clouds(300, 9) {
            for me in [0, 7, 100] {
                let (_, mut offsets) = offsets::<f64>(&cloud, me);
                neighbours(&offsets, &mut scratch, &mut out).unwrap();
                let mut fresh = Vec::new();
                neighbours(&offsets, &mut Scratch::default(), &mut fresh).unwrap();
                assert_eq!(out, fresh);
                for offset in &mut offsets {
                    *offset = *offset * 1024.0;
                }
                neighbours(&offsets, &mut scratch, &mut fresh).unwrap();
                assert_eq!(out, fresh);
                let last = offsets.len() as u32 - 1;
                offsets.reverse();
                neighbours(&offsets, &mut scratch, &mut fresh).unwrap();
                fresh.reverse();
                assert!(fresh.iter().map(|&k| last - k).eq(out.iter().copied()));
            }
        }
    }

    #[test]
    fn cells_fill_the_space() {
        // 30 members in a periodic unit square, through all images within two boxes
        let mut numbers = Numbers(11);
        let positions: Positions = (0..30).map(|_| [numbers.next(), numbers.next()]).collect();
        let mut filled = 0.0;
        for (i, me) in positions.iter().enumerate() {
            let mut images = vec![[0.0, 0.0]];
            for (j, other) in positions.iter().enumerate() {
                for a in -2..=2 {
                    for b in -2..=2 {
                        if (j, a, b) != (i, 0, 0) {
                            images.push([other[0] - me[0] + f64::from(a), other[1] - me[1] + f64::from(b)]);
                        }
                    }
                }
            }
            filled += area(&images).unwrap();
        }
        assert!((filled - 1.0).abs() < 1e-12, "{filled}");
    }

    #[test]
    fn the_turn_is_exact() {
        // three points almost on one circle with the origin, in integers whose determinant i128 holds
        let mut numbers = Numbers(21);
        let mut zeros = 0;
        for round in 0..20_000 {
            // (u, v) is a diameter from the origin; times 36,000 many points of the circle are integers, others nearly
            let (u, v) = (numbers.below(1000) + 1.0, numbers.below(1000) + 1.0);
            let mut points: Vec<Site> = Vec::new();
            for k in 0..3 {
                let (m, n) = (numbers.below(40) + 1.0, numbers.below(40));
                // the foot of the perpendicular from (u, v) on the line in direction (m, n) lies on the circle
                let scale = (m * u + n * v) / (m * m + n * n) * 36_000.0;
                let nudge = if round % 2 == 0 { 0.0 } else { numbers.below(2) };
                let offset = Vector([(m * scale).round() + nudge, (n * scale).round()]);
                points.push(Site::new(&offset, k).unwrap());
            }
            let [a, b, c] = points.as_slice() else { unreachable!() };
            let exact = |p: &Site, q: &Site, r: &Site| {
                let [px, py, qx, qy, rx, ry] = [p.x, p.y, q.x, q.y, r.x, r.y].map(|x| x as i128);
                (px * px + py * py) * (qx * ry - qy * rx)
            };
            let expected = (exact(a, b, c) + exact(b, c, a) + exact(c, a, b)).cmp(&0);
            assert_eq!(turn(a, b, c), expected);
            assert_eq!(turn_exact(a, b, c), expected);
            let doubled = turn_doubled(a, b, c);
            assert!(
                doubled == 0.0 || order(doubled, 0.0) == expected,
                "products of 2^20 are exact in doubled precision"
            );
            zeros += usize::from(expected == Ordering::Equal);
        }
        assert!(zeros > 10, "{zeros}");
    }
}
