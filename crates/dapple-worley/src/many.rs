//! Many scattered positions: sixteen side by side, one in each lane.
//!
//! Every lane visits its own cell and the neighbors of that, the near ones first: along each axis, first the cell
//! itself, then the neighbor on the nearer side, then the other. A neighbor that is too far away for all lanes is left
//! out. A lane for which neighbors were not enough, or in which two distances are equal, is searched again on its own.

use crate::fixed::{Place, STEP, STEPS};
use crate::lattice::{IDS, Lattice, POSITIONS, steps};
use crate::metric::Norm;
use dapple_hash::CellHashes;
use fearless_simd::{f32x16, i32x16, mask32x16, prelude::*, u32x16};

/// The positions of a register.
pub(crate) const LANES: usize = 16;

/// Sixteen places, axis by axis.
pub(crate) struct Places<S: Simd, const N: usize> {
    /// The steps within the cells.
    steps: [i32x16<S>; N],
    /// For each axis, which neighbor is nearer: -1 or 1.
    nearer: [i32x16<S>; N],
    /// For each axis, the low and the high words of the own cell, the nearer and the other neighbor.
    words: [[[u32x16<S>; 2]; 3]; N],
}

/// The nearest points of sixteen places.
pub(crate) struct Nearest<S: Simd, const K: usize> {
    /// Their keys, smallest first.
    pub(crate) keys: [f32x16<S>; K],
    /// Which points they are: see [`code`].
    codes: [u32x16<S>; K],
    /// The lanes that hold, as bits.
    pub(crate) holds: u64,
}

/// One of the nearest points of sixteen places.
pub(crate) struct Points<const N: usize> {
    pub(crate) vector: [[f32; LANES]; N],
    pub(crate) id: [[u32; LANES]; 2],
}

impl<S: Simd, const N: usize> Places<S, N> {
    #[inline(always)]
    pub(crate) fn new(simd: S, lattice: &Lattice<N>, places: &[Place<N>; LANES]) -> Self {
        let zero = u32x16::splat(simd, 0);
        let mut result = Self {
            steps: [i32x16::splat(simd, 0); N],
            nearer: [i32x16::splat(simd, 1); N],
            words: [[[zero; 2]; 3]; N],
        };
        for axis in 0..N {
            let mut steps = [0; LANES];
            let mut nearer = [0; LANES];
            let mut words = [[[0; LANES]; 2]; 3];
            for (lane, place) in places.iter().enumerate() {
                steps[lane] = place.steps[axis];
                nearer[lane] = if place.steps[axis] < STEPS / 2 { -1 } else { 1 };
                for (words, shift) in words.iter_mut().zip([0, nearer[lane], -nearer[lane]]) {
                    let cell = lattice.wrap(axis, place.cell[axis] + i64::from(shift));
                    words[0][lane] = cell as u32;
                    words[1][lane] = (cell >> 32) as u32;
                }
            }
            result.steps[axis] = i32x16::from_slice(simd, &steps);
            result.nearer[axis] = i32x16::from_slice(simd, &nearer);
            for digit in 0..3 {
                for half in 0..2 {
                    result.words[axis][digit][half] =
                        u32x16::from_slice(simd, &words[digit][half]);
                }
            }
        }
        result
    }

    /// The `K` nearest points.
    #[inline(always)]
    pub(crate) fn nearest<M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        lattice: &Lattice<N>,
    ) -> Nearest<S, K> {
        let infinite = f32x16::splat(simd, f32::INFINITY);
        let mut keys = [infinite; K];
        let mut codes = [u32x16::splat(simd, 0); K];
        let mut ties = mask32x16::splat(simd, false);
        let gaps = self.gaps(simd, norm);
        let rows = self.rows(simd, lattice);
        for &cell in cells_by_distance::<N>() {
            let cell = u32::from(cell);
            let mut gap = gaps[N - 1][digit(cell, N - 1)];
            for axis in (0..N - 1).rev() {
                gap = norm.joins(gaps[axis][digit(cell, axis)], gap);
            }
            let matters = gap.simd_le(keys[K - 1] * M::LOOSE);
            if matters.all_false() {
                continue;
            }
            let [low, high] = self.words[0][digit(cell, 0)];
            let hashes = rows[row_index::<N>(cell)].axis(low, high);
            let counts = lattice.counts_of(simd, hashes);
            let counts = matters.select(counts, u32x16::splat(simd, 0));
            let origins = self.origins(simd, cell);
            for index in 0..counts.reduce_max() {
                let index_lanes = u32x16::splat(simd, index);
                let bits = hashes.at(u32x16::splat(simd, POSITIONS + index));
                let key = norm.keys(vector(&origins, bits, lattice.jitter));
                let key = counts.simd_gt(index_lanes).select(key, infinite);
                let code = u32x16::splat(simd, code(cell, index));
                ties = ties | insert(&mut keys, &mut codes, key, code);
            }
        }
        let is_right = (keys[K - 1] * M::LOOSE).simd_lt(self.border(simd, norm));
        Nearest {
            keys,
            codes,
            holds: is_right.to_bitmask() & !ties.to_bitmask(),
        }
    }

    /// For each axis, the terms of the distances to the own cell, the nearer and the other neighbor.
    #[inline(always)]
    fn gaps<M: Norm>(&self, simd: S, norm: M) -> [[f32x16<S>; 3]; N] {
        let zero = norm.terms(f32x16::splat(simd, 0.0));
        let mut gaps = [[zero; 3]; N];
        for axis in 0..N {
            let below = self.steps[axis];
            let above = i32x16::splat(simd, STEPS) - below;
            gaps[axis][1] = norm.terms(cells(below.min(above)));
            gaps[axis][2] = norm.terms(cells(below.max(above)));
        }
        gaps
    }

    /// Beyond the neighbors, keys are no smaller than this.
    #[inline(always)]
    fn border<M: Norm>(&self, simd: S, norm: M) -> f32x16<S> {
        let mut nearest = i32x16::splat(simd, STEPS);
        for axis in 0..N {
            let above = i32x16::splat(simd, STEPS) - self.steps[axis];
            nearest = nearest.min(self.steps[axis]).min(above);
        }
        norm.terms(cells(nearest + STEPS))
    }

    /// The hashes of the rows of cells: of all axes but the first.
    #[inline(always)]
    fn rows(&self, simd: S, lattice: &Lattice<N>) -> [CellHashes<S>; 27] {
        let mut rows = [CellHashes::splat(simd, lattice.root); 27];
        let mut n_rows = 1;
        for axis in (1..N).rev() {
            for digit in (0..3).rev() {
                let [low, high] = self.words[axis][digit];
                for row in 0..n_rows {
                    rows[digit * n_rows + row] = rows[row].axis(low, high);
                }
            }
            n_rows *= 3;
        }
        rows
    }

    /// The places, in steps from the lower corners of one of the neighbors.
    #[inline(always)]
    fn origins(&self, simd: S, cell: u32) -> [i32x16<S>; N] {
        let mut origins = self.steps;
        for axis in 0..N {
            match digit(cell, axis) {
                1 => origins[axis] -= self.nearer[axis] * i32x16::splat(simd, STEPS),
                2 => origins[axis] += self.nearer[axis] * i32x16::splat(simd, STEPS),
                _ => {}
            }
        }
        origins
    }

    /// The ways from the points of a rank to the places, and their ids.
    #[inline(always)]
    pub(crate) fn points<const K: usize>(
        &self,
        simd: S,
        lattice: &Lattice<N>,
        nearest: &Nearest<S, K>,
        rank: usize,
    ) -> Points<N> {
        let code = nearest.codes[rank];
        let mut hashes = CellHashes::splat(simd, lattice.root);
        let mut origins = self.steps;
        for axis in (0..N).rev() {
            let digit = (code >> (2 * axis as u32)) & 3;
            let [is_near, is_far] = [1, 2].map(|which| digit.simd_eq(which));
            let [own, near, far] = self.words[axis];
            let low = is_near.select(near[0], is_far.select(far[0], own[0]));
            let high = is_near.select(near[1], is_far.select(far[1], own[1]));
            hashes = hashes.axis(low, high);
            let shift = self.nearer[axis] * i32x16::splat(simd, STEPS);
            let zero = i32x16::splat(simd, 0);
            origins[axis] -= is_near.select(shift, is_far.select(zero - shift, zero));
        }
        let index = code >> INDEX_SHIFT;
        let bits = hashes.at(index + POSITIONS);
        let ways = vector(&origins, bits, lattice.jitter);
        let mut points = Points {
            vector: [[0.0; LANES]; N],
            id: [[0; LANES]; 2],
        };
        for axis in 0..N {
            ways[axis].store_slice(&mut points.vector[axis]);
        }
        let [high, low] = hashes.at(index + IDS);
        low.store_slice(&mut points.id[0]);
        high.store_slice(&mut points.id[1]);
        points
    }
}

impl<const N: usize> Lattice<N> {
    /// How many points each of sixteen cells has.
    #[inline(always)]
    pub(crate) fn counts_of<S: Simd>(&self, simd: S, hashes: CellHashes<S>) -> u32x16<S> {
        let mut counts = u32x16::splat(simd, self.counts.least());
        if self.counts.thresholds().is_empty() {
            return counts;
        }
        let [bits, _] = hashes.at(u32x16::splat(simd, 0));
        let one = u32x16::splat(simd, 1);
        for &threshold in self.counts.thresholds() {
            counts = bits.simd_ge(threshold).select(counts + one, counts);
        }
        counts
    }
}

/// Where the index of a point begins in its code.
const INDEX_SHIFT: u32 = 8;

/// What a point is known by among the neighbors: two bits for each axis, 0 for the own cell, 1 for the nearer neighbor,
/// 2 for the other; and its index in its cell.
#[inline(always)]
fn code(cell: u32, index: u32) -> u32 {
    cell | index << INDEX_SHIFT
}

/// Which neighbor it is along an axis.
#[inline(always)]
fn digit(cell: u32, axis: usize) -> usize {
    (cell >> (2 * axis) & 3) as usize
}

/// The row of a cell in [`Places::rows`].
#[inline(always)]
fn row_index<const N: usize>(cell: u32) -> usize {
    (1..N).fold(0, |index, axis| index * 3 + digit(cell, axis))
}

/// The own cell and its neighbors, those that are nearer on average first.
fn cells_by_distance<const N: usize>() -> &'static [u8] {
    const TWO: [u8; 9] = sorted_cells(2);
    const THREE: [u8; 27] = sorted_cells(3);
    const FOUR: [u8; 81] = sorted_cells(4);
    match N {
        2 => &TWO,
        3 => &THREE,
        _ => &FOUR,
    }
}

/// All cells with these axes, in the order of the mean of their squared distance.
const fn sorted_cells<const LEN: usize>(n_axes: u32) -> [u8; LEN] {
    let mut cells = [0; LEN];
    let mut len = 0;
    let mut wanted = 0;
    // The mean squares of the distances to the nearer and to the other neighbor, 1/12 and 7/12, are as 1 to 7.
    while len < LEN {
        let mut cell = 0_u32;
        while cell < 1 << (2 * n_axes) {
            let mut distance = 0;
            let mut axis = 0;
            while axis < n_axes {
                distance += [0, 1, 7, 1000][(cell >> (2 * axis) & 3) as usize];
                axis += 1;
            }
            if distance == wanted {
                cells[len] = cell as u8;
                len += 1;
            }
            cell += 1;
        }
        wanted += 1;
    }
    cells
}

/// Steps as cells. Differences within the neighbors are below 8 cells, so nothing is rounded.
#[inline(always)]
fn cells<S: Simd>(steps: i32x16<S>) -> f32x16<S> {
    steps.to_float::<f32x16<S>>() * STEP
}

/// The ways from points to places, in cells.
#[inline(always)]
fn vector<S: Simd, const N: usize>(
    origins: &[i32x16<S>; N],
    bits: [u32x16<S>; 2],
    jitter: u32,
) -> [f32x16<S>; N] {
    let points: [u32x16<S>; N] = steps(bits, jitter);
    let mut vector = [cells(origins[0]); N];
    for axis in 0..N {
        vector[axis] = cells(origins[axis] - points[axis].bitcast::<i32x16<S>>());
    }
    vector
}

/// Takes in one more point, and tells which lanes had one at the same distance.
#[inline(always)]
fn insert<S: Simd, const K: usize>(
    keys: &mut [f32x16<S>; K],
    codes: &mut [u32x16<S>; K],
    key: f32x16<S>,
    code: u32x16<S>,
) -> mask32x16<S> {
    let simd = key.simd;
    let mut is_tie = mask32x16::splat(simd, false);
    let mut is_nearer = [is_tie; K];
    for rank in 0..K {
        is_nearer[rank] = key.simd_lt(keys[rank]);
        is_tie = is_tie | key.simd_eq(keys[rank]);
    }
    for rank in (1..K).rev() {
        let [moves, enters] = [is_nearer[rank - 1], is_nearer[rank]];
        keys[rank] = moves.select(keys[rank - 1], enters.select(key, keys[rank]));
        codes[rank] = moves.select(codes[rank - 1], enters.select(code, codes[rank]));
    }
    keys[0] = is_nearer[0].select(key, keys[0]);
    codes[0] = is_nearer[0].select(code, codes[0]);
    is_tie & key.simd_lt(f32::INFINITY)
}
