//! What the models of the group-control experiments share: walls that steer, and a limited turn.

use crate::motion::*;
use crate::parameters::Scalar;
use space::Vector;
use space::shape::epsilon;

/// The distance just past another: whoever stands exactly at a radius of these models is still seen.
pub fn past<R: Scalar>(radius: R) -> R {
    radius * (R::ONE + epsilon())
}

/// The sum over walls and discs nearer than `distance` of the ways out, fading to 0 there, unless a member is leaving them (the cosine
/// between the way out and its heading is at least `leaving`).
#[inline(always)]
pub fn walls<R: Scalar>(me: &Me<'_, R, 2>, distance: R, leaving: R) -> Vector<R, 2> {
    let heading = me.heading();
    let mut walls = Vector::ZERO;
    for wall in me.around.obstacles {
        if wall.distance < distance && wall.away.dot(heading) < leaving {
            walls += wall.away * ((distance - wall.distance) / distance);
        }
    }
    walls
}

/// A supplied or normal angle `wander` of this standard deviation (behaviour slots 0 and 1), told; 0 where nothing is drawn.
#[inline(always)]
pub fn wander<R: Scalar>(deviation: R, me: &mut Me<'_, R, 2>, draws: &Draws<'_>) -> R {
    if deviation <= R::ZERO && draws.injected.is_none() {
        return R::ZERO;
    }
    let wander = draws.number("wander", 0.0, |s| deviation.to_f64() * s.normal(0));
    me.value("wander", wander, "rad");
    wander
}

/// The heading turned towards what is wanted by at most `limit`, told.
#[inline(always)]
pub fn turn<R: Scalar>(me: &mut Me<'_, R, 2>, wanted: Vector<R, 2>, limit: R) -> Vector<R, 2> {
    let heading = me.heading();
    me.turn("turn asked for", heading, wanted);
    me.value("turn allowed", limit, "rad");
    heading.turned_toward(wanted.unit(), limit)
}
