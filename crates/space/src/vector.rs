//! `Vector<R, D>`: a point, offset, velocity or heading with `D` components.

use crate::Real;
use core::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// A vector of `D` real components (lengths, speeds or pure directions, by context).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<R, const D: usize>(pub [R; D]);

impl<R: Real, const D: usize> Default for Vector<R, D> {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl<R, const D: usize> Index<usize> for Vector<R, D> {
    type Output = R;
    #[inline(always)]
    fn index(&self, axis: usize) -> &R {
        &self.0[axis]
    }
}
impl<R, const D: usize> IndexMut<usize> for Vector<R, D> {
    #[inline(always)]
    fn index_mut(&mut self, axis: usize) -> &mut R {
        &mut self.0[axis]
    }
}
impl<R: Real, const D: usize> Add for Vector<R, D> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        for a in 0..D {
            self.0[a] += other.0[a];
        }
        self
    }
}
impl<R: Real, const D: usize> Sub for Vector<R, D> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        for a in 0..D {
            self.0[a] -= other.0[a];
        }
        self
    }
}
impl<R: Real, const D: usize> Mul<R> for Vector<R, D> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, factor: R) -> Self {
        for a in 0..D {
            self.0[a] *= factor;
        }
        self
    }
}
impl<R: Real, const D: usize> Div<R> for Vector<R, D> {
    type Output = Self;
    #[inline(always)]
    fn div(mut self, divisor: R) -> Self {
        for a in 0..D {
            self.0[a] /= divisor;
        }
        self
    }
}
impl<R: Real, const D: usize> Neg for Vector<R, D> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for a in 0..D {
            self.0[a] = -self.0[a];
        }
        self
    }
}
impl<R: Real, const D: usize> AddAssign for Vector<R, D> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<R: Real, const D: usize> SubAssign for Vector<R, D> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<R: Real, const D: usize> Vector<R, D> {
    /// The zero vector.
    pub const ZERO: Self = Self([R::ZERO; D]);

    /// The unit vector along one axis.
    #[inline]
    pub fn axis(axis: usize) -> Self {
        let mut v = Self::ZERO;
        v.0[axis] = R::ONE;
        v
    }
    /// From f64 components; missing ones are 0.
    #[inline]
    pub fn of(components: &[f64]) -> Self {
        Self(core::array::from_fn(|a| components.get(a).map_or(R::ZERO, |&c| R::of(c))))
    }
    /// Inner product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        let mut sum = self.0[0] * other.0[0];
        for a in 1..D {
            sum += self.0[a] * other.0[a];
        }
        sum
    }
    /// Squared length.
    #[inline(always)]
    pub fn length_squared(self) -> R {
        self.dot(self)
    }
    /// Euclidean length.
    #[inline(always)]
    pub fn length(self) -> R {
        self.length_squared().root()
    }
    /// `self / |self|`, or the zero vector when `|self|` is at most 1e-12.
    #[inline(always)]
    pub fn unit(self) -> Self {
        let length = self.length();
        if length > R::TINY { self / length } else { Self::ZERO }
    }
    /// `self / |self|`, or `other` when `|self|` is at most 1e-12.
    #[inline(always)]
    pub fn unit_or(self, other: Self) -> Self {
        let length = self.length();
        if length > R::TINY { self / length } else { other }
    }
    /// Whether the length is at most 1e-12 (the zero vector for every rule of direction).
    #[inline(always)]
    pub fn is_tiny(self) -> bool {
        self.length() <= R::TINY
    }
    /// The vector shortened to length `limit` if it is longer.
    #[inline(always)]
    pub fn clip(self, limit: R) -> Self {
        let length = self.length();
        if length > limit { self * (limit / length) } else { self }
    }
    /// Every component finite.
    #[inline(always)]
    pub fn finite(self) -> bool {
        self.0.iter().all(|c| c.finite())
    }
    /// The coordinate axis with the smallest absolute component (lowest index on ties), made
    /// perpendicular to `self` (a unit vector) and of unit length. Needs two or more dimensions.
    #[inline]
    pub fn perpendicular(self) -> Self {
        let mut least = 0;
        for a in 1..D {
            if self.0[a].abs() < self.0[least].abs() {
                least = a;
            }
        }
        let axis = Self::axis(least);
        (axis - self * self.0[least]).unit()
    }
    /// The angle between two vectors, in [0, pi]; 0 where one of them is zero.
    pub fn angle_to(self, other: Self) -> R {
        let (a, b) = (self.unit(), other.unit());
        if a.is_tiny() || b.is_tiny() {
            return R::ZERO;
        }
        let along = a.dot(b);
        (b - a * along).length().atan2(along)
    }
    /// `self` and `other` as a rotation by `angle` in their plane: `self` turned by `angle` towards
    /// the unit vector `side`, which is perpendicular to it.
    #[inline(always)]
    pub fn rotated_towards(self, side: Self, angle: R) -> Self {
        let (sin, cos) = angle.sin_cos();
        self * cos + side * sin
    }
    /// The unit vector `self` turned towards the unit vector `wanted` by at most `limit` radians.
    ///
    /// A zero `wanted` gives `self`, a zero `self` gives `wanted`. Exactly opposite vectors turn left
    /// in two dimensions, towards [`Self::perpendicular`] in three, and not at all in one unless the limit
    /// allows the half turn.
    #[inline]
    pub fn turned_toward(self, wanted: Self, limit: R) -> Self {
        if wanted.is_tiny() {
            return self;
        }
        if self.is_tiny() {
            return wanted;
        }
        let cos = self.dot(wanted);
        let across = wanted - self * cos;
        let sin = across.length();
        if sin.atan2(cos) <= limit {
            return wanted;
        }
        let side = if sin > R::TINY {
            across / sin
        } else if D == 2 {
            let mut left = Self::ZERO;
            left.0[0] = -self.0[1];
            left.0[1] = self.0[0];
            left
        } else if D > 2 {
            self.perpendicular()
        } else {
            return self;
        };
        self.rotated_towards(side, limit)
    }
    /// The unit vector `self` turned by `angle`: to the left in two dimensions; in three about an axis
    /// perpendicular to it, which stands at `axis_angle` about `self`, measured from
    /// [`Self::perpendicular`]. In one dimension it is returned as it is.
    #[inline(always)]
    pub fn turned_by(self, angle: R, axis_angle: R) -> Self {
        if angle == R::ZERO || D == 1 {
            return self;
        }
        let (sin, cos) = angle.sin_cos();
        if D == 2 {
            let mut out = self;
            out.0[0] = self.0[0] * cos - self.0[1] * sin;
            out.0[1] = self.0[0] * sin + self.0[1] * cos;
            return out;
        }
        if self.is_tiny() {
            return self;
        }
        let first = self.perpendicular();
        let second = self.cross3(first);
        let axis = first.rotated_towards(second, axis_angle);
        // axis is perpendicular to self, so Rodrigues' formula loses its third term
        self * cos + axis.cross3(self) * sin
    }
    /// Cross product of the first three components (zero below three dimensions).
    #[inline(always)]
    pub fn cross3(self, other: Self) -> Self {
        let mut out = Self::ZERO;
        if D >= 3 {
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                out.0[a] = self.0[b] * other.0[c] - self.0[c] * other.0[b];
            }
        }
        out
    }
    /// The angle of the first two components from the x axis, counter-clockwise, in (-pi, pi]; in one
    /// dimension 0 or pi by sign.
    #[inline(always)]
    pub fn angle(self) -> R {
        if D >= 2 {
            self.0[1].atan2(self.0[0])
        } else if self.0[0] < R::ZERO {
            R::PI
        } else {
            R::ZERO
        }
    }
    /// The unit vector at `angle` in the plane of the first two axes.
    #[inline(always)]
    pub fn at_angle(angle: R) -> Self {
        let (sin, cos) = angle.sin_cos();
        let mut v = Self::ZERO;
        v.0[0] = cos;
        if D >= 2 {
            v.0[1] = sin;
        }
        v
    }
    /// A quarter turn to the left in the plane of the first two axes.
    #[inline(always)]
    pub fn left(self) -> Self {
        let mut v = Self::ZERO;
        if D >= 2 {
            v.0[0] = -self.0[1];
            v.0[1] = self.0[0];
        }
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    type V = Vector<f64, 2>;

    #[test]
    fn unit_of_zero_is_zero() {
        assert_eq!(V::ZERO.unit(), V::ZERO);
        assert_eq!(Vector([1e-13, 0.0]).unit(), V::ZERO);
        assert_eq!(Vector([3.0, 4.0]).unit(), Vector([0.6, 0.8]));
    }

    #[test]
    fn turning_is_limited_and_opposite_turns_left() {
        let h = Vector([1.0, 0.0]);
        let quarter = h.turned_toward(Vector([0.0, 1.0]), 0.1);
        assert!((quarter.angle() - 0.1).abs() < 1e-15);
        let back = h.turned_toward(Vector([-1.0, 0.0]), 0.1);
        assert!((back.angle() - 0.1).abs() < 1e-15, "opposite turns left");
        assert_eq!(h.turned_toward(V::ZERO, 0.1), h);
        assert_eq!(V::ZERO.turned_toward(h, 0.1), h);
        let h3 = Vector([0.0, 0.0, 1.0f64]);
        let turned = h3.turned_toward(-h3, 0.2);
        assert!((turned.dot(h3) - 0.2f64.cos()).abs() < 1e-15);
        assert!((turned[0] - 0.2f64.sin()).abs() < 1e-15, "towards the x axis, the lowest of the smallest");
    }

    #[test]
    fn turning_by_an_angle_keeps_length_and_angle() {
        let h = Vector([0.6, 0.0, 0.8f64]);
        for axis in [0.0, 1.0, 4.0] {
            let turned = h.turned_by(0.3, axis);
            assert!((turned.length() - 1.0).abs() < 1e-14);
            assert!((turned.dot(h) - 0.3f64.cos()).abs() < 1e-14);
        }
        assert!((Vector([1.0, 0.0f64]).turned_by(0.3, 9.0).angle() - 0.3).abs() < 1e-15);
    }

    #[test]
    fn wrapping_angles() {
        let pi = core::f64::consts::PI;
        assert_eq!(pi.wrapped(), pi);
        assert_eq!((-pi).wrapped(), pi);
        assert!((4.0f64.wrapped() - (4.0 - 2.0 * pi)).abs() < 1e-15);
        assert_eq!(0.25f64.wrapped(), 0.25);
    }
}
