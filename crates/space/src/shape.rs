//! Shapes of obstacles: the nearest point, what lies inside, where a ray or a move meets the surface.
//!
//! Two ideas keep the answers free of contradictions. Which side of a wall a point lies on is computed from
//! the point alone, never from the move, so a body cannot pass a wall between two moves by rounding; and a
//! move that ends strictly inside a solid is always blocked, so nothing enters one by rounding either.
//! A path that dips into a solid by no more than rounding, between two ends that are outside, is a touch.
//!
//! Every answer is finite for coordinates whose squares are finite.

use crate::{Real, Vector};
use core::fmt;

/// A solid or thin obstacle (all lengths in the units of space).
///
/// Build one with the `new_` functions, or pass a literal through [`Shape::checked`]. The methods never fail:
/// a shape without extent is a point, a polygon outside two dimensions is only its outline.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape<R, const D: usize> {
    /// A solid interval, disc or sphere.
    Ball {
        /// Its middle.
        centre: Vector<R, D>,
        /// Its radius, 0 or more.
        radius: R,
    },
    /// A thin wall (in three dimensions a thin line, in one a closed interval).
    Segment {
        /// One end.
        from: Vector<R, D>,
        /// The other end.
        to: Vector<R, D>,
    },
    /// A solid simple polygon, in two dimensions only.
    Polygon {
        /// The corners in order, either way round; the last is joined to the first.
        vertices: Vec<Vector<R, D>>,
    },
    /// A solid box along the axes.
    Cuboid {
        /// The corner with the least coordinates.
        low: Vector<R, D>,
        /// The corner with the greatest coordinates.
        high: Vector<R, D>,
    },
    /// A half-space: everything behind the plane is solid.
    Plane {
        /// Any point of the plane.
        point: Vector<R, D>,
        /// Unit vector out of the solid.
        normal: Vector<R, D>,
    },
}

/// Why a shape, or the collection it was meant for, was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeError {
    /// A coordinate, radius, albedo or time is infinite or no number, or too great to be squared.
    NotFinite,
    /// A ball has a radius below 0.
    NegativeRadius,
    /// A cuboid's low corner exceeds its high corner on some axis.
    LowAboveHigh,
    /// A polygon has fewer than three vertices.
    FewVertices,
    /// Two edges of a polygon cross: by their numbers, from 0, each from the vertex of its number to the next.
    Crossing(usize, usize),
    /// A plane's normal has no length.
    ZeroNormal,
    /// A polygon was given outside two dimensions.
    PolygonDimension,
    /// Way-points are not in order of time.
    WaypointOrder,
    /// A periodic length is not positive and finite.
    PeriodicLength,
    /// The reach is negative, infinite, or more than eight lengths of the periodic box.
    Reach,
    /// An obstacle extends over more than eight lengths of the periodic box.
    LongerThanSpace,
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Crossing(a, b) => {
                return write!(
                    f,
                    "a polygon must not cross itself: its edges from vertex {a} and from vertex {b} (counted from 0) do"
                );
            }
            Self::NotFinite => "an obstacle has a number that is infinite, not a number or too great to be squared",
            Self::NegativeRadius => "a ball's radius must be 0 or more",
            Self::LowAboveHigh => "a cuboid's low corner must not exceed its high corner on any axis",
            Self::FewVertices => "a polygon needs at least three vertices",
            Self::ZeroNormal => "a plane's normal must not be the zero vector",
            Self::PolygonDimension => "a polygon is an obstacle of two dimensions only",
            Self::WaypointOrder => "the way-points of an obstacle must be in order of time",
            Self::PeriodicLength => "the length of a periodic axis must be positive and finite",
            Self::Reach => "the reach must be 0 or more and at most eight lengths of the periodic box",
            Self::LongerThanSpace => "an obstacle must not extend over more than eight lengths of the periodic box",
        })
    }
}

impl core::error::Error for ShapeError {}

/// The first two edges of a polygon that cross.
fn crossing<R: Real, const D: usize>(vertices: &[Vector<R, D>]) -> Option<(usize, usize)> {
    let edge = |k: usize| (vertices[k], vertices[(k + 1) % vertices.len()]);
    // on which side of the line from `a` to `b` a point lies
    let side = |(a, b): (Vector<R, D>, Vector<R, D>), p: Vector<R, D>| {
        let (along, to) = (b - a, p - a);
        along[0] * to[1] - along[1] * to[0]
    };
    let parts = |line, (p, q)| {
        let (p, q) = (side(line, p), side(line, q));
        (p < R::ZERO && q > R::ZERO) || (p > R::ZERO && q < R::ZERO)
    };
    let crosses = |&(a, b): &(usize, usize)| parts(edge(a), edge(b)) && parts(edge(b), edge(a));
    (0..vertices.len()).flat_map(|a| (a + 1..vertices.len()).map(move |b| (a, b))).find(crosses)
}

/// Where an obstacle is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<R, const D: usize> {
    /// The nearest point of the surface.
    pub point: Vector<R, D>,
    /// Distance to it, negative strictly inside a solid; never negative for a thin wall.
    pub distance: R,
    /// Unit vector towards free space: away from `point` outside, out of the solid inside and on its surface.
    /// The zero vector where there is none: exactly on a thin wall, at a ball's centre.
    pub away: Vector<R, D>,
}

/// Where a ray first meets an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<R, const D: usize> {
    /// Distance from the ray's origin.
    pub distance: R,
    /// Unit normal of the surface there, on the side the ray comes from.
    pub normal: Vector<R, D>,
}

/// Where an obstacle blocks a straight move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<R, const D: usize> {
    /// Share of the move made until then, in [0, 1].
    pub fraction: R,
    /// Unit normal of the surface there, on the side the move comes from.
    pub normal: Vector<R, D>,
}

/// The distance from 1 to the next greater number.
pub fn epsilon<R: Real>() -> R {
    R::of(if core::mem::size_of::<R>() == 4 { f64::from(f32::EPSILON) } else { f64::EPSILON })
}

/// The third component of the cross product in the plane of the first two axes; 0 in one dimension.
#[inline(always)]
fn cross<R: Real, const D: usize>(u: Vector<R, D>, v: Vector<R, D>) -> R {
    if D >= 2 { u[0] * v[1] - u[1] * v[0] } else { R::ZERO }
}

/// Positive where `p` is to the left of the line from `a` to `b`, negative to the right.
#[inline(always)]
fn side<R: Real, const D: usize>(a: Vector<R, D>, b: Vector<R, D>, p: Vector<R, D>) -> R {
    cross(b - a, p - a)
}

/// Whether the closed segment from `a` to `b` meets the endless line through `origin` along `direction`.
///
/// Two walls with a common end compute the same sign for it, so that no line slips between them.
#[inline(always)]
fn straddles<R: Real, const D: usize>(
    a: Vector<R, D>,
    b: Vector<R, D>,
    origin: Vector<R, D>,
    direction: Vector<R, D>,
) -> bool {
    let (first, second) = (cross(direction, a - origin), cross(direction, b - origin));
    !(first > R::ZERO && second > R::ZERO || first < R::ZERO && second < R::ZERO)
}

/// The unit normal of the segment from `a` to `b` that opposes `direction`; `-direction` for a point.
fn normal_against<R: Real, const D: usize>(a: Vector<R, D>, b: Vector<R, D>, direction: Vector<R, D>) -> Vector<R, D> {
    let normal = (b - a).left().unit();
    if normal == Vector::ZERO {
        -direction.unit()
    } else if normal.dot(direction) > R::ZERO {
        -normal
    } else {
        normal
    }
}

/// The place of the segment from `a` to `b` nearest to `p`.
#[inline]
fn nearest_on_segment<R: Real, const D: usize>(a: Vector<R, D>, b: Vector<R, D>, p: Vector<R, D>) -> Nearest<R, D> {
    let (along, offset) = (b - a, p - a);
    let squared = along.length_squared();
    let share = if along.is_tiny() { R::ZERO } else { offset.dot(along) / squared };
    if D == 2 && share > R::ZERO && share < R::ONE {
        // close to a wall p - point is all rounding, while the side of p is not
        let length = squared.root();
        let signed = cross(along, offset) / length;
        let distance = signed.abs();
        let away = if distance <= R::TINY {
            Vector::ZERO
        } else if signed > R::ZERO {
            along.left() / length
        } else {
            -along.left() / length
        };
        return Nearest { point: a + along * share, distance, away };
    }
    let point = if share <= R::ZERO {
        a
    } else if share >= R::ONE {
        b
    } else {
        a + along * share
    };
    let offset = p - point;
    Nearest { point, distance: offset.length(), away: offset.unit() }
}

/// Where two lines in space come closest: the shares along `first` from `origin` and along `second` from `a`, if
/// the lines are not parallel and pass each other within rounding. That is all that "meeting a thin line" can
/// mean in three dimensions.
fn closest_approach<R: Real, const D: usize>(
    origin: Vector<R, D>,
    first: Vector<R, D>,
    a: Vector<R, D>,
    second: Vector<R, D>,
) -> Option<(R, R)> {
    let offset = origin - a;
    let (ff, ss, fs) = (first.length_squared(), second.length_squared(), first.dot(second));
    let (fo, so) = (first.dot(offset), second.dot(offset));
    let determinant = ff * ss - fs * fs;
    let rounding = R::of(16.0) * epsilon::<R>();
    if second.is_tiny() || determinant <= rounding * ff * ss {
        return None;
    }
    let t = (fs * so - fo * ss) / determinant;
    let u = (ff * so - fs * fo) / determinant;
    let gap = offset + first * t - second * u;
    let scale = origin.length() + a.length() + first.length() * t.abs() + second.length();
    (gap.length() <= rounding * scale).then_some((t, u))
}

/// Where the line from `origin` along `step` is between the faces of a box: the shares of `step` at which it
/// comes in and goes out, and the axes of the faces it does so by. `None` if it runs beside the box or along a face.
pub(crate) fn between_faces<R: Real, const D: usize>(
    low: Vector<R, D>,
    high: Vector<R, D>,
    origin: Vector<R, D>,
    step: Vector<R, D>,
) -> Option<([R; 2], [usize; 2])> {
    let (mut enter, mut leave) = (-R::INFINITY, R::INFINITY);
    let mut axes = [0; 2];
    for a in 0..D {
        if step[a] == R::ZERO {
            if !(origin[a] > low[a] && origin[a] < high[a]) {
                return None;
            }
            continue;
        }
        let (first, second) = ((low[a] - origin[a]) / step[a], (high[a] - origin[a]) / step[a]);
        let (first, second) = if step[a] > R::ZERO { (first, second) } else { (second, first) };
        if first > enter {
            (enter, axes[0]) = (first, a);
        }
        if second < leave {
            (leave, axes[1]) = (second, a);
        }
    }
    Some(([enter, leave], axes))
}

/// The edges of a polygon as pairs of vertices, the closing one last.
fn edges<R: Real, const D: usize>(
    vertices: &[Vector<R, D>],
) -> impl Iterator<Item = (Vector<R, D>, Vector<R, D>)> + '_ {
    let following = vertices.iter().cycle().skip(1);
    vertices.iter().zip(following).map(|(&a, &b)| (a, b))
}

/// Whether `p` is strictly inside a polygon: even-odd rule, the outline excluded.
fn polygon_contains<R: Real, const D: usize>(vertices: &[Vector<R, D>], p: Vector<R, D>) -> bool {
    if D != 2 {
        return false;
    }
    let mut inside = false;
    for (a, b) in edges(vertices) {
        if (a[1] > p[1]) != (b[1] > p[1]) {
            let signed = side(a, b, p);
            if signed == R::ZERO {
                return false;
            }
            if (signed > R::ZERO) == (b[1] > a[1]) {
                inside = !inside;
            }
        } else if a[1].most(b[1]) == p[1] {
            // the ray of the rule starts at the height of a vertex or along a level edge: only the outline matters
            let on_level = a[1] == b[1] && p[0] >= a[0].least(b[0]) && p[0] <= a[0].most(b[0]);
            if on_level || a == p || b == p {
                return false;
            }
        }
    }
    inside
}

/// Sum of the outward unit normals of the edges that touch `p`, made a unit vector: at a corner it halves the
/// free angle, which a single edge's normal may point out of.
fn polygon_outward<R: Real, const D: usize>(vertices: &[Vector<R, D>], p: Vector<R, D>) -> Vector<R, D> {
    let Some(&origin) = vertices.first() else { return Vector::ZERO };
    let mut area = R::ZERO;
    let mut sum = Vector::ZERO;
    for (a, b) in edges(vertices) {
        area += cross(a - origin, b - origin);
        if nearest_on_segment(a, b, p).distance <= R::TINY {
            sum -= (b - a).left().unit();
        }
    }
    if area > R::ZERO {
        sum.unit()
    } else if area < R::ZERO {
        -sum.unit()
    } else {
        Vector::ZERO
    }
}

/// Shares of the move at which it touches the closed edge from `a` to `b`: none, one, or for a move along the edge
/// the places of both ends.
fn edge_contacts<R: Real, const D: usize>(
    a: Vector<R, D>,
    b: Vector<R, D>,
    from: Vector<R, D>,
    to: Vector<R, D>,
) -> [Option<R>; 2] {
    let (start, end) = (side(a, b, from), side(a, b, to));
    if start > R::ZERO && end > R::ZERO || start < R::ZERO && end < R::ZERO {
        return [None; 2];
    }
    let step = to - from;
    if start == end {
        let squared = step.length_squared();
        return [a, b].map(|vertex| {
            let share = (vertex - from).dot(step) / squared;
            (share >= R::ZERO && share <= R::ONE).then_some(share)
        });
    }
    [straddles(a, b, from, step).then(|| start / (start - end)), None]
}

/// The surface crossed at share `fraction` of a move into a polygon: of the edges touched there the one that
/// opposes the move most.
fn polygon_normal<R: Real, const D: usize>(
    vertices: &[Vector<R, D>],
    from: Vector<R, D>,
    to: Vector<R, D>,
    fraction: R,
) -> Vector<R, D> {
    let step = to - from;
    let mut best = Vector::ZERO;
    for (a, b) in edges(vertices) {
        if edge_contacts(a, b, from, to).contains(&Some(fraction)) {
            let normal = normal_against(a, b, step);
            if best == Vector::ZERO || normal.dot(step) < best.dot(step) {
                best = normal;
            }
        }
    }
    if best == Vector::ZERO { -step.unit() } else { best }
}

/// Where a move that starts outside a polygon first enters it.
fn polygon_crossing<R: Real, const D: usize>(
    vertices: &[Vector<R, D>],
    from: Vector<R, D>,
    to: Vector<R, D>,
) -> Option<Crossing<R, D>> {
    if D != 2 || polygon_contains(vertices, from) {
        return None;
    }
    let step = to - from;
    let rounding = epsilon::<R>() * (from.length() + to.length());
    let deep = |share: R| {
        let place = from + step * share;
        polygon_contains(vertices, place)
            && edges(vertices).all(|(a, b)| nearest_on_segment(a, b, place).distance > rounding)
    };
    // between two contacts in a row the path is wholly inside or wholly outside, so its middle tells
    let mut reached = R::ZERO;
    loop {
        let mut next = R::INFINITY;
        for (a, b) in edges(vertices) {
            for contact in edge_contacts(a, b, from, to).into_iter().flatten() {
                if contact > reached {
                    next = next.least(contact);
                }
            }
        }
        let last = next >= R::ONE;
        if deep((reached + next.least(R::ONE)) * R::HALF) || last && polygon_contains(vertices, to) {
            return Some(Crossing { fraction: reached, normal: polygon_normal(vertices, from, to, reached) });
        }
        if last {
            return None;
        }
        reached = next;
    }
}

/// Distance along a ray at which it meets the closed edge from `a` to `b`; a parallel ray never does.
#[inline]
fn edge_hit<R: Real, const D: usize>(
    a: Vector<R, D>,
    b: Vector<R, D>,
    origin: Vector<R, D>,
    direction: Vector<R, D>,
) -> Option<R> {
    let rate = cross(b - a, direction);
    let signed = side(a, b, origin);
    if rate == R::ZERO || !straddles(a, b, origin, direction) {
        return None;
    }
    if signed == R::ZERO {
        return Some(R::ZERO);
    }
    let distance = -signed / rate;
    (distance > R::ZERO).then_some(distance)
}

/// First hit of a ray on a polygon that does not contain its origin.
fn polygon_hit<R: Real, const D: usize>(
    vertices: &[Vector<R, D>],
    origin: Vector<R, D>,
    direction: Vector<R, D>,
) -> Option<Hit<R, D>> {
    let mut touching: Option<Vector<R, D>> = None;
    let mut first: Option<Hit<R, D>> = None;
    for (a, b) in edges(vertices) {
        let Some(distance) = edge_hit(a, b, origin, direction) else { continue };
        let normal = normal_against(a, b, direction);
        if distance == R::ZERO {
            if touching.is_none_or(|other| normal.dot(direction) < other.dot(direction)) {
                touching = Some(normal);
            }
        } else if first.is_none_or(|other| distance < other.distance) {
            first = Some(Hit { distance, normal });
        }
    }
    // an origin on the outline is a hit only for a ray that goes in, not for one that leaves
    if let (Some(normal), Some(hit)) = (touching, first)
        && polygon_contains(vertices, origin + direction * (hit.distance * R::HALF))
    {
        return Some(Hit { distance: R::ZERO, normal });
    }
    first
}

/// Whether the length of a difference between coordinates like these can be computed.
pub(crate) fn measurable<R: Real, const D: usize>(v: Vector<R, D>) -> bool {
    (v * R::of(4.0)).length_squared().finite()
}

impl<R: Real, const D: usize> Shape<R, D> {
    /// A solid ball.
    ///
    /// # Errors
    /// When a number is not finite or the radius is negative.
    pub fn new_ball(centre: Vector<R, D>, radius: R) -> Result<Self, ShapeError> {
        Self::Ball { centre, radius }.checked()
    }
    /// A thin wall from one point to another.
    ///
    /// # Errors
    /// When a number is not finite.
    pub fn new_segment(from: Vector<R, D>, to: Vector<R, D>) -> Result<Self, ShapeError> {
        Self::Segment { from, to }.checked()
    }
    /// A solid polygon with its vertices in order, either way round. It may touch itself.
    ///
    /// # Errors
    /// When a number is not finite, there are fewer than three vertices, two edges cross, or space has not two dimensions.
    pub fn new_polygon(vertices: Vec<Vector<R, D>>) -> Result<Self, ShapeError> {
        Self::Polygon { vertices }.checked()
    }
    /// A solid box along the axes.
    ///
    /// # Errors
    /// When a number is not finite or a low coordinate exceeds its high one.
    pub fn new_cuboid(low: Vector<R, D>, high: Vector<R, D>) -> Result<Self, ShapeError> {
        Self::Cuboid { low, high }.checked()
    }
    /// A half-space behind the plane through `point`; `normal` points out of it and is normalised here.
    ///
    /// # Errors
    /// When a number is not finite or the normal is the zero vector.
    pub fn new_plane(point: Vector<R, D>, normal: Vector<R, D>) -> Result<Self, ShapeError> {
        Self::Plane { point, normal }.checked()
    }

    /// The shape if its numbers make sense, a plane's normal made a unit vector.
    ///
    /// # Errors
    /// The first rule broken, see [`ShapeError`].
    pub fn checked(self) -> Result<Self, ShapeError> {
        let measured = |good: bool| if good { Ok(()) } else { Err(ShapeError::NotFinite) };
        match &self {
            Self::Ball { centre, radius } => {
                measured(measurable(*centre) && measurable(Vector([*radius; D])))?;
                if *radius < R::ZERO {
                    return Err(ShapeError::NegativeRadius);
                }
            }
            Self::Segment { from, to } => measured(measurable(*from) && measurable(*to))?,
            Self::Polygon { vertices } => {
                if D != 2 {
                    return Err(ShapeError::PolygonDimension);
                }
                if vertices.len() < 3 {
                    return Err(ShapeError::FewVertices);
                }
                measured(vertices.iter().all(|v| measurable(*v)))?;
                if let Some((a, b)) = crossing(vertices) {
                    return Err(ShapeError::Crossing(a, b));
                }
            }
            Self::Cuboid { low, high } => {
                measured(measurable(*low) && measurable(*high))?;
                if (0..D).any(|a| low[a] > high[a]) {
                    return Err(ShapeError::LowAboveHigh);
                }
            }
            Self::Plane { point, normal } => {
                measured(measurable(*point) && measurable(*normal))?;
                let unit = normal.unit();
                if unit == Vector::ZERO {
                    return Err(ShapeError::ZeroNormal);
                }
                return Ok(Self::Plane { point: *point, normal: unit });
            }
        }
        Ok(self)
    }

    /// The nearest point of the surface to `p`, with signed distance and the way to free space.
    ///
    /// Of several nearest points a box gives that of the lowest axis (its low face first), a polygon that of
    /// its first edge, and a ball at its centre the one along the first axis.
    pub fn nearest(&self, p: Vector<R, D>) -> Nearest<R, D> {
        match self {
            Self::Ball { centre, radius } => {
                let offset = p - *centre;
                let length = offset.length();
                let away = offset.unit();
                let outward = if away == Vector::ZERO { Vector::axis(0) } else { away };
                Nearest { point: *centre + outward * *radius, distance: length - *radius, away }
            }
            Self::Segment { from, to } => nearest_on_segment(*from, *to, p),
            Self::Polygon { vertices } => {
                let mut best = Nearest { point: p, distance: R::INFINITY, away: Vector::ZERO };
                for (a, b) in edges(vertices) {
                    let place = nearest_on_segment(a, b, p);
                    if place.distance < best.distance {
                        best = place;
                    }
                }
                if polygon_contains(vertices, p) {
                    best.distance = -best.distance;
                    best.away = -best.away;
                }
                if best.away == Vector::ZERO {
                    best.away = polygon_outward(vertices, p);
                }
                best
            }
            Self::Cuboid { low, high } => {
                let mut point = p;
                for a in 0..D {
                    point[a] = p[a].clamped(low[a], high[a]);
                }
                let offset = p - point;
                let length = offset.length();
                if length > R::TINY {
                    return Nearest { point, distance: length, away: offset / length };
                }
                let (mut depth, mut axis, mut outward) = (R::INFINITY, 0, R::ZERO);
                for a in 0..D {
                    let (below, above) = (point[a] - low[a], high[a] - point[a]);
                    if below < depth {
                        // on a plate without thickness neither face is the outer one
                        let sign = if above == R::ZERO && below == R::ZERO { R::ZERO } else { -R::ONE };
                        (depth, axis, outward) = (below, a, sign);
                    }
                    if above < depth {
                        (depth, axis, outward) = (above, a, R::ONE);
                    }
                }
                let away = Vector::axis(axis) * outward;
                Nearest { point: point + away * depth, distance: length - depth, away }
            }
            Self::Plane { point, normal } => {
                let distance = normal.dot(p - *point);
                Nearest { point: p - *normal * distance, distance, away: *normal }
            }
        }
    }

    /// Whether `p` lies strictly inside a solid; always false for a thin wall.
    pub fn contains(&self, p: Vector<R, D>) -> bool {
        match self {
            Self::Ball { centre, radius } => (p - *centre).length() < *radius,
            Self::Segment { .. } => false,
            Self::Polygon { vertices } => polygon_contains(vertices, p),
            Self::Cuboid { low, high } => (0..D).all(|a| p[a] > low[a] && p[a] < high[a]),
            Self::Plane { point, normal } => normal.dot(p - *point) < R::ZERO,
        }
    }

    /// The first hit of the ray from `origin` along the unit vector `direction`, no farther than `limit` (which
    /// may be infinite).
    ///
    /// From strictly inside a solid the hit is at distance 0 with `-direction` for a normal. A ray that starts
    /// on a solid's surface hits it at once if it goes in, and not if it leaves; one that starts on a
    /// thin wall hits it at distance 0. A ray along a wall, a face or a plane passes it; whether one that only
    /// grazes a corner or a tangent hits is a matter of rounding.
    pub fn cast(&self, origin: Vector<R, D>, direction: Vector<R, D>, limit: R) -> Option<Hit<R, D>> {
        if self.contains(origin) {
            return (limit >= R::ZERO).then(|| Hit { distance: R::ZERO, normal: -direction });
        }
        let hit = match self {
            Self::Ball { centre, radius } => {
                let offset = origin - *centre;
                let middle = -offset.dot(direction);
                if middle < R::ZERO {
                    return None;
                }
                let closest = offset + direction * middle;
                let spare = radius.squared() - closest.length_squared();
                if spare < R::ZERO {
                    return None;
                }
                let distance = (middle - spare.root()).most(R::ZERO);
                let normal = (offset + direction * distance).unit();
                Hit { distance, normal: if normal == Vector::ZERO { -direction } else { normal } }
            }
            Self::Segment { from, to } => match D {
                1 => {
                    let (low, high) = (from[0].least(to[0]), from[0].most(to[0]));
                    let gap = (low - origin[0]).most(origin[0] - high).most(R::ZERO);
                    if direction[0] == R::ZERO || gap > R::ZERO && (direction[0] > R::ZERO) != (origin[0] < low) {
                        return None;
                    }
                    Hit { distance: gap, normal: -direction }
                }
                2 => {
                    let distance = edge_hit(*from, *to, origin, direction)?;
                    Hit { distance, normal: normal_against(*from, *to, direction) }
                }
                _ => {
                    let along = *to - *from;
                    let (distance, share) = closest_approach(origin, direction, *from, along)?;
                    if distance < R::ZERO || share < R::ZERO || share > R::ONE {
                        return None;
                    }
                    Hit { distance, normal: line_normal(along, direction) }
                }
            },
            Self::Polygon { vertices } => polygon_hit(vertices, origin, direction)?,
            Self::Cuboid { low, high } => {
                let ([enter, leave], [axis, _]) = between_faces(*low, *high, origin, direction)?;
                if enter > leave || leave <= R::ZERO {
                    return None;
                }
                Hit { distance: enter.most(R::ZERO), normal: face_normal(axis, direction) }
            }
            Self::Plane { point, normal } => {
                let rate = normal.dot(direction);
                if rate >= R::ZERO {
                    return None;
                }
                Hit { distance: normal.dot(origin - *point) / -rate, normal: *normal }
            }
        };
        (hit.distance <= limit).then_some(hit)
    }

    /// Where the straight move between two points is blocked, as a share of it in [0, 1]; see [`Self::block`].
    pub fn crossing(&self, from: Vector<R, D>, to: Vector<R, D>) -> Option<R> {
        self.block(from, to).map(|crossing| crossing.fraction)
    }

    /// The unit normal of the surface at which the move is blocked, on the side of `from`; see [`Self::block`].
    pub fn crossing_normal(&self, from: Vector<R, D>, to: Vector<R, D>) -> Option<Vector<R, D>> {
        self.block(from, to).map(|crossing| crossing.normal)
    }

    /// Where and at which surface the straight move between two points is blocked.
    ///
    /// A thin wall includes its ends; it blocks a move that reaches or passes it, but neither one along it nor one
    /// that starts exactly on it. In one dimension it is a closed interval and blocks on reaching it; without
    /// length, in two or more dimensions, it blocks nothing. A solid blocks a move of which any point lies
    /// strictly inside, unless the start does: from inside a body may always leave. Touching is free.
    pub fn block(&self, from: Vector<R, D>, to: Vector<R, D>) -> Option<Crossing<R, D>> {
        let step = to - from;
        match self {
            Self::Ball { centre, radius } => {
                let offset = from - *centre;
                let length = offset.length();
                if length < *radius {
                    return None;
                }
                let ends_inside = (to - *centre).length() < *radius;
                let squared = step.length_squared();
                if squared == R::ZERO {
                    return ends_inside.then(|| Crossing { fraction: R::ZERO, normal: offset.unit() });
                }
                let middle = -offset.dot(step) / squared;
                let closest = (offset + step * middle).length_squared();
                let rounding = R::of(4.0) * epsilon::<R>() * *radius * (length + *radius);
                let dips = middle > R::ZERO && middle < R::ONE && closest < radius.squared() - rounding;
                if !dips && !ends_inside {
                    return None;
                }
                let half = ((radius.squared() - closest).most(R::ZERO) / squared).root();
                let fraction = (middle - half).clamped(R::ZERO, R::ONE);
                let normal = (offset + step * fraction).unit();
                Some(Crossing { fraction, normal: if normal == Vector::ZERO { -step.unit() } else { normal } })
            }
            Self::Segment { from: a, to: b } => match D {
                1 => {
                    let (low, high) = (a[0].least(b[0]), a[0].most(b[0]));
                    let target = if from[0] < low && to[0] >= low {
                        low
                    } else if from[0] > high && to[0] <= high {
                        high
                    } else {
                        return None;
                    };
                    let fraction = ((target - from[0]) / step[0]).clamped(R::ZERO, R::ONE);
                    Some(Crossing { fraction, normal: face_normal(0, step) })
                }
                2 => {
                    let (start, end) = (side(*a, *b, from), side(*a, *b, to));
                    let reaches = start > R::ZERO && end <= R::ZERO || start < R::ZERO && end >= R::ZERO;
                    if !reaches || (*b - *a).is_tiny() || !straddles(*a, *b, from, step) {
                        return None;
                    }
                    let normal = (*b - *a).left().unit();
                    Some(Crossing {
                        fraction: start / (start - end),
                        normal: if start > R::ZERO { normal } else { -normal },
                    })
                }
                _ => {
                    let along = *b - *a;
                    let (fraction, share) = closest_approach(from, step, *a, along)?;
                    let rounding = R::of(16.0) * epsilon::<R>() * (from.length() + a.length() + along.length());
                    let starts_on_it = nearest_on_segment(*a, *b, from).distance <= rounding;
                    let reaches = fraction >= R::ZERO && fraction <= R::ONE && share >= R::ZERO && share <= R::ONE;
                    (reaches && !starts_on_it).then(|| Crossing { fraction, normal: line_normal(along, step.unit()) })
                }
            },
            Self::Polygon { vertices } => polygon_crossing(vertices, from, to),
            Self::Cuboid { low, high } => {
                if self.contains(from) {
                    return None;
                }
                let ([enter, leave], [axis, other]) = between_faces(*low, *high, from, step)?;
                let dips = if axis == other {
                    // through two opposite faces: however thin the box, no question of rounding
                    let through = low[axis] < high[axis];
                    let forward = from[axis] <= low[axis] && to[axis] > low[axis];
                    let backward = from[axis] >= high[axis] && to[axis] < high[axis];
                    through && (forward || backward)
                } else {
                    let rounding = R::of(8.0) * epsilon::<R>() * (R::ONE + enter.abs());
                    leave - enter > rounding && enter < R::ONE && leave > R::ZERO
                };
                (dips || self.contains(to))
                    .then(|| Crossing { fraction: enter.clamped(R::ZERO, R::ONE), normal: face_normal(axis, step) })
            }
            Self::Plane { point, normal } => {
                let (start, end) = (normal.dot(from - *point), normal.dot(to - *point));
                (start >= R::ZERO && end < R::ZERO)
                    .then(|| Crossing { fraction: start / (start - end), normal: *normal })
            }
        }
    }

    /// Whether part of the obstacle lies strictly between two points: on the straight way from one to the
    /// other, the ends excluded. Touching a solid from outside does not count; a thin wall counts with its ends.
    pub fn between(&self, from: Vector<R, D>, to: Vector<R, D>) -> bool {
        if from == to {
            return false;
        }
        if let Self::Segment { from: a, to: b } = self {
            if D == 1 {
                let (low, high) = (from[0].least(to[0]), from[0].most(to[0]));
                return a[0].most(b[0]) > low && a[0].least(b[0]) < high;
            }
            return self.block(from, to).is_some_and(|crossing| crossing.fraction < R::ONE);
        }
        self.contains(from) || self.contains(to) || self.block(from, to).is_some()
    }

    /// The corners of the smallest box along the axes that holds the shape; infinite for a plane.
    pub fn bounds(&self) -> (Vector<R, D>, Vector<R, D>) {
        let around = |points: &mut dyn Iterator<Item = Vector<R, D>>| {
            let (mut low, mut high) = (Vector([R::INFINITY; D]), Vector([-R::INFINITY; D]));
            for p in points {
                for a in 0..D {
                    low[a] = low[a].least(p[a]);
                    high[a] = high[a].most(p[a]);
                }
            }
            (low, high)
        };
        match self {
            Self::Ball { centre, radius } => {
                let half = Vector([*radius; D]);
                (*centre - half, *centre + half)
            }
            Self::Segment { from, to } => around(&mut [*from, *to].into_iter()),
            Self::Polygon { vertices } => around(&mut vertices.iter().copied()),
            Self::Cuboid { low, high } => (*low, *high),
            Self::Plane { .. } => (Vector([-R::INFINITY; D]), Vector([R::INFINITY; D])),
        }
    }

    /// The same shape displaced by `by`.
    pub fn moved(&self, by: Vector<R, D>) -> Self {
        match self {
            Self::Ball { centre, radius } => Self::Ball { centre: *centre + by, radius: *radius },
            Self::Segment { from, to } => Self::Segment { from: *from + by, to: *to + by },
            Self::Polygon { vertices } => Self::Polygon { vertices: vertices.iter().map(|&v| v + by).collect() },
            Self::Cuboid { low, high } => Self::Cuboid { low: *low + by, high: *high + by },
            Self::Plane { point, normal } => Self::Plane { point: *point + by, normal: *normal },
        }
    }
}

/// The normal of a box's face across `axis` that a step comes in by.
fn face_normal<R: Real, const D: usize>(axis: usize, step: Vector<R, D>) -> Vector<R, D> {
    Vector::axis(axis) * if step[axis] > R::ZERO { -R::ONE } else { R::ONE }
}

/// The unit vector across a thin line in space that opposes `direction`.
fn line_normal<R: Real, const D: usize>(along: Vector<R, D>, direction: Vector<R, D>) -> Vector<R, D> {
    let axis = along.unit();
    (axis * axis.dot(direction) - direction).unit()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    type V = Vector<f64, 2>;
    type S = Shape<f64, 2>;

    fn v(x: f64, y: f64) -> V {
        Vector([x, y])
    }
    fn wall(a: V, b: V) -> S {
        S::new_segment(a, b).unwrap()
    }
    fn square() -> S {
        S::new_polygon(vec![v(0.0, 0.0), v(2.0, 0.0), v(2.0, 2.0), v(0.0, 2.0)]).unwrap()
    }
    /// A notch from above, and its twin with the vertices the other way round.
    fn notched() -> [S; 2] {
        let mut vertices = vec![v(0.0, 0.0), v(4.0, 0.0), v(4.0, 4.0), v(2.0, 1.0), v(0.0, 4.0)];
        let forward = S::new_polygon(vertices.clone()).unwrap();
        vertices.reverse();
        [forward, S::new_polygon(vertices).unwrap()]
    }
    fn near<const D: usize>(a: Vector<f64, D>, b: Vector<f64, D>) -> bool {
        (a - b).length() < 1e-12
    }
    /// Numbers in [-1, 1) from a small generator, so that the tests need nothing else.
    fn draws(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn a_polygon_that_crosses_itself_is_refused_and_one_that_touches_itself_is_not() {
        let polygon = |points: &[[f64; 2]]| Shape::new_polygon(points.iter().map(|&p| Vector(p)).collect());
        let bow = polygon(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
        assert_eq!(bow, Err(ShapeError::Crossing(0, 2)));
        assert!(ShapeError::Crossing(0, 2).to_string().contains("from vertex 0 and from vertex 2"));
        let star: Vec<[f64; 2]> = (0..5).map(|k| Vector::<f64, 2>::at_angle(0.8 * f64::from(k) * f64::PI).0).collect();
        assert!(polygon(&star).is_err());
        assert!(polygon(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0]]).is_ok(), "a dent");
        assert!(polygon(&[[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]]).is_ok(), "a waist");
        assert!(polygon(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]).is_ok(), "flat");
    }

    #[test]
    fn senseless_shapes_are_refused_in_plain_words() {
        let zero = V::ZERO;
        assert_eq!(S::new_ball(zero, -1.0), Err(ShapeError::NegativeRadius));
        assert_eq!(S::new_ball(v(f64::NAN, 0.0), 1.0), Err(ShapeError::NotFinite));
        assert_eq!(S::new_ball(zero, f64::NAN), Err(ShapeError::NotFinite));
        assert_eq!(S::new_segment(zero, v(f64::INFINITY, 0.0)), Err(ShapeError::NotFinite));
        assert_eq!(S::new_segment(zero, v(1e200, 0.0)), Err(ShapeError::NotFinite));
        assert_eq!(S::new_polygon(vec![zero, v(1.0, 0.0)]), Err(ShapeError::FewVertices));
        assert_eq!(Shape::<f64, 3>::new_polygon(vec![]), Err(ShapeError::PolygonDimension));
        assert_eq!(S::new_cuboid(v(1.0, 0.0), v(0.0, 1.0)), Err(ShapeError::LowAboveHigh));
        assert_eq!(S::new_plane(zero, zero), Err(ShapeError::ZeroNormal));
        let plane = S::new_plane(zero, v(3.0, 4.0)).unwrap();
        assert_eq!(plane, Shape::Plane { point: zero, normal: v(0.6, 0.8) });
        assert_eq!(ShapeError::FewVertices.to_string(), "a polygon needs at least three vertices");
    }

    #[test]
    fn nearest_of_a_ball() {
        let ball = S::new_ball(v(1.0, 1.0), 2.0).unwrap();
        let out = ball.nearest(v(4.0, 5.0));
        assert!(near(out.point, v(2.2, 2.6)) && (out.distance - 3.0).abs() < 1e-12 && near(out.away, v(0.6, 0.8)));
        let inside = ball.nearest(v(1.0, 0.0));
        assert_eq!((inside.point, inside.distance, inside.away), (v(1.0, -1.0), -1.0, v(0.0, -1.0)));
        let centre = ball.nearest(v(1.0, 1.0));
        assert_eq!((centre.point, centre.distance, centre.away), (v(3.0, 1.0), -2.0, V::ZERO));
        let point = S::new_ball(V::ZERO, 0.0).unwrap();
        assert_eq!(point.nearest(v(0.0, 3.0)), Nearest { point: V::ZERO, distance: 3.0, away: v(0.0, 1.0) });
        assert!(!point.contains(V::ZERO));
    }

    #[test]
    fn nearest_of_a_thin_wall() {
        let w = wall(v(0.0, 0.0), v(4.0, 0.0));
        assert_eq!(w.nearest(v(1.0, 2.0)), Nearest { point: v(1.0, 0.0), distance: 2.0, away: v(0.0, 1.0) });
        assert_eq!(w.nearest(v(1.0, -2.0)), Nearest { point: v(1.0, 0.0), distance: 2.0, away: v(0.0, -1.0) });
        assert_eq!(w.nearest(v(7.0, 4.0)), Nearest { point: v(4.0, 0.0), distance: 5.0, away: v(0.6, 0.8) });
        assert_eq!(w.nearest(v(3.0, 0.0)).away, V::ZERO);
        assert_eq!(w.nearest(v(5.0, 0.0)).away, v(1.0, 0.0), "beyond the end there is a way out");
        let dot = wall(v(1.0, 1.0), v(1.0, 1.0));
        assert_eq!(dot.nearest(v(1.0, 3.0)), Nearest { point: v(1.0, 1.0), distance: 2.0, away: v(0.0, 1.0) });
        assert_eq!(dot.nearest(v(1.0, 1.0)).away, V::ZERO);
    }

    #[test]
    fn near_a_wall_the_way_out_is_its_normal_even_in_single_precision() {
        let (a, b) = (Vector([100.0f32, 200.0]), Vector([170.0f32, 310.0]));
        let w = Shape::new_segment(a, b).unwrap();
        let normal = (b - a).left().unit();
        let p = a + (b - a) * 0.3 + normal * 1e-4;
        let place = w.nearest(p);
        assert!(place.away.dot(normal).abs() > 0.999_999, "{place:?}");
    }

    #[test]
    fn nearest_of_boxes_and_planes() {
        let cuboid = Shape::new_cuboid(Vector([0.0, 0.0, 0.0]), Vector([4.0, 6.0, 8.0])).unwrap();
        let out = cuboid.nearest(Vector([7.0, 10.0, 3.0]));
        assert_eq!(out, Nearest { point: Vector([4.0, 6.0, 3.0]), distance: 5.0, away: Vector([0.6, 0.8, 0.0]) });
        let inside = cuboid.nearest(Vector([3.0, 3.0, 4.0]));
        assert_eq!(inside, Nearest { point: Vector([4.0, 3.0, 4.0]), distance: -1.0, away: Vector([1.0, 0.0, 0.0]) });
        let face = cuboid.nearest(Vector([2.0, 3.0, 8.0]));
        assert_eq!((face.distance, face.away), (0.0, Vector([0.0, 0.0, 1.0])));
        assert!(!cuboid.contains(Vector([2.0, 3.0, 8.0])));
        let plate = S::new_cuboid(v(0.0, 1.0), v(4.0, 1.0)).unwrap();
        assert_eq!(plate.nearest(v(2.0, 1.0)).away, V::ZERO);
        assert_eq!(plate.nearest(v(2.0, 3.0)).away, v(0.0, 1.0));
        let plane = S::new_plane(v(0.0, 1.0), v(0.0, 5.0)).unwrap();
        assert_eq!(plane.nearest(v(3.0, 3.0)), Nearest { point: v(3.0, 1.0), distance: 2.0, away: v(0.0, 1.0) });
        assert_eq!(plane.nearest(v(3.0, -1.0)).distance, -2.0);
        assert!(plane.contains(v(9.0, 0.9)) && !plane.contains(v(9.0, 1.0)));
    }

    #[test]
    fn nearest_of_a_polygon() {
        let s = square();
        assert_eq!(s.nearest(v(1.0, 3.0)), Nearest { point: v(1.0, 2.0), distance: 1.0, away: v(0.0, 1.0) });
        assert_eq!(s.nearest(v(1.0, 1.5)), Nearest { point: v(1.0, 2.0), distance: -0.5, away: v(0.0, 1.0) });
        assert_eq!(s.nearest(v(5.0, 6.0)), Nearest { point: v(2.0, 2.0), distance: 5.0, away: v(0.6, 0.8) });
        assert_eq!(s.nearest(v(2.0, 0.5)).away, v(1.0, 0.0), "on an edge: out of the solid");
        assert!(near(s.nearest(v(2.0, 2.0)).away, v(0.5f64.sqrt(), 0.5f64.sqrt())), "at a corner: halfway");
        for n in notched() {
            assert!(near(n.nearest(v(2.0, 1.0)).away, v(0.0, 1.0)), "at the bottom of the notch: up");
            assert!(n.nearest(v(2.0, 1.5)).distance > 0.0 && n.nearest(v(2.0, 0.9)).distance < 0.0);
        }
    }

    #[test]
    fn strictly_inside_a_polygon() {
        let s = square();
        for corner in [v(0.0, 0.0), v(2.0, 0.0), v(2.0, 2.0), v(0.0, 2.0), v(1.0, 0.0), v(2.0, 1.0), v(0.0, 1.0)] {
            assert!(!s.contains(corner), "the outline is not inside: {corner:?}");
        }
        assert!(s.contains(v(1.0, 1.0)) && !s.contains(v(3.0, 2.0)) && !s.contains(v(-1.0, 0.0)));
        // the height of a vertex passes through tips, notches and level edges
        for n in notched() {
            assert!(n.contains(v(0.5, 1.0)) && n.contains(v(3.5, 1.0)) && !n.contains(v(2.0, 1.0)));
            assert!(!n.contains(v(2.0, 4.0)) && !n.contains(v(-1.0, 4.0)) && !n.contains(v(5.0, 1.0)));
        }
        let diamond = S::new_polygon(vec![v(1.0, 0.0), v(0.0, 1.0), v(-1.0, 0.0), v(0.0, -1.0)]).unwrap();
        assert!(diamond.contains(V::ZERO) && !diamond.contains(v(-2.0, 0.0)) && !diamond.contains(v(2.0, 0.0)));
        assert!(!diamond.contains(v(-1.0, 0.0)) && !diamond.contains(v(0.5, 0.5)));
        let flat = S::new_polygon(vec![v(0.0, 0.0), v(1.0, 0.0), v(2.0, 0.0)]).unwrap();
        assert!(!flat.contains(v(0.5, 0.0)) && flat.nearest(v(0.5, 0.0)).away == V::ZERO);
    }

    #[test]
    fn rays() {
        let ball = S::new_ball(v(5.0, 0.0), 1.0).unwrap();
        let x = v(1.0, 0.0);
        assert_eq!(ball.cast(V::ZERO, x, 4.0), Some(Hit { distance: 4.0, normal: -x }));
        assert_eq!(ball.cast(V::ZERO, x, 3.9), None);
        assert_eq!(ball.cast(V::ZERO, -x, 99.0), None);
        assert_eq!(ball.cast(v(5.0, 0.5), x, 9.0), Some(Hit { distance: 0.0, normal: -x }), "from inside");
        assert_eq!(ball.cast(v(6.0, 0.0), x, 9.0), None, "leaving the surface");
        assert_eq!(ball.cast(v(4.0, 0.0), x, 9.0), Some(Hit { distance: 0.0, normal: -x }));
        assert!(ball.cast(V::ZERO, x, f64::INFINITY).is_some() && ball.cast(V::ZERO, x, f64::NAN).is_none());

        let w = wall(v(2.0, -1.0), v(2.0, 1.0));
        assert_eq!(w.cast(V::ZERO, x, 5.0), Some(Hit { distance: 2.0, normal: -x }));
        assert_eq!(w.cast(v(4.0, 0.0), -x, 5.0), Some(Hit { distance: 2.0, normal: x }));
        assert_eq!(w.cast(v(0.0, 1.0), x, 5.0), Some(Hit { distance: 2.0, normal: -x }), "the ends belong to it");
        assert_eq!(w.cast(v(0.0, 1.1), x, 5.0), None);
        assert_eq!(w.cast(v(2.0, -3.0), v(0.0, 1.0), 9.0), None, "edge-on");
        assert_eq!(w.cast(v(2.0, 0.0), x, 9.0), Some(Hit { distance: 0.0, normal: -x }), "from the wall itself");

        let s = square();
        assert_eq!(s.cast(v(-1.0, 1.0), x, 5.0), Some(Hit { distance: 1.0, normal: -x }));
        assert_eq!(s.cast(v(1.0, 1.0), x, 5.0), Some(Hit { distance: 0.0, normal: -x }));
        assert_eq!(s.cast(v(2.0, 1.0), x, 5.0), None);
        assert_eq!(s.cast(v(2.0, 1.0), -x, 5.0), Some(Hit { distance: 0.0, normal: x }));
        assert_eq!(s.cast(v(2.0, 2.0), v(0.6, 0.8), 5.0), None, "leaving a corner");
        for n in notched() {
            let across = n.cast(v(1.0, 2.5), x, 5.0).unwrap();
            assert!((across.distance - 2.0).abs() < 1e-12 && across.normal[0] < 0.0, "from slope to slope of a notch");
        }
        let cuboid = S::new_cuboid(v(0.0, 0.0), v(2.0, 2.0)).unwrap();
        assert_eq!(cuboid.cast(v(-1.0, 1.0), x, 5.0), Some(Hit { distance: 1.0, normal: -x }));
        assert_eq!(cuboid.cast(v(2.0, 1.0), x, 5.0), None);
        assert_eq!(cuboid.cast(v(2.0, 1.0), -x, 5.0), Some(Hit { distance: 0.0, normal: x }));
        assert_eq!(cuboid.cast(v(-1.0, 2.0), x, 5.0), None, "along a face");
        let plate = S::new_cuboid(v(1.0, 0.0), v(1.0, 2.0)).unwrap();
        assert_eq!(plate.cast(v(0.0, 1.0), x, 5.0), Some(Hit { distance: 1.0, normal: -x }));
        let plane = S::new_plane(v(3.0, 0.0), -x).unwrap();
        assert_eq!(plane.cast(V::ZERO, x, 5.0), Some(Hit { distance: 3.0, normal: -x }));
        assert_eq!(plane.cast(V::ZERO, v(0.0, 1.0), 5.0), None);
        assert_eq!(plane.cast(v(4.0, 0.0), x, 5.0), Some(Hit { distance: 0.0, normal: -x }));
    }

    #[test]
    fn moves_and_thin_walls() {
        let w = wall(v(0.0, 0.0), v(4.0, 0.0));
        assert_eq!(w.crossing(v(1.0, 1.0), v(1.0, -3.0)), Some(0.25));
        assert_eq!(w.crossing_normal(v(1.0, 1.0), v(2.0, -3.0)), Some(v(0.0, 1.0)));
        assert_eq!(w.crossing_normal(v(1.0, -1.0), v(2.0, 3.0)), Some(v(0.0, -1.0)));
        assert_eq!(w.crossing(v(1.0, 1.0), v(1.0, 0.0)), Some(1.0), "reaching it blocks");
        assert_eq!(w.crossing(v(4.0, 1.0), v(4.0, -1.0)), Some(0.5), "the ends belong to it");
        assert_eq!(w.crossing(v(4.1, 1.0), v(4.1, -1.0)), None);
        assert_eq!(w.crossing(v(1.0, 0.0), v(1.0, -3.0)), None, "contact at the start is free");
        assert_eq!(w.crossing(v(-1.0, 0.0), v(2.0, 0.0)), None, "along it is free");
        assert_eq!(w.crossing(v(-1.0, 1.0), v(5.0, 1.0)), None);
        assert_eq!(w.crossing(v(1.0, 1.0), v(1.0, 1.0)), None);
        let dot = wall(v(1.0, 0.0), v(1.0, 0.0));
        assert_eq!(dot.crossing(v(1.0, 1.0), v(1.0, -1.0)), None);

        let post = Shape::new_segment(Vector([1.0]), Vector([2.0])).unwrap();
        assert_eq!(post.crossing(Vector([0.0]), Vector([4.0])), Some(0.25));
        assert_eq!(post.crossing_normal(Vector([4.0]), Vector([0.0])), Some(Vector([1.0])));
        assert_eq!(post.crossing(Vector([1.0]), Vector([4.0])), None);
        assert_eq!(post.crossing(Vector([2.5]), Vector([4.0])), None);
        assert_eq!(post.cast(Vector([4.0]), Vector([-1.0]), 9.0).unwrap().distance, 2.0);
        assert_eq!(post.cast(Vector([4.0]), Vector([1.0]), 9.0), None);

        let line = Shape::new_segment(Vector([0.0, 0.0, 0.0]), Vector([0.0, 0.0, 4.0])).unwrap();
        let (from, to) = (Vector([-1.0, 0.0, 1.0]), Vector([3.0, 0.0, 1.0]));
        assert_eq!(line.block(from, to), Some(Crossing { fraction: 0.25, normal: Vector([-1.0, 0.0, 0.0]) }));
        assert_eq!(line.crossing(Vector([-1.0, 1e-6, 1.0]), to + Vector([0.0, 1e-6, 0.0])), None);
        assert_eq!(line.crossing(Vector([0.0, 0.0, 1.0]), to), None);
        assert_eq!(line.cast(from, Vector([1.0, 0.0, 0.0]), 9.0).unwrap().distance, 1.0);
        assert_eq!(line.nearest(Vector([3.0, 4.0, 2.0])).distance, 5.0);
    }

    #[test]
    fn moves_and_balls() {
        let ball = S::new_ball(V::ZERO, 1.0).unwrap();
        assert_eq!(ball.block(v(-3.0, 0.0), v(1.0, 0.0)), Some(Crossing { fraction: 0.5, normal: v(-1.0, 0.0) }));
        assert_eq!(ball.crossing(v(-3.0, 0.0), v(5.0, 0.0)), Some(0.25), "passing through");
        assert_eq!(ball.crossing(v(-3.0, 0.0), v(-1.0, 0.0)), None, "touching is free");
        assert_eq!(ball.crossing(v(-3.0, 1.0), v(3.0, 1.0)), None, "so is a tangent");
        assert_eq!(ball.crossing(v(-1.0, 0.0), v(-2.0, 0.0)), None, "and leaving the surface");
        assert_eq!(ball.crossing(v(-1.0, 0.0), v(0.0, 0.0)), Some(0.0));
        assert_eq!(ball.crossing(v(0.5, 0.0), v(-5.0, 0.0)), None, "from inside everything is free");
        assert_eq!(S::new_ball(V::ZERO, 0.0).unwrap().crossing(v(-1.0, 0.0), v(1.0, 0.0)), None);
        for k in 0..1000 {
            let angle = f64::from(k) * 0.1;
            let (n, t) = (V::at_angle(angle), V::at_angle(angle).left());
            let start = n * 1.5 - t * 2.0;
            let shifted = Shape::new_ball(n * 0.5, 1.0).unwrap();
            assert_eq!(shifted.crossing(start, start + t * 4.0), None, "a tangent at any angle");
        }
    }

    #[test]
    fn moves_and_boxes_planes_polygons() {
        let cuboid = S::new_cuboid(v(0.0, 0.0), v(2.0, 2.0)).unwrap();
        for s in [cuboid, square()] {
            assert_eq!(s.block(v(-1.0, 1.0), v(1.0, 1.0)), Some(Crossing { fraction: 0.5, normal: v(-1.0, 0.0) }));
            assert_eq!(s.crossing(v(-1.0, 1.0), v(3.0, 1.0)), Some(0.25), "passing through");
            assert_eq!(s.crossing_normal(v(1.0, 3.0), v(1.5, 1.0)), Some(v(0.0, 1.0)));
            assert_eq!(s.crossing(v(-1.0, 1.0), v(0.0, 1.0)), None, "touching");
            assert_eq!(s.crossing(v(-1.0, 2.0), v(3.0, 2.0)), None, "along a face");
            assert_eq!(s.crossing(v(0.0, 0.5), v(0.0, 1.5)), None, "along a face, from it");
            assert_eq!(s.crossing(v(-1.0, 1.0), v(1.0, 3.0)), None, "past a corner");
            assert_eq!(s.crossing(v(0.0, 1.0), v(-1.0, 1.0)), None, "leaving the surface");
            assert_eq!(s.block(v(0.0, 1.0), v(1.0, 1.0)), Some(Crossing { fraction: 0.0, normal: v(-1.0, 0.0) }));
            assert_eq!(s.crossing(v(1.0, 1.0), v(9.0, 1.0)), None, "from inside");
            assert_eq!(s.crossing(v(-1.0, -1.0), v(3.0, 3.0)), Some(0.25), "through two corners");
            assert_eq!(s.crossing(v(-1.0, 1.0), v(-1.0, 1.0)), None);
        }
        let plane = S::new_plane(V::ZERO, v(0.0, 1.0)).unwrap();
        assert_eq!(plane.block(v(0.0, 1.0), v(1.0, -3.0)), Some(Crossing { fraction: 0.25, normal: v(0.0, 1.0) }));
        assert_eq!(plane.crossing(v(0.0, 1.0), v(1.0, 0.0)), None);
        assert_eq!(plane.crossing(v(0.0, 0.0), v(1.0, 0.0)), None);
        assert_eq!(plane.crossing(v(0.0, 0.0), v(1.0, -1.0)), Some(0.0));
        assert_eq!(plane.crossing(v(0.0, -1.0), v(1.0, -2.0)), None);
        for n in notched() {
            assert_eq!(n.crossing(v(2.0, 4.0), v(2.0, 1.0)), None, "down to the bottom of the notch");
            assert!((n.crossing(v(2.0, 4.0), v(2.0, -2.0)).unwrap() - 0.5).abs() < 1e-15);
            assert_eq!(n.crossing(v(2.0, 1.0), v(2.0, 3.0)), None, "and up again");
            assert_eq!(n.crossing(v(-1.0, 4.0), v(5.0, 4.0)), None, "over both tips");
            assert!((n.crossing(v(2.0, 1.0), v(2.0, 0.5)).unwrap()).abs() < 1e-15);
        }
    }

    #[test]
    fn a_move_along_a_slanted_surface_is_free_whatever_the_rounding() {
        let mut draw = draws(3);
        let mut blocked = 0;
        for _ in 0..2000 {
            let (a, b) = (v(draw() * 9.0, draw() * 9.0), v(draw() * 9.0, draw() * 9.0));
            let third = (a + b) * 0.5 + (b - a).left();
            let s = S::new_polygon(vec![a, b, third]).unwrap();
            // ends that computed numbers leave inside are blocked, and must be; all others pass
            let (from, to) = (a + (b - a) * -0.3, b + (b - a) * 0.4);
            blocked += usize::from(s.crossing(from, to).is_some());
            let across = (b - third).left();
            blocked += usize::from(s.crossing(b - across, b + across).is_some());
        }
        assert_eq!(blocked, 0);
    }

    #[test]
    fn thin_solids_do_not_let_a_move_through() {
        let mut draw = draws(23);
        for _ in 0..1000 {
            let x = (draw() * 50.0) as f32;
            let thin = x + x.abs() * 3e-7;
            let plate = Shape::new_cuboid(Vector([x, -1.0]), Vector([thin, 1.0f32])).unwrap();
            let (from, to) = (Vector([x - 0.7, 0.3f32]), Vector([x + 1.1, -0.4]));
            assert!(plate.block(from, to).is_some() && plate.block(to, from).is_some());
            let wide = x + 1e-4;
            let outline = [[x, -1.0], [wide, -1.0], [wide, 1.0], [x, 1.0f32]].map(Vector);
            let polygon = Shape::new_polygon(outline.to_vec()).unwrap();
            assert!(polygon.block(from, to).is_some() && polygon.block(to, from).is_some());
        }
    }

    #[test]
    fn lying_between_two_points() {
        let ball = S::new_ball(V::ZERO, 1.0).unwrap();
        assert!(ball.between(v(-2.0, 0.0), v(2.0, 0.0)) && !ball.between(v(-2.0, 1.0), v(2.0, 1.0)));
        assert!(!ball.between(v(-2.0, 0.0), v(-1.0, 0.0)) && ball.between(v(-2.0, 0.0), v(0.0, 0.0)));
        assert!(ball.between(v(0.0, 0.0), v(2.0, 0.0)) && !ball.between(V::ZERO, V::ZERO));
        let w = wall(v(0.0, -1.0), v(0.0, 1.0));
        assert!(w.between(v(-1.0, 0.0), v(1.0, 0.0)) && w.between(v(1.0, 1.0), v(-1.0, 1.0)));
        assert!(!w.between(v(-1.0, 0.0), v(0.0, 0.0)) && !w.between(v(0.0, 0.0), v(1.0, 0.0)));
        let post = Shape::new_segment(Vector([1.0]), Vector([1.0])).unwrap();
        assert!(post.between(Vector([2.0]), Vector([0.0])) && !post.between(Vector([1.0]), Vector([0.0])));
    }

    #[test]
    fn bounds_and_moving() {
        let by = v(10.0, -1.0);
        for s in [
            square(),
            S::new_ball(v(1.0, 1.0), 1.0).unwrap(),
            S::new_cuboid(v(0.0, 0.0), v(2.0, 2.0)).unwrap(),
            wall(v(2.0, 0.0), v(0.0, 2.0)),
        ] {
            assert_eq!(s.bounds(), (v(0.0, 0.0), v(2.0, 2.0)));
            assert_eq!(s.moved(by).bounds(), (v(10.0, -1.0), v(12.0, 1.0)));
        }
        let plane = S::new_plane(V::ZERO, v(0.0, 1.0)).unwrap();
        assert_eq!(plane.bounds().0[0], -f64::INFINITY);
        assert_eq!(plane.moved(by).nearest(V::ZERO).distance, 1.0);
    }

    fn shapes<R: Real>(draw: &mut impl FnMut() -> f64) -> Vec<Shape<R, 2>> {
        let mut point = || Vector::<R, 2>::of(&[draw() * 3.0, draw() * 3.0]);
        let (a, b, c) = (point(), point(), point());
        let (low, high) = (Vector([a[0].least(b[0]), a[1].least(b[1])]), Vector([a[0].most(b[0]), a[1].most(b[1])]));
        vec![
            Shape::new_ball(a, R::of(0.7)).unwrap(),
            Shape::new_segment(a, b).unwrap(),
            Shape::new_polygon(vec![a, b, c]).unwrap(),
            Shape::new_cuboid(low, high).unwrap(),
            Shape::new_plane(a, b).unwrap(),
        ]
    }

    /// Methods agree with each other on random shapes, in both precisions.
    fn agreement<R: Real>(tolerance: f64) {
        let mut draw = draws(7);
        for _ in 0..400 {
            for shape in shapes::<R>(&mut draw) {
                let mut point = || Vector::<R, 2>::of(&[draw() * 4.0, draw() * 4.0]);
                let (p, q) = (point(), point());
                let place = shape.nearest(p);
                assert!(place.point.finite() && place.distance.finite() && place.away.finite());
                assert_eq!(place.distance < R::ZERO, shape.contains(p), "{shape:?} {p:?}");
                let back = p - place.away * place.distance - place.point;
                assert!(back.length().to_f64() < tolerance, "{shape:?} {p:?} {place:?}");
                assert!((shape.nearest(place.point).distance.abs()).to_f64() < tolerance);

                let step = q - p;
                let length = step.length();
                let hit = shape.cast(p, step / length, length);
                let block = shape.block(p, q);
                let thin = matches!(shape, Shape::Segment { .. });
                if shape.contains(p) {
                    assert_eq!(block, None);
                    assert_eq!(hit.map(|h| h.distance), Some(R::ZERO));
                } else {
                    assert_eq!(hit.is_some(), block.is_some(), "{shape:?} {p:?} {q:?}");
                    assert!(!shape.contains(q) || block.is_some());
                }
                if let (Some(hit), Some(block)) = (hit, block) {
                    let gap = hit.distance - block.fraction * length;
                    assert!(gap.abs().to_f64() < tolerance, "{shape:?} {p:?} {q:?} {hit:?} {block:?}");
                    assert!((hit.normal - block.normal).length().to_f64() < tolerance * 10.0);
                    assert!((block.normal.length() - R::ONE).abs().to_f64() < tolerance);
                    assert!(block.normal.dot(step) <= R::ZERO && (thin || !shape.contains(p)));
                    let at = shape.nearest(p + step * block.fraction);
                    assert!(at.distance.abs().to_f64() < tolerance, "{shape:?} {p:?} {q:?} {at:?}");
                }
            }
        }
    }

    #[test]
    fn methods_agree_in_double_precision() {
        agreement::<f64>(1e-10);
    }

    #[test]
    fn methods_agree_in_single_precision() {
        agreement::<f32>(3e-3);
    }

    /// However often a body moves, sides of a closed chain of walls and of a solid never change unblocked.
    fn nothing_leaks<R: Real>() {
        let corners = [[0.0, 0.0], [3.1, 0.7], [2.3, 2.9], [0.9, 1.1], [-1.7, 2.2]].map(|c| Vector::<R, 2>::of(&c));
        let solid = Shape::new_polygon(corners.to_vec()).unwrap();
        let walls: Vec<_> = (0..5).map(|k| Shape::new_segment(corners[k], corners[(k + 1) % 5]).unwrap()).collect();
        let mut draw = draws(11);
        let mut inside = Vector::<R, 2>::of(&[1.0, 0.7]);
        let mut outside = Vector::<R, 2>::of(&[0.7, 1.9]);
        assert!(solid.contains(inside) && !solid.contains(outside));
        for _ in 0..100_000 {
            let step = Vector::<R, 2>::of(&[draw() * 0.6, draw() * 0.6]);
            let wanted = inside + step;
            if walls.iter().all(|w| w.block(inside, wanted).is_none()) {
                inside = wanted;
            }
            assert!(solid.contains(inside), "{inside:?}");
            let wanted = outside + step;
            // the second half of the moves ends as near to the surface as numbers allow
            let wanted = match solid.block(outside, wanted) {
                None => wanted,
                Some(crossing) => outside + (wanted - outside) * crossing.fraction,
            };
            if solid.block(outside, wanted).is_none() {
                outside = wanted;
            }
            assert!(!solid.contains(outside), "{outside:?}");
        }
    }

    #[test]
    fn nothing_leaks_in_either_precision() {
        nothing_leaks::<f64>();
        nothing_leaks::<f32>();
    }

    #[test]
    fn distance_changes_no_faster_than_the_point() {
        let mut draw = draws(5);
        for _ in 0..500 {
            for shape in shapes::<f64>(&mut draw) {
                let (p, q) = (v(draw() * 4.0, draw() * 4.0), v(draw() * 4.0, draw() * 4.0));
                let change = (shape.nearest(p).distance - shape.nearest(q).distance).abs();
                assert!(change <= (p - q).length() + 1e-12, "{shape:?}");
            }
        }
    }
}
