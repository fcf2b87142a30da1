//! Tests the search against a comparison with all rows.

mod parts;

use super::*;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::simd::for_every_level;
use proptest::prelude::*;

/// Finds the nearest row by comparing with all rows (reference).
fn brute_force(dims: usize, rows: &[f32], query: &[f32], below: f32) -> Option<Match> {
    brute_force_times(dims, rows, query, below, |_| 1.0)
}

/// Finds the nearest row like [`brute_force`], with a factor for each row (reference).
fn brute_force_times(
    dims: usize,
    rows: &[f32],
    query: &[f32],
    below: f32,
    factor: impl Fn(u32) -> f32,
) -> Option<Match> {
    let mut best = None;
    let mut least = below;
    for (row, values) in (0..).zip(rows.chunks_exact(dims)) {
        let distance_sq = distance_sq(query, values) * factor(row);
        if distance_sq < least {
            least = distance_sq;
            best = Some(Match { row, distance_sq });
        }
    }
    best
}

/// Checks a query with and without bounds and hints.
fn check(matcher: &Matcher, rows: &[f32], query: &[f32], memory: &mut MatcherMemory) {
    let expected = brute_force(matcher.dims, rows, query, f32::INFINITY);
    let distance_sq = expected.map_or(1.0, |best| best.distance_sq);
    let hints = [
        None,
        Some(0),
        Some(7),
        Some(u32::MAX),
        expected.map(|best| best.row),
    ];
    for hint in hints {
        for below in [f32::INFINITY, distance_sq.next_up(), distance_sq, 0.0, -1.0] {
            let expected = expected.filter(|best| best.distance_sq < below);
            let found = matcher.nearest(query, below, hint, memory);
            assert_eq!(found, expected, "below {below}, hint {hint:?}");
        }
        let found = matcher.nearest(query, f32::NAN, hint, memory);
        assert_eq!(found, None, "nothing is below what is not a number");
    }
}

/// Returns a random number from 0 to 1 for a pair of integers.
fn random(i: usize, j: usize) -> f32 {
    unit_f32((hash2(Seed(5), [i as i64, j as i64], 0) >> 32) as u32)
}

/// Returns the color of a brick texture with smooth noise, at any position.
fn texture(x: f32, y: f32) -> [f32; 3] {
    let noise = |x: f32, y: f32| {
        let (i, j) = (x.floor(), y.floor());
        let (u, v) = (x - i, y - j);
        let at = |di: usize, dj: usize| random(i as usize + di, 1000 + j as usize + dj);
        let top = at(0, 0) + (at(1, 0) - at(0, 0)) * u;
        let bottom = at(0, 1) + (at(1, 1) - at(0, 1)) * u;
        top + (bottom - top) * v
    };
    let shift = if (y / 8.0).floor() % 2.0 == 0.0 {
        0.0
    } else {
        8.0
    };
    let mortar = y % 8.0 < 1.5 || (x + shift) % 16.0 < 1.5;
    let base = if mortar {
        [0.7, 0.7, 0.6]
    } else {
        [0.6, 0.2, 0.1]
    };
    let rough = 0.2 * noise(x / 3.0, y / 3.0) + 0.1 * noise(x, y);
    base.map(|value| value + rough)
}

/// Returns the 48 neighbors of a position, on a grid rotated and scaled by a vector (cosine and sine times a factor).
fn neighborhood(x: f32, y: f32, [cos, sin]: [f32; 2]) -> Vec<f32> {
    let mut values = Vec::new();
    for j in -3_i8..=3 {
        for i in -3_i8..=3 {
            if (i, j) != (0, 0) {
                let (i, j) = (f32::from(i), f32::from(j));
                values.extend(texture(x + cos * i - sin * j, y + sin * i + cos * j));
            }
        }
    }
    values
}

/// Returns the neighborhoods of a texture, and queries as in a synthesis: between pixels, rotated, mixed and perturbed.
fn exemplar(side: usize, n_queries: usize) -> (usize, Vec<f32>, Vec<Vec<f32>>) {
    let place = |i: usize| (4 + i) as f32;
    let rows: Vec<f32> = (0..side * side)
        .flat_map(|i| neighborhood(place(i % side), place(i / side), [1.0, 0.0]))
        .collect();
    let reach = side as f32;
    let queries = (0..n_queries).map(|i| {
        let at = |k: usize| 4.0 + reach * random(i, k);
        let mut query = neighborhood(at(0), at(1), [0.96, 0.28]);
        let other = neighborhood(at(2), at(3), [1.0, 0.0]);
        let share = 0.3 * random(i, 4);
        for (j, (value, other)) in query.iter_mut().zip(other).enumerate() {
            *value += share * (other - *value) + 0.05 * (random(i, 10 + j) - 0.5);
        }
        query
    });
    (144, rows, queries.collect())
}

#[test]
fn nearest_is_that_of_brute_force_for_neighborhoods() {
    let (dims, rows, queries) = exemplar(40, 300);
    let matcher = Matcher::new(dims, &rows);
    assert!(matcher.index.is_some(), "the index is used");
    let mut memory = MatcherMemory::default();
    for query in &queries {
        check(&matcher, &rows, query, &mut memory);
    }
    for row in rows.chunks_exact(dims).step_by(97) {
        check(&matcher, &rows, row, &mut memory);
    }
}

#[test]
fn nearest_is_the_same_at_every_level() {
    let (dims, rows, queries) = exemplar(24, 50);
    let matcher = Matcher::new(dims, &rows);
    for query in &queries {
        let expected = brute_force(dims, &rows, query, f32::INFINITY);
        for_every_level(|level| {
            let memory = &mut MatcherMemory::default();
            let query = Query {
                values: query,
                below: f32::INFINITY,
                hint: None,
                factors: None,
            };
            let found = matcher.find_at(level, query, memory);
            assert_eq!(found, expected, "{level:?}");
        });
    }
}

#[test]
fn nearest_with_factors_is_that_of_brute_force() {
    let (dims, rows, queries) = exemplar(40, 100);
    let n_rows = rows.len() / dims;
    let memory = &mut MatcherMemory::default();
    // Few rows are compared one by one; many rows have an index.
    for n_rows in [40, n_rows] {
        let rows = &rows[..n_rows * dims];
        let matcher = Matcher::with_factors(dims, rows);
        assert_eq!(matcher.index.is_some(), n_rows > 40, "the index is used");
        for (number, query) in queries.iter().enumerate() {
            // Many factors are 1, as at the beginning of a pass, and a few are about 60.
            let factor = |row: u32| {
                let over = (random(number, row as usize) - 0.5).max(0.0);
                1.0 + 1000.0 * over * over * over * over
            };
            let factors: Vec<f32> = (0..n_rows as u32).map(factor).collect();
            let expected = brute_force_times(dims, rows, query, f32::INFINITY, factor);
            let distance_sq = expected.map_or(1.0, |best| best.distance_sq);
            for below in [f32::INFINITY, distance_sq.next_up(), distance_sq] {
                let expected = expected.filter(|best| best.distance_sq < below);
                for hint in [None, Some(7), Some(u32::MAX)] {
                    let query = Query {
                        values: query,
                        below,
                        hint,
                        factors: Some(&factors),
                    };
                    let found = matcher.find(query, memory);
                    assert_eq!(found, expected, "{number}: below {below}, hint {hint:?}");
                }
            }
        }
    }
}

#[test]
fn nearest_is_the_first_of_rows_with_equal_products() {
    // All rows are at distance 1 or 2 from the query. The factors make all products 2, except for one row.
    let value = |row: usize| {
        if row.is_multiple_of(2) {
            1.0
        } else {
            2.0_f32.sqrt()
        }
    };
    let rows: Vec<f32> = (0..300).map(value).collect();
    let mut factors: Vec<f32> = rows.iter().map(|value| 2.0 / (value * value)).collect();
    let matcher = Matcher::with_factors(1, &rows);
    let memory = &mut MatcherMemory::default();
    let mut nearest = |factors: &[f32]| {
        let query = Query {
            values: &[0.0],
            below: f32::INFINITY,
            hint: Some(9),
            factors: Some(factors),
        };
        matcher.find(query, memory)
    };
    let first = brute_force_times(1, &rows, &[0.0], f32::INFINITY, |row| factors[row as usize]);
    assert_eq!(nearest(&factors), first, "the first of all");
    factors[200] = 1.0;
    assert_eq!(
        nearest(&factors).map(|best| best.row),
        Some(200),
        "one is nearer"
    );
    assert_eq!(nearest(&factors[..299]), None, "one factor is missing");
}

#[test]
fn equal_rows_are_kept_once() {
    // 37 different rows of 5 values, repeated, and another one at the end.
    let row = |at: usize| (0..5).map(move |j| random(at % 37, j));
    let rows: Vec<f32> = (0..2000)
        .flat_map(row)
        .chain(row(40).map(|value| -value))
        .collect();
    let [once, all] = [Matcher::new(5, &rows), Matcher::with_factors(5, &rows)];
    let kept = |matcher: &Matcher| {
        let mut rows = matcher.index.as_ref().unwrap().tree.rows.concat();
        rows.sort_unstable();
        rows.dedup();
        rows
    };
    assert!(
        kept(&once).into_iter().eq((0..37).chain([2000])),
        "the first of each"
    );
    assert!(kept(&all).into_iter().eq(0..2001), "all");
    let mut memory = MatcherMemory::default();
    for at in 0..100 {
        let query: Vec<f32> = (0..5).map(|j| random(at + 1000, j)).collect();
        check(&once, &rows, &query, &mut memory);
        check(&all, &rows, &query, &mut memory);
    }
}

#[test]
fn index_is_the_same_with_any_number_of_threads() {
    let (dims, rows, _) = exemplar(48, 0);
    let with = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build();
        let pool = pool.expect("a pool of a few threads can be made");
        pool.install(|| Index::new(dims, &rows, tree::every_row(dims, &rows)))
            .expect("the rows are finite")
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one.tree.rows, three.tree.rows, "order of rows");
    assert_eq!(one.tree.steps, three.tree.steps, "coordinates");
}

#[test]
fn nearest_is_that_of_brute_force_for_odd_rows() {
    let memory = &mut MatcherMemory::default();
    for (dims, n_rows) in [
        (1, 1),
        (1, 300),
        (2, 65),
        (15, 64),
        (16, 257),
        (17, 200),
        (700, 80),
        (1025, 70),
    ] {
        for variant in 0..3 {
            let value = |i: usize| match variant {
                0 => random(i, 0),
                1 => 0.25,
                _ => random(i % dims, i / dims % 5),
            };
            let rows: Vec<f32> = (0..dims * n_rows).map(value).collect();
            let matcher = Matcher::new(dims, &rows);
            let query: Vec<f32> = (0..dims).map(|i| random(i, 3)).collect();
            check(&matcher, &rows, &query, memory);
            check(&matcher, &rows, &rows[dims * (n_rows - 1)..], memory);
        }
    }
}

#[test]
fn nearest_is_nothing_without_rows() {
    let memory = &mut MatcherMemory::default();
    for (dims, rows) in [(0, &[][..]), (0, &[1.0; 500]), (3, &[]), (3, &[1.0, 2.0])] {
        let matcher = Matcher::new(dims, rows);
        let query = vec![1.0; dims];
        assert_eq!(
            matcher.nearest(&query, f32::INFINITY, Some(0), memory),
            None,
            "{dims}"
        );
    }
}

#[test]
fn nearest_is_nothing_for_bad_queries() {
    let (dims, rows, queries) = exemplar(12, 1);
    let matcher = Matcher::new(dims, &rows);
    let memory = &mut MatcherMemory::default();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut query = queries[0].clone();
        query[100] = bad;
        assert_eq!(
            matcher.nearest(&query, f32::INFINITY, Some(3), memory),
            None,
            "{bad}"
        );
    }
    assert_eq!(
        matcher.nearest(&queries[0][1..], f32::INFINITY, None, memory),
        None
    );
    assert_eq!(matcher.nearest(&[], f32::INFINITY, None, memory), None);
}

#[test]
fn value_stability_nearest() {
    let (dims, rows, queries) = exemplar(20, 4);
    let matcher = Matcher::new(dims, &rows);
    let memory = &mut MatcherMemory::default();
    let found: Vec<(u32, u32)> = queries
        .iter()
        .filter_map(|query| matcher.nearest(query, f32::INFINITY, None, memory))
        .map(|found| (found.row, found.distance_sq.to_bits()))
        .collect();
    let expected = [
        (279, 1_081_484_379),
        (384, 1_080_292_490),
        (59, 1_076_123_624),
        (93, 1_082_957_781),
    ];
    assert_eq!(found, expected);
}

proptest! {
    #[test]
    fn nearest_is_the_first_of_many_ties(
        dims in 1_usize..40,
        n_rows in 60_usize..400,
        n_levels in 1_usize..4,
        seed in 0_usize..1000,
    ) {
        let level = |i: usize| (random(seed, i) * n_levels as f32).floor();
        let rows: Vec<f32> = (0..dims * n_rows).map(level).collect();
        let matcher = Matcher::new(dims, &rows);
        let memory = &mut MatcherMemory::default();
        for query in 0..5 {
            let query: Vec<f32> = (0..dims).map(|i| 0.5 * level(100_000 + query * dims + i)).collect();
            check(&matcher, &rows, &query, memory);
        }
    }

    #[test]
    fn nearest_is_that_of_brute_force_for_any_magnitude(
        dims in 1_usize..24,
        n_rows in 60_usize..150,
        exponents in (-45_i32..39, 0_i32..12),
        bad in prop::option::of((0_usize..1000, prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::MAX, 1e30]))),
        seed in 0_usize..1000,
    ) {
        let (first, n) = exponents;
        let value = |i: usize| {
            let exponent = first + (random(seed, 2 * i) * n as f32) as i32;
            (random(seed, 2 * i + 1) - 0.5) * libm::exp10(f64::from(exponent)) as f32
        };
        let mut rows: Vec<f32> = (0..dims * n_rows).map(value).collect();
        if let Some((place, bad)) = bad {
            let place = place % rows.len();
            rows[place] = bad;
        }
        let matcher = Matcher::new(dims, &rows);
        let memory = &mut MatcherMemory::default();
        for query in 0..4 {
            let query: Vec<f32> = (0..dims).map(|i| value(100_000 + query * dims + i)).collect();
            check(&matcher, &rows, &query, memory);
        }
        check(&matcher, &rows, &rows[..dims], memory);
    }
}
