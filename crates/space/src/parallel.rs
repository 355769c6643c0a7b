//! Work spread over threads without touching the result: fixed tasks, disjoint writes.
//!
//! The threads live as long as their [`Workers`]: between rounds of work they spin a little, then park, since a step is a
//! handful of rounds close together and waking a thread costs more than most of them.

use core::marker::PhantomData;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::any::Any;
use std::cell::UnsafeCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// How often a thread looks for what it waits for before it gives its processor away; some hundred microseconds.
const SPINS: u32 = 5000;

/// No more workers than these: far above the processors of any machine, far below what a system lets one process have.
pub const MOST_THREADS: usize = 1024;

/// A set of worker threads. One thread means the caller's own.
pub struct Workers {
    room: Option<Arc<Room>>,
    threads: Vec<JoinHandle<()>>,
}

impl Workers {
    /// `threads` workers (at least one, at most [`MOST_THREADS`]), the caller included. As many fewer as the system refuses.
    pub fn new(threads: usize) -> Self {
        let threads = threads.min(MOST_THREADS);
        if threads <= 1 {
            return Self { room: None, threads: Vec::new() };
        }
        // whoever spins while another waits for a processor holds that other up
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let room = Arc::new(Room::new(threads, if threads > processors { 0 } else { SPINS }));
        let start = |worker: usize| {
            let room = Arc::clone(&room);
            std::thread::Builder::new().name(format!("worker {worker}")).spawn(move || room.work(worker)).ok()
        };
        let threads: Vec<_> = (1..threads).map_while(start).collect();
        Self { room: Some(room), threads }
    }
    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads.len() + 1
    }
    /// Calls `work(worker, task)` for every task from 0 to `tasks - 1`, in any order, each once; `worker` (below
    /// [`Self::threads`]) is not used by two calls at a time, so it can choose a scratch buffer.
    ///
    /// Each worker begins with its own share of consecutive tasks, so that in round after round it meets the same data, and
    /// then helps the others. Where the workers are at work already, the caller does all tasks itself.
    pub fn each(&self, tasks: usize, work: impl Fn(usize, usize) + Sync) {
        match self.room.as_ref().and_then(|room| Some((room, room.enter()?))) {
            Some((room, caller)) if tasks > 1 => room.share(caller, &self.threads, tasks, &work),
            _ => {
                for task in 0..tasks {
                    work(0, task);
                }
            }
        }
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        let Some(room) = &self.room else { return };
        room.over.store(true, Ordering::Release);
        for thread in self.threads.drain(..) {
            thread.thread().unpark();
            // a panic of a worker was handed to the caller of its round
            let _ = thread.join();
        }
    }
}

/// What is called for every worker and task.
type Work = dyn Fn(usize, usize) + Sync;

/// A round of work, as the workers are told of it.
#[derive(Clone, Copy)]
struct Round {
    work: *const Work,
    tasks: usize,
}

/// The round goes on: workers may join it. The lower bits of the door count those inside.
const OPEN: usize = 1 << (usize::BITS - 1);

/// Next task of a worker's share, on a cache line of its own.
#[repr(align(128))]
struct Next(AtomicUsize);

/// Where rounds are announced.
struct Room {
    /// Number of the round, raised when a new one is open.
    number: AtomicUsize,
    door: AtomicUsize,
    /// Written by the caller while the door is closed and nobody inside, read by those inside.
    round: UnsafeCell<Option<Round>>,
    /// By worker.
    next: Vec<Next>,
    spins: u32,
    /// No further round will come.
    over: AtomicBool,
    /// Held by the caller of a round.
    caller: Mutex<()>,
    /// What a worker's panic said, for the caller of the round.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

// SAFETY: `round` is written by the one caller that holds `caller`, and never while a worker reads it: see `door`. The pointer in
// it leads to a `Sync` closure.
unsafe impl Send for Room {}
// SAFETY: as above.
unsafe impl Sync for Room {}

impl Room {
    fn new(threads: usize, spins: u32) -> Self {
        Self {
            number: AtomicUsize::new(0),
            door: AtomicUsize::new(0),
            round: UnsafeCell::new(None),
            next: (0..threads).map(|_| Next(AtomicUsize::new(0))).collect(),
            spins,
            over: AtomicBool::new(false),
            caller: Mutex::new(()),
            panic: Mutex::new(None),
        }
    }

    /// The right to call a round; `None` while another one goes on.
    fn enter(&self) -> Option<MutexGuard<'_, ()>> {
        self.caller.try_lock().ok()
    }

    /// A round: opens the door, works along, closes the door, and waits for those inside.
    fn share<'a>(
        &self,
        caller: MutexGuard<'_, ()>,
        threads: &[JoinHandle<()>],
        tasks: usize,
        work: &'a (dyn Fn(usize, usize) + Sync + 'a),
    ) {
        for (worker, next) in self.next.iter().enumerate() {
            next.0.store(self.first(worker, tasks), Ordering::Relaxed);
        }
        let work: *const (dyn Fn(usize, usize) + Sync + 'a) = work;
        // SAFETY: only the lifetime is forgotten. Workers use the closure only while they are inside, and this call does not
        // return before the door is closed and all have left.
        let work = unsafe { core::mem::transmute::<*const (dyn Fn(usize, usize) + Sync + 'a), *const Work>(work) };
        let round = Round { work, tasks };
        // SAFETY: the door is closed, nobody who came in before is still inside, and there is one caller at a time.
        unsafe { *self.round.get() = Some(round) };
        self.door.fetch_or(OPEN, Ordering::Release);
        self.number.fetch_add(1, Ordering::Release);
        threads.iter().for_each(|thread| thread.thread().unpark());
        let done = catch_unwind(AssertUnwindSafe(|| self.drain(0, round)));
        self.door.fetch_and(!OPEN, Ordering::Relaxed);
        let mut looks = 0;
        while self.door.load(Ordering::Acquire) != 0 {
            if looks < self.spins {
                looks += 1;
                core::hint::spin_loop();
            } else {
                std::thread::yield_now();
            }
        }
        let panic = self.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
        drop(caller);
        if let Some(panic) = done.err().or(panic) {
            resume_unwind(panic);
        }
    }

    /// First task of a worker's share.
    fn first(&self, worker: usize, tasks: usize) -> usize {
        tasks * worker / self.next.len()
    }

    /// Does tasks until there are none: those of the own share first, then those of the workers after it.
    fn drain(&self, worker: usize, round: Round) {
        // SAFETY: the caller of the round waits for everyone inside.
        let work = unsafe { &*round.work };
        let threads = self.next.len();
        for other in (worker..threads).chain(0..worker) {
            let end = self.first(other + 1, round.tasks);
            loop {
                let task = self.next[other].0.fetch_add(1, Ordering::Relaxed);
                if task >= end {
                    break;
                }
                work(worker, task);
            }
        }
    }

    /// The life of a worker: it waits for a round, joins it, and waits again.
    fn work(&self, worker: usize) {
        let (mut known, mut looks) = (0, 0);
        while !self.over.load(Ordering::Acquire) {
            let number = self.number.load(Ordering::Acquire);
            if number == known {
                if looks < self.spins {
                    looks += 1;
                    core::hint::spin_loop();
                } else {
                    std::thread::park();
                }
                continue;
            }
            (known, looks) = (number, 0);
            if self.door.fetch_add(1, Ordering::Acquire) & OPEN != 0 {
                // SAFETY: the door was open, so the round was written before and stays until this worker has left.
                if let Some(round) = unsafe { *self.round.get() }
                    && let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.drain(worker, round)))
                {
                    *self.panic.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic);
                }
            }
            self.door.fetch_sub(1, Ordering::Release);
        }
    }
}

/// A slice that several threads may write to, each place by one of them at most.
pub struct Shared<'a, T> {
    start: *mut T,
    length: usize,
    lifetime: PhantomData<&'a mut [T]>,
}

// SAFETY: the only access is through the unsafe methods below, whose callers promise disjoint places.
unsafe impl<T: Send> Send for Shared<'_, T> {}
// SAFETY: as above.
unsafe impl<T: Send> Sync for Shared<'_, T> {}

impl<'a, T> Shared<'a, T> {
    /// Shares a slice for as long as it is borrowed.
    pub fn new(slice: &'a mut [T]) -> Self {
        Self { start: slice.as_mut_ptr(), length: slice.len(), lifetime: PhantomData }
    }
    /// Length of the slice.
    pub fn len(&self) -> usize {
        self.length
    }
    /// Whether the slice is empty.
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }
    /// Writes one place.
    ///
    /// # Safety
    /// `place` is below the length, and no other thread reads or writes it meanwhile.
    #[inline(always)]
    pub unsafe fn write(&self, place: usize, value: T) {
        debug_assert!(place < self.length);
        // SAFETY: in bounds and exclusive by the caller's promise.
        unsafe { *self.start.add(place) = value }
    }
    /// A part of the slice.
    ///
    /// # Safety
    /// The range lies inside the slice, and no other thread reads or writes it meanwhile.
    #[allow(clippy::mut_from_ref, reason = "the caller promises that the range is its own")]
    #[inline(always)]
    pub unsafe fn part(&self, range: core::ops::Range<usize>) -> &mut [T] {
        debug_assert!(range.start <= range.end && range.end <= self.length);
        // SAFETY: in bounds and exclusive by the caller's promise.
        unsafe { core::slice::from_raw_parts_mut(self.start.add(range.start), range.end - range.start) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_task_once_for_any_number_of_threads() {
        for threads in [1, 2, 3, 8] {
            let workers = Workers::new(threads);
            let mut seen = vec![0u32; 100];
            let shared = Shared::new(&mut seen);
            workers.each(100, |worker, task| {
                assert!(worker < threads);
                // SAFETY: each task writes its own place.
                unsafe { shared.part(task..task + 1)[0] += 1 };
            });
            assert!(seen.iter().all(|&n| n == 1));
        }
    }

    #[test]
    fn there_are_no_more_threads_than_a_system_has() {
        let workers = Workers::new(usize::MAX);
        assert!(workers.threads() <= MOST_THREADS);
        let count = AtomicUsize::new(0);
        workers.each(3, |_, _| {
            count.fetch_add(1, Ordering::Relaxed);
        });
        assert_eq!(count.into_inner(), 3);
    }

    #[test]
    fn rounds_in_a_row_and_inside_one_another() {
        let workers = Workers::new(3);
        let count = AtomicUsize::new(0);
        for _ in 0..1000 {
            workers.each(4, |_, _| {
                // the workers are busy: this round is done by whoever asks for it
                workers.each(2, |_, _| {
                    count.fetch_add(1, Ordering::Relaxed);
                });
            });
        }
        assert_eq!(count.into_inner(), 8000);
    }

    #[test]
    fn a_panic_reaches_the_caller_and_the_workers_go_on() {
        let workers = Workers::new(2);
        for broken in 0..8 {
            let round = catch_unwind(AssertUnwindSafe(|| workers.each(8, |_, task| assert_ne!(task, broken))));
            assert!(round.is_err());
            let count = AtomicUsize::new(0);
            workers.each(8, |_, _| {
                count.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!(count.into_inner(), 8);
        }
    }
}
