//! State as columns, and the read-only view of it that everything outside the engine reads.

use crate::{Real, Space, Vector};

/// Places kept after the last agent, so that a full vector may be loaded anywhere.
pub const PADDING: usize = 16;

/// The state of all agents, one array per quantity.
///
/// The order of the rows is the engine's (by cell, so that neighbours lie together); `id` names the agent of each row.
/// Each array is [`PADDING`] places longer than there are agents.
#[derive(Clone, Debug)]
pub struct Columns<R, const D: usize> {
    agents: usize,
    /// Positions, `[D][agents]`, length.
    pub position: [Vec<R>; D],
    /// Velocities, `[D][agents]`, length/time.
    pub velocity: [Vec<R>; D],
    /// Index of each agent in the whole world, `[agents]`.
    pub id: Vec<u32>,
    /// Declared columns, `[columns][agents]`.
    pub state: Vec<Vec<R>>,
}

impl<R: Real, const D: usize> Columns<R, D> {
    /// Columns of zeros for `agents` agents in order of their ids, with `columns` declared columns.
    pub fn new(agents: usize, columns: usize) -> Self {
        let zeros = || vec![R::ZERO; agents + PADDING];
        Self {
            agents,
            position: core::array::from_fn(|_| zeros()),
            velocity: core::array::from_fn(|_| zeros()),
            id: (0..(agents + PADDING) as u32).collect(),
            state: (0..columns).map(|_| zeros()).collect(),
        }
    }
    /// Nothing at all, not even padding: stands in for columns that are in use elsewhere. Nothing is allocated.
    pub fn nothing() -> Self {
        let nothing = || core::array::from_fn(|_| Vec::new());
        Self { agents: 0, position: nothing(), velocity: nothing(), id: Vec::new(), state: Vec::new() }
    }
    /// Number of agents.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.agents
    }
    /// Whether there are no agents.
    pub fn is_empty(&self) -> bool {
        self.agents == 0
    }
    /// Rows in the order of their ids, `[agents]`.
    pub fn rows_by_id(&self) -> Vec<usize> {
        let mut rows = vec![0; self.agents];
        for (row, &id) in self.id[..self.agents].iter().enumerate() {
            rows[id as usize] = row;
        }
        rows
    }
    /// Writes all rows into columns of the same shape, in the order of their ids.
    pub fn write_by_id(&self, to: &mut Self) {
        let put = |to: &mut [R], from: &[R]| {
            for (&id, &value) in self.id[..self.agents].iter().zip(from) {
                to[id as usize] = value;
            }
        };
        for a in 0..D {
            put(&mut to.position[a], &self.position[a]);
            put(&mut to.velocity[a], &self.velocity[a]);
        }
        for (to, from) in to.state.iter_mut().zip(&self.state) {
            put(to, from);
        }
        for (id, to) in to.id[..self.agents].iter_mut().enumerate() {
            *to = id as u32;
        }
    }
    /// Position of a row.
    #[inline(always)]
    pub fn position(&self, row: usize) -> Vector<R, D> {
        Vector(core::array::from_fn(|a| self.position[a][row]))
    }
    /// Velocity of a row.
    #[inline(always)]
    pub fn velocity(&self, row: usize) -> Vector<R, D> {
        Vector(core::array::from_fn(|a| self.velocity[a][row]))
    }
    /// Sets the position of a row.
    #[inline(always)]
    pub fn set_position(&mut self, row: usize, position: Vector<R, D>) {
        for a in 0..D {
            self.position[a][row] = position.0[a];
        }
    }
    /// Sets the velocity of a row.
    #[inline(always)]
    pub fn set_velocity(&mut self, row: usize, velocity: Vector<R, D>) {
        for a in 0..D {
            self.velocity[a][row] = velocity.0[a];
        }
    }
}

/// What a declared column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A real quantity.
    Quantity,
    /// A whole number of things.
    Count,
    /// One of the named states, by its place in the list.
    Label(&'static [&'static str]),
}

/// A named state column beyond position and velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name in tables and files.
    pub name: &'static str,
    /// Unit: `rad`, `1`, `length`...
    pub unit: &'static str,
    /// What the numbers mean.
    pub kind: ColumnKind,
    /// One sentence.
    pub about: &'static str,
}

/// A group of agents: its name and the ids it owns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GroupRange {
    /// Name in files and tables.
    pub name: String,
    /// First id.
    pub first: u32,
    /// Number of agents.
    pub count: u32,
}

/// A read-only view of one moment, whatever made it: a running world, a stored frame, tracked animals.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a, R, const D: usize> {
    /// The rows.
    pub columns: &'a Columns<R, D>,
    /// Meaning of the declared columns.
    pub declared: &'a [Column],
    /// The groups, by ascending first id.
    pub groups: &'a [GroupRange],
    /// The space.
    pub space: &'a Space<R, D>,
    /// Time since the start.
    pub time: f64,
    /// Steps since the start.
    pub step: u64,
}

impl<R: Real, const D: usize> Frame<'_, R, D> {
    /// Rows in the order of their ids, `[agents]`.
    pub fn rows_by_id(&self) -> Vec<usize> {
        self.columns.rows_by_id()
    }
    /// A hash of the whole state in the order of ids (FNV-1a over the bits): equal states, equal hash.
    pub fn hash(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325u64;
        let mut take = |bits: u64| {
            for byte in bits.to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        };
        for row in self.rows_by_id() {
            for a in 0..D {
                take(self.columns.position[a][row].bits());
                take(self.columns.velocity[a][row].bits());
            }
            for column in &self.columns.state {
                take(column[row].bits());
            }
        }
        hash
    }
    /// Whether every number of the state is finite.
    pub fn finite(&self) -> bool {
        let n = self.columns.len();
        let fine = |column: &Vec<R>| column[..n].iter().all(|v| v.finite());
        self.columns.position.iter().all(fine)
            && self.columns.velocity.iter().all(fine)
            && self.columns.state.iter().all(fine)
    }
}
