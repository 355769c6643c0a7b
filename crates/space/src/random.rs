//! Counter-based random numbers: a draw is a function of what it is for, never of when it is made.
//!
//! Philox4x32-10 (Salmon et al. 2011): `U(seed, purpose, a, b)` with the key (low, high word of the
//! seed) and the counter (low word of `a`, high word of `a`, `b`, purpose). Results therefore do not depend on the order of
//! evaluation, the number of threads, or on whether something else drew as well.

use crate::{Real, Vector};

/// What a random draw is for. The number is part of the bit contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Initial positions, headings, per-agent parameters.
    Init = 1,
    /// Placement of obstacles.
    Obstacles = 2,
    /// Random quantities in the laws of the models.
    Behaviour = 3,
    /// Errors of sensing.
    Sensing = 4,
    /// Errors of computation.
    Computation = 5,
    /// Errors of execution.
    Execution = 6,
    /// The environment: respawn places, activation order, phases.
    Environment = 7,
    /// Searches over parameters.
    Search = 8,
    /// Resampling of measured values.
    Resampling = 9,
}

/// The Philox4x32-10 block function: four words from a counter and a key.
#[inline(always)]
pub fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    for round in 0..10 {
        if round > 0 {
            key = [key[0].wrapping_add(0x9E37_79B9), key[1].wrapping_add(0xBB67_AE85)];
        }
        let a = u64::from(counter[0]) * 0xD251_1F53;
        let b = u64::from(counter[2]) * 0xCD9E_8D57;
        counter = [(b >> 32) as u32 ^ counter[1] ^ key[0], b as u32, (a >> 32) as u32 ^ counter[3] ^ key[1], a as u32];
    }
    counter
}

/// The draw `U(seed, purpose, a, b)`, uniform in [0, 1) with 53 random bits.
#[inline(always)]
pub fn uniform(seed: u64, purpose: Purpose, a: u64, b: u32) -> f64 {
    let words = philox([a as u32, (a >> 32) as u32, b, purpose as u32], [seed as u32, (seed >> 32) as u32]);
    let bits = u64::from(words[0]) | (u64::from(words[1]) << 32);
    (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

/// [`uniform`] for several counters `b` at once: the same numbers, computed side by side.
#[inline(always)]
pub fn uniforms<const W: usize>(seed: u64, purpose: Purpose, a: u64, b: &[u32; W]) -> [f64; W] {
    let mut c0 = [a as u32; W];
    let mut c1 = [(a >> 32) as u32; W];
    let mut c2 = *b;
    let mut c3 = [purpose as u32; W];
    let mut key = [seed as u32, (seed >> 32) as u32];
    for round in 0..10 {
        if round > 0 {
            key = [key[0].wrapping_add(0x9E37_79B9), key[1].wrapping_add(0xBB67_AE85)];
        }
        for w in 0..W {
            let x = u64::from(c0[w]) * 0xD251_1F53;
            let y = u64::from(c2[w]) * 0xCD9E_8D57;
            c0[w] = (y >> 32) as u32 ^ c1[w] ^ key[0];
            c1[w] = y as u32;
            c2[w] = (x >> 32) as u32 ^ c3[w] ^ key[1];
            c3[w] = x as u32;
        }
    }
    let mut out = [0.0; W];
    for w in 0..W {
        let bits = u64::from(c0[w]) | (u64::from(c1[w]) << 32);
        out[w] = (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0);
    }
    out
}

/// The draws of one agent in one step for one purpose: `b = 8 i + slot`.
///
/// A place in the stream is a slot (0 to 7); when the draw concerns another member `j`, `a` is
/// `step + 2^32 (j + 1)`.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    /// Seed of the run.
    pub seed: u64,
    /// Purpose of the draws.
    pub purpose: Purpose,
    /// Step of the run (or attempt number).
    pub step: u64,
    /// Index of the agent in the whole world.
    pub agent: u32,
    /// The uniform draw of slot 0, where it was made beforehand together with others; negative where not.
    pub first: f64,
}

impl Stream {
    /// Slots a decision may use.
    pub const SLOTS: u32 = 8;

    /// The draws of an agent in a step.
    #[inline(always)]
    pub fn new(seed: u64, purpose: Purpose, step: u64, agent: u32) -> Self {
        Self { seed, purpose, step, agent, first: -1.0 }
    }
    /// Uniform in [0, 1).
    #[inline(always)]
    pub fn uniform(&self, slot: u32) -> f64 {
        if slot == 0 && self.first >= 0.0 {
            return self.first;
        }
        uniform(self.seed, self.purpose, self.step, self.agent.wrapping_mul(8).wrapping_add(slot))
    }
    /// Uniform in [0, 1), about the other member `j`.
    #[inline(always)]
    pub fn uniform_about(&self, j: u32, slot: u32) -> f64 {
        let a = self.step.wrapping_add((u64::from(j) + 1) << 32);
        uniform(self.seed, self.purpose, a, self.agent.wrapping_mul(8).wrapping_add(slot))
    }
    /// Standard normal, from the uniform draws of `slot` and `slot + 1` (Box-Muller, cosine branch).
    #[inline]
    pub fn normal(&self, slot: u32) -> f64 {
        normal(self.uniform(slot), self.uniform(slot + 1))
    }
    /// Standard normal about the other member `j`, from `slot` and `slot + 1`.
    #[inline]
    pub fn normal_about(&self, j: u32, slot: u32) -> f64 {
        normal(self.uniform_about(j, slot), self.uniform_about(j, slot + 1))
    }
    /// Random unit vector: one draw in one (sign) and two dimensions (angle), two in three (`slot`
    /// gives the third component, `slot + 1` the azimuth).
    #[inline]
    pub fn unit<R: Real, const D: usize>(&self, slot: u32) -> Vector<R, D> {
        let second = if D == 3 { self.uniform(slot + 1) } else { 0.0 };
        unit_vector(self.uniform(slot), second)
    }
}

/// Standard normal from two uniform numbers in [0, 1), by Box and Muller; the first is taken as `1 - u` so that
/// the logarithm stays finite.
#[inline]
pub fn normal(first: f64, second: f64) -> f64 {
    libm::sqrt(-2.0 * libm::log(1.0 - first)) * libm::cos(core::f64::consts::TAU * second)
}

/// A unit vector, uniform over directions, from uniform numbers in [0, 1).
#[inline]
pub fn unit_vector<R: Real, const D: usize>(first: f64, second: f64) -> Vector<R, D> {
    match D {
        1 => Vector::of(&[if first < 0.5 { -1.0 } else { 1.0 }]),
        2 => {
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * first - core::f64::consts::PI);
            Vector::of(&[cos, sin])
        }
        _ => {
            let z = 2.0 * first - 1.0;
            let around = libm::sqrt((1.0 - z * z).max(0.0));
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * second - core::f64::consts::PI);
            Vector::of(&[around * cos, around * sin, z])
        }
    }
}

/// The key of a child (a trial, a candidate, a generation), derived from the parent's by one Philox
/// call from what the child *is*.
pub fn child_seed(parent: u64, kind: u32, number: u64, detail: u32) -> u64 {
    let words = philox([number as u32, (number >> 32) as u32, detail, kind], [parent as u32, (parent >> 32) as u32]);
    u64::from(words[0]) | (u64::from(words[1]) << 32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_known_answers() {
        // Random123's kat_vectors for philox4x32-10
        assert_eq!(philox([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        assert_eq!(
            philox([0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344], [0xa409_3822, 0x299f_31d0]),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn several_at_once_are_the_same_numbers() {
        let b = [0, 8, 16, 7, u32::MAX, 1, 2, 3];
        let all = uniforms(0x1234_5678_9abc_def0, Purpose::Behaviour, 1 << 33, &b);
        for (k, &b) in b.iter().enumerate() {
            assert_eq!(all[k], uniform(0x1234_5678_9abc_def0, Purpose::Behaviour, 1 << 33, b));
        }
    }

    #[test]
    fn the_documented_draw() {
        assert_eq!(uniform(7, Purpose::Behaviour, 11, 0), 0.992_562_634_704_139_1);
    }

    #[test]
    fn normal_and_unit_have_their_moments() {
        let (mut sum, mut squares, mut mean) = (0.0, 0.0, Vector::<f64, 3>::ZERO);
        let n = 20_000;
        for step in 0..n {
            let s = Stream::new(5, Purpose::Sensing, step, 3);
            let x = s.normal(0);
            sum += x;
            squares += x * x;
            let u: Vector<f64, 3> = s.unit(2);
            assert!((u.length() - 1.0).abs() < 1e-12);
            mean += u;
        }
        let n = n as f64;
        assert!((sum / n).abs() < 0.03 && (squares / n - 1.0).abs() < 0.04);
        assert!((mean / n).length() < 0.02);
    }
}
