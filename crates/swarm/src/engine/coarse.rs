//! Who is roughly how far away: rings marked in single precision, twice as many others at a time, wherever the rounding of
//! single precision cannot make a difference.
//!
//! With `M` the largest size of a coordinate and `S` the largest squared radius, the squared distance of a pair that is about
//! as far apart as `S` comes out wrong by less than `(8 sqrt(S) M + 12 M^2 2^-24) 2^-24 + S 2^-20`: the rounding of both places,
//! of their difference, and of its square. Whoever is farther from the bound of a ring than that is on the side that it seems
//! to be on. An agent for which somebody is nearer to a bound looks again, at all of them, in full precision.

use crate::engine::kernel::mask_of;
use crate::motion::{BLOCK, dot};
use crate::parameters::Scalar;
use crate::selection::{RINGS, Rings};
use space::lanes::{Lanes, Mask, Task};
use space::{Columns, Vector};

/// Half a unit in the last place of 1, in single precision.
const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// Everyone's place, in single precision.
pub(crate) struct Coarse<const D: usize> {
    position: [Vec<f32>; D],
    /// Largest size of a coordinate.
    farthest: f64,
    count: usize,
}

impl<const D: usize> Coarse<D> {
    pub(crate) fn new() -> Self {
        Self { position: core::array::from_fn(|_| Vec::new()), farthest: 0.0, count: 0 }
    }
    /// Takes over where everyone is.
    pub(crate) fn update<R: Scalar>(&mut self, now: &Columns<R, D>) {
        self.count = now.len();
        let mut farthest = R::ZERO;
        for (to, from) in self.position.iter_mut().zip(&now.position) {
            // nobody stands in the rest of the last block
            to.resize(self.count, 0.0);
            to.resize(self.count.next_multiple_of(BLOCK), f32::INFINITY);
            for (to, &from) in to.iter_mut().zip(&from[..self.count]) {
                *to = from.to_f64() as f32;
                farthest = farthest.most(from.abs());
            }
        }
        self.farthest = farthest.to_f64();
    }
    /// Where everyone is, padded to whole blocks.
    #[inline(always)]
    pub(crate) fn position(&self) -> [&[f32]; D] {
        self.position.each_ref().map(|column| &column[..])
    }
    /// How wrong the difference of two places may be along an axis: both were rounded, and so was the difference.
    #[inline(always)]
    pub(crate) fn displaced(&self) -> f32 {
        (16.0 * ROUNDING * self.farthest) as f32
    }
    /// What marks the rings about an agent; `None` where the rounding would be of the size of the rings.
    #[inline(always)]
    pub(crate) fn about<'a, R: Scalar>(
        &'a self,
        row: usize,
        heading: Vector<R, D>,
        rings: &Rings<R>,
        squared: &'a mut [f32],
        marks: [&'a mut [u16]; RINGS],
        close: &'a mut [u16],
    ) -> Option<MarkCoarse<'a, D>> {
        let outermost = rings.outer[RINGS - 1].to_f64();
        let places = (8.0 * rings.reach.to_f64() + 12.0 * ROUNDING * self.farthest) * self.farthest;
        let margin = places * ROUNDING + outermost * (16.0 * ROUNDING);
        let rest = heading.length_squared() <= R::ZERO;
        // not a number fails, too
        let sharp = margin < outermost * 1e-3;
        if rest || !sharp {
            return None;
        }
        let mut cone = rings.cos_half.to_f64();
        cone *= cone.abs();
        let mut head = [0.0; D];
        let mut position = [&[][..]; D];
        for a in 0..D {
            head[a] = heading.0[a].to_f64() as f32;
            position[a] = &self.position[a][..];
        }
        Some(MarkCoarse {
            position,
            count: self.count,
            row,
            heading: head,
            low: rings.outer.map(|bound| (bound.to_f64() - margin) as f32),
            high: rings.outer.map(|bound| (bound.to_f64() + margin) as f32),
            cone: cone as f32,
            // the direction is rounded as well, and the distance along it enters as a square
            cone_margin: (4.0 * margin) as f32,
            within_cone: rings.within_cone,
            margin: margin as f32,
            squared,
            marks,
            close,
        })
    }
}

/// Marks the rings about an agent; the answer is whether that could be done for sure.
pub(crate) struct MarkCoarse<'a, const D: usize> {
    position: [&'a [f32]; D],
    count: usize,
    row: usize,
    heading: [f32; D],
    low: [f32; RINGS],
    high: [f32; RINGS],
    cone: f32,
    cone_margin: f32,
    within_cone: [bool; RINGS],
    /// How wrong squared distances up to the largest radius may be.
    pub(crate) margin: f32,
    squared: &'a mut [f32],
    marks: [&'a mut [u16]; RINGS],
    close: &'a mut [u16],
}

impl<const D: usize> Task<f32> for MarkCoarse<'_, D> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes<f32>>(self) -> bool {
        let Self { position, count, row, squared, marks, close, .. } = self;
        let padded = count.next_multiple_of(BLOCK);
        let marks = marks.map(|marks| &mut marks[..padded / BLOCK]);
        let close = &mut close[..padded / BLOCK];
        let squares = &mut squared[..padded];
        let zero = L::splat(0.0);
        let (mut me, mut heading) = ([zero; D], [zero; D]);
        let mut columns = [&[][..]; D];
        for a in 0..D {
            columns[a] = &position[a][..padded];
            me[a] = L::splat(position[a][row]);
            heading[a] = L::splat(self.heading[a]);
        }
        let (mut low, mut high) = ([zero; RINGS], [zero; RINGS]);
        for s in 0..RINGS {
            (low[s], high[s]) = (L::splat(self.low[s]), L::splat(self.high[s]));
        }
        let limited = self.within_cone.contains(&true);
        let (cone, margin) = (L::splat(self.cone), L::splat(self.cone_margin));
        let behind = -margin;
        let (own_block, own_bit) = (row / BLOCK, 1 << (row % BLOCK));
        let everyone = mask_of(BLOCK);
        let mut unsure = 0;
        for block in 0..padded / BLOCK {
            let first = block * BLOCK;
            // nearer than each bound for sure, and perhaps; in view for sure, and perhaps: logic is quicker with bits
            let (mut surely, mut perhaps) = ([0; RINGS], [0; RINGS]);
            let (mut seen, mut glimpsed) = if limited { (0, 0) } else { (everyone, everyone) };
            for part in (0..BLOCK).step_by(L::WIDTH) {
                let mut offset = me;
                for a in 0..D {
                    offset[a] = L::load(&columns[a][first + part..]) - me[a];
                }
                let squared = dot(&offset, &offset);
                squared.store(&mut squares[first + part..]);
                if limited {
                    let along = dot(&heading, &offset);
                    let ahead = along * along.size() - cone * squared;
                    seen |= margin.less_equal(ahead).bits() << part;
                    glimpsed |= behind.less_equal(ahead).bits() << part;
                }
                for s in 0..RINGS {
                    surely[s] |= squared.less(low[s]).bits() << part;
                    perhaps[s] |= squared.less(high[s]).bits() << part;
                }
            }
            let mut blurred = (glimpsed ^ seen) & perhaps[RINGS - 1];
            let mut inside = 0;
            for s in 0..RINGS {
                let view = if self.within_cone[s] { seen } else { everyone };
                marks[s][block] = (surely[s] & !inside & view) as u16;
                blurred |= perhaps[s] ^ surely[s];
                inside = surely[s];
            }
            close[block] = surely[0] as u16;
            unsure |= blurred & !(if block == own_block { own_bit } else { 0 });
        }
        // all but oneself
        close[own_block] &= !(own_bit as u16);
        for marks in marks {
            marks[own_block] &= !(own_bit as u16);
        }
        unsure & everyone == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::lanes::{level, with_lanes};

    /// Marks in full precision, pair by pair.
    fn exactly(now: &Columns<f64, 3>, row: usize, heading: Vector<f64, 3>, rings: &Rings<f64>) -> [[u16; 3]; RINGS] {
        let mut marks = [[0; 3]; RINGS];
        for other in (0..now.len()).filter(|&other| other != row) {
            let offset = now.position(other) - now.position(row);
            let squared = offset.length_squared();
            let seen = crate::motion::in_view::<f64, f64, 3>(&heading.0, &offset.0, squared, rings.cos_half);
            if let Some(s) = (0..RINGS).find(|&s| squared < rings.outer[s])
                && (seen || !rings.within_cone[s])
            {
                marks[s][other / BLOCK] |= 1 << (other % BLOCK);
            }
        }
        marks
    }

    #[test]
    fn what_is_told_for_sure_is_what_full_precision_says() {
        let mut told = 0;
        for trial in 0..400u32 {
            let mut now = Columns::<f64, 3>::new(40, 0);
            let shift = [0.0, 100.0, 1e4, 1e7][trial as usize % 4];
            let number = |k: u32| ((f64::from(k + 1000 * trial) * 12.9898).sin() * 43_758.545_3).rem_euclid(1.0);
            for k in 0..40 {
                // every fourth one stands at a bound, or within a hair of it
                let length = if k % 4 == 0 { [6.0, 12.0, 26.0][k as usize % 3] } else { 30.0 * number(4 * k + 3) };
                let hair = if k % 8 == 0 { 0.0 } else { 1e-7 * number(4 * k) };
                let way = Vector([number(4 * k) - 0.5, number(4 * k + 1) - 0.5, number(4 * k + 2) - 0.5]).unit();
                let place = if k == 0 { Vector::ZERO } else { way * (length + hair) };
                now.set_position(k as usize, place + Vector([shift, -shift, 0.5 * shift]));
            }
            let rings = Rings {
                outer: [36.0, 144.0, 676.0],
                reach: 26.0,
                cos_half: [-0.7, 0.0, 0.5][trial as usize % 3],
                within_cone: [trial % 2 == 0, true, true],
            };
            let heading = Vector([number(1) - 0.5, number(2) - 0.5, number(3) - 0.5]).unit();
            let mut coarse = Coarse::new();
            coarse.update(&now);
            for row in 0..40 {
                let (mut marks, mut close) = ([[0; 3]; RINGS], [0; 3]);
                let mut squared = [0.0; 48];
                let task =
                    coarse.about(row, heading, &rings, &mut squared, marks.each_mut().map(|m| &mut m[..]), &mut close);
                if task.is_some_and(|task| with_lanes(level(), task)) {
                    told += 1;
                    assert_eq!(marks, exactly(&now, row, heading, &rings), "trial {trial}, row {row}");
                }
            }
        }
        // of 16,000; those far from the origin, and those who stand at a bound on purpose, are to look again
        assert!(told > 6_000, "{told}");
    }
}
