//! Angles and directions side by side: sine, cosine and arc tangent for lanes.
//!
//! `libm` serves one number at a time, and each number waits for the one before it. These serve as many as there are lanes,
//! without a branch, by sums, products and quotients alone: so they give the same bits at every instruction level, and the
//! plain number is one of the levels. They differ from `libm` by a unit or two in the last place.

use crate::Real;
use crate::lanes::{Lanes, Mask};

/// The polynomial with these coefficients, lowest power first.
#[inline(always)]
fn polynomial<R: Real, L: Lanes<R>, const N: usize>(x: L, coefficients: [f64; N]) -> L {
    let mut sum = L::splat(R::of(coefficients[N - 1]));
    for n in (0..N - 1).rev() {
        sum = sum * x + L::splat(R::of(coefficients[n]));
    }
    sum
}

/// The nearest whole number, for sizes below a quarter of what the precision can count.
#[inline(always)]
fn whole<R: Real, L: Lanes<R>>(x: L) -> L {
    let far = L::splat(R::TO_WHOLE);
    (x + far) - far
}

/// `x` with its sign turned where the mask holds.
#[inline(always)]
fn turned<R: Real, L: Lanes<R>>(mask: L::Mask, x: L) -> L {
    L::choose(mask, -x, x)
}

/// Sine and cosine of angles (radians) of a few turns at most: up to 10,000 either way.
#[inline(always)]
pub fn sine_cosine<R: Real, L: Lanes<R>>(angle: L) -> (L, L) {
    let number = |value: f64| L::splat(R::of(value));
    // the quarter turns nearest to it are taken off in three parts, the first two of which are exact
    let quarters = whole::<R, L>(angle * number(core::f64::consts::FRAC_2_PI));
    let mut rest = angle;
    for part in R::QUARTER_TURN {
        rest = rest - quarters * L::splat(part);
    }
    let square = rest * rest;
    let sine = rest
        + rest
            * square
            * polynomial(
                square,
                [
                    -1.666_666_666_666_663_2e-1,
                    8.333_333_333_322_49e-3,
                    -1.984_126_982_985_795e-4,
                    2.755_731_370_707_007e-6,
                    -2.505_076_025_340_686_3e-8,
                    1.589_690_995_211_55e-10,
                ],
            );
    let half = square * L::splat(R::HALF);
    let first = L::splat(R::ONE) - half;
    let cosine = first
        + (((L::splat(R::ONE) - first) - half)
            + square
                * square
                * polynomial(
                    square,
                    [
                        4.166_666_666_666_66e-2,
                        -1.388_888_888_887_411e-3,
                        2.480_158_728_947_673e-5,
                        -2.755_731_435_139_066_3e-7,
                        2.087_572_321_298_175e-9,
                        -1.135_964_755_778_819_5e-11,
                    ],
                ));
    // which of four quarters, from -2 to 2
    let quarter = quarters - number(4.0) * whole::<R, L>(quarters * number(0.25));
    let odd = (quarter.size() - L::splat(R::ONE)).size().less(L::splat(R::HALF));
    let (up, down) = (number(1.5), number(-1.5));
    let half = L::splat(R::HALF);
    let sine_turns = quarter.less(-half).or(up.less(quarter));
    let cosine_turns = half.less(quarter).or(quarter.less(down));
    (
        turned::<R, L>(sine_turns, L::choose(odd, cosine, sine)),
        turned::<R, L>(cosine_turns, L::choose(odd, sine, cosine)),
    )
}

/// Angles of the points (`x`, `y`), in [-pi, pi]; 0 for the origin.
#[inline(always)]
pub fn arc_tangent<R: Real, L: Lanes<R>>(y: L, x: L) -> L {
    let (zero, one) = (L::splat(R::ZERO), L::splat(R::ONE));
    let (high, wide) = (y.size(), x.size());
    let (less, more) = (high.lesser(wide), high.greater(wide));
    // above an eighth of a turn's half, the angle from the diagonal is taken; it is small, too
    let steep = (more * L::splat(R::of(0.414_213_562_373_095))).less(less);
    let above = L::choose(steep, less - more, less);
    let below = L::choose(steep, less + more, more);
    let ratio = above / L::choose(below.less_equal(zero), one, below);
    let square = ratio * ratio;
    let small = ratio
        - ratio
            * square
            * polynomial(
                square,
                [
                    3.333_333_333_333_293e-1,
                    -1.999_999_999_987_648_3e-1,
                    1.428_571_427_250_346_6e-1,
                    -1.111_111_040_546_235_6e-1,
                    9.090_887_133_436_507e-2,
                    -7.691_876_205_044_83e-2,
                    6.661_073_137_387_531e-2,
                    -5.833_570_133_790_573_5e-2,
                    4.976_877_994_615_932e-2,
                    -3.653_157_274_421_691_6e-2,
                    1.628_582_011_536_578_2e-2,
                ],
            );
    let quarter = L::splat(R::PI * R::HALF);
    let eighth = L::splat(R::PI * R::HALF * R::HALF);
    let angle = L::choose(steep, eighth + small, small);
    let angle = L::choose(wide.less(high), quarter - angle, angle);
    let angle = L::choose(x.less(zero), L::splat(R::PI) - angle, angle);
    turned::<R, L>(y.less(zero), angle)
}

/// The representatives of angles in (-pi, pi], as [`Real::wrapped`].
#[inline(always)]
pub fn wrapped<R: Real, L: Lanes<R>>(angle: L) -> L {
    let (pi, turn) = (L::splat(R::PI), L::splat(R::TAU));
    let inside = (-pi).less(angle).and(angle.less_equal(pi));
    let turned = angle - turn * whole::<R, L>(angle / turn);
    let turned = turned.lesser(pi).greater(-pi);
    let turned = L::choose(turned.less_equal(-pi), pi, turned);
    L::choose(inside, angle, turned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Level, Task, with_lanes};

    struct All<'a, R>(&'a [R], &'a [R]);
    impl<R: Real> Task<R> for All<'_, R> {
        type Output = Vec<[R; 4]>;
        #[inline(always)]
        fn run<L: Lanes<R>>(self) -> Self::Output {
            let mut out = vec![[R::ZERO; 4]; self.0.len()];
            for first in (0..self.0.len()).step_by(L::WIDTH) {
                let (a, b) = (L::load(&self.0[first..]), L::load(&self.1[first..]));
                let (sine, cosine) = sine_cosine::<R, L>(a);
                for (n, lanes) in [sine, cosine, arc_tangent::<R, L>(a, b), wrapped::<R, L>(a)].into_iter().enumerate()
                {
                    let mut each = [R::ZERO; 16];
                    lanes.store(&mut each);
                    for l in 0..L::WIDTH {
                        out[first + l][n] = each[l];
                    }
                }
            }
            out
        }
    }

    /// Angles of a few turns, those around quarters of a turn, and points on and beside the axes.
    fn cases<R: Real>() -> (Vec<R>, Vec<R>) {
        let mut points = Vec::new();
        for k in 0..4000 {
            points.push((f64::from(k) * 0.013 - 26.0, (f64::from(k) * 0.37).sin() * 10f64.powi(k % 9 - 4)));
        }
        for k in -16..16 {
            let quarter = f64::from(k) * core::f64::consts::FRAC_PI_4;
            points.extend([(quarter, 1.0), (quarter + 1e-9, -1.0), (quarter, 0.0), (0.0, quarter), (quarter, quarter)]);
        }
        points.resize(points.len().next_multiple_of(16), (0.0, 0.0));
        points.iter().map(|&(a, b)| (R::of(a), R::of(b))).unzip()
    }

    fn levels_agree<R: Real>() {
        let (a, b) = cases::<R>();
        let plain = All(&a, &b).run::<R>();
        for level in [Level::Portable, Level::Avx2, Level::Avx512] {
            let wide = with_lanes(level, All(&a, &b));
            for (k, (plain, wide)) in plain.iter().zip(&wide).enumerate() {
                assert_eq!(plain.map(R::bits), wide.map(R::bits), "{level:?} {} {}", a[k], b[k]);
            }
        }
    }

    #[test]
    fn every_level_computes_the_same_bits() {
        levels_agree::<f32>();
        levels_agree::<f64>();
    }

    fn near_libm<R: Real>(last: f64) {
        let (a, b) = cases::<R>();
        for (k, found) in All(&a, &b).run::<R>().iter().enumerate() {
            let (a64, b64) = (a[k].to_f64(), b[k].to_f64());
            let expected = [libm::sin(a64), libm::cos(a64), libm::atan2(a64, b64)];
            for n in 0..3 {
                let error = (found[n].to_f64() - expected[n]).abs();
                // the sign of zero is not told apart: pi, where libm has minus pi
                assert!(
                    error <= last * expected[n].abs().max(1e-3),
                    "{n}: {} of {a64}, {b64}, not {}",
                    found[n],
                    expected[n]
                );
            }
            let turns = (a64 - found[3].to_f64()) / core::f64::consts::TAU;
            assert!((turns - turns.round()).abs() < 40.0 * last && found[3] > -R::PI && found[3] <= R::PI);
        }
    }

    #[test]
    fn they_are_those_of_libm_to_the_last_places() {
        near_libm::<f64>(6e-16);
        near_libm::<f32>(3e-7);
    }

    #[test]
    fn small_angles_keep_their_digits() {
        for angle in [1e-300, 1e-20, 1e-9, 1e-4] {
            let (sine, cosine) = sine_cosine::<f64, f64>(angle);
            assert!((sine / libm::sin(angle) - 1.0).abs() < 3e-16 && (cosine - libm::cos(angle)).abs() < 2e-16);
            assert!((arc_tangent::<f64, f64>(angle, 1.0) / angle - 1.0).abs() < 1e-8);
        }
        assert_eq!(arc_tangent::<f64, f64>(0.0, 0.0), 0.0);
        assert_eq!(arc_tangent::<f64, f64>(0.0, -1.0), core::f64::consts::PI);
    }
}
