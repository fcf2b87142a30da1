//! Parallel loops, which run on all cores if the feature `rayon` is enabled and sequentially otherwise.
//!
//! Every piece is computed independently and stored at its position, so that the bits do not depend on the number of
//! threads. This is the only module that uses `rayon`. The code of parallel iterators is large. It is compiled
//! separately for every closure and optimized again in each caller. Therefore closures are called through trait
//! objects: a call costs about a nanosecond, and the surrounding code is compiled once per value type.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Maximum number of pieces per thread. It is large enough that no thread waits long for another.
const PIECES: usize = 64;

/// Returns the number of threads that can run in parallel: 1 if the feature `rayon` is disabled.
#[must_use]
pub fn n_threads() -> usize {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    return 1;
}

/// Calls `work` once with each number below `count`, in any order.
pub fn for_each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    #[cfg(feature = "rayon")]
    if count > 1 && n_threads() > 1 {
        use rayon::prelude::*;
        (0..count).into_par_iter().for_each(work);
        return;
    }
    (0..count).for_each(work);
}

/// Returns `make(0)` to `make(count - 1)` in order. Each call may run as a separate parallel task.
pub fn map<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync) -> Vec<T> {
    map_at_least(1, count, make)
}

/// Returns `make(0)` to `make(count - 1)` in order. A parallel task makes at least `least` calls.
pub fn map_at_least<T: Send>(
    least: usize,
    count: usize,
    make: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    all_of(least, count, &make)
}

/// Implements [`map_at_least`] through a trait object.
#[inline(never)]
fn all_of<T: Send>(least: usize, count: usize, make: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    map_parts(least, count, &|part| part.map(make).collect())
}

/// Concatenates the results of `make` for consecutive ranges of `0..count`. A parallel task covers at least `least`
/// numbers.
///
/// On one thread there is a single range: `make` has only one call site, so that it is compiled once.
#[inline(never)]
pub(crate) fn map_parts<T: Send>(
    least: usize,
    count: usize,
    make: &(dyn Fn(Range<usize>) -> Vec<T> + Sync),
) -> Vec<T> {
    let size = piece(count, least);
    if size >= count {
        return make(0..count);
    }
    let n_parts = count.div_ceil(size);
    let parts = Mutex::new(Vec::new());
    lock(&parts).resize_with(n_parts, Vec::new);
    for_each(n_parts, &|part| {
        let first = part * size;
        let made = make(first..count.min(first + size));
        lock(&parts)[part] = made;
    });
    let mut all = Vec::with_capacity(count);
    for part in lock(&parts).iter_mut() {
        all.append(&mut core::mem::take(part));
    }
    all
}

/// Calls `work` once with each item and its index, in any order. Each call may run as a separate parallel task.
pub fn for_each_mut<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    for_each_mut_at_least(1, items, work);
}

/// Calls `work` once with each item and its index, in any order. A parallel task covers at least `least` items.
pub fn for_each_mut_at_least<T: Send>(
    least: usize,
    items: &mut [T],
    work: impl Fn(usize, &mut T) + Sync,
) {
    each_of(least, items, &work);
}

/// Implements [`for_each_mut_at_least`] through a trait object.
#[inline(never)]
fn each_of<T: Send>(least: usize, items: &mut [T], work: &(dyn Fn(usize, &mut T) + Sync)) {
    let size = piece(items.len(), least);
    for_each_chunk(items, size, |chunk, items| {
        for (index, item) in (chunk * size..).zip(items) {
            work(index, item);
        }
    });
}

/// Collects the results of `change` for each item and its index, in order. A parallel task covers at least `least`
/// items.
pub fn map_mut_at_least<T: Send, U: Send>(
    least: usize,
    items: &mut [T],
    change: impl Fn(usize, &mut T) -> U + Sync,
) -> Vec<U> {
    let mut pairs: Vec<_> = items.iter_mut().map(|item| (item, None)).collect();
    for_each_mut_at_least(least, &mut pairs, |index, (item, made)| {
        *made = Some(change(index, item));
    });
    pairs.into_iter().filter_map(|(_, made)| made).collect()
}

/// Calls `work` once with each chunk of `size` values (the last one may be shorter) and its index, in any order.
///
/// # Panics
///
/// If `size` is zero.
pub fn for_each_chunk<T: Send>(
    values: &mut [T],
    size: usize,
    work: impl Fn(usize, &mut [T]) + Sync,
) {
    for_each_chunk_with(values, size, || (), |(), chunk, values| work(chunk, values));
}

/// Calls `work` once with each chunk of `size` values (the last one may be shorter), its index, and scratch memory
/// that is reused between chunks.
///
/// # Panics
///
/// If `size` is zero.
pub fn for_each_chunk_with<T: Send, S: Send>(
    values: &mut [T],
    size: usize,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize, &mut [T]) + Sync,
) {
    let chunks = values.chunks_mut(size).collect();
    consume_with(chunks, scratch, |scratch, chunk, values| {
        work(scratch, chunk, values);
    });
}

/// Calls `work` once with each item and its index, in any order.
pub fn consume<T: Send>(items: Vec<T>, work: impl Fn(usize, T) + Sync) {
    consume_with(items, || (), |(), index, item| work(index, item));
}

/// Calls `work` once with each item, its index, and scratch memory that is reused between items.
pub fn consume_with<T: Send, S: Send>(
    items: Vec<T>,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize, T) + Sync,
) {
    consume_all(items, &scratch, &work);
}

/// Implements [`consume_with`] through trait objects.
#[inline(never)]
fn consume_all<T: Send, S: Send>(
    items: Vec<T>,
    scratch: &(dyn Fn() -> S + Sync),
    work: &(dyn Fn(&mut S, usize, T) + Sync),
) {
    let (count, items, free) = (items.len(), Mutex::new(items), Mutex::new(Vec::new()));
    for_each(count, &|_| {
        let last = {
            let mut items = lock(&items);
            items.pop().map(|item| (items.len(), item))
        };
        if let Some((index, item)) = last {
            let before = lock(&free).pop();
            let mut memory = before.unwrap_or_else(scratch);
            work(&mut memory, index, item);
            lock(&free).push(memory);
        }
    });
}

/// Runs all workers concurrently, each with its index. Pass at most [`n_threads`] workers.
///
/// Workers share the work, so one that starts late may find nothing left to do.
pub fn together<W: Send>(workers: &mut [W], work: impl Fn(usize, &mut W) + Sync) {
    #[cfg(feature = "rayon")]
    if workers.len() > 1 {
        let work = &work;
        rayon::scope(|scope| {
            for (number, worker) in workers.iter_mut().enumerate() {
                scope.spawn(move |_| work(number, worker));
            }
        });
        return;
    }
    for (number, worker) in workers.iter_mut().enumerate() {
        work(number, worker);
    }
}

/// Sorts numbers in ascending order.
pub fn sort(numbers: &mut [u128]) {
    #[cfg(feature = "rayon")]
    rayon::slice::ParallelSliceMut::par_sort_unstable(numbers);
    #[cfg(not(feature = "rayon"))]
    numbers.sort_unstable();
}

/// Returns the number of items per task: at least `least`, and all `count` items on a single thread.
fn piece(count: usize, least: usize) -> usize {
    let size = match n_threads() {
        1 => count,
        threads => count.div_ceil(PIECES * threads),
    };
    size.max(least).max(1)
}

/// Locks a mutex and ignores poisoning, because rayon propagates the panic.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
