//! Many scattered positions: sixteen side by side, one in each lane.
//!
//! Every lane visits its own cell and the neighbors of that, the near ones first: along each axis, first the cell
//! itself, then the neighbor on the nearer side, then the other. A neighbor that is too far away for all lanes is left
//! out.
//!
//! While searching, the low bits of a key hold which point it belongs to, so that one minimum and one maximum sort both
//! at once. The order of two points whose keys agree in the other bits is not known then. A lane that has such points,
//! or for which neighbors are not enough, does not hold, and is searched again on its own.

use crate::fixed::{STEP, STEPS, split};
use crate::lattice::{IDS, Lattice, SixteenCells};
use crate::metric::Norm;
use dapple_hash::CellHashes;
use fearless_simd::{f32x16, f64x8, i32x16, prelude::*, u32x16, u64x8};

/// The positions of a register.
pub(crate) const LANES: usize = 16;

/// The low and the high word of sixteen whole numbers.
type Words<S> = [u32x16<S>; 2];

/// Sixteen places, axis by axis.
pub(crate) struct Places<S: Simd, const N: usize> {
    /// The steps within the cells.
    steps: [i32x16<S>; N],
    /// For each axis, which neighbor is nearer: -1 or 1.
    nearer: [i32x16<S>; N],
    /// For each axis, the own cell, the nearer and the other neighbor.
    cells: [[Words<S>; 3]; N],
}

/// The nearest points of sixteen places.
pub(crate) struct Nearest<S: Simd, const K: usize> {
    /// Which points they are, nearest first: see [`INDEX_SHIFT`].
    codes: [u32x16<S>; K],
    /// The lanes that hold, as bits.
    pub(crate) holds: u64,
}

/// One of the nearest points of sixteen places.
pub(crate) struct Points<S: Simd, const N: usize> {
    /// The ways from the points to the places, in cells.
    pub(crate) vectors: [f32x16<S>; N],
    /// The low and the high words of their ids.
    pub(crate) ids: Words<S>,
}

/// The key of no point: the largest number. (Infinity with a code in its low bits would not be a number.)
pub(crate) const NOTHING: u32 = f32::MAX.to_bits();

/// `f64` has whole numbers only between this and twice this, and their difference from this is in the low bits.
const WHOLE: f64 = (3_u64 << 51) as f64;

impl<S: Simd, const N: usize> Places<S, N> {
    /// The places of sixteen positions, axis by axis; those that have none get any, and are not told apart.
    #[inline(always)]
    pub(crate) fn new(simd: S, lattice: &Lattice<N>, positions: &[[f64; LANES]; N]) -> Self {
        let zero = u32x16::splat(simd, 0);
        let mut places = Self {
            steps: [i32x16::splat(simd, 0); N],
            nearer: [i32x16::splat(simd, 1); N],
            cells: [[[zero; 2]; 3]; N],
        };
        for axis in 0..N {
            let (cell, steps) = split_lanes(simd, &positions[axis]);
            let is_low = steps.simd_lt(STEPS / 2);
            let [one, minus_one] = [1, -1].map(|shift| i32x16::splat(simd, shift));
            let nearer = is_low.select(minus_one, one);
            places.steps[axis] = steps;
            places.nearer[axis] = nearer;
            let [below, above] = [previous(cell), next(cell)];
            let [mut near, mut far] = [cell; 2];
            for half in 0..2 {
                near[half] = is_low.select(below[half], above[half]);
                far[half] = is_low.select(above[half], below[half]);
            }
            places.cells[axis] = [cell, near, far];
            if lattice.period[axis] > 0 {
                for cell in &mut places.cells[axis] {
                    *cell = wrap(lattice, axis, *cell);
                }
            }
        }
        places
    }

    /// The `K` nearest points.
    #[inline(always)]
    pub(crate) fn nearest<M: Norm, const K: usize>(
        &self,
        simd: S,
        norm: M,
        lattice: &Lattice<N>,
    ) -> Nearest<S, K> {
        let mut best = [u32x16::splat(simd, NOTHING); K];
        let mut next = u32x16::splat(simd, NOTHING);
        let index_bits = u32::BITS - lattice.counts.range().end().leading_zeros();
        let code_mask = (1 << (2 * N as u32 + index_bits)) - 1;
        let gaps = self.gaps(simd, norm);
        let rows = self.rows(simd, lattice);
        for &cell in cells_by_distance::<N>() {
            let cell = u32::from(cell);
            let mut gap = gaps[N - 1][digit(cell, N - 1)];
            for axis in (0..N - 1).rev() {
                gap = norm.joins(gaps[axis][digit(cell, axis)], gap);
            }
            let reach = (best[K - 1] | code_mask).bitcast::<f32x16<S>>();
            let matters = gap.simd_le(reach);
            if matters.all_false() {
                continue;
            }
            let [low, high] = self.cells[0][digit(cell, 0)];
            let hashes = rows[row_index::<N>(cell)].axis(low, high);
            let cells = SixteenCells::new(simd, lattice, hashes);
            let counts = matters.select(cells.counts, u32x16::splat(simd, 0));
            let origins = self.origins(simd, cell);
            for index in 0..counts.reduce_max() {
                let index_lanes = u32x16::splat(simd, index);
                let points: [_; N] = cells.steps(index_lanes, lattice.jitter);
                let mut vector = [gap; N];
                for axis in 0..N {
                    let ahead = origins[axis] - points[axis].bitcast::<i32x16<S>>();
                    vector[axis] = ahead.to_float();
                }
                let key = norm.keys(vector).bitcast::<u32x16<S>>();
                let coded = (key & !code_mask) | (cell << index_bits | index);
                let is_there = counts.simd_gt(index_lanes);
                let mut coded = is_there.select(coded, u32x16::splat(simd, NOTHING));
                for best in &mut best {
                    let larger = best.max(coded);
                    *best = best.min(coded);
                    coded = larger;
                }
                next = next.min(coded);
            }
        }
        let is_last = (best[K - 1] | code_mask).bitcast::<f32x16<S>>();
        let mut holds = is_last.simd_lt(self.border(simd, norm));
        for rank in 0..K {
            let after = if rank + 1 < K { best[rank + 1] } else { next };
            holds &= (best[rank] | code_mask).simd_lt(after | code_mask);
        }
        for code in &mut best {
            let index = *code & ((1 << index_bits) - 1);
            *code = (*code & code_mask) >> index_bits | index << INDEX_SHIFT;
        }
        Nearest {
            codes: best,
            holds: holds.to_bitmask(),
        }
    }

    /// For each axis, the terms of the distances to the own cell, the nearer and the other neighbor, in steps.
    #[inline(always)]
    fn gaps<M: Norm>(&self, simd: S, norm: M) -> [[f32x16<S>; 3]; N] {
        let mut gaps = [[f32x16::splat(simd, 0.0); 3]; N];
        for axis in 0..N {
            let below = self.steps[axis];
            let above = i32x16::splat(simd, STEPS) - below;
            gaps[axis][1] = norm.terms(below.min(above).to_float());
            gaps[axis][2] = norm.terms(below.max(above).to_float());
        }
        gaps
    }

    /// Beyond the neighbors, keys are no smaller than this, in steps.
    #[inline(always)]
    fn border<M: Norm>(&self, simd: S, norm: M) -> f32x16<S> {
        let mut nearest = i32x16::splat(simd, STEPS);
        for axis in 0..N {
            let above = i32x16::splat(simd, STEPS) - self.steps[axis];
            nearest = nearest.min(self.steps[axis]).min(above);
        }
        norm.terms((nearest + STEPS).to_float())
    }

    /// The hashes of the rows of cells: of all axes but the first.
    #[inline(always)]
    fn rows(&self, simd: S, lattice: &Lattice<N>) -> [CellHashes<S>; 27] {
        let mut rows = [CellHashes::splat(simd, lattice.root); 27];
        let mut n_rows = 1;
        for axis in (1..N).rev() {
            for digit in (0..3).rev() {
                let [low, high] = self.cells[axis][digit];
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
            let shift = self.nearer[axis] * i32x16::splat(simd, STEPS);
            match digit(cell, axis) {
                1 => origins[axis] -= shift,
                2 => origins[axis] += shift,
                _ => {}
            }
        }
        origins
    }

    /// The points of a rank.
    #[inline(always)]
    pub(crate) fn points<const K: usize>(
        &self,
        simd: S,
        lattice: &Lattice<N>,
        nearest: &Nearest<S, K>,
        rank: usize,
    ) -> Points<S, N> {
        let code = nearest.codes[rank];
        let mut hashes = CellHashes::splat(simd, lattice.root);
        let mut origins = self.steps;
        for axis in (0..N).rev() {
            let digit = (code >> (2 * axis as u32)) & 3;
            let [is_near, is_far] = [1, 2].map(|which| digit.simd_eq(which));
            let [own, near, far] = self.cells[axis];
            let low = is_near.select(near[0], is_far.select(far[0], own[0]));
            let high = is_near.select(near[1], is_far.select(far[1], own[1]));
            hashes = hashes.axis(low, high);
            let shift = self.nearer[axis] * i32x16::splat(simd, STEPS);
            let zero = i32x16::splat(simd, 0);
            origins[axis] -= is_near.select(shift, is_far.select(zero - shift, zero));
        }
        let index = code >> INDEX_SHIFT;
        let points: [_; N] = SixteenCells::new(simd, lattice, hashes).steps(index, lattice.jitter);
        let mut vectors = [f32x16::splat(simd, 0.0); N];
        for axis in 0..N {
            let ahead = origins[axis] - points[axis].bitcast::<i32x16<S>>();
            vectors[axis] = ahead.to_float::<f32x16<S>>() * STEP;
        }
        let [high, low] = hashes.at(index + IDS);
        Points {
            vectors,
            ids: [low, high],
        }
    }
}

/// The cells of sixteen coordinates, and the steps from their lower edges: as [`split`].
#[inline(always)]
fn split_lanes<S: Simd>(simd: S, coordinates: &[f64; LANES]) -> (Words<S>, i32x16<S>) {
    let halves = [&coordinates[..8], &coordinates[8..]].map(|half| f64x8::from_slice(simd, half));
    let is_near = |half: f64x8<S>| half.abs().simd_lt(WHOLE / 4.0).all_true();
    if !(is_near(halves[0]) && is_near(halves[1])) {
        return split_each(simd, coordinates);
    }
    let mut cells = [u32x16::splat(simd, 0); 2];
    let mut steps = halves;
    for half in 0..2 {
        let floor = halves[half].floor();
        steps[half] = ((halves[half] - floor) * f64::from(STEPS)).floor();
        let whole = (floor + WHOLE).bitcast::<u64x8<S>>() - WHOLE.to_bits();
        cells[half] = whole.bitcast();
    }
    let [a, b] = cells;
    let steps: i32x16<S> = steps[0].narrow(steps[1]).to_int();
    // Just below a whole number the difference can be rounded up to a whole cell.
    let carries = steps.simd_eq(STEPS);
    let cell = [a.unzip_low(b), a.unzip_high(b)];
    let [low, high] = next(cell);
    let cell = [carries.select(low, cell[0]), carries.select(high, cell[1])];
    (cell, carries.select(i32x16::splat(simd, 0), steps))
}

/// The same one by one, for coordinates that are very large, or not finite.
#[inline(never)]
fn split_each<S: Simd>(simd: S, coordinates: &[f64; LANES]) -> (Words<S>, i32x16<S>) {
    let mut words = [[0; LANES]; 2];
    let mut steps = [0; LANES];
    for (lane, &coordinate) in coordinates.iter().enumerate() {
        let (cell, within) = split(coordinate).unwrap_or((0, 0));
        (words[0][lane], words[1][lane]) = (cell as u32, (cell >> 32) as u32);
        steps[lane] = within;
    }
    let [low, high] = words;
    let words = [
        u32x16::from_slice(simd, &low),
        u32x16::from_slice(simd, &high),
    ];
    (words, i32x16::from_slice(simd, &steps))
}

/// The next cells.
#[inline(always)]
fn next<S: Simd>([low, high]: Words<S>) -> Words<S> {
    let next = low + 1;
    let carries = next.simd_eq(0);
    [next, carries.select(high + 1, high)]
}

/// The cells before.
#[inline(always)]
fn previous<S: Simd>([low, high]: Words<S>) -> Words<S> {
    let borrows = low.simd_eq(0);
    [low - 1, borrows.select(high - 1, high)]
}

/// The cells that cells repeat.
#[inline(never)]
fn wrap<S: Simd, const N: usize>(
    lattice: &Lattice<N>,
    axis: usize,
    [mut low, mut high]: Words<S>,
) -> Words<S> {
    for lane in 0..LANES {
        let cell = i64::from(high[lane].cast_signed()) << 32 | i64::from(low[lane]);
        let cell = lattice.wrap(axis, cell);
        (low[lane], high[lane]) = (cell as u32, (cell >> 32) as u32);
    }
    [low, high]
}

/// Where the index of a point begins in its code; below are two bits for each axis, 0 for the own cell, 1 for the
/// nearer neighbor, 2 for the other.
const INDEX_SHIFT: u32 = 8;

/// Which neighbor it is along an axis.
#[inline(always)]
pub(crate) fn digit(cell: u32, axis: usize) -> usize {
    (cell >> (2 * axis) & 3) as usize
}

/// The row of a cell in [`Places::rows`].
#[inline(always)]
fn row_index<const N: usize>(cell: u32) -> usize {
    (1..N).fold(0, |index, axis| index * 3 + digit(cell, axis))
}

/// The own cell and its neighbors, those that are nearer on average first.
pub(crate) fn cells_by_distance<const N: usize>() -> &'static [u8] {
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
