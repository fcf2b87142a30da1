//! The search for the nearest points of one position, with a cell in each lane.
//!
//! Keys are coded as in [`many`](crate::many). A position whose nearest points are not certain is left to the search by
//! rings: one with points so far away that other cells matter, or with two points at nearly the same distance.

use crate::Metric;
use crate::fixed::{Place, STEP, STEPS};
use crate::lattice::{Lattice, SixteenCells};
use crate::levels::wide;
use crate::many::{Found, Search};
use crate::places::{LANES, Words, cells_by_distance, digit};
use crate::search::{self, Hit, Name};
use dapple_hash::CellHashes;
use dapple_raster::simd;
use fearless_simd::{i32x16, prelude::*, u32x16};

/// The number of cells that are visited: the nearest ones on average. The others are the own cell's neighbors across
/// most corners and the cells beyond the neighbors.
const fn n_visited(n_axes: usize) -> usize {
    [0, 0, 8, 24][n_axes]
}

/// The nearest points of a place in the plane or in space, nearest first; at most four.
pub(crate) fn nearest<const N: usize>(
    lattice: &Lattice,
    metric: Metric,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) {
    if !finds(lattice, metric, place, hits) {
        search::nearest(lattice, metric, place, hits);
    }
}

/// Finds the nearest points among the nearer neighbors; returns whether they are certain.
#[inline(always)]
fn finds<const N: usize>(
    lattice: &Lattice,
    metric: Metric,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) -> bool {
    if metric.is_slow() || lattice.density.is_some() {
        return false;
    }
    let around = Around::new(lattice, place);
    let search = Search::new(N, lattice, metric);
    let level = simd::level();
    let is_certain = if lattice.counts.thresholds().is_empty() && hits.len() == 1 {
        wide!(level, simd => around.search_by_axes::<_, 1, true>(simd, search, hits))
    } else if hits.len() <= 2 {
        wide!(level, simd => around.search_by_axes::<_, 2, false>(simd, search, hits))
    } else {
        wide!(level, simd => around.search_by_axes::<_, 4, false>(simd, search, hits))
    };
    is_certain.unwrap_or(false)
}

/// The own cell of a place and its neighbors: for each axis, the own cell, the nearer and the other neighbor.
struct Around<const N: usize> {
    /// The cells, or those that they repeat.
    cells: [[i64; 3]; N],
    /// The place, in steps from the lower edges of the cells.
    origins: [[i32; 3]; N],
    /// The steps to the own cell, to the nearer and to the other neighbor.
    sides: [[i32; 3]; N],
}

impl<const N: usize> Around<N> {
    #[inline(always)]
    fn new(lattice: &Lattice, place: &Place<N>) -> Self {
        let mut around = Self {
            cells: [[0; 3]; N],
            origins: [[0; 3]; N],
            sides: [[0; 3]; N],
        };
        for axis in 0..N {
            let below = place.steps[axis];
            let above = STEPS - below;
            let nearer = if below < above { -1 } else { 1 };
            for (which, shift) in [0, nearer, -nearer].into_iter().enumerate() {
                let cell = place.cell[axis] + i64::from(shift);
                around.cells[axis][which] = lattice.wrap(axis, cell);
                around.origins[axis][which] = below - shift * STEPS;
            }
            around.sides[axis] = [0, below.min(above), below.max(above)];
        }
        around
    }

    #[inline(always)]
    fn search_by_axes<S: Simd, const K: usize, const IS_SINGLE: bool>(
        &self,
        simd: S,
        search: Search<'_>,
        hits: &mut [Hit<N>],
    ) -> bool {
        if const { N == 2 } {
            self.search::<S, K, 1, IS_SINGLE>(simd, search, hits)
        } else {
            self.search::<S, K, 2, IS_SINGLE>(simd, search, hits)
        }
    }

    /// Visits the cells, in `C` registers; `IS_SINGLE` says that each has one point.
    #[inline(always)]
    fn search<S: Simd, const K: usize, const C: usize, const IS_SINGLE: bool>(
        &self,
        simd: S,
        search: Search<'_>,
        hits: &mut [Hit<N>],
    ) -> bool {
        let lattice = search.lattice;
        let (index_bits, code_mask) = (search.index_bits, search.code_mask);
        let mut hashes = [CellHashes::splat(simd, lattice.root); C];
        let mut origins = [[i32x16::splat(simd, 0); N]; C];
        for axis in (0..N).rev() {
            let mut words = [[u32x16::splat(simd, 0); 2]; C];
            for register in 0..C {
                let digits = const { digits::<N>() };
                let digits = u32x16::from_slice(simd, &digits[axis][register]);
                words[register] = pick_words(digits, self.cells[axis]);
                let origin = self.origins[axis].map(i32::cast_unsigned);
                origins[register][axis] = pick(digits, origin).bitcast();
            }
            hashes = CellHashes::axis_each(hashes, words);
        }
        let mut cells = SixteenCells::new_each(simd, lattice, hashes);
        let mut found = Found::<S, K>::new(simd, 0);
        for register in 0..C {
            // What is known to be 0 is not computed where a register of the processor has eight lanes.
            let numbers = u32x16::from_slice(simd, &const { numbers() }[register]);
            let is_visited = numbers.simd_lt(n_visited(N) as u32);
            let counts = cells[register].counts;
            let counts = if IS_SINGLE {
                u32x16::splat(simd, 1)
            } else {
                counts
            };
            cells[register].counts = is_visited.select(counts, u32x16::splat(simd, 0));
            let most = if IS_SINGLE {
                1
            } else {
                cells[register].counts.reduce_max()
            };
            let codes = numbers << index_bits;
            found.look(search, &cells[register], &origins[register], codes, most);
        }
        let mut states = [hashes[0].halves()[0]; 4];
        let mut words = [[[0; 8]; 2]; 4];
        for register in 0..C {
            [states[2 * register], states[2 * register + 1]] = hashes[register].halves();
            for which in 0..2 {
                let (low, high) = cells[register].words[which].split();
                low.store_slice(&mut words[2 * register][which]);
                high.store_slice(&mut words[2 * register + 1][which]);
            }
        }
        let mut coded = found.pop();
        for rank in 0..K {
            let Some(hit) = hits.get_mut(rank) else {
                break;
            };
            let next = found.pop();
            // The order of keys that differ in their codes alone is not known.
            if coded | code_mask == next | code_mask {
                return false;
            }
            let code = coded & code_mask;
            let (number, index) = (
                (code >> index_bits) as usize,
                code & ((1 << index_bits) - 1),
            );
            let number = number % n_visited(N);
            let (half, lane) = (number / 8, number % 8);
            let words = [words[half][0][lane], words[half][1][lane]];
            let steps: [i32; N] = lattice.steps(words, index);
            let neighbor = cells_by_distance::<N>()[number];
            for axis in 0..N {
                let ahead = self.origins[axis][digit(neighbor.into(), axis)] - steps[axis];
                hit.vector[axis] = ahead as f32 * STEP;
            }
            hit.key = search.exact.0.key(hit.vector);
            let hash = states[half].get(lane);
            hit.name = Some(Name { hash, index });
            coded = next;
        }
        // A missing point has the largest key.
        let border = self.border(search.exact.0);
        hits.last().is_none_or(|hit| hit.key < border)
    }

    /// A lower bound of the keys of all points of cells that are not visited.
    #[inline(always)]
    fn border(&self, metric: Metric) -> f32 {
        let mut sides = self.sides.map(|[_, near, _]| near);
        let nearest = sides.into_iter().fold(STEPS, i32::min);
        let mut border = metric.term((nearest + STEPS) as f32 * STEP);
        for &neighbor in &cells_by_distance::<N>()[n_visited(N)..] {
            for axis in 0..N {
                sides[axis] = self.sides[axis][digit(neighbor.into(), axis)];
            }
            border = border.min(metric.key(sides.map(|steps| steps as f32 * STEP)));
        }
        border
    }
}

/// The code of each cell along each axis, see [`places`](crate::places), in two registers.
const fn digits<const N: usize>() -> [[[u32; LANES]; 2]; N] {
    let mut digits = [[[0; LANES]; 2]; N];
    let cells = cells_by_distance::<N>();
    let mut number = 0;
    while number < n_visited(N) {
        let mut axis = 0;
        while axis < N {
            digits[axis][number / LANES][number % LANES] = digit(cells[number] as u32, axis) as u32;
            axis += 1;
        }
        number += 1;
    }
    digits
}

/// The numbers of the cells, in two registers.
const fn numbers() -> [[u32; LANES]; 2] {
    let mut numbers = [[0; LANES]; 2];
    let mut number = 0;
    while number < 2 * LANES {
        numbers[number / LANES][number % LANES] = number as u32;
        number += 1;
    }
    numbers
}

/// One of three numbers for each lane.
#[inline(always)]
fn pick<S: Simd>(digits: u32x16<S>, of: [u32; 3]) -> u32x16<S> {
    let [own, near, far] = of.map(|number| u32x16::splat(digits.simd, number));
    let other = digits.simd_eq(1).select(near, far);
    digits.simd_eq(0).select(own, other)
}

/// The words of one of three cells for each lane.
#[inline(always)]
fn pick_words<S: Simd>(digits: u32x16<S>, cells: [i64; 3]) -> Words<S> {
    let low = pick(digits, cells.map(|cell| cell as u32));
    let high = pick(digits, cells.map(|cell| (cell >> 32) as u32));
    [low, high]
}
