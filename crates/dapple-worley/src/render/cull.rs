//! Which feature points matter to a tile of pixels.
//!
//! A point can be among the `K` nearest of some pixel only if it is nearer to the tile than a bound. There are two:
//! the `K`-th smallest of the distances from the points to their furthest corner of the tile, which always holds and
//! is best for small tiles; and a guess, which is best for large tiles, and holds if the distances that result are
//! below it.

use crate::fixed::{STEP, STEP_BITS, STEPS};
use crate::metric::Norm;
use crate::render::LANES;
use crate::render::table::Table;
use fearless_simd::{f32x16, i32x16, mask32x16, prelude::*, u32x16};

/// Where the pixels of a tile lie, in steps from the lower corner of a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileBox<const N: usize> {
    pub(crate) low: [i32; N],
    pub(crate) high: [i32; N],
}

impl<const N: usize> TileBox<N> {
    /// The cells of the table within `ring` cells of those that the tile touches, as the first and the last along each
    /// axis. May reach past the table.
    #[inline(always)]
    pub(crate) fn cells(&self, ring: i32) -> [[i32; N]; 2] {
        [
            self.low.map(|low| (low >> STEP_BITS) - ring),
            self.high.map(|high| (high >> STEP_BITS) + ring),
        ]
    }

    /// How far it is from the tile to the nearest place outside of these cells, in steps.
    #[inline(always)]
    pub(crate) fn border(&self, [first, last]: [[i32; N]; 2]) -> i32 {
        let mut border = i32::MAX;
        for axis in 0..N {
            border = border
                .min(self.low[axis] - first[axis] * STEPS)
                .min((last[axis] + 1) * STEPS - self.high[axis]);
        }
        border
    }
}

/// The points that matter to a tile, relative to its lower corner, and memory to find them with.
#[derive(Debug)]
pub(crate) struct Candidates<const N: usize> {
    /// How many there are.
    pub(crate) len: usize,
    /// Their coordinates along each axis, in cells.
    pub(crate) coordinates: [Vec<f32>; N],
    /// Their indices in the table.
    pub(crate) points: Vec<u32>,
    /// All points looked at, in registers that are not always full.
    slots: [Vec<f32>; N],
    /// The smallest key that the point of a slot has in the tile; infinite if there is none.
    near: Vec<f32>,
    /// The point of the first lane of each register.
    firsts: Vec<u32>,
}

impl<const N: usize> Candidates<N> {
    pub(crate) fn new() -> Self {
        Self {
            len: 0,
            coordinates: core::array::from_fn(|_| Vec::new()),
            points: Vec::new(),
            slots: core::array::from_fn(|_| Vec::new()),
            near: Vec::new(),
            firsts: Vec::new(),
        }
    }

    /// Finds the points that matter to `tile`, among those of the cells from `first` to `last` of the table.
    ///
    /// With a `guess` (a key), those whose smallest key is at most that; without, all that can be among the `K` nearest.
    /// They come in the order of the table.
    #[inline(always)]
    pub(crate) fn find<S: Simd, M: Norm, const K: usize>(
        &mut self,
        simd: S,
        norm: M,
        table: &Table<N>,
        (tile, [first, last]): (&TileBox<N>, [[i32; N]; 2]),
        guess: Option<f32>,
    ) {
        let columns = first[0] as usize..last[0] as usize + 1;
        let mut slot = 0;
        let mut far = [f32x16::splat(simd, f32::INFINITY); K];
        let mut row = first;
        loop {
            let mut index = 0;
            for axis in (1..N).rev() {
                index = index * table.cells.side(axis) + row[axis] as usize;
            }
            let run = table.run(index, columns.clone());
            let mut start = run.start;
            while start < run.end {
                self.reserve(slot);
                let lanes = run.end - start;
                self.look(simd, norm, table, (tile, start, lanes, slot), (&mut far, guess.is_none()));
                slot += 1;
                start += LANES;
            }
            let mut axis = 1;
            loop {
                if axis == N {
                    let bound = match guess {
                        Some(guess) => guess,
                        None => last_of_least(far),
                    };
                    self.keep(simd, slot, bound * M::LOOSE);
                    return;
                }
                row[axis] += 1;
                if row[axis] <= last[axis] {
                    break;
                }
                row[axis] = first[axis];
                axis += 1;
            }
        }
    }

    /// Makes room for a register in slot `slot`.
    #[inline(always)]
    fn reserve(&mut self, slot: usize) {
        if self.near.len() <= slot * LANES {
            let len = (slot + 1) * LANES * 2;
            self.near.resize(len, 0.0);
            self.firsts.resize(len, 0);
            self.points.resize(len + LANES, 0);
            for axis in 0..N {
                self.slots[axis].resize(len, 0.0);
                self.coordinates[axis].resize(len + LANES, 0.0);
            }
        }
    }

    /// Computes the smallest and largest keys of up to sixteen points.
    #[inline(always)]
    fn look<S: Simd, M: Norm, const K: usize>(
        &mut self,
        simd: S,
        norm: M,
        table: &Table<N>,
        (tile, start, lanes, slot): (&TileBox<N>, usize, usize, usize),
        (far, wants_far): (&mut [f32x16<S>; K], bool),
    ) {
        let zero = f32x16::splat(simd, 0.0);
        let infinite = f32x16::splat(simd, f32::INFINITY);
        let at = slot * LANES;
        let [mut near_key, mut far_key] = [zero; 2];
        for axis in (0..N).rev() {
            let steps = i32x16::from_slice(simd, &table.steps[axis][start..start + LANES]);
            let ahead = (steps - tile.low[axis]).to_float::<f32x16<S>>() * STEP;
            let extent = (tile.high[axis] - tile.low[axis]) as f32 * STEP;
            ahead.store_slice(&mut self.slots[axis][at..at + LANES]);
            let past = ahead - extent;
            let near = norm.terms(past.max(-ahead).max(zero));
            near_key = if axis == N - 1 { near } else { norm.joins(near, near_key) };
            if wants_far {
                let far = norm.terms(ahead.max(-past));
                far_key = if axis == N - 1 { far } else { norm.joins(far, far_key) };
            }
        }
        let is_there = mask32x16::from_bitmask(simd, u64::MAX >> (64 - lanes.min(LANES)));
        is_there.select(near_key, infinite).store_slice(&mut self.near[at..at + LANES]);
        self.firsts[slot] = start as u32;
        if wants_far {
            let mut key = is_there.select(far_key, infinite);
            for least in far {
                let larger = key.max(*least);
                *least = key.min(*least);
                key = larger;
            }
        }
    }

    /// Keeps the points of the first `n_slots` registers whose smallest key is at most `bound`.
    #[inline(always)]
    fn keep<S: Simd>(&mut self, simd: S, n_slots: usize, bound: f32) {
        let ascending = u32x16::from_slice(simd, &ASCENDING);
        let mut len = 0;
        for slot in 0..n_slots {
            let at = slot * LANES;
            let near = f32x16::from_slice(simd, &self.near[at..at + LANES]);
            // An infinite bound keeps what is there, and only that.
            let matters = near.simd_le(bound.min(f32::MAX));
            for axis in 0..N {
                let ahead = f32x16::from_slice(simd, &self.slots[axis][at..at + LANES]);
                ahead.compress(matters).store_slice(&mut self.coordinates[axis][len..len + LANES]);
            }
            let points = ascending + self.firsts[slot];
            points.compress(matters).store_slice(&mut self.points[len..len + LANES]);
            len += matters.to_bitmask().count_ones() as usize;
        }
        self.len = len;
    }
}

/// The numbers of the lanes.
const ASCENDING: [u32; LANES] = {
    let mut numbers = [0; LANES];
    let mut lane = 0;
    while lane < LANES {
        numbers[lane] = lane as u32;
        lane += 1;
    }
    numbers
};

/// The `K`-th smallest number of registers in which each lane holds its `K` smallest in order, or a larger one of them
/// if some are equal.
#[inline(always)]
fn last_of_least<S: Simd, const K: usize>(mut least: [f32x16<S>; K]) -> f32 {
    for _ in 1..K {
        let smallest = least[0].reduce_min();
        let taken = least[0].simd_eq(smallest);
        for rank in 1..K {
            least[rank - 1] = taken.select(least[rank], least[rank - 1]);
        }
        least[K - 1] = taken.select(f32x16::splat(least[0].simd, f32::INFINITY), least[K - 1]);
    }
    least[0].reduce_min()
}
