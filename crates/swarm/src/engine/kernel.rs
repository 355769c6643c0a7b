//! One group's way through the stages: chosen once, called once per block of agents.

use crate::engine::beside::{Adapts, Pace, Taxis};
use crate::engine::coarse::Coarse;
use crate::engine::conduct::Conduct;
use crate::motion::{
    Abreast, Agents, Around, BLOCK, Draws, Injected, LaneSums, MOST_OWN, Me, MeLanes, Model, Motion, NearItem,
    NearObstacle, Other, Percepts, Rough, Single, Start, Stream, Summed, TOGETHER, Together, Trace, WIDEST, splat,
};
use crate::parameters::Scalar;
use crate::physics::{Mobility, capsule};
use crate::resources::Resources;
use crate::selection::{self, Candidates, NamedSet, RINGS, Reach, Rings};
use crate::sensing::robot::{Memory, Robot, RobotScratch};
use crate::sensing::{Ideal, Occlusion, Pool, SensingNoise};
use core::ops::Range;
use space::grid::Segment;
use space::lanes::{Lanes, Mask, Task, level, with_lanes};
use space::obstacles::{Obstacles, Screens};
use space::parallel::Shared;
use space::random::{Purpose, Stream as DrawStream, uniforms};
use space::shape::Shape;
use space::{Columns, Edge, Grid, LiveGrid, PADDING, Real, Space, Vector};

/// How neighbours are found.
#[derive(Clone, Copy)]
pub(crate) enum Index<'a, R, const D: usize> {
    /// All pairs, in the order of rows.
    Pairs,
    /// Rows sorted by cell.
    Sorted(&'a Grid<R, D>),
    /// Cells that follow the rows.
    Live(&'a LiveGrid<R, D>),
}

/// The frozen world that a step reads.
#[derive(Clone, Copy)]
pub(crate) struct View<'a, R, const D: usize> {
    pub(crate) now: &'a Columns<R, D>,
    /// What is seen of others: `now`, or an older moment where readings are stale.
    pub(crate) others: &'a Columns<R, D>,
    /// Unit headings of `now`, where a law wants them at hand.
    pub(crate) heading: &'a [Vec<R>; D],
    /// Places of `others` in single precision, where that is of use.
    pub(crate) coarse: Option<&'a Coarse<D>>,
    pub(crate) index: Index<'a, R, D>,
    pub(crate) space: &'a Space<R, D>,
    pub(crate) obstacles: &'a Obstacles<R, D>,
    pub(crate) resources: Option<&'a Resources<R, D>>,
    /// Declared column whose zero means death.
    pub(crate) mortality: Option<usize>,
    /// Rows by id, where they are sorted and somebody needs it.
    pub(crate) rows: Option<&'a [u32]>,
    /// Bodies by group.
    pub(crate) bodies: &'a [Body<R>],
    /// The longest half axis of a body; 0 where all are round.
    pub(crate) longest: R,
    /// Whether members may be unequally fast.
    pub(crate) uneven: bool,
    pub(crate) seed: u64,
    pub(crate) step: u64,
    pub(crate) time: f64,
    pub(crate) injected: Option<&'a Injected>,
}

impl<R: Scalar, const D: usize> View<'_, R, D> {
    #[inline(always)]
    pub(crate) fn dead(&self, columns: &Columns<R, D>, row: usize) -> bool {
        self.mortality.is_some_and(|c| columns.state[c][row] <= R::ZERO)
    }
    /// The unit heading of a row of `now`.
    #[inline(always)]
    fn heading_of(&self, row: usize) -> Vector<R, D> {
        if self.heading[0].is_empty() {
            return self.now.velocity(row).unit();
        }
        let mut heading = Vector::ZERO;
        for a in 0..D {
            heading.0[a] = self.heading[a][row];
        }
        heading
    }
    fn body(&self, id: u32) -> Option<&Body<R>> {
        let group = self.bodies.partition_point(|body| body.first <= id);
        self.bodies.get(group.checked_sub(1)?)
    }
    pub(crate) fn body_radius(&self, id: u32) -> R {
        self.body(id).map_or(R::ZERO, |body| body.radius)
    }
    /// From the centre of a body to the front end of its axis, by its velocity.
    fn axis(&self, id: u32, velocity: Vector<R, D>) -> Vector<R, D> {
        self.body(id).map_or(Vector::ZERO, |body| velocity.unit() * body.half)
    }
}

/// The bodies of a group.
#[derive(Clone, Copy)]
pub(crate) struct Body<R> {
    /// First id of the group.
    pub(crate) first: u32,
    pub(crate) radius: R,
    /// Half the length of the axis; 0 where they are round.
    pub(crate) half: R,
}

/// Errors of computation and execution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionNoise<R> {
    /// Standard deviation of the wanted direction, rad.
    pub computation: R,
    /// Standard deviation of the direction actually taken, rad.
    pub execution_direction: R,
    /// Standard deviation of the speed actually taken, as a share of it.
    pub execution_speed: R,
}

/// How a group senses.
#[derive(Clone, Debug, PartialEq)]
pub enum Sensing<R> {
    /// From the state itself, within limits.
    Ideal(Ideal<R>),
    /// From the rays of a scanner (2-D).
    Scanner(Box<Robot<R>>),
}

impl<R: Real> Default for Sensing<R> {
    fn default() -> Self {
        Self::Ideal(Ideal::default())
    }
}

/// Everything about a group's stages that is not its law.
pub(crate) struct Stages<R, const D: usize> {
    pub(crate) first: u32,
    pub(crate) count: u32,
    /// World column of each declared column of the law, and of the body.
    pub(crate) columns: Vec<usize>,
    pub(crate) body_columns: Vec<usize>,
    pub(crate) sets: Vec<NamedSet<R, D>>,
    /// Whether the named sets are the law's own.
    pub(crate) own_sets: bool,
    /// The named sets as rings, where they are that and nothing limits or disturbs their sensing.
    pub(crate) rings: Option<Rings<R>>,
    pub(crate) reach: Reach<R>,
    /// Where the sets need no more than so many of the nearest, and nothing limits or disturbs their sensing: how many.
    pub(crate) nearest: Option<usize>,
    pub(crate) sensing: Sensing<R>,
    pub(crate) obstacle_reach: Option<R>,
    /// How many of the obstacles and walls in reach are handed on: the nearest so many.
    pub(crate) obstacles_kept: usize,
    /// How far the law itself looks, 0 where it does not, where farther obstacles may be handed on as virtual members.
    pub(crate) law_reach: Option<R>,
    /// Whether those are detected members too.
    pub(crate) virtual_members: bool,
    /// What it does beside its law.
    pub(crate) conduct: Option<Conduct<R>>,
    pub(crate) taxis: Option<Taxis<R, D>>,
    pub(crate) pace: Option<Pace<R, D>>,
    /// What its parameters adapt to.
    pub(crate) adapts: Option<Adapts<R>>,
    /// Whether a motion that is no number is not made.
    pub(crate) guarded: bool,
    pub(crate) mobility: Mobility<R>,
    pub(crate) noise: MotionNoise<R>,
    pub(crate) dt: R,
    /// Body radius.
    pub(crate) radius: R,
    /// Half the length of a body's axis; 0 where it is round.
    pub(crate) half: R,
    /// Whether anybody's body is elongated, so that distances are those between axes.
    pub(crate) elongated: bool,
    /// Whether motions are performed exactly as wanted.
    pub(crate) plain: bool,
}

/// A buffer that begins a cache line, so that no full vector of it lies across two.
struct Lined<R> {
    numbers: Vec<R>,
    /// Places before its first.
    lead: usize,
}

impl<R: Real> Lined<R> {
    /// Bytes of a cache line.
    const LINE: usize = 64;

    fn new() -> Self {
        Self { numbers: Vec::new(), lead: 0 }
    }
    /// Makes it so long at least, and keeps what it holds.
    #[cold]
    fn grow(&mut self, length: usize) {
        let places = Self::LINE / size_of::<R>();
        self.numbers.resize(length + places, R::ZERO);
        let lead = self.numbers.as_ptr().align_offset(Self::LINE).min(places);
        self.numbers.copy_within(self.lead..self.lead + length, lead);
        self.lead = lead;
    }
}
impl<R> core::ops::Deref for Lined<R> {
    type Target = [R];
    #[inline(always)]
    fn deref(&self) -> &[R] {
        &self.numbers[self.lead..]
    }
}
impl<R> core::ops::DerefMut for Lined<R> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [R] {
        &mut self.numbers[self.lead..]
    }
}

/// Buffers of one worker.
pub(crate) struct Scratch<R, const D: usize> {
    /// Number of detected members: so many places of the next three are theirs.
    found: usize,
    row: Vec<u32>,
    offset: [Lined<R>; D],
    squared: Lined<R>,
    sets: Vec<u32>,
    /// The named sets by blocks of percepts, for laws that ask for marks, and whoever is inside the first ring.
    marks: [Vec<u16>; RINGS],
    close: Vec<u16>,
    /// Outer radius of that ring where all rows were marked in the last decision, else 0.
    close_within: R,
    /// Whether the percepts are all rows; whether their displacements are not written down, and then all rows.
    whole: bool,
    rough: bool,
    everyone: Vec<u32>,
    /// Then, the squared distances in single precision, and how wrong they may be.
    rough_squared: Lined<f32>,
    margin: f32,
    /// Squared distances to all rows, where the nearest of all are asked for.
    distances: Lined<R>,
    chosen: Vec<bool>,
    order: Vec<u32>,
    selection: selection::Scratch<R, D>,
    pub(crate) obstacles: Vec<NearObstacle<R, D>>,
    pub(crate) sensed: Columns<R, D>,
    /// The law's declared columns of the deciding agent: before, and after deciding.
    pub(crate) own: Vec<R>,
    /// Columns of its body.
    pub(crate) body: Vec<R>,
    pub(crate) robot: RobotScratch<R>,
    segments: Vec<Segment<R, D>>,
    /// The agents of a sweep that move abreast.
    agents: Agents<R, D>,
}

impl<R: Scalar, const D: usize> Scratch<R, D> {
    pub(crate) fn new(columns: usize) -> Self {
        Self {
            found: 0,
            row: Vec::new(),
            offset: core::array::from_fn(|_| Lined::new()),
            squared: Lined::new(),
            sets: Vec::new(),
            marks: [const { Vec::new() }; RINGS],
            close: Vec::new(),
            close_within: R::ZERO,
            whole: false,
            rough: false,
            everyone: Vec::new(),
            rough_squared: Lined::new(),
            margin: 0.0,
            distances: Lined::new(),
            chosen: Vec::new(),
            order: Vec::new(),
            selection: selection::Scratch::default(),
            obstacles: Vec::new(),
            sensed: Columns::new(0, columns),
            own: Vec::new(),
            body: Vec::new(),
            robot: RobotScratch::default(),
            segments: Vec::new(),
            agents: Agents::new(0),
        }
    }
    /// Makes room for so many more, and for a full vector of lanes after them.
    #[inline(always)]
    fn reserve(&mut self, more: usize) {
        let needed = self.found + more + WIDEST;
        if self.row.len() < needed {
            self.row.resize(2 * needed, 0);
            self.offset.iter_mut().for_each(|o| o.grow(2 * needed));
            self.squared.grow(2 * needed);
            self.marks.iter_mut().for_each(|marks| marks.resize(2 * needed / BLOCK, 0));
            self.close.resize(2 * needed / BLOCK, 0);
        }
    }
    #[inline(always)]
    fn push(&mut self, row: u32, offset: Vector<R, D>, squared: R) {
        self.reserve(1);
        self.row[self.found] = row;
        for a in 0..D {
            self.offset[a][self.found] = offset.0[a];
        }
        self.squared[self.found] = squared;
        self.found += 1;
    }
    fn clear(&mut self) {
        self.found = 0;
    }
    /// Marks what selection put into sets.
    fn mark(&mut self) {
        for (b, block) in self.sets.chunks(BLOCK).enumerate() {
            for (s, marks) in self.marks.iter_mut().enumerate() {
                marks[b] = 0;
                for (l, &sets) in block.iter().enumerate() {
                    marks[b] |= ((sets >> s & 1) as u16) << l;
                }
            }
        }
    }
    /// Leaves the dead out.
    #[inline(always)]
    fn bury(&mut self, view: &View<'_, R, D>) {
        if view.mortality.is_some() {
            self.retain(|s, k| !view.dead(view.others, s.row[k] as usize));
        }
    }
    /// Keeps the percepts for which `keep` holds, in order.
    fn retain(&mut self, mut keep: impl FnMut(&Self, usize) -> bool) {
        let mut kept = 0;
        for k in 0..self.found {
            if keep(self, k) {
                self.row[kept] = self.row[k];
                for a in 0..D {
                    self.offset[a][kept] = self.offset[a][k];
                }
                self.squared[kept] = self.squared[k];
                kept += 1;
            }
        }
        self.found = kept;
    }
    fn at(&self, k: usize) -> Vector<R, D> {
        Vector(core::array::from_fn(|a| self.offset[a][k]))
    }
    /// The detected members of the last decision: row in what it read of others, displacement, named sets as bits.
    pub(crate) fn detected(&self) -> impl Iterator<Item = (usize, Vector<R, D>, u32)> + '_ {
        (0..self.found).map(|k| (self.row[k] as usize, self.at(k), self.sets[k]))
    }
}

/// Who is close to whom before a step, where all pairs are compared: what contacts have to look at afterwards.
#[derive(Default)]
pub(crate) struct Close<R> {
    /// Blocks of rows; 0 where nobody asks.
    pub(crate) blocks: usize,
    /// For each row, a bit for each other row that is closer than `within`: so many blocks of [`BLOCK`] bits.
    pub(crate) marks: Vec<u16>,
    /// For each row, up to where its bits are known.
    pub(crate) within: Vec<R>,
}

struct CloseWriter<'a, R> {
    blocks: usize,
    marks: Shared<'a, u16>,
    within: Shared<'a, R>,
}

/// The next state, written by several workers at disjoint rows.
pub(crate) struct Writer<'a, R, const D: usize> {
    /// What agents remember of their last scan, by id; empty where nobody does.
    memory: Shared<'a, Memory<R>>,
    /// Whether a row's move is known to meet neither wall nor obstacle.
    clear: Shared<'a, bool>,
    /// What is known of who is close to whom.
    close: CloseWriter<'a, R>,
    id: Shared<'a, u32>,
    position: [Shared<'a, R>; D],
    velocity: [Shared<'a, R>; D],
    state: Vec<Shared<'a, R>>,
}

impl<'a, R: Scalar, const D: usize> Writer<'a, R, D> {
    pub(crate) fn new(
        columns: &'a mut Columns<R, D>,
        memory: &'a mut [Memory<R>],
        clear: &'a mut [bool],
        close: &'a mut Close<R>,
    ) -> Self {
        Self {
            close: CloseWriter {
                blocks: close.blocks,
                marks: Shared::new(&mut close.marks),
                within: Shared::new(&mut close.within),
            },
            memory: Shared::new(memory),
            clear: Shared::new(clear),
            id: Shared::new(&mut columns.id),
            position: columns.position.each_mut().map(|c| Shared::new(c)),
            velocity: columns.velocity.each_mut().map(|c| Shared::new(c)),
            state: columns.state.iter_mut().map(|c| Shared::new(c)).collect(),
        }
    }
    /// Begins rows with what no kernel needs to write: ids and declared columns stay as they are.
    ///
    /// # Safety
    /// No other worker writes these rows.
    pub(crate) unsafe fn keep(&self, now: &Columns<R, D>, rows: Range<usize>) {
        // SAFETY: the caller's promise; rows are in bounds.
        unsafe {
            self.clear.part(rows.clone()).fill(false);
            if self.close.blocks > 0 {
                self.close.within.part(rows.clone()).fill(R::ZERO);
            }
            self.id.part(rows.clone()).copy_from_slice(&now.id[rows.clone()]);
            for (to, from) in self.state.iter().zip(&now.state) {
                to.part(rows.clone()).copy_from_slice(&from[rows.clone()]);
            }
        }
    }
    /// # Safety
    /// No other worker writes this row.
    #[inline(always)]
    pub(crate) unsafe fn write(&self, row: usize, position: Vector<R, D>, velocity: Vector<R, D>) {
        for a in 0..D {
            // SAFETY: the caller's promise; rows are in bounds.
            unsafe {
                self.position[a].write(row, position.0[a]);
                self.velocity[a].write(row, velocity.0[a]);
            }
        }
    }
    /// # Safety
    /// No other worker writes these rows.
    #[inline(always)]
    unsafe fn write_block(&self, axis: usize, row: usize, position: &[R], velocity: &[R]) {
        let rows = row..row + position.len();
        // SAFETY: the caller's promise; rows are in bounds.
        unsafe {
            self.position[axis].part(rows.clone()).copy_from_slice(position);
            self.velocity[axis].part(rows).copy_from_slice(velocity);
        }
    }
    /// # Safety
    /// No other worker writes this row.
    #[inline(always)]
    pub(crate) unsafe fn write_state(&self, row: usize, columns: &[usize], values: &[R]) {
        for (&column, &value) in columns.iter().zip(values) {
            // SAFETY: the caller's promise; rows are in bounds.
            unsafe { self.state[column].write(row, value) };
        }
    }
}

/// A group's law with its stages, behind the run-time door.
pub(crate) trait Kernel<R: Scalar, const D: usize>: Send + Sync {
    /// Stages around the law.
    fn stages(&self) -> &Stages<R, D>;
    /// Whether the law wants headings at hand.
    fn headings(&self) -> bool;
    /// Whether the law has rows marked that are in its rings.
    fn marks(&self) -> bool {
        false
    }
    /// Completes an initial state.
    fn complete(&self, start: &mut Start<'_, R, D>);
    /// Decides and moves this group's members among the rows.
    fn sweep(&self, view: &View<'_, R, D>, rows: Range<usize>, out: &Writer<'_, R, D>, scratch: &mut Scratch<R, D>);
    /// The wanted motion of one member; its columns are left in `scratch.own`.
    fn one(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
    ) -> Motion<R, D>;
    /// As [`Self::one`], by the same code over lists, with everything that the law says of its computation.
    fn explained(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        trace: &mut Trace<R, D>,
    ) -> Motion<R, D>;
    /// Tells the law that a body moves otherwise than wanted.
    fn performed(&self, _own: &mut [R], _velocity: Vector<R, D>) {}
    /// Number of others in any named set of one member, for statistics.
    fn neighbours(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) -> usize;
}

impl<R: Scalar, const D: usize> Stages<R, D> {
    #[inline(always)]
    pub(crate) fn mine(&self, id: u32) -> bool {
        id.wrapping_sub(self.first) < self.count
    }
    /// From the wanted to the actual motion, before contacts: the place reached and the velocity.
    #[inline(always)]
    pub(crate) fn perform(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        wanted: Motion<R, D>,
        dt: R,
        own: &[R],
        body: &mut [R],
    ) -> (Vector<R, D>, Vector<R, D>) {
        let motion = if self.plain { wanted } else { self.changed(view, row, wanted, dt, own, body) };
        let place = view.space.place(view.now.position(row) + motion.displacement);
        // a motion that is not a number of finite size is not made
        let fine = place.finite() && motion.velocity.finite() || !self.guarded;
        if fine { (place, motion.velocity) } else { (view.now.position(row), view.now.velocity(row)) }
    }
    /// What becomes of a wanted motion that is not performed exactly. The same code for all laws: it is compiled once per
    /// precision and dimension.
    #[inline(never)]
    fn changed(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        wanted: Motion<R, D>,
        dt: R,
        own: &[R],
        body: &mut [R],
    ) -> Motion<R, D> {
        let mut motion = wanted;
        let mut follows = true;
        if let Some(conduct) = &self.conduct {
            motion = conduct.motion(view, row, motion, dt, body);
            follows = conduct.follows_law(body);
        }
        if let Some(taxis) = self.taxis.as_ref().filter(|_| follows) {
            motion = taxis.motion(view, row, motion, own, body);
        }
        if let Some(pace) = &self.pace {
            motion = pace.motion(view, row, motion, own, dt, body);
        }
        if let Some(adapts) = &self.adapts {
            adapts.note(view, row, self.radius, dt, body);
        }
        if !matches!(self.mobility, Mobility::Ideal) {
            motion = self.mobility.perform(view.now.velocity(row), motion, dt, body);
        }
        if let Some((draws, aside, faster)) = self.execution_error(view, row) {
            motion = turned(motion, aside, &draws, 4);
            motion = Motion { velocity: motion.velocity * faster, displacement: motion.displacement * faster };
        }
        motion
    }
    /// Errors of execution, where there are any: their draws, the angle (rad), and the factor of the speed.
    #[inline(always)]
    pub(crate) fn execution_error(&self, view: &View<'_, R, D>, row: usize) -> Option<(DrawStream, R, R)> {
        let n = &self.noise;
        if n.execution_direction > R::ZERO || n.execution_speed > R::ZERO {
            let draws = DrawStream::new(view.seed, Purpose::Execution, view.step, view.now.id[row]);
            let faster = (R::ONE + n.execution_speed * R::of(draws.normal(2))).most(R::ZERO);
            return Some((draws, n.execution_direction * R::of(draws.normal(0)), faster));
        }
        None
    }
    /// The error of computation, where there is one: its draws, and the angle (rad).
    #[inline(always)]
    pub(crate) fn computation_error(&self, view: &View<'_, R, D>, row: usize) -> Option<(DrawStream, R)> {
        if self.noise.computation > R::ZERO {
            let draws = DrawStream::new(view.seed, Purpose::Computation, view.step, view.now.id[row]);
            return Some((draws, self.noise.computation * R::of(draws.normal(0))));
        }
        None
    }
    #[inline(always)]
    fn wanted(&self, view: &View<'_, R, D>, row: usize, motion: Motion<R, D>) -> Motion<R, D> {
        if self.noise.computation > R::ZERO { self.mistaken(view, row, motion) } else { motion }
    }
    #[inline(never)]
    fn mistaken(&self, view: &View<'_, R, D>, row: usize, motion: Motion<R, D>) -> Motion<R, D> {
        match self.computation_error(view, row) {
            Some((draws, aside)) => turned(motion, aside, &draws, 2),
            None => motion,
        }
    }
    /// Loads an agent's columns into the scratch.
    #[inline(always)]
    pub(crate) fn load(&self, now: &Columns<R, D>, row: usize, scratch: &mut Scratch<R, D>) {
        if self.columns.is_empty() && self.body_columns.is_empty() {
            return;
        }
        scratch.own.resize(self.columns.len(), R::ZERO);
        for (own, &column) in scratch.own.iter_mut().zip(&self.columns) {
            *own = now.state[column][row];
        }
        scratch.body.resize(self.body_columns.len(), R::ZERO);
        for (body, &column) in scratch.body.iter_mut().zip(&self.body_columns) {
            *body = now.state[column][row];
        }
    }
    /// Obstacles and walls near an agent: those detected, and of these the ones selected.
    #[inline(never)]
    fn perceive_obstacles(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) {
        let Scratch { obstacles: to, robot, .. } = scratch;
        to.clear();
        let Some(reach) = self.obstacle_reach else { return };
        match &self.sensing {
            Sensing::Scanner(_) => to.extend(robot.obstacles(reach)),
            Sensing::Ideal(ideal) => {
                self.detect_obstacles(view, row, reach, to);
                if let Some(opening) = ideal.field_of_view {
                    let limit = crate::sensing::cos_half(opening);
                    let heading = view.now.velocity(row).unit();
                    to.retain(|near| {
                        let squared = near.offset.length_squared();
                        crate::motion::in_view::<R, R, D>(&heading.0, &near.offset.0, squared, limit)
                    });
                }
            }
        }
        self.select_obstacles(to);
    }
    /// Leaves out what lies beyond the law's own reach.
    #[inline(always)]
    fn within_law(&self, to: &mut Vec<NearObstacle<R, D>>) {
        if let Some(reach) = self.law_reach {
            to.retain(|near| reach > R::ZERO && near.distance < reach);
        }
    }
    /// Leaves the nearest so many of the obstacles detected; of equally near ones those met first.
    #[inline(always)]
    fn select_obstacles(&self, to: &mut Vec<NearObstacle<R, D>>) {
        if to.len() > self.obstacles_kept {
            to.sort_by(|a, b| a.distance.partial_cmp(&b.distance).unwrap_or(core::cmp::Ordering::Equal));
            to.truncate(self.obstacles_kept);
        }
    }
    #[inline(always)]
    fn detect_obstacles(&self, view: &View<'_, R, D>, row: usize, reach: R, to: &mut Vec<NearObstacle<R, D>>) {
        let place = view.now.position(row);
        if self.half > R::ZERO {
            return self.perceive_along_axis(view, row, reach, to);
        }
        if !view.obstacles.is_empty() {
            view.obstacles.near(place, reach, |_, shape, near| {
                let radius = if let Shape::Ball { radius, .. } = shape { *radius } else { R::INFINITY };
                to.push(NearObstacle { offset: near.point - place, distance: near.distance, away: near.away, radius });
            });
        }
        for a in 0..D {
            if let Edge::Walls(length) = view.space.edges[a] {
                for (distance, sign) in [(place.0[a], R::ONE), (length - place.0[a], -R::ONE)] {
                    if distance < reach {
                        let away = Vector::axis(a) * sign;
                        to.push(NearObstacle { offset: -away * distance, distance, away, radius: R::INFINITY });
                    }
                }
            }
        }
    }
    /// The three stages before the law, for members and obstacles. Returns whether the members stand in `scratch.sensed`.
    #[inline(always)]
    fn perceive(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        quick: bool,
    ) -> bool {
        let mut indirect = self.detect(view, row, scratch, memory, quick);
        self.perceive_obstacles(view, row, scratch);
        if self.virtual_members {
            let obstacles = core::mem::take(&mut scratch.obstacles);
            self.add_virtual_members(view, row, &obstacles, scratch, indirect);
            scratch.obstacles = obstacles;
            indirect = true;
        }
        self.select(view, row, scratch, indirect);
        indirect
    }
    /// As [`Self::detect_obstacles`], from that point of the body's axis that is nearest to each.
    #[cold]
    fn perceive_along_axis(&self, view: &View<'_, R, D>, row: usize, reach: R, to: &mut Vec<NearObstacle<R, D>>) {
        let (place, heading) = (view.now.position(row), view.now.velocity(row).unit());
        view.obstacles.near(place, reach + self.half, |_, shape, _| {
            let near = |along: R| (along, shape.nearest(place + heading * along));
            let nearest = capsule::points(self.half, self.radius)
                .map(near)
                .reduce(|a, b| if b.1.distance < a.1.distance { b } else { a });
            if let Some((along, near)) = nearest
                && near.distance < reach
            {
                let radius = if let Shape::Ball { radius, .. } = shape { *radius } else { R::INFINITY };
                let offset = near.point - (place + heading * along);
                to.push(NearObstacle { offset, distance: near.distance, away: near.away, radius });
            }
        });
        for a in 0..D {
            if let Edge::Walls(length) = view.space.edges[a] {
                let aside = self.half * heading[a].abs();
                for (distance, sign) in [(place.0[a] - aside, R::ONE), (length - place.0[a] - aside, -R::ONE)] {
                    if distance < reach {
                        let away = Vector::axis(a) * sign;
                        to.push(NearObstacle { offset: -away * distance, distance, away, radius: R::INFINITY });
                    }
                }
            }
        }
    }
    /// The item of food nearest to a place.
    #[inline(always)]
    fn item(view: &View<'_, R, D>, place: Vector<R, D>) -> Option<NearItem<R, D>> {
        view.resources.and_then(|r| r.nearest(view.space, place)).map(|(item, offset)| NearItem { offset, item })
    }
    #[inline(always)]
    fn around<'a>(
        &self,
        view: &View<'a, R, D>,
        row: usize,
        item: Option<NearItem<R, D>>,
        obstacles: &'a [NearObstacle<R, D>],
    ) -> Around<'a, R, D> {
        Around {
            obstacles,
            item,
            truth: view.now,
            row,
            rows: view.rows,
            space: view.space,
            group: (self.first, self.count),
            facing: self.facing(view, row),
        }
    }
    /// The angle in which an agent's body faces, where it keeps one.
    #[inline(always)]
    fn facing(&self, view: &View<'_, R, D>, row: usize) -> Option<R> {
        let keeps = matches!(self.mobility, Mobility::DifferentialDrive(_));
        self.body_columns.first().filter(|_| keeps).map(|&column| view.now.state[column][row])
    }
    /// Fills the scratch with the detected members of one agent. Returns whether velocities and columns stand in
    /// `scratch.sensed` rather than in the state. Where it is to be `quick`, members that can be in no set may be left out.
    ///
    /// The same code for all laws: it is compiled once per precision and dimension.
    #[inline(never)]
    fn detect(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        quick: bool,
    ) -> bool {
        if let (Some(count), Index::Pairs, true) = (self.nearest, view.index, quick) {
            scratch.clear();
            closest(view, row, view.now.position(row), count, scratch);
            return false;
        }
        match &self.sensing {
            Sensing::Ideal(ideal) => {
                let wanted = match self.reach {
                    // errors, views and hiding change who the nearest are: look at everyone
                    Reach::Nearest(_) if !ideal.is_perfect() => Reach::All,
                    // whoever stands farther may seem to be within it
                    Reach::Within(reach) if ideal.noise.distance > R::ZERO => {
                        let nearest = R::ONE - ideal.noise.distance * R::of(MOST_DEVIATIONS);
                        if nearest > R::ZERO { Reach::Within(reach / nearest) } else { Reach::All }
                    }
                    reach => reach,
                };
                let reach = match (ideal.range, wanted) {
                    (Some(range), Reach::Within(reach)) => Reach::Within(reach.least(range)),
                    (Some(range), _) => Reach::Within(range),
                    (None, reach) => reach,
                };
                if self.elongated {
                    self.candidates_between_axes(view, row, reach, scratch);
                } else {
                    self.candidates(view, row, reach, scratch);
                }
                !ideal.is_perfect() && self.limit(ideal, view, row, scratch)
            }
            Sensing::Scanner(robot) => {
                self.scan(robot, view, row, scratch, memory);
                true
            }
        }
    }
    /// Makes a member of every obstacle handed on: it stands at the obstacle's nearest point and moves with the agent's own motion
    /// along the surface, slower where that is curved (Olfati-Saber 2006). As [`Self::detect`] from then on, with the members in
    /// `scratch.sensed`.
    #[cold]
    fn add_virtual_members(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        obstacles: &[NearObstacle<R, D>],
        scratch: &mut Scratch<R, D>,
        indirect: bool,
    ) {
        if !indirect {
            self.copy_sensed(view, scratch);
        }
        let (place, velocity) = (view.now.position(row), view.now.velocity(row));
        let draws = DrawStream::new(view.seed, Purpose::Sensing, view.step, view.now.id[row]);
        scratch.make_room(scratch.found + obstacles.len());
        for (n, near) in obstacles.iter().enumerate() {
            // nobody's number, and draws that are nobody else's: the last one has those that are about nobody
            let id = u32::MAX - 1 - n as u32;
            let mut offset = near.offset;
            if let Sensing::Ideal(ideal) = &self.sensing {
                if ideal.noise.miss > R::ZERO && draws.uniform_about(id, 0) < ideal.noise.miss.to_f64() {
                    continue;
                }
                // up to just before its surface
                let to = place + offset * R::of(0.999_999);
                if ideal.occlusion != Occlusion::None && view.obstacles.hides(Screens::ANY, place, to) {
                    continue;
                }
                offset = seeming(offset, &ideal.noise, &draws, id);
            }
            let k = scratch.found;
            // inside of a ball as at its surface
            let curved = if near.radius.finite() { near.radius / (near.radius + near.distance) } else { R::ONE };
            let curved = curved.most(R::ZERO).least(R::ONE);
            scratch.push(k as u32, offset, offset.length_squared());
            scratch.sensed.id[k] = id;
            scratch.sensed.set_position(k, place + offset);
            scratch.sensed.set_velocity(k, (velocity - near.away * velocity.dot(near.away)) * curved);
            for column in &mut scratch.sensed.state {
                column[k] = R::ZERO;
            }
        }
    }
    /// Puts the detected members into the named sets.
    #[inline(never)]
    fn select(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>, indirect: bool) {
        let count = scratch.found;
        scratch.sets.clear();
        if count == 0 {
            return;
        }
        scratch.sets.resize(count, 0);
        let candidates = Candidates {
            offset: firsts(&scratch.offset, count),
            squared: &scratch.squared[..count],
            row: &scratch.row[..count],
            others: if indirect { &scratch.sensed } else { view.others },
            heading: view.now.velocity(row).unit(),
            member: (view.now.id[row] - self.first) as usize,
            periods: view.space.periods(),
        };
        for (s, set) in self.sets.iter().enumerate() {
            scratch.chosen.clear();
            scratch.chosen.resize(count, true);
            candidates.select(&set.perception, &mut scratch.chosen, &mut scratch.selection);
            for (bits, &chosen) in scratch.sets.iter_mut().zip(&scratch.chosen) {
                *bits |= u32::from(chosen) << s;
            }
        }
    }
    /// Others that can matter, in canonical order.
    #[inline(always)]
    fn candidates(&self, view: &View<'_, R, D>, row: usize, reach: Reach<R>, scratch: &mut Scratch<R, D>) {
        scratch.clear();
        let place = view.now.position(row);
        match reach {
            // nobody is asked for
            Reach::Within(radius) if radius <= R::TINY => {}
            Reach::Within(radius) => self.within(view, row, place, radius, scratch),
            Reach::All => pairs(view, row, place, R::INFINITY, scratch),
            Reach::Nearest(count) => {
                let Index::Sorted(grid) = view.index else {
                    return pairs(view, row, place, R::INFINITY, scratch);
                };
                // rings of growing radius: whoever is among the nearest lies inside the first that holds enough
                let mut radius = grid.spacing();
                for _ in 0..64 {
                    scratch.clear();
                    let asked = grid.within(view.others, place, radius, |other, offset, squared| {
                        if other as usize != row && !view.dead(view.others, other as usize) {
                            scratch.push(other, offset, squared);
                        }
                    });
                    if !asked {
                        break;
                    }
                    if scratch.found >= count {
                        return;
                    }
                    radius *= R::of(if scratch.found == 0 { 2.0 } else { 1.4 });
                }
                scratch.clear();
                pairs(view, row, place, R::INFINITY, scratch);
            }
        }
    }
    /// As [`Self::candidates`], by the shortest ways between the axes of bodies.
    #[cold]
    fn candidates_between_axes(&self, view: &View<'_, R, D>, row: usize, reach: Reach<R>, scratch: &mut Scratch<R, D>) {
        let wider = match reach {
            Reach::Within(radius) => Reach::Within(radius + self.half + view.longest),
            // who the nearest are is known when all ways are
            Reach::Nearest(_) | Reach::All => Reach::All,
        };
        self.candidates(view, row, wider, scratch);
        let mine = view.axis(view.now.id[row], view.now.velocity(row));
        for k in 0..scratch.found {
            let other = scratch.row[k] as usize;
            let axis = view.axis(view.others.id[other], view.others.velocity(other));
            let way = capsule::between(scratch.at(k), mine, axis);
            for a in 0..D {
                scratch.offset[a][k] = way[a];
            }
            scratch.squared[k] = way.length_squared();
        }
        if let Reach::Within(radius) = reach {
            scratch.retain(|scratch, k| scratch.squared[k] < radius * radius);
        }
    }
    fn within(&self, view: &View<'_, R, D>, row: usize, place: Vector<R, D>, radius: R, scratch: &mut Scratch<R, D>) {
        let found = match view.index {
            Index::Pairs => false,
            Index::Sorted(grid) => {
                let mut segments = core::mem::take(&mut scratch.segments);
                segments.clear();
                let found = grid.each_segment(place, radius, |segment| segments.push(segment));
                if found {
                    with_lanes(
                        level(),
                        Meet::<R, D, SHIFTED> { view, row, place, radius, segments: &segments, scratch },
                    );
                    scratch.bury(view);
                }
                scratch.segments = segments;
                found
            }
            Index::Live(grid) => grid.within(place, radius, |other, offset, squared| {
                if other as usize != row && !view.dead(view.others, other as usize) {
                    scratch.push(other, offset, squared);
                }
            }),
        };
        if !found {
            pairs(view, row, place, radius, scratch);
        }
    }
    /// Marks the members of rings; false where the index is none to do that with.
    #[inline(always)]
    fn mark(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        heading: Vector<R, D>,
        rings: &Rings<R>,
        scratch: &mut Scratch<R, D>,
    ) -> bool {
        scratch.clear();
        let mut segments = core::mem::take(&mut scratch.segments);
        segments.clear();
        let shifted = match (view.index, self.reach) {
            (Index::Live(_), _) => false,
            (Index::Sorted(grid), Reach::Within(radius)) => {
                grid.each_segment(view.now.position(row), radius, |segment| segments.push(segment))
            }
            _ => false,
        };
        if shifted {
            with_lanes(level(), Mark::<R, D, SHIFTED> { view, row, heading, rings, segments: &segments, scratch });
        } else if !matches!(view.index, Index::Live(_)) {
            let segments = &everyone(view);
            scratch.close_within = rings.outer[0].root();
            scratch.whole = true;
            if self.mark_coarse(view, row, heading, rings, scratch) {
                scratch.rough = true;
            } else if view.space.is_periodic() {
                with_lanes(level(), Mark::<R, D, ALL> { view, row, heading, rings, segments, scratch });
            } else {
                with_lanes(level(), Mark::<R, D, ALL_OPEN> { view, row, heading, rings, segments, scratch });
            }
        }
        scratch.segments = segments;
        if view.mortality.is_some() {
            for k in 0..scratch.found {
                let row = if scratch.rough { k } else { scratch.row[k] as usize };
                if view.dead(view.others, row) {
                    scratch.marks.iter_mut().for_each(|marks| marks[k / BLOCK] &= !(1 << (k % BLOCK)));
                }
            }
        }
        !matches!(view.index, Index::Live(_))
    }
    /// Marks the members of rings in single precision; false where that cannot be told.
    #[inline(always)]
    fn mark_coarse(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        heading: Vector<R, D>,
        rings: &Rings<R>,
        scratch: &mut Scratch<R, D>,
    ) -> bool {
        let Some(coarse) = view.coarse else { return false };
        let agents = view.others.len();
        scratch.reserve(agents);
        if scratch.everyone.len() < agents {
            scratch.everyone.extend(scratch.everyone.len() as u32..agents as u32);
            scratch.rough_squared.grow(agents.next_multiple_of(BLOCK));
        }
        let Scratch { rough_squared, marks, close, .. } = &mut *scratch;
        let Some(task) = coarse.about(row, heading, rings, rough_squared, marks.each_mut().map(|m| &mut m[..]), close)
        else {
            return false;
        };
        let margin = task.margin;
        if !with_lanes(level(), task) {
            return false;
        }
        scratch.margin = margin;
        scratch.found = agents;
        true
    }
    /// The limits and errors of ideal sensing. Returns whether others' velocities were changed too.
    #[inline(never)]
    fn limit(&self, ideal: &Ideal<R>, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) -> bool {
        let id = view.now.id[row];
        let draws = DrawStream::new(view.seed, Purpose::Sensing, view.step, id);
        if let Some(opening) = ideal.field_of_view {
            let heading = view.now.velocity(row).unit();
            let limit = crate::sensing::cos_half(opening);
            scratch.retain(|s, k| crate::motion::in_view::<R, R, D>(&heading.0, &s.at(k).0, s.squared[k], limit));
        }
        if ideal.occlusion != Occlusion::None {
            self.hide(view, row, scratch, ideal.occlusion == Occlusion::All, ideal.free);
        }
        let noise = &ideal.noise;
        if noise.miss > R::ZERO {
            let miss = noise.miss.to_f64();
            scratch.retain(|s, k| draws.uniform_about(view.others.id[s.row[k] as usize], 0) >= miss);
        }
        if noise.distance > R::ZERO || noise.direction > R::ZERO {
            for k in 0..scratch.found {
                let j = view.others.id[scratch.row[k] as usize];
                let seen = seeming(scratch.at(k), noise, &draws, j);
                for a in 0..D {
                    scratch.offset[a][k] = seen.0[a];
                }
                scratch.squared[k] = seen.length_squared();
            }
            // what seems to be beyond the reach of the sets is in none of them
            if let Reach::Within(reach) = self.reach {
                scratch.retain(|s, k| s.squared[k] < reach * reach);
            }
        }
        if let Some(pool) = &ideal.one_of {
            Self::draw_one(pool, view, row, &draws, scratch);
        }
        if noise.heading > R::ZERO {
            // whoever was not missed has drawn at least `miss`; beyond that the draw is still uniform, and nobody has used it
            let miss = noise.miss.to_f64();
            let spare = |draw: f64| if miss < 1.0 { (draw - miss) / (1.0 - miss) } else { 0.0 };
            self.copy_sensed(view, scratch);
            for k in 0..scratch.found {
                let j = scratch.sensed.id[k];
                let aside = noise.heading * R::of(draws.normal_about(j, 5));
                let velocity = scratch.sensed.velocity(k);
                let turned = velocity.unit().turned_by(aside, R::of(spare(draws.uniform_about(j, 0))) * R::TAU)
                    * velocity.length();
                scratch.sensed.set_velocity(k, turned);
            }
            return true;
        }
        false
    }
    /// Copies what is shown of the detected members into the scratch, so that it may be changed; their rows are those there.
    fn copy_sensed(&self, view: &View<'_, R, D>, scratch: &mut Scratch<R, D>) {
        let count = scratch.found;
        scratch.make_room(count);
        for k in 0..count {
            let row = scratch.row[k] as usize;
            scratch.sensed.id[k] = view.others.id[row];
            scratch.sensed.set_position(k, view.others.position(row));
            scratch.sensed.set_velocity(k, view.others.velocity(row));
            for (to, from) in scratch.sensed.state.iter_mut().zip(&view.others.state) {
                to[k] = from[row];
            }
            scratch.row[k] = k as u32;
        }
    }
    /// Drops all but one of the nearest, which is drawn.
    fn draw_one(pool: &Pool<R>, view: &View<'_, R, D>, row: usize, draws: &DrawStream, scratch: &mut Scratch<R, D>) {
        scratch.sort_by_distance();
        let heading = view.now.velocity(row).unit();
        let nearest = scratch.found.min(pool.nearest);
        let weight = |scratch: &Scratch<R, D>, n: usize| {
            let offset = scratch.at(scratch.order[n] as usize);
            pool.weight.of(offset.length(), heading.angle_to(offset))
        };
        let total: f64 = (0..nearest).map(|n| weight(scratch, n)).sum();
        // where all weights vanish, the nearest
        let mut left = draws.uniform(0) * total;
        let mut drawn = 0;
        for n in 0..nearest {
            drawn = n;
            left -= weight(scratch, n);
            if left < 0.0 || total <= 0.0 {
                break;
            }
        }
        let one = scratch.order.get(drawn).map(|&k| k as usize);
        scratch.retain(|_, k| Some(k) == one);
    }
    /// Drops members hidden behind nearer bodies or opaque obstacles: whose centre is hidden, or of whose disc less than a share
    /// is free.
    fn hide(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>, bodies: bool, free: Option<R>) {
        if let Some(least) = free {
            return self.hide_in_part(view, row, scratch, bodies, least);
        }
        let place = view.now.position(row);
        let count = scratch.found;
        // walls can only be in the way within the box that holds me and everybody
        let (mut low, mut high) = (place, place);
        for a in 0..D {
            for &offset in &scratch.offset[a][..count] {
                let at = place[a] + offset;
                (low[a], high[a]) = (low[a].least(at), high[a].most(at));
            }
        }
        let screens = view.obstacles.screens(low, high);
        if bodies {
            scratch.sort_by_distance();
        } else if screens.is_none() {
            return;
        } else {
            scratch.order.clear();
            scratch.order.extend(0..count as u32);
        }
        scratch.chosen.clear();
        scratch.chosen.resize(count, true);
        for n in 0..count {
            let k = scratch.order[n] as usize;
            let to = scratch.at(k);
            let far = scratch.squared[k];
            let hidden = bodies
                && scratch.order[..n].iter().any(|&m| {
                    let other = scratch.at(m as usize);
                    let radius = view.body_radius(view.others.id[scratch.row[m as usize] as usize]);
                    let along = (other.dot(to) / far.most(R::TINY)).clamped(R::ZERO, R::ONE);
                    scratch.squared[m as usize] < far && (other - to * along).length_squared() < radius * radius
                });
            scratch.chosen[k] = !(hidden || view.obstacles.hides(screens, place, place + to));
        }
        let chosen = core::mem::take(&mut scratch.chosen);
        scratch.retain(|_, k| chosen[k]);
        scratch.chosen = chosen;
    }
    /// Drops members of whose disc, as it is seen, less than a share is free: lines of sight to points spread evenly over it
    /// are followed.
    fn hide_in_part(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>, bodies: bool, least: R) {
        let place = view.now.position(row);
        let count = scratch.found;
        scratch.sort_by_distance();
        scratch.chosen.clear();
        scratch.chosen.resize(count, true);
        let radius_of = |scratch: &Scratch<R, D>, m: usize| view.body_radius(view.others.id[scratch.row[m] as usize]);
        for n in 0..count {
            let k = scratch.order[n] as usize;
            let (to, far) = (scratch.at(k), scratch.squared[k]);
            let radius = radius_of(scratch, k);
            let mut clear = 0;
            for aside in disc_points::<R, D>(to.unit()) {
                let to = to + aside * radius;
                let squared = to.length_squared().most(R::TINY);
                let hidden = bodies
                    && scratch.order[..n].iter().any(|&m| {
                        let (m, other) = (m as usize, scratch.at(m as usize));
                        let radius = radius_of(scratch, m);
                        let along = (other.dot(to) / squared).clamped(R::ZERO, R::ONE);
                        scratch.squared[m] < far && (other - to * along).length_squared() < radius * radius
                    });
                let walled =
                    !hidden && !view.obstacles.is_empty() && view.obstacles.hides(Screens::ANY, place, place + to);
                clear += usize::from(!(hidden || walled));
            }
            scratch.chosen[k] = R::count(clear) >= least * R::count(DISC);
        }
        let chosen = core::mem::take(&mut scratch.chosen);
        scratch.retain(|_, k| chosen[k]);
        scratch.chosen = chosen;
    }
    /// Sensing by rays and detection among the readings.
    fn scan(
        &self,
        robot: &Robot<R>,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
    ) {
        let place = view.now.position(row);
        self.candidates(view, row, Reach::Within(robot.scanner_range() + robot.widest_body), scratch);
        scratch.robot.bodies.clear();
        for k in 0..scratch.found {
            let other = scratch.row[k] as usize;
            let id = view.others.id[other];
            scratch.robot.add_body(scratch.at(k), view.body_radius(id), id);
        }
        let facing = self.facing(view, row).unwrap_or_else(|| view.now.velocity(row).angle());
        let draws = DrawStream::new(view.seed, Purpose::Sensing, view.step, view.now.id[row]);
        let moving = view.now.velocity(row);
        robot.detect(view.obstacles, view.space, place, moving, facing, &draws, view.time, &mut scratch.robot, memory);
        scratch.clear();
        let found = scratch.robot.found.len();
        scratch.make_room(found);
        for k in 0..found {
            let input = scratch.robot.found[k];
            let offset: Vector<R, D> = Vector::of(&[input.offset.0[0].to_f64(), input.offset.0[1].to_f64()]);
            let velocity: Vector<R, D> = Vector::of(&[input.velocity.0[0].to_f64(), input.velocity.0[1].to_f64()]);
            scratch.push(k as u32, offset, offset.length_squared());
            scratch.sensed.id[k] = k as u32;
            scratch.sensed.set_position(k, place + offset);
            scratch.sensed.set_velocity(k, velocity);
            for column in &mut scratch.sensed.state {
                column[k] = R::ZERO;
            }
        }
    }
}

/// Where somebody seems to be, by the errors of distance and direction.
#[inline(always)]
fn seeming<R: Scalar, const D: usize>(
    offset: Vector<R, D>,
    noise: &SensingNoise<R>,
    draws: &DrawStream,
    j: u32,
) -> Vector<R, D> {
    if noise.distance <= R::ZERO && noise.direction <= R::ZERO {
        return offset;
    }
    let farther = (R::ONE + noise.distance * R::of(draws.normal_about(j, 1))).most(R::ZERO);
    let aside = noise.direction * R::of(draws.normal_about(j, 3));
    let direction = offset.unit().turned_by(aside, R::of(draws.uniform_about(j, 7)) * R::TAU);
    direction * (offset.length() * farther)
}

/// No normal draw is so many standard deviations from its mean: they are made of uniform ones with 53 bits.
const MOST_DEVIATIONS: f64 = 8.6;

/// Lines of sight to a disc.
const DISC: usize = 19;

/// Points of a disc of radius 1 that is seen along a direction, each for an equal part of it: along its diameter in the plane,
/// in space on a spiral whose turns are golden angles.
fn disc_points<R: Scalar, const D: usize>(along: Vector<R, D>) -> impl Iterator<Item = Vector<R, D>> {
    let first = if D == 2 {
        along.left()
    } else if D > 2 {
        along.perpendicular()
    } else {
        Vector::ZERO
    };
    let second = along.cross3(first);
    (0..DISC).map(move |k| {
        let part = R::of((k as f64 + 0.5) / DISC as f64);
        if D == 2 {
            return first * (part + part - R::ONE);
        }
        let (sine, cosine) = R::of(k as f64 * 2.399_963_229_728_653).sin_cos();
        (first * cosine + second * sine) * part.root()
    })
}

impl<R: Scalar, const D: usize> Scratch<R, D> {
    /// Puts the detected members in order of their distance; ties keep the order in which they were met.
    fn sort_by_distance(&mut self) {
        self.order.clear();
        self.order.extend(0..self.found as u32);
        let squared = &self.squared;
        self.order.sort_unstable_by(|&a, &b| {
            let (x, y) = (squared[a as usize], squared[b as usize]);
            x.partial_cmp(&y).unwrap_or(core::cmp::Ordering::Equal).then(a.cmp(&b))
        });
    }
    /// Makes room for so many in what was sensed, and keeps what is there.
    fn make_room(&mut self, count: usize) {
        let before = self.sensed.id.len();
        if before >= count + PADDING {
            return;
        }
        let mut wider = Columns::new(2 * count, self.sensed.state.len());
        wider.id[..before].copy_from_slice(&self.sensed.id);
        let columns = |c: &mut Columns<R, D>| -> Vec<Vec<R>> {
            c.position.iter_mut().chain(&mut c.velocity).chain(&mut c.state).map(core::mem::take).collect()
        };
        let old = columns(&mut self.sensed);
        let all = wider.position.iter_mut().chain(&mut wider.velocity).chain(&mut wider.state);
        for (to, from) in all.zip(old) {
            to[..before].copy_from_slice(&from);
        }
        self.sensed = wider;
    }
}

/// The first `count` places of each column.
#[inline(always)]
fn firsts<R, const D: usize>(columns: &[impl core::ops::Deref<Target = [R]>; D], count: usize) -> [&[R]; D] {
    let mut firsts = [&[][..]; D];
    for a in 0..D {
        firsts[a] = &columns[a][..count];
    }
    firsts
}

/// A motion turned by an angle (about a drawn axis in three dimensions).
#[inline(always)]
fn turned<R: Scalar, const D: usize>(motion: Motion<R, D>, angle: R, draws: &DrawStream, slot: u32) -> Motion<R, D> {
    let axis = if D == 3 { R::of(draws.uniform(slot)) * R::TAU } else { R::ZERO };
    let turn = |v: Vector<R, D>| v.unit().turned_by(angle, axis) * v.length();
    Motion { velocity: turn(motion.velocity), displacement: turn(motion.displacement) }
}

/// All rows, for [`Meet`] and [`Mark`]: displacements are made minimal where an axis is periodic.
const ALL: u8 = 0;
/// As [`ALL`], where no axis is.
const ALL_OPEN: u8 = 1;
/// Runs of rows, each displaced by its shift.
const SHIFTED: u8 = 2;

/// Displacements to several others.
#[inline(always)]
fn offsets_to<R: Scalar, L: Lanes<R>, const D: usize, const WAY: u8>(
    space: &Space<R, D>,
    position: &[&[R]; D],
    first: usize,
    shift: &[L; D],
    me: &[L; D],
) -> [L; D] {
    let mut offset = *me;
    for a in 0..D {
        let other = L::load(&position[a][first..]);
        offset[a] = (if WAY == SHIFTED { other + shift[a] } else { other }) - me[a];
        if WAY == ALL {
            offset[a] = minimal_lanes(space, a, offset[a]);
        }
    }
    offset
}

/// Members of runs of rows closer than a radius, several at a time.
struct Meet<'a, 'b, R, const D: usize, const WAY: u8> {
    view: &'a View<'b, R, D>,
    row: usize,
    place: Vector<R, D>,
    radius: R,
    segments: &'a [Segment<R, D>],
    scratch: &'a mut Scratch<R, D>,
}

/// All pairs.
fn pairs<R: Scalar, const D: usize>(
    view: &View<'_, R, D>,
    row: usize,
    place: Vector<R, D>,
    radius: R,
    scratch: &mut Scratch<R, D>,
) {
    let segments = &everyone(view);
    if view.space.is_periodic() {
        with_lanes(level(), Meet::<R, D, ALL> { view, row, place, radius, segments, scratch });
    } else {
        with_lanes(level(), Meet::<R, D, ALL_OPEN> { view, row, place, radius, segments, scratch });
    }
    scratch.bury(view);
}

/// So many nearest among all, and perhaps a few more: their distances come first, so that no more than these are listed.
fn closest<R: Scalar, const D: usize>(
    view: &View<'_, R, D>,
    row: usize,
    place: Vector<R, D>,
    count: usize,
    scratch: &mut Scratch<R, D>,
) {
    let some = (1..=BLOCK).contains(&count) && view.others.len() > 2 * BLOCK && view.mortality.is_none();
    let found = some
        && if view.space.is_periodic() {
            with_lanes(level(), Closest::<R, D, ALL> { view, row, place, count, scratch })
        } else {
            with_lanes(level(), Closest::<R, D, ALL_OPEN> { view, row, place, count, scratch })
        };
    if !found {
        pairs(view, row, place, R::INFINITY, scratch);
    }
}

/// See [`closest`]. False, and nobody listed, where fewer than that stand at a finite distance.
struct Closest<'a, 'b, R, const D: usize, const WAY: u8> {
    view: &'a View<'b, R, D>,
    row: usize,
    place: Vector<R, D>,
    count: usize,
    scratch: &'a mut Scratch<R, D>,
}

impl<R: Scalar, const D: usize, const WAY: u8> Task<R> for Closest<'_, '_, R, D, WAY> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes<R>>(self) -> bool {
        let Self { view, row, place, count, scratch } = self;
        let end = view.others.len();
        let mut position = [&[][..]; D];
        for a in 0..D {
            position[a] = &view.others.position[a][..end + PADDING];
        }
        if scratch.distances.len() < end + PADDING {
            scratch.distances.grow(2 * (end + PADDING));
        }
        let distances = &mut scratch.distances[..end + PADDING];
        let (me, still): ([L; D], [L; D]) = (splat(place), splat(Vector::ZERO));
        // the least of every sixteenth: as many different members stand within the last of any so many of these
        let mut least = [L::splat(R::INFINITY); BLOCK];
        for first in (0..end).step_by(BLOCK) {
            let mut others = mask_of((end - first).min(BLOCK));
            if row.wrapping_sub(first) < BLOCK {
                others &= !(1 << (row - first));
            }
            for n in 0..BLOCK / L::WIDTH {
                let part = n * L::WIDTH;
                let offset = offsets_to::<R, L, D, WAY>(view.space, &position, first + part, &still, &me);
                let mut squared = crate::motion::dot(&offset, &offset);
                if others != mask_of(BLOCK) {
                    squared = L::choose(L::Mask::from_bits(others >> part), squared, L::splat(R::INFINITY));
                }
                least[n] = L::lesser(squared, least[n]);
                squared.store(&mut distances[first + part..]);
            }
        }
        let mut minima = [R::ZERO; BLOCK];
        for n in 0..BLOCK / L::WIDTH {
            least[n].store(&mut minima[n * L::WIDTH..]);
        }
        minima.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
        let limit = minima[count - 1];
        if !limit.finite() {
            return false;
        }
        let near = L::splat(limit);
        for first in (0..end).step_by(BLOCK) {
            let mut bits = 0;
            for n in 0..BLOCK / L::WIDTH {
                let part = n * L::WIDTH;
                bits |= L::load(&scratch.distances[first + part..]).less_equal(near).bits() << part;
            }
            while bits != 0 {
                let other = first + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let offset = offsets_to::<R, R, D, WAY>(view.space, &position, other, &Vector::ZERO.0, &place.0);
                scratch.push(other as u32, Vector(offset), scratch.distances[other]);
            }
        }
        true
    }
}

/// All rows as one segment.
#[inline(always)]
fn everyone<R: Scalar, const D: usize>(view: &View<'_, R, D>) -> [Segment<R, D>; 1] {
    [Segment { first: 0, end: view.others.len() as u32, shift: Vector::ZERO }]
}

impl<R: Scalar, const D: usize, const WAY: u8> Task<R> for Meet<'_, '_, R, D, WAY> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<R>>(self) {
        let Self { view, row, place, radius, segments, scratch } = self;
        let limit = L::splat(radius * radius);
        let me: [L; D] = splat(place);
        for segment in segments {
            let (mut first, end) = (segment.first as usize, segment.end as usize);
            scratch.reserve(end - first);
            let Scratch { found, row: rows, offset: offsets, squared: squares, .. } = &mut *scratch;
            // slices of their own, which stay in registers
            let mut position = [&[][..]; D];
            for a in 0..D {
                position[a] = &view.others.position[a][..end + PADDING];
            }
            let (rows, squares) = (&mut rows[..], &mut squares[..]);
            let offsets = &mut offsets.each_mut().map(|o| &mut o[..]);
            let shift: [L; D] = splat(segment.shift);
            let mut count = *found;
            while first < end {
                let offset = offsets_to::<R, L, D, WAY>(view.space, &position, first, &shift, &me);
                let squared = crate::motion::dot(&offset, &offset);
                let mut bits = squared.less(limit).bits() & mask_of(end - first);
                if row >= first && row < first + L::WIDTH {
                    bits &= !(1 << (row - first));
                }
                L::pack_numbers(first as u32, bits, &mut rows[count..]);
                for a in 0..D {
                    offset[a].pack(bits, &mut offsets[a][count..]);
                }
                squared.pack(bits, &mut squares[count..]);
                count += bits.count_ones() as usize;
                first += L::WIDTH;
            }
            *found = count;
        }
    }
}

/// The members of rings about an agent, as marks of the rows themselves: nothing is moved, and no row is tested by itself.
struct Mark<'a, 'b, R, const D: usize, const WAY: u8> {
    view: &'a View<'b, R, D>,
    row: usize,
    heading: Vector<R, D>,
    rings: &'a Rings<R>,
    segments: &'a [Segment<R, D>],
    scratch: &'a mut Scratch<R, D>,
}

impl<R: Scalar, const D: usize, const WAY: u8> Task<R> for Mark<'_, '_, R, D, WAY> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<R>>(self) {
        let Self { view, row, heading, rings, segments, scratch } = self;
        let rings = *rings;
        let me: [L; D] = splat(view.now.position(row));
        let heading: [L; D] = splat(heading);
        let mut outer = [L::splat(R::ZERO); RINGS];
        // every bit where the cone does not limit a ring
        let mut all_round = [0u32; RINGS];
        for s in 0..RINGS {
            outer[s] = L::splat(rings.outer[s]);
            all_round[s] = if rings.within_cone[s] { 0 } else { u32::MAX };
        }
        for segment in segments {
            let (mut first, end) = (segment.first as usize, segment.end as usize);
            // every segment begins a block
            scratch.reserve((end - first).next_multiple_of(BLOCK));
            let mut at = scratch.found;
            let Scratch { row: rows, offset: offsets, squared: squares, marks, close, .. } = &mut *scratch;
            let mut position = [&[][..]; D];
            for a in 0..D {
                position[a] = &view.others.position[a][..end + PADDING];
            }
            let (rows, squares, close) = (&mut rows[..], &mut squares[..], &mut close[..]);
            let marks = &mut marks.each_mut().map(|m| &mut m[..]);
            let offsets = &mut offsets.each_mut().map(|o| &mut o[..]);
            let shift: [L; D] = splat(segment.shift);
            while first < end {
                let (mut nearer, mut seen) = ([0u32; RINGS], 0u32);
                let squares = &mut squares[at..at + BLOCK];
                let offsets = &mut offsets.each_mut().map(|o| &mut o[at..at + BLOCK]);
                for n in 0..BLOCK / L::WIDTH {
                    let part = n * L::WIDTH;
                    let offset = offsets_to::<R, L, D, WAY>(view.space, &position, first + part, &shift, &me);
                    let squared = crate::motion::dot(&offset, &offset);
                    for s in 0..RINGS {
                        nearer[s] |= squared.less(outer[s]).bits() << part;
                    }
                    seen |= crate::motion::in_view(&heading, &offset, squared, rings.cos_half).bits() << part;
                    for a in 0..D {
                        offset[a].store(&mut offsets[a][part..]);
                    }
                    squared.store(&mut squares[part..]);
                }
                let mut others = mask_of(end - first);
                if row.wrapping_sub(first) < BLOCK {
                    others &= !(1 << (row - first));
                }
                let mut inside = 0;
                for s in 0..RINGS {
                    marks[s][at / BLOCK] = (nearer[s] & !inside & (seen | all_round[s]) & others) as u16;
                    inside = nearer[s];
                }
                close[at / BLOCK] = (nearer[0] & others) as u16;
                for (l, row) in rows[at..at + BLOCK].iter_mut().enumerate() {
                    *row = (first + l) as u32;
                }
                at += BLOCK;
                first += BLOCK;
            }
            scratch.found = at;
        }
    }
}

/// Which lanes are neither infinite nor NaN.
#[allow(clippy::eq_op, reason = "the difference of a number with itself is 0 unless it is infinite or not a number")]
#[inline(always)]
fn finite_lanes<R: Scalar, L: Lanes<R>>(value: L) -> L::Mask {
    (value - value).less_equal(L::splat(R::ZERO))
}

/// The first `count` lanes as bits.
#[inline(always)]
pub(crate) fn mask_of(count: usize) -> u32 {
    if count >= 32 { u32::MAX } else { (1u32 << count) - 1 }
}

#[inline(always)]
pub(crate) fn minimal_lanes<R: Real, L: Lanes<R>, const D: usize>(space: &Space<R, D>, axis: usize, d: L) -> L {
    if let Edge::Periodic(length) = space.edges[axis] {
        let (length, half) = (L::splat(length), L::splat(length * R::HALF));
        let above = half.less_equal(d);
        let below = d.less(-half);
        L::choose(above, d - length, L::choose(below, d + length, d))
    } else {
        d
    }
}

impl<R: Scalar, const D: usize> Stages<R, D> {
    fn remembers(&self) -> bool {
        matches!(&self.sensing, Sensing::Scanner(robot) if robot.association.is_some())
    }

    /// Everything that comes before the law, and then what is to be done with it. `marks`: of a law that reads marks; `trace` is given
    /// by explanations alone.
    #[inline(always)]
    fn present<P: Perceiving<R, D>>(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        (marks, trace): (bool, Option<&mut Trace<R, D>>),
        then: P,
    ) -> P::Found {
        let mut indirect = false;
        // an explanation goes the long way, over lists, which comes to the same
        let quick = marks && trace.is_none();
        scratch.close_within = R::ZERO;
        (scratch.whole, scratch.rough) = (false, false);
        let heading = view.heading_of(row);
        let marked = match &self.rings {
            Some(rings) if quick => self.mark(view, row, heading, rings, scratch),
            _ => false,
        };
        let position = view.now.position(row);
        if marked {
            self.perceive_obstacles(view, row, scratch);
        } else {
            indirect = self.perceive(view, row, scratch, memory, trace.is_none());
            if marks {
                scratch.mark();
            }
        }
        self.within_law(&mut scratch.obstacles);
        let obstacles = core::mem::take(&mut scratch.obstacles);
        self.load(view.now, row, scratch);
        // whole blocks, where they are read by blocks
        let count = if marks { scratch.found.next_multiple_of(BLOCK) } else { scratch.found };
        let seen = Percepts {
            offset: firsts(&scratch.offset, count),
            squared: &scratch.squared[..count],
            row: if scratch.rough { &scratch.everyone[..scratch.found] } else { &scratch.row[..scratch.found] },
            sets: if marked { &[] } else { &scratch.sets },
            marks: firsts(&scratch.marks, scratch.found.div_ceil(BLOCK)),
            others: if indirect { &scratch.sensed } else { view.others },
            columns: &self.columns,
            // what was sensed with errors, or is of an older moment, is not the present one
            headings: if indirect || !core::ptr::eq(view.others, view.now) {
                [&[]; D]
            } else {
                view.heading.each_ref().map(|column| &column[..])
            },
            whole: scratch.whole,
            uneven: view.uneven,
            rough: view.coarse.filter(|_| scratch.rough).map(|coarse| Rough {
                from: position,
                squared: &scratch.rough_squared,
                margin: scratch.margin,
                position: coarse.position(),
                row,
                displaced: coarse.displaced(),
            }),
        };
        let draws = Draws::new(view.seed, view.step, view.now.id[row], view.injected);
        let mut me = Me {
            id: view.now.id[row],
            position,
            velocity: view.now.velocity(row),
            heading,
            own: &mut scratch.own,
            around: self.around(view, row, Self::item(view, position), &obstacles),
            trace,
        };
        let found = then.by(&mut me, &seen, &draws);
        scratch.obstacles = obstacles;
        found
    }

    /// [`Self::present`] to any law: what comes before laws is compiled once and not with each of them.
    #[inline(never)]
    fn present_to(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        how: (bool, Option<&mut Trace<R, D>>),
        law: &mut Deciding<'_, R, D>,
    ) {
        self.present(view, row, scratch, memory, how, law);
    }

    /// The memory of an agent of this sweep.
    ///
    /// # Safety
    /// No other worker sweeps this row.
    #[allow(clippy::mut_from_ref, reason = "a writer is shared by workers that each own their rows")]
    #[inline(always)]
    unsafe fn memory<'m>(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        out: &'m Writer<'_, R, D>,
    ) -> Option<&'m mut Memory<R>> {
        let id = view.now.id[row] as usize;
        // SAFETY: an agent's memory is touched by the sweep of its row alone.
        if self.remembers() { unsafe { out.memory.part(id..id + 1) }.first_mut() } else { None }
    }

    /// Whether a row is to decide; the dead are written as they are.
    #[inline(always)]
    fn decides(&self, view: &View<'_, R, D>, row: usize, out: &Writer<'_, R, D>) -> bool {
        if !self.mine(view.now.id[row]) {
            return false;
        }
        let dead = view.dead(view.now, row);
        if dead {
            // SAFETY: rows of one sweep are written by it alone.
            unsafe { out.write(row, view.now.position(row), view.now.velocity(row)) };
        }
        !dead
    }

    /// Free space all round that the last agent that perceived knows of.
    #[inline(always)]
    fn room(&self, scratch: &Scratch<R, D>) -> R {
        match (&self.sensing, self.obstacle_reach) {
            // a limited view does not know of all that is near
            (Sensing::Ideal(Ideal { field_of_view: None, .. }), Some(reach))
                if scratch.obstacles.is_empty() && self.half == R::ZERO =>
            {
                reach.least(self.law_reach.unwrap_or(reach)) - self.radius
            }
            _ => R::ZERO,
        }
    }

    /// Notes who is close to the last agent that perceived.
    #[inline(always)]
    fn note_close(row: usize, out: &Writer<'_, R, D>, scratch: &Scratch<R, D>) {
        if out.close.blocks > 0 && scratch.close_within > R::ZERO {
            let blocks = out.close.blocks;
            // SAFETY: rows of one sweep are written by it alone.
            unsafe {
                out.close.marks.part(row * blocks..(row + 1) * blocks).copy_from_slice(&scratch.close[..blocks]);
                out.close.within.write(row, scratch.close_within);
            }
        }
    }

    /// Moves an agent as it wants to, as far as its body can, and writes its next state; its columns stand in the scratch.
    #[inline(always)]
    fn perform_and_write(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        (wanted, room): (Motion<R, D>, R),
        out: &Writer<'_, R, D>,
        scratch: &mut Scratch<R, D>,
        performed: &dyn Fn(&mut [R], Vector<R, D>),
    ) {
        let (place, velocity) = self.perform(view, row, wanted, self.dt, &scratch.own, &mut scratch.body);
        if !self.plain && velocity != wanted.velocity {
            performed(&mut scratch.own, velocity);
        }
        // a move that is shorter than the free space around it meets nothing
        let moved = (place - view.now.position(row)).length_squared();
        // SAFETY: rows of one sweep are written by it alone.
        unsafe {
            out.clear.write(row, room > R::ZERO && moved < room * room);
            out.write(row, place, velocity);
            out.write_state(row, &self.columns, &scratch.own);
            out.write_state(row, &self.body_columns, &scratch.body);
        }
    }

    /// The decisions and moves of some rows of any law.
    #[inline(never)]
    fn sweep_rows(
        &self,
        view: &View<'_, R, D>,
        rows: Range<usize>,
        out: &Writer<'_, R, D>,
        scratch: &mut Scratch<R, D>,
        decision: &dyn Fn(usize, &mut Scratch<R, D>, Option<&mut Memory<R>>) -> Motion<R, D>,
        performed: &dyn Fn(&mut [R], Vector<R, D>),
    ) {
        for row in rows {
            if !self.decides(view, row, out) {
                continue;
            }
            // SAFETY: rows of one sweep are its own.
            let memory = unsafe { self.memory(view, row, out) };
            let wanted = decision(row, scratch, memory);
            Self::note_close(row, out, scratch);
            self.perform_and_write(view, row, (wanted, self.room(scratch)), out, scratch, performed);
        }
    }
}

/// A law that is given lists of percepts.
pub(crate) struct Listed<M, R, const D: usize> {
    pub(crate) law: M,
    pub(crate) stages: Stages<R, D>,
}

impl<R: Scalar, const D: usize, M: Model<R, D>> Listed<M, R, D> {
    /// One decision. The same code for sweeps, turns and explanations, so that it is compiled once.
    fn decision(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        trace: Option<&mut Trace<R, D>>,
    ) -> Motion<R, D> {
        let mut motion = Motion { velocity: Vector::ZERO, displacement: Vector::ZERO };
        self.stages.present_to(view, row, scratch, memory, (M::MARKS, trace), &mut |me, seen, draws| {
            motion = self.law.decide(me, seen, draws);
        });
        self.stages.wanted(view, row, motion)
    }
}

/// A law, as it is told what an agent perceives.
type Deciding<'a, R, const D: usize> = dyn FnMut(&mut Me<'_, R, D>, &Percepts<'_, R, D>, &Draws<'_>) + 'a;

/// What is done with what an agent perceives. (A closure would not be compiled for the lanes.)
trait Perceiving<R: Scalar, const D: usize> {
    type Found;
    fn by(self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> Self::Found;
}

impl<R: Scalar, const D: usize> Perceiving<R, D> for &mut Deciding<'_, R, D> {
    type Found = ();
    #[inline(always)]
    fn by(self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) {
        self(me, seen, draws);
    }
}

/// The law finds out what the agent wishes.
struct Wishing<'a, M>(&'a M);
impl<R: Scalar, const D: usize, M: Abreast<R, D>> Perceiving<R, D> for Wishing<'_, M> {
    type Found = M::Wish;
    #[inline(always)]
    fn by(self, me: &mut Me<'_, R, D>, seen: &Percepts<'_, R, D>, draws: &Draws<'_>) -> M::Wish {
        self.0.wish(me, seen, draws)
    }
}

impl<R: Scalar, const D: usize, M: Model<R, D>> Kernel<R, D> for Listed<M, R, D> {
    fn stages(&self) -> &Stages<R, D> {
        &self.stages
    }
    fn headings(&self) -> bool {
        false
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        self.law.complete(start);
    }
    fn sweep(&self, view: &View<'_, R, D>, rows: Range<usize>, out: &Writer<'_, R, D>, scratch: &mut Scratch<R, D>) {
        let decision = |row, scratch: &mut _, memory: Option<&mut _>| self.decision(view, row, scratch, memory, None);
        let performed = |own: &mut [R], velocity| self.law.performed(own, velocity);
        self.stages.sweep_rows(view, rows, out, scratch, &decision, &performed);
    }
    fn one(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
    ) -> Motion<R, D> {
        self.decision(view, row, scratch, memory, None)
    }
    fn explained(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        trace: &mut Trace<R, D>,
    ) -> Motion<R, D> {
        self.decision(view, row, scratch, memory, Some(trace))
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, D>) {
        self.law.performed(own, velocity);
    }
    fn neighbours(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) -> usize {
        self.stages.perceive(view, row, scratch, None, true);
        scratch.sets.iter().filter(|&&bits| bits != 0).count()
    }
}

/// A law whose agents look each for itself and move abreast.
pub(crate) struct SideBySide<M, R, const D: usize> {
    pub(crate) listed: Listed<Single<M>, R, D>,
}

struct SweepSideBySide<'a, 'b, M, R, const D: usize> {
    kernel: &'a SideBySide<M, R, D>,
    view: &'a View<'b, R, D>,
    rows: Range<usize>,
    out: &'a Writer<'b, R, D>,
    scratch: &'a mut Scratch<R, D>,
}

impl<R: Scalar, const D: usize, M: Abreast<R, D>> Task<R> for SweepSideBySide<'_, '_, M, R, D> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<R>>(self) {
        let Self { kernel, view, rows, out, scratch } = self;
        let listed = &kernel.listed;
        let mut agents = core::mem::replace(&mut scratch.agents, Agents::new(0));
        agents.own.resize(listed.stages.columns.len(), [R::ZERO; WIDEST]);
        let mut wishes = [M::Wish::default(); WIDEST];
        // rows that follow each other, moved exactly as wished
        let stages = &listed.stages;
        let together = stages.plain
            && stages.noise.computation == R::ZERO
            && stages.body_columns.is_empty()
            && view.mortality.is_none()
            && view.bodies.len() == 1;
        let (mut places, mut rooms, mut count) = ([0; WIDEST], [R::ZERO; WIDEST], 0);
        for row in rows.clone() {
            if stages.decides(view, row, out) {
                // SAFETY: rows of one sweep are its own.
                let memory = unsafe { stages.memory(view, row, out) };
                let how = (<Single<M> as Model<R, D>>::MARKS, None);
                wishes[count] = stages.present(view, row, scratch, memory, how, Wishing(&listed.law.0));
                Stages::note_close(row, out, scratch);
                agents.put(count, view.now.velocity(row), &scratch.own);
                (places[count], rooms[count]) = (row, stages.room(scratch));
                count += 1;
            }
            if count < WIDEST && row + 1 < rows.end {
                continue;
            }
            for first in (0..count).step_by(L::WIDTH) {
                listed.law.0.conclude::<L>(first, &wishes, &mut agents);
            }
            if !(together && kernel.move_together::<L>(view, places[0], count, &agents, &rooms, out)) {
                for k in 0..count {
                    let row = places[k];
                    stages.load(view.now, row, scratch);
                    let wanted = stages.wanted(view, row, agents.take(k, &mut scratch.own));
                    let performed = |own: &mut [R], velocity| listed.law.performed(own, velocity);
                    stages.perform_and_write(view, row, (wanted, rooms[k]), out, scratch, &performed);
                }
            }
            count = 0;
        }
        scratch.agents = agents;
    }
}

impl<R: Scalar, const D: usize, M: Abreast<R, D>> SideBySide<M, R, D> {
    /// Moves consecutive rows and writes their next state; false where they cannot be moved together: they are then to be
    /// written one by one.
    #[inline(always)]
    fn move_together<L: Lanes<R>>(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        count: usize,
        agents: &Agents<R, D>,
        rooms: &[R; WIDEST],
        out: &Writer<'_, R, D>,
    ) -> bool {
        let zero = L::splat(R::ZERO);
        for first in (0..count).step_by(L::WIDTH) {
            let (mut velocity, mut displacement) = ([[R::ZERO; WIDEST]; D], [[R::ZERO; WIDEST]; D]);
            let mut moved = zero;
            for a in 0..D {
                let step = L::load(&agents.displacement[a][first..]);
                step.store(&mut displacement[a]);
                L::load(&agents.velocity[a][first..]).store(&mut velocity[a]);
                let from = L::load(&view.now.position[a][row + first..]);
                let way = (from + step) - from;
                moved = if a == 0 { way * way } else { moved + way * way };
            }
            let some = (count - first).min(L::WIDTH);
            if !perform_together::<R, L, D>(view, row + first, some, &velocity, &displacement, out) {
                return false;
            }
            // a move that is shorter than the free space around it meets nothing
            let room = L::load(&rooms[first..]);
            let clear = zero.less(room).and(moved.less(room * room)).bits();
            for k in 0..some {
                // SAFETY: rows of one sweep are written by it alone.
                unsafe { out.clear.write(row + first + k, clear >> k & 1 == 1) };
            }
        }
        for (&column, own) in self.listed.stages.columns.iter().zip(&agents.own) {
            // SAFETY: as above.
            unsafe { out.state[column].part(row..row + count).copy_from_slice(&own[..count]) };
        }
        true
    }
}

impl<R: Scalar, const D: usize, M: Abreast<R, D>> Kernel<R, D> for SideBySide<M, R, D> {
    fn stages(&self) -> &Stages<R, D> {
        self.listed.stages()
    }
    fn headings(&self) -> bool {
        self.marks()
    }
    fn marks(&self) -> bool {
        self.listed.stages.rings.is_some()
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        self.listed.complete(start);
    }
    fn sweep(&self, view: &View<'_, R, D>, rows: Range<usize>, out: &Writer<'_, R, D>, scratch: &mut Scratch<R, D>) {
        with_lanes(level(), SweepSideBySide { kernel: self, view, rows, out, scratch });
    }
    fn one(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
    ) -> Motion<R, D> {
        self.listed.one(view, row, scratch, memory)
    }
    fn explained(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        trace: &mut Trace<R, D>,
    ) -> Motion<R, D> {
        self.listed.explained(view, row, scratch, memory, trace)
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, D>) {
        self.listed.performed(own, velocity);
    }
    fn neighbours(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) -> usize {
        self.listed.neighbours(view, row, scratch)
    }
}

/// A law that sums neighbour by neighbour: several agents at a time against neighbours in canonical order.
pub(crate) struct Streamed<M, R, const D: usize> {
    pub(crate) listed: Listed<Summed<M>, R, D>,
}

impl<R: Scalar, const D: usize, M: Stream<R, D>> Streamed<M, R, D> {
    fn law(&self) -> &M {
        &self.listed.law.0
    }
    /// Whether the stages around the law are the ones it streams through.
    fn direct(&self) -> bool {
        let stages = &self.listed.stages;
        stages.own_sets
            && !stages.elongated
            && !stages.virtual_members
            && matches!(&stages.sensing, Sensing::Ideal(ideal) if ideal.is_perfect())
    }

    /// Adds the neighbours of one run of rows to the sums of a block. With `IMAGES`, displacements are made minimal pair by
    /// pair; otherwise the rows are displaced by `shift`.
    #[inline(always)]
    fn meet<L: Lanes<R>, const IMAGES: bool>(
        &self,
        view: &View<'_, R, D>,
        block: &Block<'_, L, D>,
        rows: Range<usize>,
        shift: Vector<R, D>,
        sums: &mut M::Sums<L>,
        together: &mut Together<'_, R, L, D>,
    ) {
        let limit = L::splat(self.law().reach() * self.law().reach());
        let (first, count) = (rows.start, rows.len());
        // cut to one length, so that no place inside the loop has to be checked
        let mut position = [&[][..]; D];
        let mut velocity = [&[][..]; D];
        let mut heading = [&[][..]; D];
        for a in 0..D {
            position[a] = &view.others.position[a][rows.clone()][..count];
            velocity[a] = &view.others.velocity[a][rows.clone()][..count];
            heading[a] = if M::HEADINGS { &view.heading[a][rows.clone()][..count] } else { velocity[a] };
        }
        let mut found = together.count;
        for k in 0..count {
            let j = first + k;
            if view.dead(view.others, j) {
                continue;
            }
            let mut other = Other {
                velocity: Vector::ZERO,
                heading: Vector::ZERO,
                row: j,
                others: view.others,
                columns: &self.listed.stages.columns,
            };
            let mut offset = block.place;
            for a in 0..D {
                offset[a] = L::splat(position[a][k] + shift.0[a]) - block.place[a];
                if IMAGES {
                    offset[a] = minimal_lanes(view.space, a, offset[a]);
                }
                other.velocity.0[a] = velocity[a][k];
                other.heading.0[a] = heading[a][k];
            }
            let squared = crate::motion::dot(&offset, &offset);
            let mut near = squared.less(limit);
            if j.wrapping_sub(block.first) < L::WIDTH {
                near = near.and(L::Mask::from_bits(!(1u32 << (j - block.first))));
            }
            if IMAGES && !near.any() {
                // of all rows, most are near nobody; rows of cells are near somebody
                continue;
            }
            if M::TOGETHER {
                found = together.put(found, &offset, squared, near, j);
                if found == TOGETHER {
                    together.count = found;
                    self.law().gather_together::<L>(sums, &block.me, together);
                    found = 0;
                }
                continue;
            }
            let mut sets = self.law().classify::<L>(&block.me, &offset, squared, &other);
            for set in &mut sets {
                *set = set.and(near);
            }
            self.law().gather::<L>(sums, &block.me, &offset, squared, &other, &sets);
        }
        together.count = found;
    }

    #[inline(always)]
    fn sweep_lanes<L: Lanes<R>>(
        &self,
        view: &View<'_, R, D>,
        rows: Range<usize>,
        out: &Writer<'_, R, D>,
        scratch: &mut Scratch<R, D>,
    ) {
        let mut row = rows.start;
        let mut each = [<M::Sums<L> as LaneSums<R, L>>::zero_one(); WIDEST];
        let mut together = Together::<R, L, D>::new(view.others, view.heading, &self.listed.stages.columns);
        // cells reach as far as laws with a reach do; who needs everyone meets everyone
        let sorted = match view.index {
            Index::Sorted(grid) if self.law().reach().finite() => Some(grid),
            _ => None,
        };
        let mut line = sorted.filter(|_| row < rows.end).map_or(0, |grid| grid.line_at(row));
        while row < rows.end {
            let mut count = (rows.end - row).min(L::WIDTH);
            if let Some(grid) = sorted {
                while grid.line(line).end <= row {
                    line += 1;
                }
                count = count.min(grid.line(line).end - row);
                count = grid.together(view.now, row, count);
            }
            if !(row..row + count).any(|row| self.listed.stages.mine(view.now.id[row])) {
                // a block of other groups
                row += count;
                continue;
            }
            let zero = L::splat(R::ZERO);
            let (mut place, mut velocity, mut heading) = ([zero; D], [zero; D], [zero; D]);
            for a in 0..D {
                place[a] = L::load(&view.now.position[a][row..]);
                velocity[a] = L::load(&view.now.velocity[a][row..]);
                heading[a] = if M::HEADINGS { L::load(&view.heading[a][row..]) } else { velocity[a] };
            }
            let mut own = [L::splat(R::ZERO); MOST_OWN];
            for (own, &column) in own.iter_mut().zip(&self.listed.stages.columns) {
                *own = L::load(&view.now.state[column][row..]);
            }
            let block = Block { first: row, place, me: MeLanes { velocity, heading, own: &own } };
            let mut sums = M::Sums::<L>::zero();
            if let Some(grid) = sorted {
                let mut segments = core::mem::take(&mut scratch.segments);
                grid.around(view.now, line, row..row + count, &mut segments);
                for s in &segments {
                    let rows = s.first as usize..s.end as usize;
                    self.meet::<L, false>(view, &block, rows, s.shift, &mut sums, &mut together);
                }
                scratch.segments = segments;
            } else {
                self.meet::<L, true>(view, &block, 0..view.others.len(), Vector::ZERO, &mut sums, &mut together);
            }
            if M::TOGETHER && together.count > 0 {
                self.law().gather_together::<L>(&mut sums, &block.me, &together);
                together.count = 0;
            }
            sums.split(&mut each[..L::WIDTH]);
            let mut first = [-1.0; WIDEST];
            if self.law().draws_first() && view.injected.is_none() {
                let mut counter = [0; WIDEST];
                for k in 0..count {
                    counter[k] = view.now.id[row + k].wrapping_mul(DrawStream::SLOTS);
                }
                first = uniforms(view.seed, Purpose::Behaviour, view.step, &counter);
            }
            let mut item = [-R::ONE; WIDEST];
            if let Some(resources) = view.resources {
                resources.nearest_abreast(view.space, &place).store(&mut item);
            }
            let stages = &self.listed.stages;
            let mine = || view.bodies.len() == 1 || (row..row + count).all(|row| stages.mine(view.now.id[row]));
            if stages.plain && view.mortality.is_none() && mine() {
                self.finish_block::<L>(view, row, count, &each, &first, &item, out, scratch);
            } else {
                for k in 0..count {
                    self.finish(view, row + k, &each[k], first[k], item[k], out, scratch);
                }
            }
            row += count;
        }
    }

    /// Moves a block whose motions are performed exactly: the same numbers as [`Stages::perform`], side by side.
    #[inline(always)]
    fn finish_block<L: Lanes<R>>(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        count: usize,
        sums: &[<M::Sums<L> as LaneSums<R, L>>::One; WIDEST],
        first: &[f64; WIDEST],
        item: &[R; WIDEST],
        out: &Writer<'_, R, D>,
        scratch: &mut Scratch<R, D>,
    ) {
        let stages = &self.listed.stages;
        let mut velocity = [[R::ZERO; WIDEST]; D];
        let mut displacement = [[R::ZERO; WIDEST]; D];
        for k in 0..count {
            let wanted = self.conclude(view, row + k, &sums[k], first[k], Self::item(view, row + k, item[k]), scratch);
            for a in 0..D {
                velocity[a][k] = wanted.velocity.0[a];
                displacement[a][k] = wanted.displacement.0[a];
            }
            // SAFETY: rows of one sweep are written by it alone.
            unsafe { out.write_state(row + k, &stages.columns, &scratch.own) };
        }
        if perform_together::<R, L, D>(view, row, count, &velocity, &displacement, out) {
            return;
        }
        for k in 0..count {
            let mut wanted = Motion { velocity: Vector::ZERO, displacement: Vector::ZERO };
            for a in 0..D {
                (wanted.velocity[a], wanted.displacement[a]) = (velocity[a][k], displacement[a][k]);
            }
            let (place, velocity) = stages.perform(view, row + k, wanted, stages.dt, &[], &mut []);
            // SAFETY: as above.
            unsafe { out.write(row + k, place, velocity) };
        }
    }

    #[inline(always)]
    fn finish(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        sums: &M::Sums<R>,
        first: f64,
        item: R,
        out: &Writer<'_, R, D>,
        scratch: &mut Scratch<R, D>,
    ) {
        let stages = &self.listed.stages;
        if !stages.mine(view.now.id[row]) {
            return;
        }
        if view.dead(view.now, row) {
            // SAFETY: rows of one sweep are written by it alone.
            unsafe { out.write(row, view.now.position(row), view.now.velocity(row)) };
            return;
        }
        let wanted = self.concluded(view, row, sums, first, Self::item(view, row, item), scratch);
        let mut body = core::mem::take(&mut scratch.body);
        let (place, velocity) = stages.perform(view, row, wanted, stages.dt, &scratch.own, &mut body);
        // SAFETY: as above.
        unsafe {
            out.write(row, place, velocity);
            out.write_state(row, &stages.columns, &scratch.own);
            out.write_state(row, &stages.body_columns, &body);
        }
        scratch.body = body;
    }

    /// An item by its number, as a row sees it; none where the number is negative.
    #[inline(always)]
    fn item(view: &View<'_, R, D>, row: usize, number: R) -> Option<NearItem<R, D>> {
        if number < R::ZERO {
            return None;
        }
        let item = number.to_f64() as usize;
        let place = view.resources.and_then(|resources| resources.place.get(item))?;
        Some(NearItem { offset: view.space.offset(view.now.position(row), *place), item: item as u32 })
    }

    /// [`Self::conclude`] for motions that are not performed side by side: compiled once and not for each width of lanes.
    #[inline(never)]
    fn concluded(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        sums: &M::Sums<R>,
        first: f64,
        item: Option<NearItem<R, D>>,
        scratch: &mut Scratch<R, D>,
    ) -> Motion<R, D> {
        self.conclude(view, row, sums, first, item, scratch)
    }

    #[inline(always)]
    fn conclude(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        sums: &M::Sums<R>,
        first: f64,
        item: Option<NearItem<R, D>>,
        scratch: &mut Scratch<R, D>,
    ) -> Motion<R, D> {
        let stages = &self.listed.stages;
        let position = view.now.position(row);
        if stages.obstacle_reach.is_some() {
            stages.perceive_obstacles(view, row, scratch);
            stages.within_law(&mut scratch.obstacles);
        }
        stages.load(view.now, row, scratch);
        let mut draws = Draws::new(view.seed, view.step, view.now.id[row], view.injected);
        draws.stream.first = first;
        let mut me = Me {
            id: view.now.id[row],
            position,
            velocity: view.now.velocity(row),
            heading: view.heading_of(row),
            own: &mut scratch.own,
            around: stages.around(view, row, item, &scratch.obstacles),
            trace: None,
        };
        let motion = self.law().finish(&mut me, sums, &draws);
        stages.wanted(view, row, motion)
    }
}

/// Moves consecutive rows, fewer than there are lanes or as many, whose motions are performed exactly: the same numbers as
/// [`Stages::perform`], side by side. False, and nothing written, where one of them is not finite or leaves a periodic space.
#[inline(always)]
fn perform_together<R: Scalar, L: Lanes<R>, const D: usize>(
    view: &View<'_, R, D>,
    row: usize,
    count: usize,
    velocity: &[[R; WIDEST]; D],
    displacement: &[[R; WIDEST]; D],
    out: &Writer<'_, R, D>,
) -> bool {
    let zero = L::splat(R::ZERO);
    let mut fine = L::Mask::all_of(true);
    let mut place = [zero; D];
    for a in 0..D {
        place[a] = L::load(&view.now.position[a][row..]) + L::load(&displacement[a]);
        fine = match view.space.edges[a] {
            Edge::Periodic(length) => fine.and(zero.less_equal(place[a])).and(place[a].less(L::splat(length))),
            _ => fine.and(finite_lanes::<R, L>(place[a])),
        };
        let moving = L::load(&velocity[a]);
        fine = fine.and(finite_lanes::<R, L>(moving));
    }
    if fine.bits() & mask_of(count) == mask_of(count) {
        for a in 0..D {
            let mut to = [R::ZERO; WIDEST];
            place[a].store(&mut to);
            // SAFETY: rows of one sweep are written by it alone.
            unsafe { out.write_block(a, row, &to[..count], &velocity[a][..count]) };
        }
        return true;
    }
    false
}

/// A block of consecutive agents, one per lane.
struct Block<'a, L, const D: usize> {
    first: usize,
    place: [L; D],
    me: MeLanes<'a, L, D>,
}

struct SweepStreamed<'a, 'b, M, R, const D: usize> {
    kernel: &'a Streamed<M, R, D>,
    view: &'a View<'b, R, D>,
    rows: Range<usize>,
    out: &'a Writer<'b, R, D>,
    scratch: &'a mut Scratch<R, D>,
}

impl<R: Scalar, const D: usize, M: Stream<R, D>> Task<R> for SweepStreamed<'_, '_, M, R, D> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<R>>(self) {
        self.kernel.sweep_lanes::<L>(self.view, self.rows, self.out, self.scratch);
    }
}

impl<R: Scalar, const D: usize, M: Stream<R, D>> Kernel<R, D> for Streamed<M, R, D> {
    fn stages(&self) -> &Stages<R, D> {
        &self.listed.stages
    }
    fn headings(&self) -> bool {
        M::HEADINGS
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        Stream::complete(self.law(), start);
    }
    fn sweep(&self, view: &View<'_, R, D>, rows: Range<usize>, out: &Writer<'_, R, D>, scratch: &mut Scratch<R, D>) {
        if self.direct() {
            with_lanes(level(), SweepStreamed { kernel: self, view, rows, out, scratch });
        } else {
            self.listed.sweep(view, rows, out, scratch);
        }
    }
    fn one(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
    ) -> Motion<R, D> {
        match view.index {
            Index::Live(grid) if self.direct() && self.law().reach() <= grid.reach() => {
                with_lanes(level(), OneStreamed { kernel: self, view, row, grid, scratch })
            }
            _ => self.listed.one(view, row, scratch, memory),
        }
    }
    fn explained(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        trace: &mut Trace<R, D>,
    ) -> Motion<R, D> {
        self.listed.explained(view, row, scratch, memory, trace)
    }
    fn neighbours(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) -> usize {
        self.listed.neighbours(view, row, scratch)
    }
}

/// One agent against its cells, without lists: several others are tested at a time, and met one by one.
struct OneStreamed<'a, 'b, M, R, const D: usize> {
    kernel: &'a Streamed<M, R, D>,
    view: &'a View<'b, R, D>,
    row: usize,
    grid: &'a LiveGrid<R, D>,
    scratch: &'a mut Scratch<R, D>,
}

impl<R: Scalar, const D: usize, M: Stream<R, D>> Task<R> for OneStreamed<'_, '_, M, R, D> {
    type Output = Motion<R, D>;
    #[inline(always)]
    fn run<L: Lanes<R>>(self) -> Motion<R, D> {
        let Self { kernel, view, row, grid, scratch } = self;
        let law = kernel.law();
        let place: [L; D] = splat(view.now.position(row));
        let velocity = view.now.velocity(row);
        kernel.listed.stages.load(view.now, row, scratch);
        let own = core::mem::take(&mut scratch.own);
        let me = MeLanes { velocity: velocity.0, heading: velocity.unit().0, own: &own };
        let limit = L::splat(law.reach() * law.reach());
        // first those in reach, packed without a branch for each, then their sums
        scratch.clear();
        let mut found = 0;
        for run in grid.around(row) {
            let members = grid.members(run);
            scratch.found = found;
            scratch.reserve(members.count);
            let Scratch { row: rows, offset: offsets, squared: squares, .. } = &mut *scratch;
            // slices of their own, which stay in registers
            let (rows, squares) = (&mut rows[..], &mut squares[..]);
            let offsets = &mut offsets.each_mut().map(|o| &mut o[..]);
            let shift: [L; D] = splat(run.shift);
            let mut first = 0;
            // at least once, since whether a run is empty cannot be foretold
            loop {
                let mut offset = place;
                for a in 0..D {
                    offset[a] = (L::load(&members.position[a][first..]) + shift[a]) - place[a];
                }
                let squared = crate::motion::dot(&offset, &offset);
                let several = &members.rows[first..];
                // all but oneself, here, where it is told for several at once
                let bits =
                    squared.less(limit).bits() & mask_of(members.count - first) & !L::listed(several, row as u32);
                L::pack_listed(several, bits, &mut rows[found..]);
                for a in 0..D {
                    offset[a].pack(bits, &mut offsets[a][found..]);
                }
                squared.pack(bits, &mut squares[found..]);
                found += bits.count_ones() as usize;
                first += L::WIDTH;
                if first >= members.count {
                    break;
                }
            }
        }
        scratch.found = found;
        scratch.bury(view);
        let found = scratch.found;
        let (rows, squares) = (&scratch.row[..found], &scratch.squared[..found]);
        let offsets = firsts(&scratch.offset, found);
        let velocities = firsts(&view.others.velocity, view.others.len());
        let mut sums = M::Sums::<R>::zero();
        for k in 0..found {
            let j = rows[k] as usize;
            let (mut to, mut velocity) = ([R::ZERO; D], Vector::ZERO);
            for a in 0..D {
                to[a] = offsets[a][k];
                velocity.0[a] = velocities[a][j];
            }
            let other = Other {
                velocity,
                heading: if M::HEADINGS { velocity.unit() } else { Vector::ZERO },
                row: j,
                others: view.others,
                columns: &kernel.listed.stages.columns,
            };
            let sets = law.classify::<R>(&me, &to, squares[k], &other);
            law.gather::<R>(&mut sums, &me, &to, squares[k], &other, &sets);
        }
        scratch.own = own;
        let item = Stages::item(view, view.now.position(row));
        kernel.conclude(view, row, &sums, -1.0, item, scratch)
    }
}
