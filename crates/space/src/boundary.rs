//! The boundaries of space, per axis, and the displacement they imply.

use crate::{Real, Vector};

/// What lies at the two ends of one axis. A bounded axis runs from 0 to its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge<R> {
    /// The axis has no end.
    Open,
    /// The axis closes on itself after this length.
    Periodic(R),
    /// Solid walls at 0 and at this length.
    Walls(R),
}

/// A space of `D` axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Space<R, const D: usize> {
    /// The ends of each axis.
    pub edges: [Edge<R>; D],
}

impl<R: Real, const D: usize> Space<R, D> {
    /// Unbounded in every direction.
    pub fn open() -> Self {
        Self { edges: [Edge::Open; D] }
    }
    /// Periodic in every direction.
    pub fn periodic(size: [R; D]) -> Self {
        Self { edges: size.map(Edge::Periodic) }
    }
    /// A box with solid walls.
    pub fn walled(size: [R; D]) -> Self {
        Self { edges: size.map(Edge::Walls) }
    }
    /// The period of each axis that has one.
    #[inline(always)]
    pub fn periods(&self) -> [Option<R>; D] {
        self.edges.map(|edge| if let Edge::Periodic(length) = edge { Some(length) } else { None })
    }
    /// The length of a bounded axis.
    #[inline(always)]
    pub fn side(&self, axis: usize) -> Option<R> {
        match self.edges[axis] {
            Edge::Open => None,
            Edge::Periodic(length) | Edge::Walls(length) => Some(length),
        }
    }
    /// Whether any axis has walls.
    pub fn has_walls(&self) -> bool {
        self.edges.iter().any(|edge| matches!(edge, Edge::Walls(_)))
    }
    /// Whether any axis is periodic.
    pub fn is_periodic(&self) -> bool {
        self.edges.iter().any(|edge| matches!(edge, Edge::Periodic(_)))
    }
    /// A displacement made minimal on periodic axes: in [-L/2, L/2), which is `d - L floor(d/L + 1/2)`.
    #[inline(always)]
    pub fn minimal(&self, mut offset: Vector<R, D>) -> Vector<R, D> {
        for a in 0..D {
            if let Edge::Periodic(length) = self.edges[a] {
                let half = length * R::HALF;
                let mut d = offset.0[a];
                // the two comparisons are what vector lanes do; they suffice for places inside the box
                if half <= d {
                    d -= length;
                } else if d < -half {
                    d += length;
                }
                if d < -half || half <= d {
                    d -= length * (d / length + R::HALF).floor();
                }
                offset.0[a] = d;
            }
        }
        offset
    }
    /// The displacement `other - me`, by minimum image.
    #[inline(always)]
    pub fn offset(&self, me: Vector<R, D>, other: Vector<R, D>) -> Vector<R, D> {
        self.minimal(other - me)
    }
    /// A position brought back into [0, L) on periodic axes; other axes are left alone.
    #[inline(always)]
    pub fn place(&self, mut position: Vector<R, D>) -> Vector<R, D> {
        for a in 0..D {
            if let Edge::Periodic(length) = self.edges[a] {
                position.0[a] = wrap_into(position.0[a], length);
            }
        }
        position
    }
}

/// `x` brought into [0, `length`). Rounding can put the result of the division at the upper end, where it means 0.
#[inline(always)]
pub fn wrap_into<R: Real>(x: R, length: R) -> R {
    if x >= R::ZERO && x < length {
        return x;
    }
    let wrapped = x - length * (x / length).floor();
    if wrapped >= R::ZERO && wrapped < length { wrapped } else { R::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minimum_image() {
        let space = Space::periodic([10.0, 4.0]);
        let d = space.offset(Vector([9.0, 0.5]), Vector([1.0, 3.9]));
        assert!((d[0] - 2.0f64).abs() < 1e-12 && (d[1] + 0.6).abs() < 1e-12);
        assert_eq!(Space::open().offset(Vector([9.0, 0.5]), Vector([1.0, 3.5])), Vector([-8.0, 3.0]));
    }

    #[test]
    fn places_stay_inside_for_any_input() {
        let space = Space::<f32, 1>::periodic([3.0]);
        for x in [-1e-9f32, 3.0, 1e30, -1e30, 2.999_999_9, -3.0, f32::MAX] {
            let p = space.place(Vector([x]))[0];
            assert!((0.0..3.0).contains(&p), "{x} -> {p}");
        }
    }
}
