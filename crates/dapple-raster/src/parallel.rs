//! Work on all cores where the feature `rayon` is on, and one piece after the other where it is not.
//!
//! Every piece is computed on its own and put where it belongs, so that the bits do not depend on the number of
//! threads. This is the only place that uses `rayon`. Its code and that of iterators is large and compiled anew for every
//! closure, which is optimized again in each of their functions. So closures are called through references to trait
//! objects: a call costs about a nanosecond, and all that is around it is compiled once for each type of values.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// The largest number of pieces for each thread: enough that no thread waits long for another.
const PIECES: usize = 64;

/// The number of threads that can work at once: 1 where the feature `rayon` is off.
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

/// The results of `make` for the numbers below `count`, in their order; each call is worth a task of its own.
pub fn map<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync) -> Vec<T> {
    map_at_least(1, count, make)
}

/// The results of `make` for the numbers below `count`, in their order; `least` calls together are worth a task.
pub fn map_at_least<T: Send>(
    least: usize,
    count: usize,
    make: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    all_of(least, count, &make)
}

/// What [`map_at_least`] returns, by one call of a closure for each number.
#[inline(never)]
fn all_of<T: Send>(least: usize, count: usize, make: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    map_parts(least, count, &|part| part.map(make).collect())
}

/// The results of `make` for ranges of the numbers below `count`, one after the other; `least` numbers together are
/// worth a task.
///
/// On one thread there is one range: `make` is called in one way only, so that it is compiled once.
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

/// Calls `work` once with each of some items and its number, in any order; each is worth a task of its own.
pub fn for_each_mut<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    for_each_mut_at_least(1, items, work);
}

/// Calls `work` once with each of some items and its number, in any order; `least` items together are worth a task.
pub fn for_each_mut_at_least<T: Send>(
    least: usize,
    items: &mut [T],
    work: impl Fn(usize, &mut T) + Sync,
) {
    each_of(least, items, &work);
}

/// What [`for_each_mut_at_least`] does, by one call of a closure for each item.
#[inline(never)]
fn each_of<T: Send>(least: usize, items: &mut [T], work: &(dyn Fn(usize, &mut T) + Sync)) {
    let size = piece(items.len(), least);
    for_each_chunk(items, size, |chunk, items| {
        for (index, item) in (chunk * size..).zip(items) {
            work(index, item);
        }
    });
}

/// The results of `change` for some items and their numbers, in their order; `least` items together are worth a task.
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

/// Calls `work` once with each chunk of `size` values (the last one may be shorter) and its number, in any order.
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

/// Calls `work` once with each chunk of `size` values (the last one may be shorter), its number, and scratch memory
/// that a thread keeps from one chunk to the next.
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

/// Calls `work` once with each of some items and its number, in any order.
pub fn consume<T: Send>(items: Vec<T>, work: impl Fn(usize, T) + Sync) {
    consume_with(items, || (), |(), index, item| work(index, item));
}

/// Calls `work` once with each of some items, its number, and scratch memory that a thread keeps from one item to the
/// next.
pub fn consume_with<T: Send, S: Send>(
    items: Vec<T>,
    scratch: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize, T) + Sync,
) {
    consume_all(items, &scratch, &work);
}

/// What [`consume_with`] does, by one call of a closure for each item.
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

/// Lets all workers work at the same time, each with its number; there are at most [`n_threads`] of them.
///
/// A thread that comes late may find that the others have done all of it.
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

/// Sorts numbers, ascending.
pub fn sort(numbers: &mut [u128]) {
    #[cfg(feature = "rayon")]
    rayon::slice::ParallelSliceMut::par_sort_unstable(numbers);
    #[cfg(not(feature = "rayon"))]
    numbers.sort_unstable();
}

/// How many of `count` items make one task: never fewer than `least`, and all of them on one thread.
fn piece(count: usize, least: usize) -> usize {
    let size = match n_threads() {
        1 => count,
        threads => count.div_ceil(PIECES * threads),
    };
    size.max(least).max(1)
}

/// Locks a mutex, whether or not a thread panicked while it held the lock: rayon passes the panic on.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
