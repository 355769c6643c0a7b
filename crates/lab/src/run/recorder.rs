//! The recorder: a thread beside the engine that measures and writes what the engine hands it.
//!
//! The engine's side is the [`Observer`], which copies what is due and counts what happens in between. Nothing here
//! changes the world, so that recording cannot change a result.

use super::kind;
use super::tables::{CONTACTS, DETECTIONS, Tables, Words};
use crate::scenario::Scenario;
use crate::store::StoreError;
use crate::store::log::{Log, Record};
use crate::store::table::{self, Blocks, Heading, Values};
use bytes::Bytes;
use measure::{Measure, Sample};
use space::{Column, ColumnKind, Columns, Frame, GroupRange, Space};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use swarm::World;
use swarm::engine::Checkpoint;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;
use swarm::physics::{Contact, Met};

/// Frames that may wait for the recorder: enough to even out its work, few enough to bound memory.
const WAITING: usize = 3;

/// Rows of the trajectory that wait at most before they are written.
const BLOCK_ROWS: usize = 131_072;

/// Something that happened: step, time, number of its name, agent, other.
pub(super) type Event = (u64, f64, u32, i64, i64);

/// What the engine tells the recorder.
pub(super) enum Message<R, const D: usize> {
    /// The state at a time that is kept or measured.
    Sample {
        columns: Box<Columns<R, D>>,
        step: u64,
        time: f64,
        /// Number of the kept frame.
        frame: Option<u64>,
        /// What was counted since the measurement before, where it is measured.
        measured: Option<Counted>,
    },
    /// What happened in a step.
    Events(Vec<Event>),
    /// The full state, and what is carried beside it.
    State {
        /// Whether the block before it is complete.
        ends: bool,
        carried: Carried,
        state: Box<Checkpoint<R, D>>,
    },
    /// The run is complete.
    Done,
}

/// What was counted between two measurements.
pub(super) struct Counted {
    /// Contacts of each group.
    contacts: Vec<[u64; 3]>,
    /// What scanners detected, rightly and wrongly.
    detections: [u64; DETECTIONS.len()],
}

/// Counts that are carried from one step to the next, and over a stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Carried {
    /// Contacts of each group since the last measurement.
    contacts: Vec<[u64; 3]>,
    /// Detections from the start to the last measurement.
    detections: [u64; DETECTIONS.len()],
}

/// Detections of all scanners since the start, in the order of [`DETECTIONS`].
fn detections<R: Scalar, const D: usize>(world: &World<R, D>) -> [u64; DETECTIONS.len()] {
    let count = world.detection_errors();
    [count.members_in_view, count.members_missed, count.detections, count.false_detections]
}

impl Carried {
    pub(super) fn new(groups: usize) -> Self {
        Self { contacts: vec![[0; 3]; groups], detections: [0; DETECTIONS.len()] }
    }
    fn to_bytes(&self) -> Vec<u8> {
        self.contacts.iter().flatten().chain(&self.detections).flat_map(|count| count.to_le_bytes()).collect()
    }
    /// What [`Self::to_bytes`] wrote before other bytes, and those.
    pub(crate) fn split(bytes: &[u8], groups: usize) -> Option<(Self, &[u8])> {
        let (own, rest) = bytes.split_at_checked((groups * 3 + DETECTIONS.len()) * 8)?;
        let counts: Vec<u64> =
            own.chunks_exact(8).map(|word| u64::from_le_bytes(core::array::from_fn(|k| word[k]))).collect();
        let (contacts, detections) = counts.split_at(groups * 3);
        let contacts = contacts.chunks_exact(3).map(|three| core::array::from_fn(|k| three[k])).collect();
        Some((Self { contacts, detections: core::array::from_fn(|k| detections[k]) }, rest))
    }
}

/// The engine's side.
pub(super) struct Observer {
    pub(super) carried: Carried,
    /// Time of a step. A time in a table is a multiple of it, without the rounding of a long sum.
    step: f64,
    /// Ids at which groups end.
    ends: Vec<u32>,
    /// Whether each agent was alive, by id; empty where nobody can die.
    alive: Vec<bool>,
    /// Whether each obstacle with a plan was there, by its index.
    there: Vec<(usize, bool)>,
}

impl Observer {
    pub(super) fn new<R: Scalar, const D: usize>(world: &World<R, D>, carried: Carried, step: f64) -> Self {
        let frame = world.frame();
        let ends = frame.groups.iter().map(|group| group.first + group.count).collect();
        let list = world.obstacles().list();
        let planned = list.iter().enumerate().filter_map(|(k, o)| Some((k, o.plan.as_ref()?.present(world.time()))));
        Self { carried, step, ends, alive: alive(world), there: planned.collect() }
    }
    /// The state as it is to be kept or measured.
    pub(super) fn sample<R: Scalar, const D: usize>(
        &mut self,
        world: &World<R, D>,
        frame: Option<u64>,
        measured: bool,
    ) -> Message<R, D> {
        let view = world.frame();
        Message::Sample {
            columns: Box::new(view.columns.clone()),
            step: view.step,
            time: self.step * view.step as f64,
            frame,
            measured: measured.then(|| self.counted(world)),
        }
    }
    /// What was counted since the last time this was asked.
    fn counted<R: Scalar, const D: usize>(&mut self, world: &World<R, D>) -> Counted {
        let now = Carried { detections: detections(world), ..Carried::new(self.carried.contacts.len()) };
        let before = std::mem::replace(&mut self.carried, now);
        let since = |k: usize| self.carried.detections[k].saturating_sub(before.detections[k]);
        Counted { contacts: before.contacts, detections: core::array::from_fn(since) }
    }
    /// Counts and notes what happened in the step just made; events, if there were any.
    pub(super) fn observe<R: Scalar, const D: usize>(&mut self, world: &World<R, D>) -> Option<Vec<Event>> {
        let step = world.step_number();
        let time = self.step * step as f64;
        let mut group = 0;
        for (id, &met) in world.met().iter().enumerate() {
            while self.ends.get(group).is_some_and(|&end| id as u32 >= end) {
                group += 1;
            }
            let kind = match met {
                Met::Nothing => continue,
                Met::Member => 0,
                Met::Obstacle => 1,
                Met::Wall => 2,
            };
            self.carried.contacts[group][kind] += 1;
        }
        let mut events = Vec::new();
        if let Some(resources) = world.resources() {
            let eaten = resources.consumer.iter().enumerate().filter_map(|(item, by)| by.map(|id| (item, id)));
            events.extend(eaten.map(|(item, id)| (step, time, 0, i64::from(id), item as i64)));
        }
        if !self.alive.is_empty() {
            let now = alive(world);
            let died = (0..now.len()).filter(|&id| self.alive[id] && !now[id]);
            events.extend(died.map(|id| (step, time, 1, id as i64, -1)));
            self.alive = now;
        }
        for (obstacle, there) in &mut self.there {
            let plan = world.obstacles().list()[*obstacle].plan.as_ref();
            // as the engine sees it, which counts time by adding steps
            let now = plan.is_none_or(|plan| plan.present(world.time()));
            if now != *there {
                events.push((step, time, if now { 2 } else { 3 }, -1, *obstacle as i64));
                *there = now;
            }
        }
        (!events.is_empty()).then_some(events)
    }
}

fn alive<R: Scalar, const D: usize>(world: &World<R, D>) -> Vec<bool> {
    let Some(column) = world.mortality() else { return Vec::new() };
    let columns = world.frame().columns;
    let mut alive = vec![true; columns.len()];
    for row in 0..columns.len() {
        alive[columns.id[row] as usize] = columns.state[column][row] > R::ZERO;
    }
    alive
}

/// The recorder's thread.
pub(super) struct Recorder<R, const D: usize> {
    to: SyncSender<Message<R, D>>,
    thread: JoinHandle<Result<(Log, Vec<Record>), StoreError>>,
}

impl<R: Scalar + Send + 'static, const D: usize> Recorder<R, D> {
    /// Starts the recorder of a world, which appends to a log with these records.
    ///
    /// # Errors
    /// Where there can be no such tables.
    pub(super) fn start(
        world: &World<R, D>,
        scenario: &Scenario,
        metrics: Vec<Box<dyn Measure<D>>>,
        log: Log,
        records: Vec<Record>,
    ) -> Result<Self, StoreError>
    where
        Models: Catalogue<R, D>,
    {
        let tables = Tables::new(world, scenario, &metrics);
        let frame = world.frame();
        let declares = world
            .groups()
            .iter()
            .map(|group| (0..frame.declared.len()).map(|column| group.declares(column)).collect())
            .collect();
        let keeper = Keeper {
            frames: Rows::new(&tables.frames)?,
            metrics: Rows::new(&tables.metrics)?,
            events: Rows::new(&tables.events)?,
            tables,
            space: *frame.space,
            groups: frame.groups.to_vec(),
            declared: frame.declared.to_vec(),
            declares,
            refuses: world.groups().iter().map(|group| group.contact() == Contact::Refuse).collect(),
            mortality: world.mortality(),
            measures: metrics,
            by_id: Columns::new(frame.columns.len(), frame.declared.len()),
            sample: Sample::empty(),
            log,
            records,
        };
        let (to, from) = sync_channel(WAITING);
        let thread = std::thread::Builder::new()
            .spawn(move || keeper.keep(&from))
            .map_err(|error| StoreError::Io { doing: "begin a thread for the results".into(), error })?;
        Ok(Self { to, thread })
    }
    /// Hands something on; false where the recorder has ended, which [`Self::finish`] explains.
    pub(super) fn send(&self, message: Message<R, D>) -> bool {
        self.to.send(message).is_ok()
    }
    /// Waits until all is written; the log and its records.
    pub(super) fn finish(self) -> Result<(Log, Vec<Record>), StoreError> {
        drop(self.to);
        self.thread.join().unwrap_or_else(|_| Err(StoreError::Damaged("the recorder failed".into())))
    }
}

/// Rows that wait to be written as a block.
struct Rows {
    columns: Vec<Values>,
    kinds: Vec<table::Kind>,
    blocks: Blocks,
}

impl Rows {
    fn new(headings: &[Heading]) -> Result<Self, StoreError> {
        let kinds: Vec<table::Kind> = headings.iter().map(|heading| heading.kind).collect();
        Ok(Self { columns: Self::empty(&kinds, 0), kinds, blocks: Blocks::new(headings)? })
    }
    /// No rows, with room for so many.
    fn empty(kinds: &[table::Kind], rows: usize) -> Vec<Values> {
        let empty = |kind: &table::Kind| match kind {
            table::Kind::Double => Values::Double(Vec::with_capacity(rows)),
            table::Kind::Single => Values::Single(Vec::with_capacity(rows)),
            table::Kind::Long => Values::Long(Vec::with_capacity(rows)),
            table::Kind::Whole => Values::Whole(Vec::with_capacity(rows)),
            table::Kind::Word => Values::Word(Vec::with_capacity(rows), Arc::default()),
        };
        kinds.iter().map(empty).collect()
    }
    /// The block of what waited, and nothing waits any more; none where nothing did.
    fn take(&mut self) -> Result<Option<Bytes>, StoreError> {
        let rows = self.columns.first().map_or(0, Values::len);
        if rows == 0 {
            return Ok(None);
        }
        // as many will wait the next time
        let columns = std::mem::replace(&mut self.columns, Self::empty(&self.kinds, rows));
        self.blocks.next(columns).map(Some)
    }
    fn number(&mut self, column: usize, value: f64) {
        match &mut self.columns[column] {
            Values::Double(values) => values.push(value),
            Values::Single(values) => values.push(value as f32),
            Values::Long(values) => values.push(value as i64),
            Values::Whole(values) => values.push(value as i32),
            Values::Word(..) => {}
        }
    }
    fn whole(&mut self, column: usize, value: i64) {
        match &mut self.columns[column] {
            Values::Long(values) => values.push(value),
            Values::Whole(values) => values.push(value as i32),
            Values::Double(_) | Values::Single(_) | Values::Word(..) => {}
        }
    }
    fn word(&mut self, column: usize, value: u32, words: &Arc<Vec<String>>) {
        if let Values::Word(values, known) = &mut self.columns[column] {
            if values.is_empty() {
                *known = Arc::clone(words);
            }
            values.push(value);
        }
    }
}

/// What the thread works with.
struct Keeper<R, const D: usize> {
    tables: Tables,
    frames: Rows,
    metrics: Rows,
    events: Rows,
    space: Space<R, D>,
    groups: Vec<GroupRange>,
    declared: Vec<Column>,
    /// Whether a group has a declared column, `[groups][columns]`.
    declares: Vec<Vec<bool>>,
    /// Whether a group's moves are refused on contact, `[groups]`.
    refuses: Vec<bool>,
    mortality: Option<usize>,
    measures: Vec<Box<dyn Measure<D>>>,
    /// The state of a time, in the order of ids.
    by_id: Columns<R, D>,
    /// Those who are measured.
    sample: Sample<D>,
    log: Log,
    /// The records in the log.
    records: Vec<Record>,
}

/// Appends numbers to a column.
fn append<R: Scalar>(to: &mut Values, numbers: &[R]) {
    match to {
        Values::Single(to) => to.extend(numbers.iter().map(|number| number.to_f64() as f32)),
        Values::Double(to) => to.extend(numbers.iter().map(|number| number.to_f64())),
        Values::Long(_) | Values::Whole(_) | Values::Word(..) => {}
    }
}

impl<R: Scalar, const D: usize> Keeper<R, D> {
    fn keep(mut self, from: &Receiver<Message<R, D>>) -> Result<(Log, Vec<Record>), StoreError> {
        while let Ok(message) = from.recv() {
            match message {
                Message::Sample { columns, step, time, frame, measured } => {
                    columns.write_by_id(&mut self.by_id);
                    if let Some(number) = frame {
                        self.keep_frame(number, time);
                        if self.frames.columns[0].len() >= BLOCK_ROWS {
                            self.flush_frames()?;
                        }
                    }
                    if let Some(counted) = measured {
                        self.measure(step, time, &counted);
                    }
                }
                Message::Events(events) => {
                    for (step, time, name, id, other) in events {
                        self.events.whole(0, 0);
                        self.events.whole(1, step as i64);
                        self.events.number(2, time);
                        self.events.word(3, name, &self.tables.words.events);
                        self.events.whole(4, id);
                        self.events.whole(5, other);
                    }
                }
                Message::State { ends, carried, state } => {
                    if ends {
                        self.flush()?;
                    }
                    let mut bytes = carried.to_bytes();
                    state.write(&mut bytes);
                    self.append(if ends { kind::KEYFRAME } else { kind::STATE }, &bytes)?;
                }
                Message::Done => {
                    self.flush()?;
                    self.append(kind::DONE, &[])?;
                }
            }
        }
        Ok((self.log, self.records))
    }
    fn append(&mut self, kind: u32, payload: &[u8]) -> Result<(), StoreError> {
        self.records.push(self.log.append(kind, payload)?);
        Ok(())
    }
    fn flush_frames(&mut self) -> Result<(), StoreError> {
        match self.frames.take()? {
            Some(block) => self.append(kind::FRAMES, &block),
            None => Ok(()),
        }
    }
    fn flush(&mut self) -> Result<(), StoreError> {
        self.flush_frames()?;
        for (kind, block) in [(kind::METRICS, self.metrics.take()?), (kind::EVENTS, self.events.take()?)] {
            if let Some(block) = block {
                self.append(kind, &block)?;
            }
        }
        Ok(())
    }

    fn keep_frame(&mut self, number: u64, time: f64) {
        let (columns, agents) = (&self.by_id, self.by_id.len());
        let all = &mut self.frames.columns;
        if let Values::Whole(run) = &mut all[0] {
            run.resize(run.len() + agents, 0);
        }
        if let Values::Long(frame) = &mut all[1] {
            frame.resize(frame.len() + agents, number as i64);
        }
        if let Values::Double(t) = &mut all[2] {
            t.resize(t.len() + agents, time);
        }
        if let Values::Whole(id) = &mut all[3] {
            id.extend(0..agents as i32);
        }
        if let Values::Word(group, words) = &mut all[4] {
            *words = Arc::clone(&self.tables.words.groups);
            for (g, range) in self.groups.iter().enumerate() {
                group.resize(group.len() + range.count as usize, g as u32);
            }
        }
        for a in 0..D {
            append(&mut all[5 + a], &columns.position[a][..agents]);
            append(&mut all[5 + D + a], &columns.velocity[a][..agents]);
        }
        for (c, labels) in self.tables.words.labels.iter().enumerate() {
            let (to, from) = (&mut all[5 + 2 * D + c], &columns.state[c]);
            for (g, range) in self.groups.iter().enumerate() {
                let of_group = &from[range.first as usize..(range.first + range.count) as usize];
                let declares = self.declares[g][c];
                match (&mut *to, labels) {
                    (Values::Word(values, words), Some(labels)) => {
                        *words = Arc::clone(labels);
                        let none = labels.len() as u32;
                        let word = |label: &R| label.to_f64().clamp(0.0, f64::from(none)) as u32;
                        values.extend(of_group.iter().map(|label| if declares { word(label) } else { none }));
                    }
                    (to, _) if declares => append(to, of_group),
                    (Values::Single(to), _) => to.resize(to.len() + of_group.len(), f32::NAN),
                    (Values::Double(to), _) => to.resize(to.len() + of_group.len(), f64::NAN),
                    (Values::Long(_) | Values::Whole(_) | Values::Word(..), _) => {}
                }
            }
        }
    }

    fn measure(&mut self, step: u64, time: f64, since: &Counted) {
        let columns = &self.by_id;
        let frame = Frame { columns, declared: &self.declared, groups: &self.groups, space: &self.space, time, step };
        let lives = |row: &usize| self.mortality.is_none_or(|c| columns.state[c][*row] > R::ZERO);
        let whole = self.groups.len();
        // groups own consecutive ids, which the rows are here
        let rows_of = |group: usize| -> Vec<usize> {
            let ids = match self.groups.get(group) {
                Some(range) => range.first as usize..(range.first + range.count) as usize,
                None => 0..columns.len(),
            };
            ids.filter(lives).collect()
        };
        let parts = if whole > 1 { whole + 1 } else { whole };
        for part in 0..parts {
            let members = rows_of(part);
            self.sample.read(&frame, &members);
            let out = &mut self.metrics;
            out.whole(0, 0);
            out.whole(1, step as i64);
            out.number(2, time);
            out.word(3, part as u32, &self.tables.words.groups);
            out.whole(4, members.len() as i64);
            let mut to = 5;
            for measure in &self.measures {
                out.number(to, measure.on(&self.sample).unwrap_or(f64::NAN));
                to += 1;
            }
            for (c, column) in self.declared.iter().enumerate() {
                let ColumnKind::Label(labels) = column.kind else { continue };
                let has = |row: &&usize| {
                    let group = self.groups.partition_point(|range| range.first + range.count <= columns.id[**row]);
                    self.declares[group][c]
                };
                let mut counts = vec![0usize; labels.len()];
                let mut all = 0usize;
                for row in members.iter().filter(has) {
                    all += 1;
                    if let Some(count) = counts.get_mut(columns.state[c][*row].to_f64() as usize) {
                        *count += 1;
                    }
                }
                for count in counts {
                    out.number(to, if all > 0 { count as f64 / all as f64 } else { f64::NAN });
                    to += 1;
                }
            }
            let Words { contacts: counted, refuses, detections, .. } = self.tables.words;
            let of_part = |groups: &mut dyn Iterator<Item = (usize, &[u64; 3])>| {
                let mut sum = [0; 3];
                let mut refused = 0;
                for (group, met) in groups {
                    (0..CONTACTS.len()).for_each(|k| sum[k] += met[k]);
                    if self.refuses[group] {
                        refused += met.iter().sum::<u64>();
                    }
                }
                (sum, refused)
            };
            let (sum, refused) =
                of_part(&mut since.contacts.iter().enumerate().filter(|(group, _)| part == whole || part == *group));
            if counted {
                for count in sum {
                    out.whole(to, count as i64);
                    to += 1;
                }
            }
            if refuses {
                out.whole(to, refused as i64);
                to += 1;
            }
            if detections {
                // all scanners are counted together
                let everyone = part + 1 == parts;
                for count in since.detections {
                    out.number(to, if everyone { count as f64 } else { f64::NAN });
                    to += 1;
                }
            }
        }
    }
}
