//! Elongated bodies. A capsule is all that is nearer than the radius to its axis, a straight piece along the heading; a body of
//! which nobody knows the heading is round.

use space::{Real, Vector};

/// An axis is followed in at most so many pieces ([`points`]).
const MOST: usize = 128;

/// From the centre of a body to the end of its axis; 0 for one that is no longer than wide.
pub fn half_axis<R: Real>(length: R, radius: R) -> R {
    (length * R::HALF - radius).most(R::ZERO)
}

/// The longest body of a radius whose axis can be followed.
pub fn longest<R: Real>(radius: R) -> R {
    (R::count(MOST / 2) + R::of(2.0)) * radius
}

/// The shortest way from one axis to another, of which the centres lie `offset` apart and `mine` and `other` lead from the centres
/// to the ends. Zero where the axes meet.
pub fn between<R: Real, const D: usize>(offset: Vector<R, D>, mine: Vector<R, D>, other: Vector<R, D>) -> Vector<R, D> {
    let (a, e, b) = (mine.length_squared(), other.length_squared(), mine.dot(other));
    let (c, f) = (mine.dot(offset), other.dot(offset));
    // shares of the way from a centre to an end, where the least distance is
    let share = |along: R, squared: R| {
        if squared > R::TINY { (along / squared).clamped(-R::ONE, R::ONE) } else { R::ZERO }
    };
    let skew = a * e - b * b;
    // parallel axes are as far apart all along where they lie side by side: beginning in the middle serves both
    let start = if skew > a * e * R::of(1e-9) { share(c * e - b * f, skew) } else { R::ZERO };
    let there = share(start * b - f, e);
    let here = share(c + there * b, a);
    offset + other * there - mine * here
}

/// Points along an axis that lie no farther apart than half a radius, its ends among them: how far from the centre each is.
pub fn points<R: Real>(half: R, radius: R) -> impl Iterator<Item = R> {
    let gaps = if half > R::ZERO && radius > R::ZERO {
        ((half * R::of(4.0) / radius).to_f64().ceil() as usize).clamp(1, MOST)
    } else {
        0
    };
    let step = if gaps > 0 { half * R::of(2.0) / R::count(gaps) } else { R::ZERO };
    (0..=gaps).map(move |k| step * R::count(k) - if gaps > 0 { half } else { R::ZERO })
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::random::{Purpose, uniform};

    #[test]
    fn the_shortest_way_between_axes_is_the_one_a_search_finds() {
        let number = |k: u64, slot: u32| uniform(3, Purpose::Init, k, slot);
        for k in 0..2_000u64 {
            let vector = |slot: u32, size: f64| Vector([0, 1, 2].map(|a| size * (2.0 * number(k, slot + a) - 1.0)));
            let (offset, mine) = (vector(0, 4.0), vector(3, 2.0));
            // some are parallel, some are points
            let other = match k % 5 {
                0 => mine * (2.0 * number(k, 9) - 1.0),
                1 => Vector::ZERO,
                _ => vector(6, 2.0),
            };
            let mine = if k % 7 == 0 { Vector::ZERO } else { mine };
            let found = between(offset, mine, other).length();
            let mut least = f64::INFINITY;
            for i in -40..=40 {
                for j in -40..=40 {
                    let way = offset + other * (f64::from(j) / 40.0) - mine * (f64::from(i) / 40.0);
                    least = least.min(way.length());
                }
            }
            assert!(found <= least + 1e-12, "{k}: {found} is more than {least}");
            assert!(found > least - 0.1, "{k}: {found} is less than {least}");
            // from the other side it is as long
            let back = between(-offset, other, mine).length();
            assert!((back - found).abs() < 1e-9, "{k}: {back} and {found}");
        }
    }

    #[test]
    fn side_by_side_across_and_in_line() {
        let x = |x: f64, y: f64| Vector([x, y]);
        assert_eq!(between(x(0.0, 3.0), x(2.0, 0.0), x(2.0, 0.0)), x(0.0, 3.0));
        assert_eq!(between(x(7.0, 0.0), x(2.0, 0.0), x(-2.0, 0.0)), x(3.0, 0.0));
        assert_eq!(between(x(0.0, 5.0), x(2.0, 0.0), x(0.0, 2.0)), x(0.0, 3.0));
        assert_eq!(between(x(1.0, 1.0), x(2.0, 0.0), x(0.0, 2.0)), x(0.0, 0.0));
        assert_eq!(between(x(0.0, 0.0), x(0.0, 0.0), x(0.0, 0.0)), x(0.0, 0.0));
    }

    #[test]
    fn points_of_an_axis() {
        let all: Vec<f64> = points(2.0, 1.0).collect();
        assert_eq!((all.len(), all[0], all[8]), (9, -2.0, 2.0));
        assert_eq!(points(0.0, 1.0).collect::<Vec<f64>>(), [0.0]);
        assert_eq!(points(1.0, 0.0).collect::<Vec<f64>>(), [0.0]);
        assert!((half_axis(longest(2.0), 2.0) - 64.0).abs() < 1e-9);
        assert_eq!(points(half_axis(longest(2.0), 2.0), 2.0).count(), 129);
    }
}
