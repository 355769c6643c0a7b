//! `Real`: the two precisions (f32, f64) everything is generic over.

use crate::lanes::{self, Lanes};
use core::fmt::{Debug, Display};
use core::iter::Sum;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number: f32 or f64.
///
/// Transcendental functions come from `libm`, not from the platform, so that the same inputs give
/// the same bits on every machine; only operations that IEEE 754 fixes exactly use the processor's.
pub trait Real:
    Lanes<Self, Mask = bool>
    + Default
    + PartialEq
    + PartialOrd
    + Debug
    + Display
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + Sum
    + Send
    + Sync
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 1/2.
    const HALF: Self;
    /// The ratio of a circle's circumference to its diameter.
    const PI: Self;
    /// Two pi.
    const TAU: Self;
    /// Positive infinity.
    const INFINITY: Self;
    /// Length at or below which a vector counts as the zero vector: 1e-12.
    const TINY: Self;
    /// A quarter turn in three parts that add up to it: products of the first two with small whole numbers are exact.
    const QUARTER_TURN: [Self; 3];
    /// A number so large that whole numbers stand between it and the next: what is added to it is rounded to one.
    const TO_WHOLE: Self;
    /// `"f32"` or `"f64"`.
    const NAME: &'static str;
    /// The lanes of the portable instruction level.
    type Portable: Lanes<Self>;
    /// The lanes of the AVX2 level.
    type Avx2: Lanes<Self>;
    /// The lanes of the AVX-512 level.
    type Avx512: Lanes<Self>;

    /// Nearest value to an f64.
    fn of(value: f64) -> Self;
    /// The value as f64, exactly.
    fn to_f64(self) -> f64;
    /// The bit pattern, widened to 64 bits, for hashing.
    fn bits(self) -> u64;
    /// Whole part towards minus infinity.
    fn floor(self) -> Self;
    /// Whole part towards plus infinity.
    fn ceil(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Square root.
    fn root(self) -> Self;
    /// Sine (radians).
    fn sin(self) -> Self;
    /// Cosine (radians).
    fn cos(self) -> Self;
    /// Sine and cosine at once (radians).
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`), in (-pi, pi]; 0 for the origin.
    fn atan2(self, x: Self) -> Self;
    /// Arc cosine of the value clamped to [-1, 1].
    fn acos(self) -> Self;
    /// Arc sine of the value clamped to [-1, 1].
    fn asin(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Power.
    fn powf(self, exponent: Self) -> Self;
    /// Neither infinite nor NaN.
    fn finite(self) -> bool;
    /// The smaller; the other one where one is NaN.
    fn least(self, other: Self) -> Self;
    /// The greater; the other one where one is NaN.
    fn most(self, other: Self) -> Self;
    /// Truncation to an index; negative and NaN give 0.
    fn index(self) -> usize;

    /// A count as a real number.
    #[inline(always)]
    fn count(value: usize) -> Self {
        Self::of(value as f64)
    }
    /// `self` limited to [`low`, `high`].
    #[inline(always)]
    fn clamped(self, low: Self, high: Self) -> Self {
        self.most(low).least(high)
    }
    /// The representative of an angle in (-pi, pi]: `q - 2 pi ceil((q - pi)/(2 pi))`.
    #[inline(always)]
    fn wrapped(self) -> Self {
        if self > -Self::PI && self <= Self::PI {
            return self;
        }
        let turned = self - Self::TAU * ((self - Self::PI) / Self::TAU).ceil();
        turned.clamped(-Self::PI, Self::PI)
    }
    /// Degrees to radians.
    #[inline(always)]
    fn radians(self) -> Self {
        self * (Self::PI / Self::of(180.0))
    }
    /// Square.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
}

macro_rules! real {
    ($t:ident, $name:literal, $avx2:ty, $avx512:ty, $portable:ty, $quarter:expr, $whole:literal,
     $sin:ident $cos:ident $sincos:ident $atan2:ident $acos:ident $asin:ident $exp:ident $log:ident $pow:ident) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const PI: Self = core::f64::consts::PI as $t;
            const TAU: Self = core::f64::consts::TAU as $t;
            const INFINITY: Self = $t::INFINITY;
            const TINY: Self = 1e-12;
            const QUARTER_TURN: [Self; 3] = $quarter;
            const TO_WHOLE: Self = $whole;
            const NAME: &'static str = $name;
            type Portable = $portable;
            type Avx2 = $avx2;
            type Avx512 = $avx512;
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn bits(self) -> u64 {
                u64::from(self.to_bits())
            }
            #[inline(always)]
            fn floor(self) -> Self {
                self.floor()
            }
            #[inline(always)]
            fn ceil(self) -> Self {
                self.ceil()
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn sin(self) -> Self {
                libm::$sin(self)
            }
            #[inline(always)]
            fn cos(self) -> Self {
                libm::$cos(self)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                libm::$sincos(self)
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                libm::$atan2(self, x)
            }
            #[inline(always)]
            fn acos(self) -> Self {
                libm::$acos(self.clamped(-1.0, 1.0))
            }
            #[inline(always)]
            fn asin(self) -> Self {
                libm::$asin(self.clamped(-1.0, 1.0))
            }
            #[inline(always)]
            fn exp(self) -> Self {
                libm::$exp(self)
            }
            #[inline(always)]
            fn ln(self) -> Self {
                libm::$log(self)
            }
            #[inline(always)]
            fn powf(self, exponent: Self) -> Self {
                libm::$pow(self, exponent)
            }
            #[inline(always)]
            fn finite(self) -> bool {
                self.is_finite()
            }
            #[inline(always)]
            fn least(self, other: Self) -> Self {
                self.min(other)
            }
            #[inline(always)]
            fn most(self, other: Self) -> Self {
                self.max(other)
            }
            #[inline(always)]
            fn index(self) -> usize {
                self as usize
            }
        }
    };
}

real!(f32, "f32", lanes::F32Avx2, lanes::F32Avx512, lanes::F32Portable,
    [1.570_312_5, 4.837_513e-4, 7.549_79e-8], 12_582_912.0,
    sinf cosf sincosf atan2f acosf asinf expf logf powf);
real!(f64, "f64", lanes::F64Avx2, lanes::F64Avx512, lanes::F64Portable,
    [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21], 6_755_399_441_055_744.0,
    sin cos sincos atan2 acos asin exp log pow);
