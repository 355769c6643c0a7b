//! A saved state as bytes, so that a run can go on in another process with the same bits.

use crate::detection::readings::ErrorCount;
use crate::engine::world::{Checkpoint, Clocks};
use crate::motion::Motion;
use crate::parameters::Scalar;
use crate::resources::Resources;
use space::{Columns, Vector};

/// First bytes of a saved state; the last one counts the changes of its layout.
const MARK: u64 = u64::from_le_bytes(*b"flkstat\x01");

/// Numbers written one after the other, little end first, each as wide as it is.
struct Out(Vec<u8>);

impl Out {
    fn word(&mut self, value: u64) {
        self.0.extend_from_slice(&value.to_le_bytes());
    }
    fn number(&mut self, value: f64) {
        self.word(value.to_bits());
    }
    fn real<R: Scalar>(&mut self, value: R) {
        self.0.extend_from_slice(&value.bits().to_le_bytes()[..size_of::<R>()]);
    }
    fn numbers(&mut self, values: &[f64]) {
        self.word(values.len() as u64);
        values.iter().for_each(|&v| self.number(v));
    }
    fn vectors<R: Scalar, const D: usize>(&mut self, values: &[Vector<R, D>]) {
        self.word(values.len() as u64);
        values.iter().flat_map(|v| v.0).for_each(|v| self.real(v));
    }
    fn columns<R: Scalar, const D: usize>(&mut self, columns: &Columns<R, D>) {
        let agents = columns.len();
        self.word(agents as u64);
        self.word(columns.state.len() as u64);
        columns.id[..agents].iter().for_each(|id| self.0.extend_from_slice(&id.to_le_bytes()));
        for column in columns.position.iter().chain(&columns.velocity).chain(&columns.state) {
            column[..agents].iter().for_each(|&v| self.real(v));
        }
    }
}

/// What [`Out`] wrote; `None` where it ends too early or cannot be.
struct In<'a>(&'a [u8]);

impl In<'_> {
    fn word(&mut self) -> Option<u64> {
        let (word, rest) = self.0.split_first_chunk::<8>()?;
        self.0 = rest;
        Some(u64::from_le_bytes(*word))
    }
    fn number(&mut self) -> Option<f64> {
        self.word().map(f64::from_bits)
    }
    fn id(&mut self) -> Option<u32> {
        let (id, rest) = self.0.split_first_chunk::<4>()?;
        self.0 = rest;
        Some(u32::from_le_bytes(*id))
    }
    fn real<R: Scalar>(&mut self) -> Option<R> {
        // a 32-bit number is widened on the way, which loses nothing
        if size_of::<R>() == 4 {
            self.id().map(|bits| R::of(f64::from(f32::from_bits(bits))))
        } else {
            self.number().map(R::of)
        }
    }
    /// A number of things of which each takes at least `bytes` bytes: never more than there can be.
    fn count(&mut self, bytes: usize) -> Option<usize> {
        let count = usize::try_from(self.word()?).ok()?;
        (count.checked_mul(bytes)? <= self.0.len()).then_some(count)
    }
    fn many<T>(&mut self, bytes: usize, one: impl Fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        (0..self.count(bytes)?).map(|_| one(self)).collect()
    }
    fn vector<R: Scalar, const D: usize>(&mut self) -> Option<Vector<R, D>> {
        let mut vector = Vector::ZERO;
        for a in 0..D {
            vector.0[a] = self.real()?;
        }
        Some(vector)
    }
    fn columns<R: Scalar, const D: usize>(&mut self) -> Option<Columns<R, D>> {
        let agents = self.count(4 + 2 * D * size_of::<R>())?;
        let state = usize::try_from(self.word()?).ok()?;
        if agents.checked_mul(state)?.checked_mul(size_of::<R>())? > self.0.len() || state > 1 << 16 {
            return None;
        }
        let mut columns = Columns::new(agents, state);
        for row in 0..agents {
            columns.id[row] = self.id().filter(|&id| (id as usize) < agents)?;
        }
        for column in columns.position.iter_mut().chain(&mut columns.velocity).chain(&mut columns.state) {
            for value in &mut column[..agents] {
                *value = self.real()?;
            }
        }
        Some(columns)
    }
}

impl<R: Scalar, const D: usize> Checkpoint<R, D> {
    /// Steps made when it was saved.
    pub fn step(&self) -> u64 {
        self.step
    }
    /// The state as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.write(&mut bytes);
        bytes
    }
    /// Appends the state as bytes.
    pub fn write(&self, bytes: &mut Vec<u8>) {
        let mut out = Out(core::mem::take(bytes));
        out.0.reserve((4 + (2 * D + self.columns.state.len()) * size_of::<R>()) * (self.columns.len() + 16));
        out.word(MARK);
        out.word(size_of::<R>() as u64 * 16 + D as u64);
        out.word(self.step);
        out.number(self.time);
        out.columns(&self.columns);
        match &self.resources {
            None => out.word(0),
            Some(resources) => {
                out.word(1);
                out.vectors(&resources.place);
                resources.absent_until.iter().for_each(|until| out.number(until.unwrap_or(f64::NAN)));
                resources.consumer.iter().for_each(|id| out.word(id.map_or(u64::MAX, u64::from)));
                out.word(resources.consumed);
            }
        }
        out.numbers(&self.clocks.due);
        self.clocks.decisions.iter().for_each(|&decisions| out.word(decisions));
        out.word(self.clocks.command.len() as u64);
        for motion in &self.clocks.command {
            motion.velocity.0.iter().chain(&motion.displacement.0).for_each(|&v| out.real(v));
        }
        out.word(self.clocks.history.len() as u64);
        self.clocks.history.iter().for_each(|columns| out.columns(columns));
        out.numbers(&self.memory);
        self.met_total.iter().for_each(|&count| out.word(count));
        let e = &self.errors;
        let counts = [
            e.members_in_view,
            e.members_missed,
            e.members_not_fully_occluded,
            e.missed_not_fully_occluded,
            e.detections,
            e.false_detections,
        ];
        counts.iter().for_each(|&count| out.word(count));
        *bytes = out.0;
    }
    /// The state that [`Self::write`] wrote. `like` is a state of a world of the same plan, which lends what does
    /// not change while running; `None` where the bytes are damaged or of another plan.
    pub fn from_bytes(bytes: &[u8], like: &Self) -> Option<Self> {
        let mut from = In(bytes);
        if from.word()? != MARK || from.word()? != size_of::<R>() as u64 * 16 + D as u64 {
            return None;
        }
        let step = from.word()?;
        let time = from.number()?;
        let columns = from.columns::<R, D>()?;
        let resources = match (from.word()?, &like.resources) {
            (0, None) => None,
            (1, Some(resources)) => {
                let mut resources: Resources<R, D> = resources.clone();
                resources.place = from.many(D * size_of::<R>(), In::vector)?;
                let items = resources.place.len();
                let until = |from: &mut In<'_>| from.number().map(|t| (!t.is_nan()).then_some(t));
                resources.absent_until = (0..items).map(|_| until(&mut from)).collect::<Option<_>>()?;
                let id = |from: &mut In<'_>| from.word().map(|id| u32::try_from(id).ok());
                resources.consumer = (0..items).map(|_| id(&mut from)).collect::<Option<_>>()?;
                resources.consumed = from.word()?;
                Some(resources)
            }
            _ => return None,
        };
        let due = from.many(8, In::number)?;
        let decisions = (0..due.len()).map(|_| from.word()).collect::<Option<_>>()?;
        let motion = |from: &mut In<'_>| Some(Motion { velocity: from.vector()?, displacement: from.vector()? });
        let command = from.many(2 * D * size_of::<R>(), motion)?;
        let history = from.many(16, In::columns)?.into();
        let memory = from.many(8, In::number)?;
        let mut met_total = [0; 4];
        for count in &mut met_total {
            *count = from.word()?;
        }
        let errors = ErrorCount {
            members_in_view: from.word()?,
            members_missed: from.word()?,
            members_not_fully_occluded: from.word()?,
            missed_not_fully_occluded: from.word()?,
            detections: from.word()?,
            false_detections: from.word()?,
        };
        let clocks = Clocks { due, decisions, command, history };
        let same = columns.len() == like.columns.len()
            && columns.state.len() == like.columns.state.len()
            && clocks.due.len() == like.clocks.due.len()
            && clocks.command.len() == like.clocks.command.len();
        (same && from.0.is_empty()).then_some(Self {
            columns,
            step,
            time,
            resources,
            clocks,
            memory,
            met_total,
            errors,
        })
    }
}
