//! Geometry in the plane without rounding: on which side of a line a point lies, which of two crossings comes first.
//!
//! A sign is found in floating point where the rounding error cannot change it, and otherwise by adding up all
//! products without rounding (Shewchuk 1997, *Discrete & Computational Geometry* 18:305-363). So the answers never
//! contradict each other, however nearly the points line up.

use crate::Vector;
use core::cmp::Ordering;

/// A point of the plane.
type Point = Vector<f64, 2>;

/// Components smaller than this count as 0, so that no product of four of them loses bits to underflow.
pub const NEGLIGIBLE: f64 = 1e-60;
/// Components beyond this are too great: products of four would approach overflow.
pub const FARTHEST: f64 = 1e70;
/// Relative rounding error of a difference of two products of differences, and more: Shewchuk's bound is 3.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// A component, or 0 where it is [`NEGLIGIBLE`].
#[inline(always)]
pub(crate) fn significant(component: f64) -> f64 {
    if component.abs() < NEGLIGIBLE { 0.0 } else { component }
}

/// The order of two numbers (finite ones: no product here can overflow), where 0 and -0 are equal.
#[inline(always)]
pub(crate) fn order(a: f64, b: f64) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}

/// A product as its rounded value and its rounding error, both exact. (The fused operation recovers the error here
/// instead of saving a rounding; IEEE 754 fixes its result, so the bits are the same on every machine.)
#[inline(always)]
pub(crate) fn product(a: f64, b: f64) -> [f64; 2] {
    let rounded = a * b;
    [rounded, a.mul_add(b, -rounded)]
}

/// A sum as its rounded value and its rounding error, both exact.
#[inline(always)]
pub(crate) fn sum(a: f64, b: f64) -> [f64; 2] {
    let rounded = a + b;
    let from_b = rounded - a;
    [rounded, (a - (rounded - from_b)) + (b - from_b)]
}

/// An exact sum of floating-point numbers: terms that do not overlap, the smallest first, none of them 0. Every
/// number added makes at most one term more, so `CAPACITY` is the greatest count of numbers added.
#[derive(Clone)]
pub(crate) struct Expansion<const CAPACITY: usize> {
    terms: [f64; CAPACITY],
    count: usize,
}

impl<const CAPACITY: usize> Default for Expansion<CAPACITY> {
    fn default() -> Self {
        Self { terms: [0.0; CAPACITY], count: 0 }
    }
}

impl<const CAPACITY: usize> Expansion<CAPACITY> {
    /// Shewchuk's GROW-EXPANSION with zero elimination.
    pub(crate) fn add(&mut self, value: f64) {
        let mut carried = value;
        let mut kept = 0;
        for i in 0..self.count {
            let [rounded, error] = sum(carried, self.terms[i]);
            carried = rounded;
            if error != 0.0 {
                self.terms[kept] = error;
                kept += 1;
            }
        }
        if carried != 0.0 {
            self.terms[kept] = carried;
            kept += 1;
        }
        self.count = kept;
    }
    /// Adds a product: two numbers.
    pub(crate) fn add_product(&mut self, a: f64, b: f64) {
        for term in product(a, b) {
            if term != 0.0 {
                self.add(term);
            }
        }
    }
    /// Adds `factor` (1 or -1) times the product of two exact sums: at most twice the product of their capacities.
    fn add_products<const A: usize, const B: usize>(&mut self, factor: f64, a: &Expansion<A>, b: &Expansion<B>) {
        for &left in a.terms() {
            for &right in b.terms() {
                self.add_product(factor * left, right);
            }
        }
    }
    fn terms(&self) -> &[f64] {
        &self.terms[..self.count]
    }
    /// The last term exceeds the sum of all others.
    pub(crate) fn sign(&self) -> Ordering {
        self.terms().last().map_or(Ordering::Equal, |&last| order(last, 0.0))
    }
}

/// A number with a bound on how wrong it is.
#[derive(Clone, Copy)]
struct Rounded {
    value: f64,
    error: f64,
}

impl Rounded {
    fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + other.value.abs() * self.error + self.error * other.error;
        Self { value, error: error + f64::EPSILON * value.abs() }
    }
    fn plus(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + f64::EPSILON * value.abs() }
    }
    fn minus(self, other: Self) -> Self {
        self.plus(Self { value: -other.value, ..other })
    }
    /// The sign, where the error leaves no doubt (the bound is rounded itself, hence the margin).
    fn sign(self) -> Option<Ordering> {
        (self.value.abs() > self.error * (1.0 + 16.0 * f64::EPSILON)).then(|| order(self.value, 0.0))
    }
}

/// A difference of two coordinates, rounded.
fn difference(a: f64, b: f64) -> Rounded {
    let value = a - b;
    Rounded { value, error: f64::EPSILON * value.abs() }
}

/// A difference of two coordinates, exactly.
fn difference_exact(a: f64, b: f64) -> Expansion<2> {
    let mut exact = Expansion::default();
    exact.add(a);
    exact.add(-b);
    exact
}

/// The components that count.
#[inline(always)]
fn plain(p: Point) -> [f64; 2] {
    p.0.map(significant)
}

/// `(b - a) x (d - c)`, rounded.
#[inline(always)]
fn cross_rounded([ax, ay]: [f64; 2], [bx, by]: [f64; 2], [cx, cy]: [f64; 2], [dx, dy]: [f64; 2]) -> Rounded {
    let (left, right) = ((bx - ax) * (dy - cy), (by - ay) * (dx - cx));
    Rounded { value: left - right, error: ROUNDING * (left.abs() + right.abs()) }
}

/// `(b - a) x (d - c)`, exactly.
fn cross_exact([ax, ay]: [f64; 2], [bx, by]: [f64; 2], [cx, cy]: [f64; 2], [dx, dy]: [f64; 2]) -> Expansion<16> {
    let mut total = Expansion::default();
    for (left, right, factor) in [(bx, ax, 1.0), (by, ay, -1.0)] {
        let (forth, back) = if factor > 0.0 { (dy, cy) } else { (dx, cx) };
        total.add_product(factor * left, forth);
        total.add_product(-factor * left, back);
        total.add_product(-factor * right, forth);
        total.add_product(factor * right, back);
    }
    total
}

/// The exact sign of `(b - a) x (d - c)`: `Greater` where the direction from `c` to `d` points to the left of that
/// from `a` to `b`.
#[inline]
pub fn turn(a: Point, b: Point, c: Point, d: Point) -> Ordering {
    let (a, b, c, d) = (plain(a), plain(b), plain(c), plain(d));
    cross_rounded(a, b, c, d).sign().unwrap_or_else(|| cross_exact(a, b, c, d).sign())
}

/// The exact side of the line from `a` to `b` on which `p` lies: `Greater` to the left, `Less` to the right, `Equal`
/// on the line, and wherever `a` and `b` coincide.
///
/// Components below 1e-60 in size count as 0; they must not exceed 1e70.
#[inline]
pub fn side(a: Point, b: Point, p: Point) -> Ordering {
    turn(a, b, a, p)
}

/// The order of two coordinates as these functions see them: exact, with what is [`NEGLIGIBLE`] as 0.
#[inline]
pub fn compare(a: f64, b: f64) -> Ordering {
    order(significant(a), significant(b))
}

/// The point in which a line crosses another that is not parallel to it.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// Two points of the line on which the crossing is placed.
    along: [Point; 2],
    /// Two points of the other line.
    across: [Point; 2],
}

impl Crossing {
    /// The crossing of the line through `along` with the line through `across`; they must not be parallel.
    pub fn new(along: [Point; 2], across: [Point; 2]) -> Self {
        Self { along, across }
    }
    /// The crossing, rounded.
    pub fn place(&self) -> Point {
        let [a, b] = self.along;
        let [numerator, denominator] = self.rounded();
        a + (b - a) * (numerator.value / denominator.value)
    }
    /// The points of which the cross products are the numerator and the denominator of the share of `along` at which
    /// it is crossed.
    fn share(&self) -> [[[f64; 2]; 4]; 2] {
        let ([a, b], [c, d]) = (self.along.map(plain), self.across.map(plain));
        [[a, c, c, d], [a, b, c, d]]
    }
    fn rounded(&self) -> [Rounded; 2] {
        self.share().map(|[a, b, c, d]| cross_rounded(a, b, c, d))
    }
    fn exact(&self) -> [Expansion<16>; 2] {
        self.share().map(|[a, b, c, d]| cross_exact(a, b, c, d))
    }
    fn denominator_sign(&self) -> Ordering {
        let ([a, b], [c, d]) = (self.along, self.across);
        turn(a, b, c, d)
    }
    /// The exact order of one coordinate of the crossing and a number.
    pub fn compare(&self, axis: usize, number: f64) -> Ordering {
        let [from, to] = self.along.map(|p| significant(p[axis]));
        let number = significant(number);
        let [numerator, denominator] = self.rounded();
        let rounded = difference(from, number).times(denominator).plus(difference(to, from).times(numerator));
        let sign = rounded.sign().unwrap_or_else(|| {
            let [numerator, denominator] = self.exact();
            // twice two by sixteen products of two terms
            let mut total = Expansion::<128>::default();
            total.add_products(1.0, &difference_exact(from, number), &denominator);
            total.add_products(1.0, &difference_exact(to, from), &numerator);
            total.sign()
        });
        if self.denominator_sign() == Ordering::Less { sign.reverse() } else { sign }
    }
    /// The exact order of two crossings along the same line (the same two points, in the same order).
    pub fn order(&self, other: &Self) -> Ordering {
        let (first, second) = (self.rounded(), other.rounded());
        let rounded = first[0].times(second[1]).minus(second[0].times(first[1]));
        let sign = rounded.sign().unwrap_or_else(|| {
            let (first, second) = (self.exact(), other.exact());
            // twice sixteen by sixteen products of two terms
            let mut total = Expansion::<1024>::default();
            total.add_products(1.0, &first[0], &second[1]);
            total.add_products(-1.0, &second[0], &first[1]);
            total.sign()
        });
        let reversed = self.denominator_sign() != other.denominator_sign();
        if reversed { sign.reverse() } else { sign }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, uniform};

    /// Whole numbers below `limit`, the same in every run.
    fn whole(seed: u64, k: u64, limit: f64) -> f64 {
        (uniform(seed, Purpose::Obstacles, k, 0) * limit).floor()
    }

    #[test]
    fn expansions_keep_every_bit() {
        let sign = |terms: &[f64]| {
            let mut total = Expansion::<8>::default();
            terms.iter().for_each(|&term| total.add(term));
            total.sign()
        };
        assert_eq!(sign(&[1e70, 1.0, -1e70, 1e-70, -1.0]), Ordering::Greater);
        assert_eq!(sign(&[1e70, -1e-200, -1e70]), Ordering::Less);
        assert_eq!(sign(&[0.1, 0.2, -0.1, -0.2]), Ordering::Equal);
        assert_eq!(sign(&[0.1, 0.2, -(0.1 + 0.2)]), Ordering::Less, "0.1 + 0.2 rounds up");
    }

    #[test]
    fn sides_of_points_near_a_line_do_not_contradict_each_other() {
        // the classical picture: a grid of neighbouring numbers about a point of the line y = x, as whole numbers
        let unit = 2f64.powi(-53);
        let (a, b) = (Vector([12.0, 12.0]), Vector([24.0, 24.0]));
        for i in 0..64 {
            for j in 0..64 {
                let p = Vector([0.5 + f64::from(i) * unit, 0.5 + f64::from(j) * unit]);
                assert_eq!(side(a, b, p), j.cmp(&i), "{i} {j}");
                assert_eq!(side(b, a, p), i.cmp(&j));
                assert_eq!(side(b, p, a), side(a, b, p));
            }
        }
        assert_eq!(side(a, a, b), Ordering::Equal);
        assert_eq!(side(Vector([1e-70, 0.0]), Vector([0.0, 1.0]), Vector([0.0, 5.0])), Ordering::Equal, "negligible");
    }

    /// The share n/d of a crossing in whole numbers, the denominator positive.
    fn share(along: [[i128; 2]; 2], across: [[i128; 2]; 2]) -> Option<(i128, i128)> {
        let cross = |u: [i128; 2], v: [i128; 2]| u[0] * v[1] - u[1] * v[0];
        let minus = |p: [i128; 2], q: [i128; 2]| [p[0] - q[0], p[1] - q[1]];
        let ([a, b], [c, d]) = (along, across);
        let (n, m) = (cross(minus(c, a), minus(d, c)), cross(minus(b, a), minus(d, c)));
        (m != 0).then(|| if m < 0 { (-n, -m) } else { (n, m) })
    }

    #[test]
    fn crossings_are_ordered_as_in_whole_numbers() {
        let (mut equal, mut compared) = (0, 0);
        for round in 0..4_000u64 {
            // few different numbers, so that crossings coincide; or many digits, so that floating point must err
            let limit = if round % 2 == 0 { 4.0 } else { 67_108_864.0 };
            let points: Vec<[f64; 2]> = (0..6)
                .map(|k| [whole(3, round * 12 + 2 * k, limit), whole(3, round * 12 + 2 * k + 1, limit)])
                .collect();
            let [a, b, c, d, e, f] = points.as_slice() else { continue };
            let int = |p: &[f64; 2]| p.map(|x| x as i128);
            let first = share([int(a), int(b)], [int(c), int(d)]);
            // every other time the second line goes through a point of the first
            let nudged = [c[0] + (round % 3) as f64, c[1]];
            let (e, f) = if round % 4 < 2 { (e, f) } else { (&nudged, d) };
            let second = share([int(a), int(b)], [int(e), int(f)]);
            let (Some((n, m)), Some((k, l))) = (first, second) else { continue };
            let point = |p: &[f64; 2]| Vector(*p);
            let one = Crossing::new([point(a), point(b)], [point(c), point(d)]);
            let two = Crossing::new([point(a), point(b)], [point(e), point(f)]);
            let expected = (n * l).cmp(&(k * m));
            assert_eq!(one.order(&two), expected);
            assert_eq!(two.order(&one), expected.reverse());
            equal += usize::from(expected == Ordering::Equal);
            // y = a.y + n/m (b.y - a.y) beside the height of another point
            let height = int(e)[1];
            let (ay, by) = (int(a)[1], int(b)[1]);
            assert_eq!(one.compare(1, e[1]), ((ay - height) * m + n * (by - ay)).cmp(&0));
            compared += 1;
        }
        assert!(equal > 100 && compared > 2_000, "{equal} equal of {compared}");
    }

    #[test]
    fn three_lines_through_one_point_meet_where_floating_point_has_no_number() {
        // y = x/3, y = 1 - 2x/3 and x = 1 meet in (1, 1/3)
        let line = [Vector([0.0, 0.0]), Vector([3.0, 1.0])];
        let falling = Crossing::new(line, [Vector([0.0, 1.0]), Vector([3.0, -1.0])]);
        let upright = Crossing::new(line, [Vector([1.0, -1.0]), Vector([1.0, 1.0])]);
        assert_eq!(falling.order(&upright), Ordering::Equal);
        assert_eq!(falling.compare(0, 1.0), Ordering::Equal);
        assert_eq!(falling.compare(1, 1.0 / 3.0), Ordering::Greater, "the nearest number is below 1/3");
        let beside = Crossing::new(line, [Vector([1.0 + f64::EPSILON, -1.0]), Vector([1.0 + f64::EPSILON, 1.0])]);
        assert_eq!(falling.order(&beside), Ordering::Less);
        assert!((falling.place() - Vector([1.0, 1.0 / 3.0])).length() < 1e-15);
    }
}
