//! The vector vocabulary: every SIMD instruction of the project stands in this file.
//!
//! A law that sums over its neighbours is written once, generic over [`Lanes`]: instantiated with a
//! plain number it is the law itself; with vector lanes it serves as many agents at once, one per lane.
//! Lanes never mix: no operation but [`Lanes::pack`], which makes lists, crosses from one lane to another, and there is no
//! fused multiply-add, so each lane computes the same bits that the plain number would.
//!
//! [`with_lanes`] picks the widest instruction level of the processor at run time; the environment variable
//! `FLOCKWORKS_LANES` (`portable`, `avx2`, `avx512`) may lower it, which tests use to compare levels.

use crate::Real;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// One truth value per lane.
pub trait Mask: Copy {
    /// The same value in every lane.
    fn all_of(value: bool) -> Self;
    /// Lane by lane conjunction.
    fn and(self, other: Self) -> Self;
    /// Lane by lane disjunction.
    fn or(self, other: Self) -> Self;
    /// Lane by lane negation.
    fn not(self) -> Self;
    /// Whether any lane is true.
    fn any(self) -> bool;
    /// The lanes as bits, lane 0 lowest.
    fn bits(self) -> u32;
    /// From bits, lane 0 lowest.
    fn from_bits(bits: u32) -> Self;
}

impl Mask for bool {
    #[inline(always)]
    fn all_of(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
    #[inline(always)]
    fn not(self) -> Self {
        !self
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        bits & 1 == 1
    }
}

/// A fixed number of real numbers computed side by side; one of them when `Self` is `R`.
pub trait Lanes<R>:
    Copy
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Truth values, one per lane.
    type Mask: Mask;
    /// Number of lanes.
    const WIDTH: usize;
    /// The same number in every lane.
    fn splat(value: R) -> Self;
    /// The first `WIDTH` numbers of a slice.
    ///
    /// # Panics
    /// If the slice is shorter.
    fn load(from: &[R]) -> Self;
    /// Writes the lanes to the first `WIDTH` places of a slice.
    ///
    /// # Panics
    /// If the slice is shorter.
    fn store(self, to: &mut [R]);
    /// Square root.
    fn square_root(self) -> Self;
    /// The reciprocal of the square root, through single precision: within 2e-7 of it, for numbers that single precision can
    /// hold; not a number or anything for others.
    fn rough_reciprocal_root(self) -> Self;
    /// Absolute value.
    fn size(self) -> Self;
    /// The lesser, lane by lane (no NaN expected).
    fn lesser(self, other: Self) -> Self;
    /// The greater, lane by lane (no NaN expected).
    fn greater(self, other: Self) -> Self;
    /// `self < other`.
    fn less(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn less_equal(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, else `no`.
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `self + other` where the mask holds, else `self`.
    #[inline(always)]
    fn add_where(self, mask: Self::Mask, other: Self) -> Self {
        Self::choose(mask, self + other, self)
    }
    /// Writes the lanes whose bits are set, in their order, to the front of a slice. `WIDTH` places are written; those after
    /// the chosen lanes hold anything.
    ///
    /// # Panics
    /// If the slice is shorter than `WIDTH`.
    fn pack(self, bits: u32, to: &mut [R]);
    /// [`Self::pack`] of the numbers `first`, `first + 1`, ... of the lanes.
    ///
    /// # Panics
    /// If the slice is shorter than `WIDTH`.
    #[inline(always)]
    fn pack_numbers(first: u32, bits: u32, to: &mut [u32]) {
        let to = &mut to[..Self::WIDTH];
        let mut chosen = 0;
        for k in 0..Self::WIDTH {
            // never beyond the lane's own place, so in bounds
            to[chosen] = first + k as u32;
            chosen += (bits >> k & 1) as usize;
        }
    }
    /// Which of the first `WIDTH` numbers of a slice are a value, as bits.
    ///
    /// # Panics
    /// If the slice is shorter than `WIDTH`.
    #[inline(always)]
    fn listed(from: &[u32], value: u32) -> u32 {
        let mut bits = 0;
        for (lane, &number) in from[..Self::WIDTH].iter().enumerate() {
            bits |= u32::from(number == value) << lane;
        }
        bits
    }
    /// [`Self::pack`] of the first `WIDTH` numbers of a slice.
    ///
    /// # Panics
    /// If a slice is shorter than `WIDTH`.
    #[inline(always)]
    fn pack_listed(from: &[u32], bits: u32, to: &mut [u32]) {
        let (from, to) = (&from[..Self::WIDTH], &mut to[..Self::WIDTH]);
        let mut chosen = 0;
        for k in 0..Self::WIDTH {
            // never beyond the lane's own place, so in bounds
            to[chosen] = from[k];
            chosen += (bits >> k & 1) as usize;
        }
    }
}

/// The lanes of an array whose bits are set, to the front of a slice of the same length.
#[inline(always)]
fn pack_array<R: Copy, const W: usize>(lanes: [R; W], bits: u32, to: &mut [R]) {
    let to = &mut to[..W];
    let mut chosen = 0;
    for k in 0..W {
        // never beyond the lane's own place, so in bounds
        to[chosen] = lanes[k];
        chosen += (bits >> k & 1) as usize;
    }
}

macro_rules! plain_number {
    ($t:ident) => {
        impl Lanes<$t> for $t {
            type Mask = bool;
            const WIDTH: usize = 1;
            #[inline(always)]
            fn splat(value: $t) -> Self {
                value
            }
            #[inline(always)]
            fn load(from: &[$t]) -> Self {
                from[0]
            }
            #[inline(always)]
            fn store(self, to: &mut [$t]) {
                to[0] = self;
            }
            #[inline(always)]
            fn square_root(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn rough_reciprocal_root(self) -> Self {
                $t::from(1.0f32 / (self as f32).sqrt())
            }
            #[inline(always)]
            fn size(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn greater(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn less_equal(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn choose(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn pack(self, _: u32, to: &mut [$t]) {
                to[0] = self;
            }
        }
    };
}
plain_number!(f32);
plain_number!(f64);

/// The reciprocal of the square root of positive numbers, within 2e-14 of it (1e-7 in single precision) and faster than a root
/// and a quotient.
#[inline(always)]
pub fn reciprocal_root<R: Real, L: Lanes<R>>(squared: L) -> L {
    // what single precision cannot hold
    let (low, high) = (L::splat(R::of(1e-30)), L::splat(R::of(1e30)));
    let quick = squared.rough_reciprocal_root();
    let quick = if size_of::<R>() == size_of::<f32>() {
        quick
    } else {
        // a step of Newton's method, which squares the error
        quick * (L::splat(R::of(1.5)) - L::splat(R::HALF) * squared * quick * quick)
    };
    let outside = squared.less(low).or(high.less(squared));
    if outside.any() { L::choose(outside, L::splat(R::ONE) / squared.square_root(), quick) } else { quick }
}

/// An array with each entry from its place. `core::array::from_fn` is six functions deep, and all of them are compiled anew
/// wherever it is used.
#[inline(always)]
fn each<T: Copy, const W: usize>(mut array: [T; W], entry: impl Fn(usize) -> T) -> [T; W] {
    let mut k = 0;
    while k < W {
        array[k] = entry(k);
        k += 1;
    }
    array
}

/// `W` numbers in an array: the portable level, and the plain twin of the others.
#[derive(Clone, Copy)]
pub struct Wide<R, const W: usize>([R; W]);

/// `W` truth values in an array.
#[derive(Clone, Copy)]
pub struct WideMask<const W: usize>([bool; W]);

impl<const W: usize> Mask for WideMask<W> {
    #[inline(always)]
    fn all_of(value: bool) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(each(self.0, |k| self.0[k] & other.0[k]))
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(each(self.0, |k| self.0[k] | other.0[k]))
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(each(self.0, |k| !self.0[k]))
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().any(|&b| b)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.iter().enumerate().fold(0, |bits, (k, &b)| bits | (u32::from(b) << k))
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self(each([false; W], |k| (bits >> k) & 1 == 1))
    }
}

macro_rules! wide_operator {
    ($trait:ident $method:ident $op:tt) => {
        impl<R: Real, const W: usize> $trait for Wide<R, W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(each(self.0, |k| self.0[k] $op other.0[k]))
            }
        }
    };
}
wide_operator!(Add add +);
wide_operator!(Sub sub -);
wide_operator!(Mul mul *);
wide_operator!(Div div /);

impl<R: Real, const W: usize> Neg for Wide<R, W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(each(self.0, |k| -self.0[k]))
    }
}

impl<R: Real, const W: usize> Lanes<R> for Wide<R, W> {
    type Mask = WideMask<W>;
    const WIDTH: usize = W;
    #[inline(always)]
    fn splat(value: R) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn load(from: &[R]) -> Self {
        let from = &from[..W];
        Self(each([R::ZERO; W], |k| from[k]))
    }
    #[inline(always)]
    fn store(self, to: &mut [R]) {
        to[..W].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn square_root(self) -> Self {
        Self(each(self.0, |k| self.0[k].root()))
    }
    #[inline(always)]
    fn rough_reciprocal_root(self) -> Self {
        Self(each(self.0, |k| self.0[k].rough_reciprocal_root()))
    }
    #[inline(always)]
    fn size(self) -> Self {
        Self(each(self.0, |k| self.0[k].abs()))
    }
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        Self(each(self.0, |k| self.0[k].lesser(other.0[k])))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        Self(each(self.0, |k| self.0[k].greater(other.0[k])))
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self::Mask {
        WideMask(each([false; W], |k| self.0[k] < other.0[k]))
    }
    #[inline(always)]
    fn less_equal(self, other: Self) -> Self::Mask {
        WideMask(each([false; W], |k| self.0[k] <= other.0[k]))
    }
    #[inline(always)]
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(each(yes.0, |k| if mask.0[k] { yes.0[k] } else { no.0[k] }))
    }
    #[inline(always)]
    fn pack(self, bits: u32, to: &mut [R]) {
        pack_array(self.0, bits, to);
    }
}

/// A computation that can run at any instruction level.
pub trait Task<R: Real> {
    /// What it returns.
    type Output;
    /// The computation, with `L` lanes at a time. Mark the implementation `#[inline(always)]`, as everything
    /// it calls in its inner loops, or the instruction level does not reach them.
    fn run<L: Lanes<R>>(self) -> Self::Output;
}

/// An instruction level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// What the target architecture guarantees.
    Portable,
    /// 256-bit vectors.
    Avx2,
    /// 512-bit vectors.
    Avx512,
}

/// The widest level of this processor, or a lower one by `FLOCKWORKS_LANES`; found once.
pub fn level() -> Level {
    static LEVEL: std::sync::OnceLock<Level> = std::sync::OnceLock::new();
    *LEVEL.get_or_init(|| {
        let able = processor();
        match std::env::var("FLOCKWORKS_LANES").as_deref() {
            Ok("portable") => Level::Portable,
            Ok("avx2") => able.min(Level::Avx2),
            _ => able,
        }
    })
}

#[cfg(target_arch = "x86_64")]
fn processor() -> Level {
    let counts_bits = std::is_x86_feature_detected!("popcnt");
    if counts_bits
        && std::is_x86_feature_detected!("avx512f")
        && std::is_x86_feature_detected!("avx512vl")
        && std::is_x86_feature_detected!("avx512dq")
        && std::is_x86_feature_detected!("avx512bw")
    {
        Level::Avx512
    } else if counts_bits && std::is_x86_feature_detected!("avx2") {
        Level::Avx2
    } else {
        Level::Portable
    }
}
#[cfg(not(target_arch = "x86_64"))]
fn processor() -> Level {
    Level::Portable
}

/// Runs a task at a level that this processor has (a wider request is lowered).
#[inline]
pub fn with_lanes<R: Real, T: Task<R>>(level: Level, task: T) -> T::Output {
    #[cfg(target_arch = "x86_64")]
    match level.min(self::level()) {
        // SAFETY: `level()` found these features on this processor.
        Level::Avx512 => return unsafe { x86::avx512(task) },
        // SAFETY: as above.
        Level::Avx2 => return unsafe { x86::avx2(task) },
        Level::Portable => {}
    }
    let _ = level;
    task.run::<R::Portable>()
}

/// The portable level where there are two wider ones: a number at a time. Every processor of the last ten years has one of the wider
/// ones, and arrays of numbers are what takes compilers longest.
#[cfg(target_arch = "x86_64")]
mod narrow {
    /// One number.
    pub type F32Portable = f32;
    /// One number.
    pub type F64Portable = f64;
}
#[cfg(target_arch = "x86_64")]
pub use narrow::{F32Portable, F64Portable};
#[cfg(target_arch = "x86_64")]
pub use x86::{F32Avx2, F32Avx512, F64Avx2, F64Avx512};
#[cfg(not(target_arch = "x86_64"))]
mod elsewhere {
    use super::Wide;
    /// As many numbers as common vectors hold twice.
    pub type F32Portable = Wide<f32, 8>;
    /// As many numbers as common vectors hold twice.
    pub type F64Portable = Wide<f64, 4>;
    /// Stands in for the vector types of another architecture.
    pub type F32Avx2 = Wide<f32, 8>;
    /// Stands in for the vector types of another architecture.
    pub type F32Avx512 = Wide<f32, 16>;
    /// Stands in for the vector types of another architecture.
    pub type F64Avx2 = Wide<f64, 4>;
    /// Stands in for the vector types of another architecture.
    pub type F64Avx512 = Wide<f64, 8>;
}
#[cfg(not(target_arch = "x86_64"))]
pub use elsewhere::{F32Avx2, F32Avx512, F32Portable, F64Avx2, F64Avx512, F64Portable};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Lanes, Mask, Task};
    use crate::Real;
    use core::arch::x86_64::*;
    use core::ops::{Add, Div, Mul, Neg, Sub};

    #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,popcnt")]
    pub(super) fn avx512<R: Real, T: Task<R>>(task: T) -> T::Output {
        task.run::<R::Avx512>()
    }

    #[target_feature(enable = "avx2,popcnt")]
    pub(super) fn avx2<R: Real, T: Task<R>>(task: T) -> T::Output {
        task.run::<R::Avx2>()
    }

    /// Values of these types are only made inside `avx512` and `avx2` above, that is after the features
    /// were found; every SAFETY line below rests on that.
    macro_rules! vector {
        ($doc:literal $name:ident $mask_name:ident $number:ident $width:literal $inner:ty, $mask:ty,
         $set1:ident $loadu:ident $storeu:ident $add:ident $sub:ident $mul:ident $div:ident $sqrt:ident $abs:ident $min:ident $max:ident, rough $rough:expr,
         less $less:expr, less_equal $less_equal:expr, choose $choose:expr, add_where $add_where:expr,
         and $and:expr, or $or:expr, not $not:expr, bits $bits:expr, from_bits $from_bits:expr,
         pack $pack:expr, pack_numbers $pack_numbers:expr, pack_listed $pack_listed:expr, listed $listed:expr) => {
            #[doc = $doc]
            #[derive(Clone, Copy)]
            pub struct $name($inner);
            #[doc = "Truth values of the lanes."]
            #[derive(Clone, Copy)]
            pub struct $mask_name($mask);

            impl Mask for $mask_name {
                #[inline(always)]
                fn all_of(value: bool) -> Self {
                    Self::from_bits(if value { u32::MAX } else { 0 })
                }
                #[inline(always)]
                fn and(self, other: Self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $and(self.0, other.0) })
                }
                #[inline(always)]
                fn or(self, other: Self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $or(self.0, other.0) })
                }
                #[inline(always)]
                fn not(self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $not(self.0) })
                }
                #[inline(always)]
                fn any(self) -> bool {
                    self.bits() != 0
                }
                #[inline(always)]
                fn bits(self) -> u32 {
                    // SAFETY: the features are present, see above.
                    unsafe { $bits(self.0) }
                }
                #[inline(always)]
                fn from_bits(bits: u32) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $from_bits(bits) })
                }
            }
            vector!(@op $name Add add $add);
            vector!(@op $name Sub sub $sub);
            vector!(@op $name Mul mul $mul);
            vector!(@op $name Div div $div);
            impl Neg for $name {
                type Output = Self;
                #[inline(always)]
                fn neg(self) -> Self {
                    Self::splat(-0.0) - self
                }
            }
            impl Lanes<$number> for $name {
                type Mask = $mask_name;
                const WIDTH: usize = $width;
                #[inline(always)]
                fn splat(value: $number) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $set1(value) })
                }
                #[inline(always)]
                fn load(from: &[$number]) -> Self {
                    let from = &from[..$width];
                    // SAFETY: the slice holds WIDTH numbers; the features are present, see above.
                    Self(unsafe { $loadu(from.as_ptr()) })
                }
                #[inline(always)]
                fn store(self, to: &mut [$number]) {
                    let to = &mut to[..$width];
                    // SAFETY: the slice holds WIDTH numbers; the features are present, see above.
                    unsafe { $storeu(to.as_mut_ptr(), self.0) }
                }
                #[inline(always)]
                fn square_root(self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $sqrt(self.0) })
                }
                #[inline(always)]
                fn rough_reciprocal_root(self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $rough(self.0) })
                }
                #[inline(always)]
                fn size(self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $abs(self.0) })
                }
                #[inline(always)]
                fn lesser(self, other: Self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $min(self.0, other.0) })
                }
                #[inline(always)]
                fn greater(self, other: Self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $max(self.0, other.0) })
                }
                #[inline(always)]
                fn less(self, other: Self) -> $mask_name {
                    // SAFETY: the features are present, see above.
                    $mask_name(unsafe { $less(self.0, other.0) })
                }
                #[inline(always)]
                fn less_equal(self, other: Self) -> $mask_name {
                    // SAFETY: the features are present, see above.
                    $mask_name(unsafe { $less_equal(self.0, other.0) })
                }
                #[inline(always)]
                fn choose(mask: $mask_name, yes: Self, no: Self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $choose(mask.0, yes.0, no.0) })
                }
                #[inline(always)]
                fn add_where(self, mask: $mask_name, other: Self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $add_where(self.0, mask.0, other.0) })
                }
                #[inline(always)]
                fn listed(from: &[u32], value: u32) -> u32 {
                    let from = &from[..$width];
                    // SAFETY: the slice holds WIDTH numbers; the features are present, see above.
                    unsafe { $listed(from.as_ptr(), value) }
                }
                #[inline(always)]
                fn pack(self, bits: u32, to: &mut [$number]) {
                    let to = &mut to[..$width];
                    // SAFETY: the slice holds WIDTH numbers; the features are present, see above.
                    unsafe { $pack(self.0, bits, to.as_mut_ptr()) }
                }
                #[inline(always)]
                fn pack_numbers(first: u32, bits: u32, to: &mut [u32]) {
                    let to = &mut to[..$width];
                    // SAFETY: the slice holds WIDTH numbers; the features are present, see above.
                    unsafe { $pack_numbers(first, bits, to.as_mut_ptr()) }
                }
                #[inline(always)]
                fn pack_listed(from: &[u32], bits: u32, to: &mut [u32]) {
                    let (from, to) = (&from[..$width], &mut to[..$width]);
                    // SAFETY: both slices hold WIDTH numbers; the features are present, see above.
                    unsafe { $pack_listed(from.as_ptr(), bits, to.as_mut_ptr()) }
                }
            }
        };
        (@op $name:ident $trait:ident $method:ident $intrinsic:ident) => {
            impl $trait for $name {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    // SAFETY: the features are present, see above.
                    Self(unsafe { $intrinsic(self.0, other.0) })
                }
            }
        };
    }

    macro_rules! call {
        // closures do not inherit target features, so the small compositions are macros made into
        // inline functions
        (write $name:ident($($arg:ident: $t:ty),*), $feature:literal, $body:expr) => {
            /// # Safety
            /// The pointers are good for as many numbers as there are lanes.
            #[inline]
            #[target_feature(enable = $feature)]
            unsafe fn $name($($arg: $t),*) {
                // SAFETY: the caller's promise.
                unsafe { $body }
            }
        };
        (read $name:ident($($arg:ident: $t:ty),*) -> $out:ty, $feature:literal, $body:expr) => {
            /// # Safety
            /// The pointer is good for as many numbers as there are lanes.
            #[inline]
            #[target_feature(enable = $feature)]
            unsafe fn $name($($arg: $t),*) -> $out {
                // SAFETY: the caller's promise.
                unsafe { $body }
            }
        };
        ($name:ident($($arg:ident: $t:ty),*) -> $out:ty, $feature:literal, $body:expr) => {
            #[inline]
            #[target_feature(enable = $feature)]
            fn $name($($arg: $t),*) -> $out {
                $body
            }
        };
    }

    /// A comparison that the compiler does not look into: where it knows that lanes are all ones or nothing, it keeps truth
    /// values as bytes of 0 and 1 and makes masks of them again for every use, which takes longer than what is done with them.
    macro_rules! compare {
        ($name:ident $vector:ty, $instruction:literal) => {
            #[inline]
            #[target_feature(enable = "avx2")]
            fn $name(a: $vector, b: $vector) -> $vector {
                let mask: $vector;
                // SAFETY: the instruction reads and writes these registers only.
                unsafe {
                    core::arch::asm!($instruction, a = in(ymm_reg) a, b = in(ymm_reg) b, mask = lateout(ymm_reg) mask,
                        options(pure, nomem, nostack, preserves_flags));
                }
                mask
            }
        };
    }
    /// The signs of all lanes; not left to the compiler either, which puts several of them together by way of bytes.
    macro_rules! signs {
        ($name:ident $vector:ty, $instruction:literal) => {
            #[inline]
            #[target_feature(enable = "avx2")]
            fn $name(a: $vector) -> u32 {
                let bits: u32;
                // SAFETY: the instruction reads and writes these registers only.
                unsafe {
                    core::arch::asm!($instruction, a = in(ymm_reg) a, bits = lateout(reg) bits,
                        options(pure, nomem, nostack, preserves_flags));
                }
                bits
            }
        };
    }

    call!(less_f32x16(a: __m512, b: __m512) -> __mmask16, "avx512f", _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b));
    call!(less_equal_f32x16(a: __m512, b: __m512) -> __mmask16, "avx512f", _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b));
    call!(choose_f32x16(m: __mmask16, y: __m512, n: __m512) -> __m512, "avx512f", _mm512_mask_blend_ps(m, n, y));
    call!(add_where_f32x16(a: __m512, m: __mmask16, b: __m512) -> __m512, "avx512f", _mm512_mask_add_ps(a, m, a, b));
    call!(and16(a: __mmask16, b: __mmask16) -> __mmask16, "avx512f", a & b);
    call!(or16(a: __mmask16, b: __mmask16) -> __mmask16, "avx512f", a | b);
    call!(not16(a: __mmask16) -> __mmask16, "avx512f", !a);
    call!(bits16(a: __mmask16) -> u32, "avx512f", u32::from(a));
    call!(from_bits16(bits: u32) -> __mmask16, "avx512f", bits as __mmask16);
    call!(write pack_f32x16(v: __m512, bits: u32, to: *mut f32), "avx512f",
        _mm512_storeu_ps(to, _mm512_maskz_compress_ps(bits as __mmask16, v)));
    call!(write pack_numbers16(first: u32, bits: u32, to: *mut u32), "avx512f", {
        let each = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        let all = _mm512_add_epi32(_mm512_set1_epi32(first as i32), each);
        _mm512_storeu_si512(to.cast(), _mm512_maskz_compress_epi32(bits as __mmask16, all));
    });
    call!(read listed16(from: *const u32, value: u32) -> u32, "avx512f",
        u32::from(_mm512_cmpeq_epi32_mask(_mm512_loadu_si512(from.cast()), _mm512_set1_epi32(value as i32))));
    call!(write pack_listed16(from: *const u32, bits: u32, to: *mut u32), "avx512f",
        _mm512_storeu_si512(to.cast(), _mm512_maskz_compress_epi32(bits as __mmask16, _mm512_loadu_si512(from.cast()))));
    call!(rough_f32x16(a: __m512) -> __m512, "avx512f",
        _mm512_div_ps(_mm512_set1_ps(1.0), _mm512_sqrt_ps(a)));
    vector!("Sixteen f32." F32Avx512 MaskF32Avx512 f32 16 __m512, __mmask16,
        _mm512_set1_ps _mm512_loadu_ps _mm512_storeu_ps _mm512_add_ps _mm512_sub_ps _mm512_mul_ps _mm512_div_ps
        _mm512_sqrt_ps _mm512_abs_ps _mm512_min_ps _mm512_max_ps,
        rough rough_f32x16,
        less less_f32x16, less_equal less_equal_f32x16, choose choose_f32x16, add_where add_where_f32x16,
        and and16, or or16, not not16, bits bits16, from_bits from_bits16, pack pack_f32x16, pack_numbers pack_numbers16,
        pack_listed pack_listed16, listed listed16);

    call!(less_f64x8(a: __m512d, b: __m512d) -> __mmask8, "avx512f", _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b));
    call!(less_equal_f64x8(a: __m512d, b: __m512d) -> __mmask8, "avx512f", _mm512_cmp_pd_mask::<_CMP_LE_OQ>(a, b));
    call!(choose_f64x8(m: __mmask8, y: __m512d, n: __m512d) -> __m512d, "avx512f", _mm512_mask_blend_pd(m, n, y));
    call!(add_where_f64x8(a: __m512d, m: __mmask8, b: __m512d) -> __m512d, "avx512f", _mm512_mask_add_pd(a, m, a, b));
    call!(and8(a: __mmask8, b: __mmask8) -> __mmask8, "avx512f", a & b);
    call!(or8(a: __mmask8, b: __mmask8) -> __mmask8, "avx512f", a | b);
    call!(not8(a: __mmask8) -> __mmask8, "avx512f", !a);
    call!(bits8(a: __mmask8) -> u32, "avx512f", u32::from(a));
    call!(from_bits8(bits: u32) -> __mmask8, "avx512f", bits as __mmask8);
    call!(write pack_f64x8(v: __m512d, bits: u32, to: *mut f64), "avx512f",
        _mm512_storeu_pd(to, _mm512_maskz_compress_pd(bits as __mmask8, v)));
    call!(write pack_numbers8(first: u32, bits: u32, to: *mut u32), "avx512f,avx512vl,avx2", {
        let each = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        let all = _mm256_add_epi32(_mm256_set1_epi32(first as i32), each);
        _mm256_storeu_si256(to.cast(), _mm256_maskz_compress_epi32(bits as __mmask8, all));
    });
    call!(read listed8(from: *const u32, value: u32) -> u32, "avx512f,avx512vl,avx2",
        u32::from(_mm256_cmpeq_epi32_mask(_mm256_loadu_si256(from.cast()), _mm256_set1_epi32(value as i32))));
    call!(write pack_listed8(from: *const u32, bits: u32, to: *mut u32), "avx512f,avx512vl,avx2",
        _mm256_storeu_si256(to.cast(), _mm256_maskz_compress_epi32(bits as __mmask8, _mm256_loadu_si256(from.cast()))));
    call!(rough_f64x8(a: __m512d) -> __m512d, "avx512f,avx2",
        _mm512_cvtps_pd(_mm256_div_ps(_mm256_set1_ps(1.0), _mm256_sqrt_ps(_mm512_cvtpd_ps(a)))));
    vector!("Eight f64." F64Avx512 MaskF64Avx512 f64 8 __m512d, __mmask8,
        _mm512_set1_pd _mm512_loadu_pd _mm512_storeu_pd _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd
        _mm512_sqrt_pd _mm512_abs_pd _mm512_min_pd _mm512_max_pd,
        rough rough_f64x8,
        less less_f64x8, less_equal less_equal_f64x8, choose choose_f64x8, add_where add_where_f64x8,
        and and8, or or8, not not8, bits bits8, from_bits from_bits8, pack pack_f64x8, pack_numbers pack_numbers8,
        pack_listed pack_listed8, listed listed8);

    /// Which lanes are set, the lowest first, for each set of eight lanes.
    const SET: [[u8; 8]; 256] = set_lanes(1);
    /// The halves of the lanes that are set, for each set of four lanes.
    const SET_HALVES: [[u8; 8]; 16] = set_lanes(2);

    /// The parts of the lanes that are set, in order.
    const fn set_lanes<const SETS: usize>(parts: usize) -> [[u8; 8]; SETS] {
        let mut all = [[0; 8]; SETS];
        let mut bits = 0;
        while bits < SETS {
            let (mut part, mut chosen) = (0, 0);
            while part < 8 {
                if bits >> (part / parts) & 1 == 1 {
                    all[bits][chosen] = part as u8;
                    chosen += 1;
                }
                part += 1;
            }
            bits += 1;
        }
        all
    }

    call!(order8(order: &[u8; 8]) -> __m256i, "avx2",
        _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(i64::from_le_bytes(*order))));
    call!(order4(order: &[u8; 8]) -> __m128i, "avx2", _mm_cvtepu8_epi32(_mm_cvtsi64_si128(i64::from_le_bytes(*order))));

    compare!(less_f32x8 __m256, "vcmplt_oqps {mask}, {a}, {b}");
    compare!(less_equal_f32x8 __m256, "vcmple_oqps {mask}, {a}, {b}");
    call!(write pack_f32x8(v: __m256, bits: u32, to: *mut f32), "avx2",
        _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(v, order8(&SET[bits as usize & 255]))));
    call!(write pack_numbers_avx8(first: u32, bits: u32, to: *mut u32), "avx2",
        _mm256_storeu_si256(to.cast(), _mm256_add_epi32(_mm256_set1_epi32(first as i32), order8(&SET[bits as usize & 255]))));
    call!(write pack_listed_avx8(from: *const u32, bits: u32, to: *mut u32), "avx2", {
        let all = _mm256_loadu_si256(from.cast());
        _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(all, order8(&SET[bits as usize & 255])));
    });
    call!(read listed_avx8(from: *const u32, value: u32) -> u32, "avx2", {
        let equal = _mm256_cmpeq_epi32(_mm256_loadu_si256(from.cast()), _mm256_set1_epi32(value as i32));
        _mm256_movemask_ps(_mm256_castsi256_ps(equal)) as u32
    });
    call!(choose_f32x8(m: __m256, y: __m256, n: __m256) -> __m256, "avx2", _mm256_blendv_ps(n, y, m));
    call!(add_where_f32x8(a: __m256, m: __m256, b: __m256) -> __m256, "avx2", _mm256_blendv_ps(a, _mm256_add_ps(a, b), m));
    call!(not_f32x8(a: __m256) -> __m256, "avx2", _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1))));
    call!(abs_f32x8(a: __m256) -> __m256, "avx2", _mm256_andnot_ps(_mm256_set1_ps(-0.0), a));
    signs!(bits_f32x8 __m256, "vmovmskps {bits:e}, {a}");
    call!(from_bits_f32x8(bits: u32) -> __m256, "avx2", {
        let each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        let set = _mm256_and_si256(_mm256_set1_epi32(bits as i32), each);
        _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, each))
    });
    call!(rough_f32x8(a: __m256) -> __m256, "avx2",
        _mm256_div_ps(_mm256_set1_ps(1.0), _mm256_sqrt_ps(a)));
    vector!("Eight f32." F32Avx2 MaskF32Avx2 f32 8 __m256, __m256,
        _mm256_set1_ps _mm256_loadu_ps _mm256_storeu_ps _mm256_add_ps _mm256_sub_ps _mm256_mul_ps _mm256_div_ps
        _mm256_sqrt_ps abs_f32x8 _mm256_min_ps _mm256_max_ps,
        rough rough_f32x8,
        less less_f32x8, less_equal less_equal_f32x8, choose choose_f32x8, add_where add_where_f32x8,
        and _mm256_and_ps, or _mm256_or_ps, not not_f32x8, bits bits_f32x8, from_bits from_bits_f32x8, pack pack_f32x8,
        pack_numbers pack_numbers_avx8, pack_listed pack_listed_avx8, listed listed_avx8);

    compare!(less_f64x4 __m256d, "vcmplt_oqpd {mask}, {a}, {b}");
    compare!(less_equal_f64x4 __m256d, "vcmple_oqpd {mask}, {a}, {b}");
    call!(write pack_f64x4(v: __m256d, bits: u32, to: *mut f64), "avx2", {
        let halves = _mm256_permutevar8x32_ps(_mm256_castpd_ps(v), order8(&SET_HALVES[bits as usize & 15]));
        _mm256_storeu_pd(to, _mm256_castps_pd(halves));
    });
    call!(write pack_numbers4(first: u32, bits: u32, to: *mut u32), "avx2",
        _mm_storeu_si128(to.cast(), _mm_add_epi32(_mm_set1_epi32(first as i32), order4(&SET[bits as usize & 15]))));
    call!(write pack_listed4(from: *const u32, bits: u32, to: *mut u32), "avx2", {
        let all = _mm_castsi128_ps(_mm_loadu_si128(from.cast()));
        let packed = _mm_permutevar_ps(all, order4(&SET[bits as usize & 15]));
        _mm_storeu_si128(to.cast(), _mm_castps_si128(packed));
    });
    call!(read listed4(from: *const u32, value: u32) -> u32, "avx2", {
        let equal = _mm_cmpeq_epi32(_mm_loadu_si128(from.cast()), _mm_set1_epi32(value as i32));
        _mm_movemask_ps(_mm_castsi128_ps(equal)) as u32
    });
    call!(choose_f64x4(m: __m256d, y: __m256d, n: __m256d) -> __m256d, "avx2", _mm256_blendv_pd(n, y, m));
    call!(add_where_f64x4(a: __m256d, m: __m256d, b: __m256d) -> __m256d, "avx2", _mm256_blendv_pd(a, _mm256_add_pd(a, b), m));
    call!(not_f64x4(a: __m256d) -> __m256d, "avx2", _mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi32(-1))));
    call!(abs_f64x4(a: __m256d) -> __m256d, "avx2", _mm256_andnot_pd(_mm256_set1_pd(-0.0), a));
    signs!(bits_f64x4 __m256d, "vmovmskpd {bits:e}, {a}");
    call!(from_bits_f64x4(bits: u32) -> __m256d, "avx2", {
        let each = _mm256_setr_epi64x(1, 2, 4, 8);
        let set = _mm256_and_si256(_mm256_set1_epi64x(i64::from(bits)), each);
        _mm256_castsi256_pd(_mm256_cmpeq_epi64(set, each))
    });
    call!(rough_f64x4(a: __m256d) -> __m256d, "avx2",
        _mm256_cvtps_pd(_mm_div_ps(_mm_set1_ps(1.0), _mm_sqrt_ps(_mm256_cvtpd_ps(a)))));
    vector!("Four f64." F64Avx2 MaskF64Avx2 f64 4 __m256d, __m256d,
        _mm256_set1_pd _mm256_loadu_pd _mm256_storeu_pd _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd
        _mm256_sqrt_pd abs_f64x4 _mm256_min_pd _mm256_max_pd,
        rough rough_f64x4,
        less less_f64x4, less_equal less_equal_f64x4, choose choose_f64x4, add_where add_where_f64x4,
        and _mm256_and_pd, or _mm256_or_pd, not not_f64x4, bits bits_f64x4, from_bits from_bits_f64x4, pack pack_f64x4,
        pack_numbers pack_numbers4, pack_listed pack_listed4, listed listed4);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of every operation over two arrays; the plain number is the reference.
    struct Chain<'a, R>(&'a [R], &'a [R]);

    #[inline(always)]
    fn chain<R: Real, L: Lanes<R>>(a: L, b: L) -> L {
        let masked = a.less(b).or(b.less_equal(a).not()).and(L::Mask::all_of(true));
        let sum = (a + b * a - b / (a * a + L::splat(R::ONE))).add_where(masked, b);
        let root = (sum * sum).square_root() + reciprocal_root::<R, L>(sum * sum + L::splat(R::of(1e-3)));
        L::choose(root.less(L::splat(R::of(2.0))), -root.lesser(a), root.greater(b).size())
    }

    impl<R: Real> Task<R> for Chain<'_, R> {
        type Output = Vec<R>;
        #[inline(always)]
        fn run<L: Lanes<R>>(self) -> Vec<R> {
            let mut out = vec![R::ZERO; self.0.len()];
            for start in (0..self.0.len()).step_by(L::WIDTH) {
                chain::<R, L>(L::load(&self.0[start..]), L::load(&self.1[start..])).store(&mut out[start..]);
            }
            out
        }
    }

    fn levels_agree<R: Real>() {
        let a: Vec<R> = (0..64).map(|i| R::of((f64::from(i) * 0.37).sin() * 3.0)).collect();
        let b: Vec<R> = (0..64).map(|i| R::of((f64::from(i) * 0.91).cos() * 3.0)).collect();
        let plain = Chain(&a, &b).run::<R>();
        for level in [Level::Portable, Level::Avx2, Level::Avx512] {
            let wide = with_lanes(level, Chain(&a, &b));
            for k in 0..64 {
                assert_eq!(plain[k].bits(), wide[k].bits(), "{level:?} lane {k}");
            }
        }
        // the arrays of other processors
        let wide = Chain(&a, &b).run::<Wide<R, 8>>();
        assert!((0..64).all(|k| plain[k].bits() == wide[k].bits()));
    }

    #[test]
    fn every_level_computes_the_plain_numbers_bits() {
        levels_agree::<f32>();
        levels_agree::<f64>();
    }

    #[test]
    fn reciprocal_roots_are_near_those_of_roots_and_quotients() {
        for k in -320..300 {
            for digits in [1.0, 2.7, 9.99] {
                let squared = digits * 10f64.powi(k);
                let error = reciprocal_root::<f64, f64>(squared) * squared.sqrt() - 1.0;
                assert!(error.abs() < 2e-14 || squared == 0.0, "{squared}: {error}");
            }
        }
        assert!((reciprocal_root::<f32, f32>(2.0) - 0.707_106_77).abs() < 1e-7);
    }

    struct Bits;
    impl Task<f32> for Bits {
        type Output = ();
        #[inline(always)]
        fn run<L: Lanes<f32>>(self) {
            let all = (1u32 << L::WIDTH) - 1;
            for bits in [0b1011u32 & all, 0, all] {
                let mask = L::Mask::from_bits(bits);
                assert_eq!(mask.bits(), bits);
                assert_eq!(mask.not().bits() & all, !bits & all);
                assert_eq!(mask.any(), bits != 0);
            }
        }
    }

    struct Pack;
    impl<R: Real> Task<R> for Pack {
        type Output = ();
        #[inline(always)]
        fn run<L: Lanes<R>>(self) {
            let from: Vec<R> = (0..L::WIDTH).map(R::count).collect();
            let list: Vec<u32> = (0..L::WIDTH as u32).map(|k| 1000 - k).collect();
            for seed in 0..50u32 {
                let bits = seed.wrapping_mul(0x9E37_79B9) >> 16 & ((1u32 << L::WIDTH) - 1);
                let (mut to, mut numbers, mut listed) = ([R::ZERO; 16], [0; 16], [0; 16]);
                L::load(&from).pack(bits, &mut to);
                L::pack_numbers(100, bits, &mut numbers);
                L::pack_listed(&list, bits, &mut listed);
                for (n, k) in (0..L::WIDTH).filter(|k| bits >> k & 1 == 1).enumerate() {
                    assert_eq!((to[n], numbers[n], listed[n]), (from[k], 100 + k as u32, list[k]));
                }
                assert_eq!(L::listed(&list, 1000 - seed), if seed < L::WIDTH as u32 { 1 << seed } else { 0 });
                // a number may stand there more than once
                assert_eq!(L::listed(&[seed; 16], seed), (1 << L::WIDTH) - 1);
            }
        }
    }

    #[test]
    fn packing_keeps_the_chosen_lanes_in_order() {
        for level in [Level::Portable, Level::Avx2, Level::Avx512] {
            with_lanes::<f32, _>(level, Pack);
            with_lanes::<f64, _>(level, Pack);
        }
        Pack.run::<Wide<f64, 4>>();
    }

    #[test]
    fn masks_and_bits_are_each_others_inverse() {
        for level in [Level::Portable, Level::Avx2, Level::Avx512] {
            with_lanes(level, Bits);
        }
        Bits.run::<Wide<f32, 8>>();
    }
}
