//! Work spread over threads without touching the result: fixed tasks, disjoint writes.

use core::marker::PhantomData;
use core::sync::atomic::{AtomicUsize, Ordering};

/// A set of worker threads. One thread means the caller's own.
pub struct Workers {
    pool: Option<rayon::ThreadPool>,
    threads: usize,
}

impl Workers {
    /// `threads` workers (at least one). Falls back to the calling thread where the system refuses threads.
    pub fn new(threads: usize) -> Self {
        let threads = threads.max(1);
        let pool = if threads > 1 { rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok() } else { None };
        let threads = if pool.is_some() { threads } else { 1 };
        Self { pool, threads }
    }
    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.threads
    }
    /// Calls `work(worker, task)` for every task from 0 to `tasks - 1`, in any order, each once; `worker` (below
    /// [`Self::threads`]) is not used by two calls at a time, so it can choose a scratch buffer.
    pub fn each(&self, tasks: usize, work: impl Fn(usize, usize) + Sync) {
        match &self.pool {
            Some(pool) if tasks > 1 => {
                let next = AtomicUsize::new(0);
                let threads = self.threads;
                pool.in_place_scope(|scope| {
                    for worker in 1..threads {
                        let (next, work) = (&next, &work);
                        scope.spawn(move |_| drain(next, tasks, worker, work));
                    }
                    drain(&next, tasks, 0, &work);
                });
            }
            _ => {
                for task in 0..tasks {
                    work(0, task);
                }
            }
        }
    }
}

fn drain(next: &AtomicUsize, tasks: usize, worker: usize, work: &(impl Fn(usize, usize) + Sync)) {
    loop {
        let task = next.fetch_add(1, Ordering::Relaxed);
        if task >= tasks {
            return;
        }
        work(worker, task);
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
}
