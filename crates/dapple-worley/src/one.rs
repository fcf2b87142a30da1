//! Search for one position: its cell and the neighbors side by side, one in each lane.
//!
//! Keys hold the code of their point in the low bits, as in [`many`](crate::many). If the other bits do not tell the
//! order of two of the nearest points, or the neighbors are not enough, the search by rings decides.

use crate::fixed::{Place, STEPS, cells};
use crate::lattice::{Lattice, SixteenCells};
use crate::many::NOTHING;
use crate::metric::{Exact, Measure as _};
use crate::places::{LANES, cells_by_distance, digit};
use crate::search::{self, Hit, Name, border, hit};
use crate::{LIMIT, Metric};
use dapple_hash::CellHashes;
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, f32x16, i32x16, mask32x16, prelude::*, u32x16};

/// The nearest points of a place, nearest first; at most four.
#[inline]
pub(crate) fn nearest<const N: usize>(
    metric: Metric,
    lattice: &Lattice<N>,
    level: Level,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) {
    // Powers are so slow that lanes gain nothing, and the counts of a varying density are drawn one by one.
    let is_scalar = matches!(metric, Metric::Minkowski(_)) || lattice.density.is_some();
    let is_known = !is_scalar
        && match hits.len() {
            1 => {
                dispatch!(level, simd => nearest_of_neighbors::<_, N, 1>(simd, metric, lattice, place, hits))
            }
            2 => {
                dispatch!(level, simd => nearest_of_neighbors::<_, N, 2>(simd, metric, lattice, place, hits))
            }
            _ => {
                dispatch!(level, simd => nearest_of_neighbors::<_, N, LIMIT>(simd, metric, lattice, place, hits))
            }
        };
    if !is_known {
        search::nearest(lattice, metric, place, hits);
    }
}

/// Finds the nearest points of a place, nearest first: as many as there are `hits`, and at most `K`. Returns whether
/// the neighbors are enough for that.
#[inline(always)]
fn nearest_of_neighbors<S: Simd, const N: usize, const K: usize>(
    simd: S,
    metric: Metric,
    lattice: &Lattice<N>,
    place: &Place<N>,
    hits: &mut [Hit<N>],
) -> bool {
    let around = Around::new(lattice, place);
    let index_bits = u32::BITS - lattice.counts.range().end().leading_zeros();
    let code_mask = (1 << (LANE_BITS + index_bits)) - 1;
    let mut best = [u32x16::splat(simd, NOTHING); K];
    let mut next = best[0];
    let neighbors = cells_by_distance::<N>();
    for (first, neighbors) in (0..).step_by(LANES).zip(neighbors.chunks(LANES)) {
        let mut lanes = [0; LANES];
        for (lane, &cell) in lanes.iter_mut().zip(neighbors) {
            *lane = u32::from(cell);
        }
        let is_there = mask32x16::from_bitmask(simd, u64::MAX >> (64 - neighbors.len()));
        let lanes = u32x16::from_slice(simd, &lanes);
        let (hashes, origins) = around.cells(simd, lattice, lanes);
        let points = SixteenCells::new(simd, lattice, hashes);
        let counts = is_there.select(points.counts, u32x16::splat(simd, 0));
        let codes = (u32x16::from_slice(simd, &ASCENDING) + first) << index_bits;
        for index in 0..counts.reduce_max() {
            let index_lanes = u32x16::splat(simd, index);
            let steps: [_; N] = points.steps(index_lanes, lattice.jitter);
            let mut vector = [f32x16::splat(simd, 0.0); N];
            for axis in 0..N {
                vector[axis] = (origins[axis] - steps[axis].bitcast::<i32x16<S>>()).to_float();
            }
            let key = Exact(metric).keys(vector).bitcast::<u32x16<S>>();
            let coded = (key & !code_mask) | codes | index;
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
    let n_hits = hits.len();
    let mut before = None;
    for rank in 0..=n_hits {
        let smallest = best[0].reduce_min();
        if before == Some(smallest | code_mask) {
            return false;
        }
        before = Some(smallest | code_mask);
        if rank == n_hits {
            break;
        }
        if smallest == NOTHING {
            return false;
        }
        let is_smallest = best[0].simd_eq(smallest);
        for rank in 0..K {
            let after = if rank + 1 < K { best[rank + 1] } else { next };
            best[rank] = is_smallest.select(after, best[rank]);
        }
        let code = smallest & code_mask;
        let cell = u32::from(neighbors[(code >> index_bits) as usize]);
        let shift = around.shift(cell);
        let cell = core::array::from_fn(|axis| place.cell[axis] + shift[axis]);
        let hash = lattice.hash(cell);
        let index = code & ((1 << index_bits) - 1);
        let steps = lattice.point(hash, index);
        hits[rank] = hit(metric, place, shift, steps, Name { hash, index });
    }
    hits[n_hits - 1].key < metric.term(cells(border(place, 1)))
}

/// The number of bits of a number below 81, the number of cells in four dimensions.
const LANE_BITS: u32 = 7;

/// The own cell of a place, and its neighbors.
struct Around<const N: usize> {
    steps: [i32; N],
    /// For each axis, the direction of the nearer neighbor: -1 or 1.
    nearer: [i32; N],
    /// For each axis, the own cell, the nearer and the other neighbor.
    cells: [[i64; 3]; N],
}

impl<const N: usize> Around<N> {
    #[inline(always)]
    fn new(lattice: &Lattice<N>, place: &Place<N>) -> Self {
        let nearer = place
            .steps
            .map(|steps| if steps < STEPS / 2 { -1 } else { 1 });
        let mut cells = [[0; 3]; N];
        for axis in 0..N {
            let shifts = [0, nearer[axis], -nearer[axis]];
            cells[axis] =
                shifts.map(|shift| lattice.wrap(axis, place.cell[axis] + i64::from(shift)));
        }
        Self {
            steps: place.steps,
            nearer,
            cells,
        }
    }

    /// The offset of a neighbor, in cells.
    fn shift(&self, neighbor: u32) -> [i64; N] {
        let mut shift = [0; N];
        for axis in 0..N {
            shift[axis] =
                i64::from([0, self.nearer[axis], -self.nearer[axis]][digit(neighbor, axis)]);
        }
        shift
    }

    /// The hashes of sixteen neighbors, and the place in steps from their lower corners.
    #[inline(always)]
    fn cells<S: Simd>(
        &self,
        simd: S,
        lattice: &Lattice<N>,
        neighbors: u32x16<S>,
    ) -> (CellHashes<S>, [i32x16<S>; N]) {
        let mut hashes = CellHashes::splat(simd, lattice.root);
        let mut origins = [i32x16::splat(simd, 0); N];
        for axis in (0..N).rev() {
            let digit = (neighbors >> (2 * axis as u32)) & 3;
            let [is_near, is_far] = [digit.simd_eq(1), digit.simd_eq(2)];
            let [own, near, far] = self.cells[axis];
            let word = |shift: u32| {
                let [own, near, far] =
                    [own, near, far].map(|cell| u32x16::splat(simd, (cell >> shift) as u32));
                is_near.select(near, is_far.select(far, own))
            };
            hashes = hashes.axis(word(0), word(32));
            let from = |shift: i32| i32x16::splat(simd, self.steps[axis] - shift * STEPS);
            let nearer = self.nearer[axis];
            origins[axis] = is_near.select(from(nearer), is_far.select(from(-nearer), from(0)));
        }
        (hashes, origins)
    }
}

/// The numbers of the lanes.
const ASCENDING: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
