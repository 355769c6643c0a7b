//! The step: who acts when. Synchronous, sequential and asynchronous drivers share the same decisions.

use crate::engine::kernel::{Scratch, Writer};
use crate::engine::plan::{Clock, Driver, Order};
use crate::engine::world::{Group, World};
use crate::motion::Motion;
use crate::parameters::Scalar;
use crate::physics::Met;
use space::lanes::{Lanes, Task, level, with_lanes};
use space::random::{Purpose, uniform, uniforms};

impl<R: Scalar, const D: usize> World<R, D> {
    /// Makes one step (one tick, for an asynchronous world).
    pub fn step(&mut self) {
        (self.compiled.step)(self);
    }
    pub(crate) fn make_step(&mut self) {
        match self.driver {
            Driver::Synchronous => self.step_synchronous(),
            Driver::Sequential(order) => self.step_sequential(order),
            Driver::Asynchronous { tick, clock, delay, .. } => self.step_asynchronous(tick, clock, delay),
        }
        self.step += 1;
    }
    /// Time at which a step begins. It follows from the number of the step: a sum of many steps would come late.
    pub(crate) fn time_at(&self, step: u64) -> f64 {
        let (first, time) = self.origin;
        time + self.step_time * step.saturating_sub(first) as f64
    }
    /// Makes several steps.
    pub fn run(&mut self, steps: u64) {
        for _ in 0..steps {
            self.step();
        }
    }

    /// All read the frame at `t`; the whole next frame is written at once.
    fn step_synchronous(&mut self) {
        self.obstacles.advance(self.time);
        let mut next = core::mem::replace(&mut self.next, space::Columns::nothing());
        let mut memory = core::mem::take(&mut self.memory);
        let mut clear = core::mem::take(&mut self.clear);
        let mut close = core::mem::take(&mut self.close);
        let mut scratch = core::mem::take(&mut self.scratch);
        {
            let view = self.view();
            let out = Writer::new(&mut next, &mut memory, &mut clear, &mut close);
            let worker_scratch = space::parallel::Shared::new(&mut scratch);
            let rows = self.now.len();
            let threads = self.workers.threads();
            // many, so that nobody waits long for the last one, but none so short that its beginning costs more than the rest
            let tasks = if threads == 1 { 1 } else { (rows / 16).min((rows / 1024).max(threads * 8)).max(1) };
            self.workers.each(tasks, |worker, task| {
                // SAFETY: a worker runs one task at a time.
                let scratch = unsafe { &mut worker_scratch.part(worker..worker + 1)[0] };
                let part = (rows * task / tasks)..(rows * (task + 1) / tasks);
                // SAFETY: tasks own disjoint rows.
                unsafe { out.keep(&self.now, part.clone()) };
                for (group, range) in self.groups.iter().zip(&self.ranges) {
                    let mut rows = part.clone();
                    if self.grid.is_none() {
                        // rows that are not sorted are ids, and a group's ids follow each other
                        rows.start = rows.start.max(range.first as usize);
                        rows.end = rows.end.min((range.first + range.count) as usize);
                    }
                    if rows.start < rows.end {
                        group.kernel.sweep(&view, rows, &out, scratch);
                    }
                }
            });
        }
        self.next = next;
        self.memory = memory;
        self.clear = clear;
        self.close = close;
        self.scratch = scratch;
        self.finish(self.dt);
    }

    /// What follows everyone's motion: contacts, resources, the new index.
    fn finish(&mut self, dt: R) {
        let time = self.time_at(self.step + 1);
        if self.contacts {
            self.resolve_contacts();
            self.tell_turned();
        }
        if let Some(mut resources) = self.resources.take() {
            resources.update(&self.space, &mut self.next, self.seed, self.step, time, dt);
            self.resources = Some(resources);
        }
        core::mem::swap(&mut self.now, &mut self.next);
        self.time = time;
        self.settle();
    }

    /// Tells the laws of bodies that a surface has turned round: what they keep of their own heading follows it.
    fn tell_turned(&mut self) {
        if !self.groups.iter().any(Group::turns) {
            return;
        }
        let Some(mut scratch) = self.scratch.pop() else { return };
        for row in 0..self.now.len() {
            let id = self.now.id[row];
            let group = &self.groups[self.group_of(id)];
            if self.met[id as usize] != Met::Nothing && group.turns() {
                let stages = group.kernel.stages();
                stages.load(&self.next, row, &mut scratch);
                group.kernel.performed(&mut scratch.own, self.next.velocity(row));
                for (&c, &value) in stages.columns.iter().zip(&scratch.own) {
                    self.next.state[c][row] = value;
                }
            }
        }
        self.scratch.push(scratch);
    }

    /// Who acts after whom in this step.
    pub(crate) fn sequence(&mut self, order: Order) -> Vec<u32> {
        // always from the order of ids, so that a step does not depend on the one before
        let mut sequence = core::mem::take(&mut self.order);
        sequence.clear();
        sequence.extend(0..self.now.len() as u32);
        if order == Order::Random {
            with_lanes(level(), Shuffle { order: &mut sequence, seed: self.seed, step: self.step });
        }
        sequence
    }

    /// One after the other; each reads the newest state and writes its own at once.
    fn step_sequential(&mut self, order: Order) {
        self.obstacles.advance(self.time);
        let Some(mut scratch) = self.scratch.pop() else { return };
        let sequence = self.sequence(order);
        self.met.fill(Met::Nothing);
        for &id in &sequence {
            self.take_turn(id, &mut scratch);
        }
        self.order = sequence;
        self.scratch.push(scratch);
        self.time = self.time_at(self.step + 1);
        self.note_collisions();
        if let Some(mut resources) = self.resources.take() {
            resources.update(&self.space, &mut self.now, self.seed, self.step, self.time, self.dt);
            self.resources = Some(resources);
        }
    }

    /// The turn of one agent in a sequential step.
    #[inline(always)]
    pub(crate) fn take_turn(&mut self, id: u32, scratch: &mut Scratch<R, D>) {
        let row = id as usize;
        let g = self.group_of(id);
        let view = self.view();
        let group = &self.groups[g];
        if view.mortality.is_some_and(|c| self.now.state[c][row] <= R::ZERO) {
            return;
        }
        let mut memory = self.memory.get(row).cloned();
        let wanted = group.kernel.one(&view, row, scratch, memory.as_mut());
        let stages = group.kernel.stages();
        let (place, velocity) = stages.perform(&view, row, wanted, self.dt, &scratch.own, &mut scratch.body);
        if velocity != wanted.velocity {
            group.kernel.performed(&mut scratch.own, velocity);
        }
        for (&c, &value) in stages.columns.iter().zip(&scratch.own) {
            self.now.state[c][row] = value;
        }
        let stages = self.groups[g].kernel.stages();
        for (&c, &value) in stages.body_columns.iter().zip(&scratch.body) {
            self.now.state[c][row] = value;
        }
        if let Some(memory) = memory {
            self.memory[row] = memory;
        }
        let (place, turned) = if self.contacts { self.resolve_one(row, place, velocity) } else { (place, velocity) };
        let group = &self.groups[g];
        if turned != velocity && group.turns() {
            group.kernel.performed(&mut scratch.own, turned);
            for (&c, &value) in group.kernel.stages().columns.iter().zip(&scratch.own) {
                self.now.state[c][row] = value;
            }
        }
        self.now.set_position(row, place);
        self.now.set_velocity(row, turned);
        if let Some(live) = &mut self.live {
            live.follow(row, place);
        }
    }

    /// Keeps the present frame for as long as readings are stale; how many frames that is.
    pub(crate) fn keep_history(&mut self, tick: f64, delay: f64) -> usize {
        let stale = (delay / tick).round() as usize;
        if stale > 0 {
            self.clocks.history.push_back(self.now.clone());
            while self.clocks.history.len() > stale + 1 {
                self.clocks.history.pop_front();
            }
        }
        stale
    }

    /// Each on its own clock; physics moves everyone in every tick.
    fn step_asynchronous(&mut self, tick: f64, clock: Clock, delay: f64) {
        self.obstacles.advance(self.time);
        let agents = self.now.len();
        let stale = self.keep_history(tick, delay);
        let Some(mut scratch) = self.scratch.pop() else { return };
        let mut clocks = core::mem::replace(
            &mut self.clocks,
            crate::engine::world::Clocks {
                due: Vec::new(),
                decisions: Vec::new(),
                command: Vec::new(),
                history: Default::default(),
            },
        );
        let per_time = R::ONE / self.dt;
        for (to, from) in self.next.state.iter_mut().zip(&self.now.state) {
            to.copy_from_slice(from);
        }
        let step = R::of(tick);
        for row in 0..agents {
            let group = &self.groups[self.group_of(row as u32)];
            let stages = group.kernel.stages();
            let mut view = self.view();
            if view.mortality.is_some_and(|c| self.now.state[c][row] <= R::ZERO) {
                self.next.set_position(row, self.now.position(row));
                self.next.set_velocity(row, self.now.velocity(row));
                continue;
            }
            if clocks.is_due(row, self.time, tick) {
                clocks.age(&mut view, stale);
                let mut memory = self.memory.get(row).cloned();
                let wanted = group.kernel.one(&view, row, &mut scratch, memory.as_mut());
                clocks.command[row] =
                    Motion { velocity: wanted.velocity, displacement: wanted.displacement * per_time };
                for (&c, &value) in stages.columns.iter().zip(&scratch.own) {
                    self.next.state[c][row] = value;
                }
                if let Some(memory) = memory {
                    self.memory[row] = memory;
                }
                let count = clocks.decisions[row];
                clocks.decisions[row] += 1;
                let draw = uniform(self.seed, Purpose::Environment, count, row as u32 * 8 + 6);
                let (period, jitter) = self.rhythm[row];
                clocks.due[row] += match clock {
                    Clock::Regular { .. } => period * (1.0 + jitter * (2.0 * draw - 1.0)),
                    Clock::Poisson => -period * <f64 as space::Real>::ln(1.0 - draw),
                };
            } else {
                stages.load(&self.now, row, &mut scratch);
            }
            let command = clocks.command[row];
            let motion = Motion { velocity: command.velocity, displacement: command.displacement * step };
            let stages = self.groups[self.group_of(row as u32)].kernel.stages();
            let (place, velocity) = stages.perform(&self.view(), row, motion, step, &scratch.own, &mut scratch.body);
            let kernel = &self.groups[self.group_of(row as u32)].kernel;
            if velocity != motion.velocity {
                kernel.performed(&mut scratch.own, velocity);
                for (&c, &value) in kernel.stages().columns.iter().zip(&scratch.own) {
                    self.next.state[c][row] = value;
                }
            }
            for (&c, &value) in kernel.stages().body_columns.iter().zip(&scratch.body) {
                self.next.state[c][row] = value;
            }
            self.next.set_position(row, place);
            self.next.set_velocity(row, velocity);
        }
        self.scratch.push(scratch);
        self.clocks = clocks;
        self.finish(step);
        if self.groups.iter().any(Group::turns) {
            // a reversed velocity is also the command from now on
            for id in 0..agents {
                if self.met.get(id).is_some_and(|&met| met != Met::Nothing) {
                    let velocity = self.now.velocity(id);
                    self.clocks.command[id] = Motion { velocity, displacement: velocity };
                }
            }
        }
    }
}

/// Fisher and Yates, with draws for this step alone, made several at a time.
struct Shuffle<'a> {
    order: &'a mut [u32],
    seed: u64,
    step: u64,
}

impl Task<f64> for Shuffle<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<f64>>(self) {
        const TOGETHER: usize = 16;
        let Self { order, seed, step } = self;
        let mut last = order.len().saturating_sub(1);
        while last > 0 {
            let mut slots = [0; TOGETHER];
            for k in 0..TOGETHER {
                slots[k] = (last.saturating_sub(k) as u32).wrapping_mul(8) + 7;
            }
            for draw in uniforms(seed, Purpose::Environment, step, &slots) {
                if last == 0 {
                    return;
                }
                let other = (draw * (last as f64 + 1.0)) as usize;
                order.swap(last, other.min(last));
                last -= 1;
            }
        }
    }
}
