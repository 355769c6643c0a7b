//! Association: pairing the inputs of one scan with those of the scan before (group-control.md section 9.3).
//!
//! A range-finder sees neither identity nor velocity. Two inputs are taken for the same body when they lie close to
//! each other in the world: nearest pairs first, one to one, within a gate. A body that is missed in one scan comes
//! back as a new one.

use core::cmp::Ordering;
use space::{Real, Vector};

/// The tracks of one agent: for every input of its latest scan a number and, from the second sight on, a velocity.
#[derive(Clone, Debug)]
pub struct Tracks<R, const D: usize> {
    /// Greatest distance between a body's places in two scans, in metres: 0.3.
    pub gate: R,
    offsets: Vec<Vector<R, D>>,
    numbers: Vec<u32>,
    velocities: Vec<Option<Vector<R, D>>>,
    /// Number of the next new track.
    next: u32,
    before: Vec<(Vector<R, D>, u32)>,
    /// Squared distance, input now, input before.
    pairs: Vec<(R, usize, usize)>,
    partner: Vec<Option<usize>>,
    taken: Vec<bool>,
}

impl<R: Real, const D: usize> Default for Tracks<R, D> {
    fn default() -> Self {
        Self::new(R::of(0.3))
    }
}

impl<R: Real, const D: usize> Tracks<R, D> {
    /// No tracks yet; the gate in metres.
    pub fn new(gate: R) -> Self {
        Self {
            gate,
            offsets: Vec::new(),
            numbers: Vec::new(),
            velocities: Vec::new(),
            next: 0,
            before: Vec::new(),
            pairs: Vec::new(),
            partner: Vec::new(),
            taken: Vec::new(),
        }
    }

    /// Takes in the world-aligned offsets (metres) of a new scan, `elapsed` seconds after the last one, during which
    /// the agent itself moved by `displacement` (metres).
    ///
    /// Of equally near pairs the one whose input comes earlier in this scan, then in the last one, is made first. If no
    /// time has passed no velocity is known. Numbers start at 0, are never given twice (within 2^32 tracks), and new
    /// tracks get theirs in the order of the inputs.
    pub fn update(&mut self, offsets: impl IntoIterator<Item = Vector<R, D>>, displacement: Vector<R, D>, elapsed: R) {
        self.before.clear();
        self.before.extend(self.offsets.iter().copied().zip(self.numbers.iter().copied()));
        self.offsets.clear();
        self.offsets.extend(offsets);
        self.pair(displacement);
        self.numbers.clear();
        self.velocities.clear();
        for (&offset, &partner) in self.offsets.iter().zip(&self.partner) {
            match partner {
                Some(old) => {
                    let (place, number) = self.before[old];
                    let moved = offset + displacement - place;
                    self.numbers.push(number);
                    self.velocities.push(if elapsed > R::ZERO { Some(moved / elapsed) } else { None });
                }
                None => {
                    self.numbers.push(self.next);
                    self.velocities.push(None);
                    self.next = self.next.wrapping_add(1);
                }
            }
        }
    }

    /// Fills `partner` with the input before of each input now.
    fn pair(&mut self, displacement: Vector<R, D>) {
        self.pairs.clear();
        for (now, &offset) in self.offsets.iter().enumerate() {
            for (old, &(place, _)) in self.before.iter().enumerate() {
                let moved = (offset + displacement - place).length_squared();
                if moved <= self.gate.squared() {
                    self.pairs.push((moved, now, old));
                }
            }
        }
        self.pairs.sort_unstable_by(|a, b| {
            a.0.partial_cmp(&b.0).unwrap_or(Ordering::Equal).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2))
        });
        self.partner.clear();
        self.partner.resize(self.offsets.len(), None);
        self.taken.clear();
        self.taken.resize(self.before.len(), false);
        for &(_, now, old) in &self.pairs {
            if self.partner[now].is_none() && !self.taken[old] {
                self.partner[now] = Some(old);
                self.taken[old] = true;
            }
        }
    }

    /// Forgets every track, as when scans were missed; numbers go on.
    pub fn forget(&mut self) {
        self.offsets.clear();
        self.numbers.clear();
        self.velocities.clear();
    }

    /// The track number of each input of the latest scan.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }
    /// The velocity in metres per second, in the world's frame, of each input of the latest scan; unknown on first
    /// sight.
    pub fn velocities(&self) -> &[Option<Vector<R, D>>] {
        &self.velocities
    }
    /// The offsets of the latest scan, world-aligned, in metres.
    pub fn offsets(&self) -> &[Vector<R, D>] {
        &self.offsets
    }

    /// Values that [`Self::save`] writes for each track: number, offset, velocity (NaN if unknown).
    pub const STRIDE: usize = 1 + 2 * D;

    /// Appends the state to `out`: the next number, the number of tracks, then [`Self::STRIDE`] values for each. The
    /// gate, a setting, is not among them.
    pub fn save(&self, out: &mut Vec<f64>) {
        out.push(f64::from(self.next));
        out.push(self.numbers.len() as f64);
        for ((&number, offset), velocity) in self.numbers.iter().zip(&self.offsets).zip(&self.velocities) {
            out.push(f64::from(number));
            out.extend(offset.0.iter().map(|c| c.to_f64()));
            out.extend((0..D).map(|a| velocity.map_or(f64::NAN, |v| v.0[a].to_f64())));
        }
    }

    /// Takes the state from the front of `values` and returns how many of them it used; `None`, with the tracks
    /// unchanged, if they are not what [`Self::save`] wrote.
    pub fn load(&mut self, values: &[f64]) -> Option<usize> {
        let whole = |value: f64| (value >= 0.0 && value <= f64::from(u32::MAX) && value % 1.0 == 0.0).then_some(value);
        let (&[next, count], rest) = values.split_first_chunk::<2>()?;
        let (next, count) = (whole(next)? as u32, whole(count)? as usize);
        let rest = rest.get(..count.checked_mul(Self::STRIDE)?)?;
        if rest.chunks_exact(Self::STRIDE).any(|track| whole(track[0]).is_none()) {
            return None;
        }
        self.forget();
        self.next = next;
        for track in rest.chunks_exact(Self::STRIDE) {
            let velocity = &track[1 + D..];
            self.numbers.push(track[0] as u32);
            self.offsets.push(Vector::of(&track[1..1 + D]));
            self.velocities.push(if velocity.iter().any(|c| c.is_nan()) { None } else { Some(Vector::of(velocity)) });
        }
        Some(2 + rest.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type V = Vector<f64, 2>;

    fn v(x: f64, y: f64) -> V {
        Vector([x, y])
    }

    #[test]
    fn velocities_are_unknown_first_and_then_those_of_the_world() {
        let mut tracks = Tracks::default();
        tracks.update([v(1.0, 0.0), v(0.0, 2.0)], V::ZERO, 0.1);
        assert_eq!((tracks.numbers(), tracks.velocities()), (&[0, 1][..], &[None, None][..]));
        // the agent moves 0.02 to the right; member 0 stands still, member 1 keeps pace with it
        tracks.update([v(0.98, 0.0), v(0.0, 2.0)], v(0.02, 0.0), 0.1);
        assert_eq!(tracks.numbers(), [0, 1]);
        let known: Vec<_> = tracks.velocities().iter().flatten().collect();
        assert!(known[0].length() < 1e-12 && (*known[1] - v(0.2, 0.0)).length() < 1e-12);
        tracks.update([v(0.98, 0.0)], V::ZERO, 0.0);
        assert_eq!((tracks.numbers(), tracks.velocities()), (&[0][..], &[None][..]), "no time, no velocity");
    }

    #[test]
    fn crossing_members_keep_their_numbers() {
        let mut tracks = Tracks::default();
        for step in 0..40 {
            let x = 1.025 - 0.05 * f64::from(step);
            let places = [v(x, 1.0), v(-x, 1.2)];
            // detections come in the order of their bearings, which changes where the members pass each other
            let first = usize::from(places[0].angle() > places[1].angle());
            tracks.update([places[first], places[1 - first]], V::ZERO, 0.1);
            assert_eq!(tracks.numbers(), [first as u32, 1 - first as u32], "step {step}");
            if step > 0 {
                let along = tracks.velocities()[first].unwrap_or_default();
                assert!((along - v(-0.5, 0.0)).length() < 1e-9);
            }
        }
    }

    #[test]
    fn lost_and_new_members() {
        let mut tracks = Tracks::default();
        tracks.update([v(1.0, 0.0), v(3.0, 0.0)], V::ZERO, 0.1);
        tracks.update([v(3.1, 0.0), v(5.0, 0.0)], V::ZERO, 0.1);
        assert_eq!(tracks.numbers(), [1, 2]);
        assert!(tracks.velocities()[0].is_some() && tracks.velocities()[1].is_none());
        tracks.update([v(1.0, 0.0), v(3.5, 0.0)], V::ZERO, 0.1);
        assert_eq!(tracks.numbers(), [3, 4], "a lost one is new again; 0.4 m is beyond the gate");
        tracks.update([], V::ZERO, 0.1);
        tracks.update([v(1.0, 0.0)], V::ZERO, 0.1);
        assert_eq!(tracks.numbers(), [5]);
        tracks.forget();
        tracks.update([v(1.0, 0.0)], V::ZERO, 0.1);
        assert_eq!(tracks.numbers(), [6]);
    }

    #[test]
    fn nearest_pairs_first_one_to_one_and_ties_to_the_earlier() {
        let mut tracks = Tracks::new(0.3);
        tracks.update([v(0.0, 0.0), v(0.25, 0.0)], V::ZERO, 0.1);
        // the second input is nearer to both; it takes track 1, so that the first gets track 0
        tracks.update([v(-0.1, 0.0), v(0.2, 0.0)], V::ZERO, 0.1);
        assert_eq!(tracks.numbers(), [0, 1]);
        let mut tracks = Tracks::new(0.25);
        tracks.update([v(0.0, 0.0), v(0.5, 0.0)], V::ZERO, 0.1);
        tracks.update([v(0.25, 0.0), v(0.25, 0.0)], V::ZERO, 0.1);
        assert_eq!(tracks.numbers(), [0, 1], "all four pairs are equally near, on the gate");
        tracks.update([v(0.25, 0.0), v(f64::NAN, 0.0)], V::ZERO, 0.1);
        assert_eq!(tracks.numbers(), [0, 2]);
    }

    #[test]
    fn a_restart_goes_on_as_if_nothing_had_been() {
        let mut tracks = Tracks::<f32, 3>::new(0.5);
        tracks.update([Vector([1.0, 2.0, 3.0])], Vector::ZERO, 0.1);
        tracks.update([Vector([1.1, 2.0, 3.0]), Vector([4.0, 0.0, 0.0])], Vector::ZERO, 0.1);
        let mut saved = vec![7.0];
        tracks.save(&mut saved);
        assert_eq!(saved.len(), 1 + 2 + 2 * Tracks::<f32, 3>::STRIDE);
        saved.push(9.0);
        let mut other = Tracks::<f32, 3>::new(0.5);
        assert_eq!(other.load(&saved[1..]), Some(16));
        assert_eq!(other.velocities(), tracks.velocities());
        for each in [&mut tracks, &mut other] {
            each.update([Vector([4.1, 0.0, 0.0]), Vector([8.0, 0.0, 0.0])], Vector::ZERO, 0.1);
            assert_eq!(each.numbers(), [1, 2]);
        }
        assert_eq!(other.velocities(), tracks.velocities());
        assert_eq!(other.load(&saved[1..9]), None, "cut short");
        assert_eq!(other.load(&[0.5, 0.0]), None);
        assert_eq!(other.load(&[0.0, -1.0]), None);
        assert_eq!(other.load(&[]), None);
        assert_eq!(other.numbers(), [1, 2], "unchanged");
    }
}
