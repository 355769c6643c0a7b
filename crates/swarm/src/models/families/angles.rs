//! Headings as angles, for laws of the plane that turn by what they see to the left and to the right; and turns by random angles.

use crate::motion::{Draws, Me, Percepts};
use crate::parameters::Scalar;
use space::Vector;

/// Signed bearing of percept `k` for a member that faces `theta`, rad: positive to the left, 0 where coincident.
#[inline]
pub fn bearing<R: Scalar>(seen: &Percepts<'_, R, 2>, k: usize, theta: R) -> R {
    let offset = seen.offset(k);
    if offset.is_tiny() { R::ZERO } else { (offset.angle() - theta).wrapped() }
}

/// An angle turned by another, in (-pi, pi]; as it was where that is no finite number.
#[inline]
pub fn turned<R: Scalar>(theta: R, by: R) -> R {
    let turned = theta + by;
    if turned.finite() { turned.wrapped() } else { theta }
}

/// The unit vector at an angle of the plane.
#[inline]
pub fn facing<R: Scalar>(theta: R) -> Vector<R, 2> {
    Vector::at_angle(theta)
}

/// A supplied or normal random angle `noise` of this standard deviation (behaviour slots 0 and 1), told; 0 where nothing is drawn.
#[inline]
pub fn angle_noise<R: Scalar, const D: usize>(deviation: R, me: &mut Me<'_, R, D>, draws: &Draws<'_>) -> R {
    if deviation <= R::ZERO && draws.injected.is_none() {
        return R::ZERO;
    }
    let noise = draws.number("noise", 0.0, |s| deviation.to_f64() * s.normal(0));
    me.value("noise", noise, "rad");
    noise
}

/// A heading turned by [`angle_noise`]; in three dimensions about an axis at the supplied or drawn `axis_angle` (slot 2).
#[inline]
pub fn with_noise<R: Scalar, const D: usize>(
    heading: Vector<R, D>,
    deviation: R,
    me: &mut Me<'_, R, D>,
    draws: &Draws<'_>,
) -> Vector<R, D> {
    let noise = angle_noise(deviation, me, draws);
    if noise == R::ZERO {
        return heading;
    }
    let axis = if D == 3 { draws.number("axis_angle", 0.0, |s| s.uniform(2) * R::TAU.to_f64()) } else { R::ZERO };
    heading.turned_by(noise, axis)
}
