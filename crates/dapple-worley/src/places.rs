//! Sixteen fixed-point positions, one in each lane, and the neighbors of their cells.
//!
//! The code of a neighbor has two bits for each axis: 0 for the own cell, 1 for the adjacent cell on the nearer side,
//! 2 for the adjacent cell on the farther side.

use crate::fixed::{STEPS, WHOLE, split};
use crate::lattice::{Lattice, both, parts_each};
use fearless_simd::{f64x8, i32x16, prelude::*, u32x16, u64x8};

/// Number of positions in a register.
pub(crate) const LANES: usize = 16;

/// The low and the high words of sixteen 64-bit integers.
pub(crate) type Words<S> = [u32x16<S>; 2];

/// Sixteen fixed-point positions, axis by axis.
#[derive(Clone, Copy)]
pub(crate) struct Places<S: Simd, const N: usize> {
    /// Cells of the positions.
    pub(crate) cells: [Words<S>; N],
    /// Steps of the positions from the lower corners of their cells.
    pub(crate) steps: [i32x16<S>; N],
}

/// One cell for each of sixteen positions, such as a neighbor.
#[derive(Clone, Copy)]
pub(crate) struct Cells<S: Simd, const N: usize> {
    /// Hash words of the cells.
    pub(crate) words: Words<S>,
    /// Coordinates of the positions, in steps from the lower corners of the cells.
    pub(crate) origins: [i32x16<S>; N],
}

impl<S: Simd, const N: usize> Places<S, N> {
    /// Converts sixteen positions, the elements of `register`, to fixed point. Also returns a bit mask of the
    /// positions that are in range; the lanes of other positions are undefined.
    #[inline(always)]
    pub(crate) fn new<const LEN: usize>(
        simd: S,
        positions: &[[f64; LEN]; N],
        register: usize,
    ) -> (Self, u64) {
        let mut places = Self {
            cells: [[u32x16::splat(simd, 0); 2]; N],
            steps: [i32x16::splat(simd, 0); N],
        };
        let mut has_place = u64::MAX >> (64 - LANES);
        for axis in 0..N {
            let coordinates = &positions[axis].as_chunks().0[register];
            let splittable;
            (places.cells[axis], places.steps[axis], splittable) = split_lanes(simd, coordinates);
            has_place &= splittable;
        }
        (places, has_place)
    }

    /// Loads a register of fixed-point positions from memory.
    #[inline(always)]
    pub(crate) fn load<const LEN: usize>(
        simd: S,
        cells: &[[[u32; LEN]; 2]; N],
        steps: &[[i32; LEN]; N],
        register: usize,
    ) -> Self {
        let mut places = Self {
            cells: [[u32x16::splat(simd, 0); 2]; N],
            steps: [i32x16::splat(simd, 0); N],
        };
        for axis in 0..N {
            for half in 0..2 {
                places.cells[axis][half] = load(simd, &cells[axis][half], register);
            }
            places.steps[axis] =
                i32x16::from_slice(simd, &steps[axis][register * LANES..][..LANES]);
        }
        places
    }

    #[inline(always)]
    pub(crate) fn store<const LEN: usize>(
        &self,
        cells: &mut [[[u32; LEN]; 2]; N],
        steps: &mut [[i32; LEN]; N],
        register: usize,
    ) {
        for axis in 0..N {
            for half in 0..2 {
                store(self.cells[axis][half], &mut cells[axis][half], register);
            }
            self.steps[axis].store_slice(&mut steps[axis][register * LANES..][..LANES]);
        }
    }

    /// Returns the direction along an axis to the nearer neighboring cell: -1 or 1.
    #[inline(always)]
    pub(crate) fn nearer(&self, simd: S, axis: usize) -> i32x16<S> {
        let [one, minus_one] = [i32x16::splat(simd, 1), i32x16::splat(simd, -1)];
        self.steps[axis].simd_lt(STEPS / 2).select(minus_one, one)
    }

    /// Returns the coordinates along an axis of the cells `shift` away from the positions' cells, wrapped by the
    /// period.
    #[inline(always)]
    pub(crate) fn shifted(&self, lattice: &Lattice, axis: usize, shift: i32x16<S>) -> Words<S> {
        let [low, high] = self.cells[axis];
        let moved = low + shift.bitcast::<u32x16<S>>();
        // Add 64-bit numbers in two words: the high word adds the sign extension of the shift and the carry of the low
        // word, which overflows if the sum is below the summand.
        let sign = (shift >> 31).bitcast::<u32x16<S>>();
        let carries = moved.simd_lt(shift.bitcast::<u32x16<S>>());
        let high = high + sign;
        let words = [moved, carries.select(high + 1, high)];
        if lattice.period[axis] > 0 {
            return wrap(lattice, axis, words);
        }
        words
    }

    /// Returns each position's neighbor with the given code, for `C` registers at once. Operations are interleaved,
    /// which is faster.
    #[inline(always)]
    pub(crate) fn neighbors_each<const C: usize>(
        simd: S,
        lattice: &Lattice,
        places: &[Self; C],
        neighbors: [u32x16<S>; C],
    ) -> [Cells<S, N>; C] {
        let mut cells = [Cells {
            words: [u32x16::splat(simd, 0); 2],
            origins: places[0].steps,
        }; C];
        for axis in (0..N).rev() {
            let mut words = [places[0].cells[axis]; C];
            for i in 0..C {
                // Decode the offset of the neighbor along the axis.
                let digit = (neighbors[i] >> (2 * axis as u32)) & 3;
                let nearer = places[i].nearer(simd, axis);
                let zero = i32x16::splat(simd, 0);
                let [is_near, is_far] = [digit.simd_eq(1), digit.simd_eq(2)];
                let shift = is_near.select(nearer, is_far.select(zero - nearer, zero));
                words[i] = places[i].shifted(lattice, axis, shift);
                let from = shift * i32x16::splat(simd, STEPS);
                cells[i].origins[axis] = places[i].steps[axis] - from;
            }
            // Combine the hash parts of the axis.
            let parts = parts_each(simd, lattice, axis, words);
            for i in 0..C {
                cells[i].words = both(cells[i].words, parts[i]);
            }
        }
        cells
    }
}

/// Loads the register with index `register` from a slice.
#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, words: &[u32], register: usize) -> u32x16<S> {
    u32x16::from_slice(simd, &words[register * LANES..][..LANES])
}

#[inline(always)]
pub(crate) fn store<S: Simd>(lanes: u32x16<S>, words: &mut [u32], register: usize) {
    lanes.store_slice(&mut words[register * LANES..][..LANES]);
}

/// Splits sixteen coordinates into cells and steps from the cells' lower edges; see [`split`]. Also returns a bit mask
/// of the coordinates that are in range.
#[inline(always)]
fn split_lanes<S: Simd>(simd: S, coordinates: &[f64; LANES]) -> (Words<S>, i32x16<S>, u64) {
    let halves = [&coordinates[..8], &coordinates[8..]].map(|half| f64x8::from_slice(simd, half));
    // Integers below a quarter of `WHOLE` can be read from the bits of a sum. The comparison is false for NaN.
    let is_near = |half: f64x8<S>| half.abs().simd_lt(WHOLE / 4.0).all_true();
    if !(is_near(halves[0]) && is_near(halves[1])) {
        return split_each(simd, coordinates);
    }
    // Adding `WHOLE` moves the integer part to the low bits of the number.
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
    // Just below an integer, the difference can be rounded up to a whole cell.
    let carries = steps.simd_eq(STEPS);
    let cell = [a.unzip_low(b), a.unzip_high(b)];
    let [low, high] = next(cell);
    let cell = [carries.select(low, cell[0]), carries.select(high, cell[1])];
    (
        cell,
        carries.select(i32x16::splat(simd, 0), steps),
        u64::MAX,
    )
}

/// Splits sixteen coordinates one by one. Used if some are very large or not finite.
#[inline(never)]
fn split_each<S: Simd>(simd: S, coordinates: &[f64; LANES]) -> (Words<S>, i32x16<S>, u64) {
    let mut words = [[0; LANES]; 2];
    let mut steps = [0; LANES];
    let mut has_place = 0;
    for (lane, &coordinate) in coordinates.iter().enumerate() {
        let Some((cell, within)) = split(coordinate) else {
            continue;
        };
        has_place |= 1 << lane;
        (words[0][lane], words[1][lane]) = (cell as u32, (cell >> 32) as u32);
        steps[lane] = within;
    }
    let [low, high] = words;
    let words = [
        u32x16::from_slice(simd, &low),
        u32x16::from_slice(simd, &high),
    ];
    (words, i32x16::from_slice(simd, &steps), has_place)
}

/// Returns the cells after the given ones along an axis.
#[inline(always)]
fn next<S: Simd>([low, high]: Words<S>) -> Words<S> {
    let next = low + 1;
    let carries = next.simd_eq(0);
    [next, carries.select(high + 1, high)]
}

/// Wraps the coordinates of cells along `axis` by the period.
#[inline(never)]
fn wrap<S: Simd>(lattice: &Lattice, axis: usize, [mut low, mut high]: Words<S>) -> Words<S> {
    for lane in 0..LANES {
        // No SIMD level has a 64-bit remainder, so wrap lane by lane.
        let cell = i64::from(high[lane].cast_signed()) << 32 | i64::from(low[lane]);
        let cell = lattice.wrap(axis, cell);
        (low[lane], high[lane]) = (cell as u32, (cell >> 32) as u32);
    }
    [low, high]
}

/// Returns the part of a neighbor's code for one axis: 0 for the own cell, 1 for the nearer, 2 for the farther side.
#[inline(always)]
pub(crate) const fn digit(cell: u32, axis: usize) -> usize {
    (cell >> (2 * axis) & 3) as usize
}

/// Returns the codes of a cell and its neighbors, sorted by their mean distance from a random position in the cell.
pub(crate) const fn cells_by_distance<const N: usize>() -> &'static [u8] {
    const TWO: [u8; 9] = sorted_cells(2);
    const THREE: [u8; 27] = sorted_cells(3);
    const FOUR: [u8; 81] = sorted_cells(4);
    match N {
        2 => &TWO,
        3 => &THREE,
        _ => &FOUR,
    }
}

/// Returns the codes of a cell and its neighbors in `n_axes` dimensions, sorted by mean squared distance from a random
/// position in the cell.
const fn sorted_cells<const LEN: usize>(n_axes: u32) -> [u8; LEN] {
    let mut cells = [0; LEN];
    let mut len = 0;
    let mut wanted = 0;
    // Mean squared distances to the nearer and to the farther neighbor are 1/12 and 7/12, a ratio of 1 to 7.
    while len < LEN {
        let mut cell = 0_u32;
        while cell < 1 << (2 * n_axes) {
            let mut distance = 0;
            let mut axis = 0;
            while axis < n_axes {
                // Code 3 does not occur; its weight exceeds every sum that is looked for.
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
