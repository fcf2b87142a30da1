//! Which feature points matter to a tile of pixels.
//!
//! A point can be among the `K` nearest of some pixel only if it is nearer to the tile than a bound. There are two:
//! the `K`-th smallest of the distances from the points to their furthest corner of the tile, which always holds and
//! is best for small tiles; and a guess, which is best for large tiles, and holds if the distances that result are
//! below it.

use super::LANES;
use super::kernel::Shortlist;
use super::table::Table;
use crate::fixed::{STEP, STEPS};
use crate::metric::Norm;
use fearless_simd::{f32x16, i32x16, mask32x16, prelude::*};

/// Where the pixels of a tile lie, in steps from the lower corner of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileBox<const N: usize> {
    pub(super) low: [i32; N],
    pub(super) high: [i32; N],
}

/// What is looked for, and where.
#[derive(Clone, Copy, Debug)]
pub(super) struct Find<'a, const N: usize> {
    pub(super) table: &'a Table<N>,
    pub(super) tile: TileBox<N>,
    /// The first and the last cell of the table that are looked at, along each axis.
    pub(super) cells: [[i32; N]; 2],
    /// The coordinates of the band's rows, along the axes from the second on.
    pub(super) lines: &'a [Vec<i32>; N],
    /// The smallest of those of the tile.
    pub(super) line_low: [i32; N],
    /// The first row of the tile, in the band.
    pub(super) first_row: usize,
    /// How many of the nearest points are needed.
    pub(super) depth: usize,
    /// The bound, as a key; if there is none, all that can matter are kept.
    pub(super) guess: Option<f32>,
}

impl<'a, const N: usize> Find<'a, N> {
    /// Looks at another table, which consists of just the cells.
    pub(super) fn move_to(&mut self, table: &'a Table<N>) {
        let [first, last] = self.cells;
        for axis in 0..N {
            self.tile.low[axis] -= first[axis] * STEPS;
            self.tile.high[axis] -= first[axis] * STEPS;
            self.cells[0][axis] = 0;
            self.cells[1][axis] = last[axis] - first[axis];
        }
        self.table = table;
    }
}

/// The points that matter to a tile, and memory to find them with.
#[derive(Debug)]
pub(super) struct Candidates<const N: usize> {
    len: usize,
    /// Their coordinates along each axis, in cells from the lower corner of the tile.
    coordinates: [Vec<f32>; N],
    /// Their ids, if the table has them.
    ids: Vec<u64>,
    /// See [`Shortlist::row_terms`].
    row_terms: Vec<f32>,
    /// All points looked at, in registers that are not always full.
    slots: [Vec<f32>; N],
    /// The smallest key that the point of a slot has in the tile; infinite if there is none.
    near: Vec<f32>,
    /// The point of the first lane of each register.
    firsts: Vec<u32>,
}

impl<const N: usize> Candidates<N> {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            coordinates: core::array::from_fn(|_| Vec::new()),
            ids: Vec::new(),
            row_terms: Vec::new(),
            slots: core::array::from_fn(|_| Vec::new()),
            near: Vec::new(),
            firsts: Vec::new(),
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Their coordinates along an axis, in cells from the lower corner of the tile, padded to a whole register.
    #[inline(always)]
    pub(super) fn coordinates(&self, axis: usize) -> &[f32] {
        &self.coordinates[axis][..self.len.next_multiple_of(LANES).max(LANES)]
    }

    /// Their ids, if they were asked for, padded to a whole register.
    pub(super) fn ids(&self) -> &[u64] {
        &self.ids
    }

    /// What the inner loop needs of them.
    pub(super) fn shortlist(&self) -> Shortlist<'_> {
        Shortlist {
            columns: &self.coordinates[0][..self.len],
            row_terms: &self.row_terms[..self.len * LANES],
        }
    }

    /// Finds the points that matter, in the order of the table.
    #[inline(always)]
    pub(super) fn find<S: Simd, M: Norm>(&mut self, simd: S, norm: M, find: &Find<'_, N>) {
        let [first, last] = find.cells;
        let columns = first[0] as usize..last[0] as usize + 1;
        let mut n_slots = 0;
        let mut far = f32x16::splat(simd, f32::INFINITY);
        let mut row = first;
        'rows: loop {
            let mut index = 0;
            for axis in (1..N).rev() {
                index = index * find.table.cells.side(axis) + row[axis] as usize;
            }
            let run = find.table.run(index, columns.clone());
            let mut start = run.start;
            while start < run.end {
                let lanes = (run.end - start).min(LANES);
                self.reserve(n_slots);
                let key = self.look(simd, norm, find, (start, lanes, n_slots));
                far = far.min(key);
                n_slots += 1;
                start += LANES;
            }
            for axis in 1..N {
                row[axis] += 1;
                if row[axis] <= last[axis] {
                    continue 'rows;
                }
                row[axis] = first[axis];
            }
            break;
        }
        let bound = match find.guess {
            Some(guess) => guess,
            None => smallest_but(find.depth - 1, far),
        };
        self.keep(simd, find.table, n_slots, bound * M::LOOSE);
        self.add_up_rows(simd, norm, find);
    }

    /// Makes room for a register in slot `slot`.
    #[inline(always)]
    fn reserve(&mut self, slot: usize) {
        if self.near.len() <= slot * LANES {
            let len = (slot + 1) * LANES * 2;
            self.near.resize(len, 0.0);
            self.firsts.resize(len, 0);
            for axis in 0..N {
                self.slots[axis].resize(len, 0.0);
                self.coordinates[axis].resize(len + LANES, 0.0);
            }
        }
    }

    /// Keeps the smallest keys of up to sixteen points, and returns the largest.
    #[inline(always)]
    fn look<S: Simd, M: Norm>(
        &mut self,
        simd: S,
        norm: M,
        find: &Find<'_, N>,
        (start, lanes, slot): (usize, usize, usize),
    ) -> f32x16<S> {
        let zero = f32x16::splat(simd, 0.0);
        let infinite = f32x16::splat(simd, f32::INFINITY);
        let at = slot * LANES;
        let [mut near_key, mut far_key] = [zero; 2];
        for axis in (0..N).rev() {
            let [low, high] = [find.tile.low[axis], find.tile.high[axis]];
            let steps = i32x16::from_slice(simd, &find.table.steps[axis][start..start + LANES]);
            let ahead = (steps - low).to_float::<f32x16<S>>() * STEP;
            ahead.store_slice(&mut self.slots[axis][at..at + LANES]);
            let past = ahead - (high - low) as f32 * STEP;
            let near = norm.terms(past.max(-ahead).max(zero));
            let far = norm.terms(ahead.max(-past));
            (near_key, far_key) = if axis == N - 1 {
                (near, far)
            } else {
                (norm.joins(near, near_key), norm.joins(far, far_key))
            };
        }
        self.firsts[slot] = start as u32;
        let is_there = mask32x16::from_bitmask(simd, u64::MAX >> (64 - lanes));
        let near_key = is_there.select(near_key, infinite);
        near_key.store_slice(&mut self.near[at..at + LANES]);
        is_there.select(far_key, infinite)
    }

    /// Keeps the points of the first `n_slots` registers whose smallest key is at most `bound`.
    #[inline(always)]
    fn keep<S: Simd>(&mut self, simd: S, table: &Table<N>, n_slots: usize, bound: f32) {
        // An infinite bound keeps what is there, and only that.
        let bound = bound.min(f32::MAX);
        let mut len = 0;
        self.ids.clear();
        for slot in 0..n_slots {
            let at = slot * LANES;
            let matters = f32x16::from_slice(simd, &self.near[at..at + LANES]).simd_le(bound);
            for axis in 0..N {
                let ahead = f32x16::from_slice(simd, &self.slots[axis][at..at + LANES]);
                let kept = &mut self.coordinates[axis][len..len + LANES];
                ahead.compress(matters).store_slice(kept);
            }
            let mut matters = matters.to_bitmask();
            len += matters.count_ones() as usize;
            while table.wants_ids && matters != 0 {
                let point = self.firsts[slot] + matters.trailing_zeros();
                self.ids.push(table.ids[point as usize]);
                matters &= matters - 1;
            }
        }
        self.len = len;
        if table.wants_ids {
            self.ids.resize(len.next_multiple_of(LANES).max(LANES), 0);
        }
    }

    /// Joins the terms of all axes but the first, for each candidate and each row.
    #[inline(always)]
    fn add_up_rows<S: Simd, M: Norm>(&mut self, simd: S, norm: M, find: &Find<'_, N>) {
        if self.row_terms.len() < self.len * LANES {
            self.row_terms
                .resize(self.len.next_power_of_two() * LANES, 0.0);
        }
        let mut rows = [f32x16::splat(simd, 0.0); N];
        for axis in 1..N {
            let steps = i32x16::from_slice(simd, &find.lines[axis][find.first_row..][..LANES]);
            let low = find.line_low[axis];
            rows[axis] = (steps - low).to_float::<f32x16<S>>() * STEP;
        }
        let terms = self.row_terms.chunks_exact_mut(LANES).take(self.len);
        for (index, terms) in terms.enumerate() {
            let mut key = norm.terms(rows[N - 1] - self.coordinates[N - 1][index]);
            for axis in (1..N - 1).rev() {
                key = norm.joins(norm.terms(rows[axis] - self.coordinates[axis][index]), key);
            }
            key.store_slice(terms);
        }
    }
}

/// The smallest number of the lanes that is left when `n` have been taken away; more, if some are equal.
///
/// Each lane holds the distance of another point, so it bounds that of the point in this place of the order.
#[inline(always)]
fn smallest_but<S: Simd>(n: usize, mut far: f32x16<S>) -> f32 {
    for _ in 0..n {
        let is_smallest = far.simd_eq(far.reduce_min());
        far = is_smallest.select(f32x16::splat(far.simd, f32::INFINITY), far);
    }
    far.reduce_min()
}
