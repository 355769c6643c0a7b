//! Units of work on several threads, whose results one writer takes as they come.

use crate::store::StoreError;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::sync_channel;

/// Results that wait to be written, at most.
const WAITING: usize = 1024;

/// Who watches.
pub trait Watch: Sync {
    /// It begins or goes on: so many `what` are to be done, so many are there already.
    fn begin(&mut self, folder: &Path, what: &str, units: usize, there: usize, threads: usize);
    /// More units came to be known of.
    fn more(&mut self, units: usize);
    /// One is done, with so many updates of agents.
    fn done(&mut self, updates: u64);
    /// Whether to stop.
    fn stopper(&self) -> fn() -> bool;
}

/// Does units on some threads, and gives each result to `take` on this one, in the order in which they come. Whether all are
/// done: not where `stop` said so.
///
/// # Errors
/// The first of a unit or of `take`; what was taken before stays.
pub fn spread<U: Sync, T: Send>(
    units: &[U],
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
    work: impl Fn(&U, &dyn Fn() -> bool) -> Result<Option<T>, String> + Sync,
    mut take: impl FnMut(&U, T) -> Result<(), StoreError>,
) -> Result<bool, StoreError> {
    let (next, over) = (AtomicUsize::new(0), AtomicBool::new(false));
    let stop = || over.load(Ordering::Relaxed) || stop();
    let (to, from) = sync_channel(WAITING);
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, units.len().max(1)) {
            let to = to.clone();
            let (next, stop, work) = (&next, &stop, &work);
            scope.spawn(move || {
                while !stop() {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(unit) = units.get(number) else { return };
                    let done = work(unit, &stop);
                    let last = !matches!(done, Ok(Some(_)));
                    // nobody listens any more where this fails
                    if to.send((number, done)).is_err() || last {
                        return;
                    }
                }
            });
        }
        drop(to);
        let (mut taken, mut failure) = (0, None);
        for (number, done) in from {
            let written = match done {
                Ok(Some(result)) => take(&units[number], result).map(|()| taken += 1),
                Ok(None) => Ok(()),
                Err(what) => Err(StoreError::Refused(what)),
            };
            if let Err(error) = written {
                over.store(true, Ordering::Relaxed);
                failure.get_or_insert(error);
            }
        }
        failure.map_or(Ok(taken == units.len()), Err)
    })
}

/// Numbers as the bytes of a record.
pub fn packed(words: impl IntoIterator<Item = u64>) -> Vec<u8> {
    words.into_iter().flat_map(u64::to_le_bytes).collect()
}

/// The words of a record.
pub fn unpacked(bytes: &[u8]) -> Vec<u64> {
    bytes.chunks_exact(8).map(|word| u64::from_le_bytes(core::array::from_fn(|k| word[k]))).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_done_once_and_errors_end_it() {
        let units: Vec<u64> = (0..100).collect();
        for threads in [1, 3, 200] {
            let mut taken = Vec::new();
            let keep = |_: &u64, square: u64| {
                taken.push(square);
                Ok(())
            };
            let complete = spread(&units, threads, &|| false, |unit, _| Ok(Some(unit * unit)), keep).unwrap();
            taken.sort_unstable();
            assert!(complete && taken.iter().copied().eq(units.iter().map(|unit| unit * unit)));
        }
        let fails = |unit: &u64, _: &dyn Fn() -> bool| if *unit == 7 { Err("seven".to_owned()) } else { Ok(Some(())) };
        let failed = spread(&units, 2, &|| false, fails, |_, ()| Ok(()));
        assert_eq!(failed.unwrap_err().to_string(), "seven");
        assert!(!spread(&units, 2, &|| true, |_, _| Ok(Some(())), |_, ()| Ok(())).unwrap());
        assert!(spread::<u64, ()>(&[], 2, &|| false, |_, _| Ok(None), |_, ()| Ok(())).unwrap());
        assert_eq!(unpacked(&packed([1, u64::MAX])), [1, u64::MAX]);
    }
}
