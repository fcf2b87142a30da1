//! Tests that every number, item and chunk is processed once, for any number of threads.

use super::{
    consume, for_each, for_each_chunk, for_each_chunk_with, for_each_mut, map, map_mut_at_least,
    sort,
};
use std::sync::atomic::{AtomicU32, Ordering};

/// Runs `check` on 1, 2 and 7 threads.
#[cfg(feature = "rayon")]
fn on_threads(check: impl Fn() + Sync) {
    for n in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
        pool.expect("a pool can be made").install(&check);
    }
}

#[cfg(not(feature = "rayon"))]
fn on_threads(check: impl Fn()) {
    check();
}

#[test]
fn for_each_takes_every_number_once() {
    on_threads(|| {
        for count in [0, 1, 2, 1000] {
            let seen: Vec<AtomicU32> = (0..count).map(|_| AtomicU32::new(0)).collect();
            for_each(count, &|index| {
                seen[index].fetch_add(1, Ordering::Relaxed);
            });
            assert!(
                seen.iter().all(|seen| seen.load(Ordering::Relaxed) == 1),
                "{count} numbers"
            );
        }
    });
}

#[test]
fn map_keeps_the_order_for_any_count() {
    on_threads(|| {
        for count in [0, 1, 2, 127, 128, 129, 10_000] {
            let squares: Vec<usize> = (0..count).map(|index| index * index).collect();
            assert_eq!(map(count, |index| index * index), squares);
        }
    });
}

#[test]
fn chunks_and_items_are_changed_once_each() {
    on_threads(|| {
        for count in [0, 1, 5, 1000] {
            let mut values = vec![0; count];
            for_each_chunk(&mut values, 7, |chunk, values| {
                for value in values {
                    *value += chunk;
                }
            });
            for_each_mut(&mut values, |index, value| *value += 1000 * index);
            let expected: Vec<usize> = (0..count).map(|index| 1000 * index + index / 7).collect();
            assert_eq!(values, expected);
        }
    });
}

#[test]
fn items_are_changed_and_what_that_gives_is_in_their_order() {
    on_threads(|| {
        for count in [0, 1, 5, 1000] {
            let mut values: Vec<usize> = (0..count).collect();
            let doubled = map_mut_at_least(3, &mut values, |index, value| {
                *value += 1;
                2 * index
            });
            assert_eq!(values, (1..=count).collect::<Vec<_>>());
            assert_eq!(
                doubled,
                (0..count).map(|index| 2 * index).collect::<Vec<_>>()
            );
        }
    });
}

#[test]
fn scratch_memory_is_used_again() {
    on_threads(|| {
        let made = AtomicU32::new(0);
        let scratch = || made.fetch_add(1, Ordering::Relaxed);
        for_each_chunk_with(&mut [0; 1000], 1, scratch, |_, _, _| ());
        // At most as many as there are threads.
        assert!((1..=7).contains(&made.into_inner()));
    });
}

#[test]
fn consume_gives_every_item_away() {
    on_threads(|| {
        let sum = AtomicU32::new(0);
        let items: Vec<Box<u32>> = (0..100).map(Box::new).collect();
        consume(items, |index, item| {
            assert_eq!(index as u32, *item);
            sum.fetch_add(*item, Ordering::Relaxed);
        });
        assert_eq!(sum.into_inner(), 4950);
    });
}

#[test]
fn sort_orders_numbers() {
    on_threads(|| {
        let mut numbers: Vec<u128> = (0..5000_u128)
            .map(|index| (index * 7919 % 5003) << 70)
            .collect();
        let mut sorted = numbers.clone();
        sorted.sort_unstable();
        sort(&mut numbers);
        assert_eq!(numbers, sorted);
    });
}

#[cfg(feature = "rayon")]
#[test]
#[should_panic(expected = "number 300")]
fn a_panic_reaches_the_caller() {
    on_threads(|| {
        map(1000, |index| assert!(index != 300, "number {index}"));
    });
}
