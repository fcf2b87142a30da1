//! The inner loop for outputs that identify the nearest feature points (features and gradients).
//!
//! The low bits of a key hold the index of its candidate, as in [`many`](crate::many). If the remaining bits do not
//! determine the order of the nearest points, the pixel is searched individually.

use super::flat::FlatPoints;
use super::kernel::{Candidate, empty, greater, lesser};
use super::table::Table;
use super::{Band, LANES};
use crate::MAX_NEAREST;
use crate::features::{FeatureRows, position};
use crate::fixed::{MOST_AXES, STEP};
use crate::many::NOTHING;
use crate::metric::Measure;
use crate::worley::cell_value;
use core::ops::Range;
use fearless_simd::{f32x16, i32x16, prelude::*, u8x64, u32x16};

/// The coordinates and ids of a tile's candidates, for looking up the nearest ones by index.
#[derive(Debug)]
pub(super) struct Lookup {
    n_axes: usize,
    /// Coordinates along each axis, in cells from the corner `low`, padded to whole registers.
    coordinates: [Vec<f32>; MOST_AXES],
    /// Candidate ids, if needed; otherwise empty.
    ids: Vec<u64>,
}

impl Lookup {
    pub(super) fn new() -> Self {
        Self {
            n_axes: 0,
            coordinates: core::array::from_fn(|_| Vec::new()),
            ids: Vec::new(),
        }
    }

    /// Copies the candidates' coordinates and ids from the table. `low` is the origin of the coordinates, in steps.
    pub(super) fn fill(&mut self, points: &FlatPoints, table: &Table, low: [i32; MOST_AXES]) {
        let numbers = &points.numbers[..points.len];
        let room = points.len.next_multiple_of(LANES).max(LANES);
        self.n_axes = table.cells.n_axes;
        for axis in 0..self.n_axes {
            let steps = numbers
                .iter()
                .map(|&number| table.steps[axis][number as usize]);
            let coordinates = &mut self.coordinates[axis];
            coordinates.clear();
            coordinates.extend(steps.map(|steps| (steps - low[axis]) as f32 * STEP));
            coordinates.resize(room, 0.0);
        }
        self.ids.clear();
        if table.wants_ids {
            let ids = numbers.iter().map(|&number| table.ids[number as usize]);
            self.ids.extend(ids);
            self.ids.resize(room, 0);
        }
    }
}

/// Rows of a tile, and the parameters for rendering them.
#[derive(Debug)]
pub(super) struct TrackedRows<'a> {
    /// Rows of the tile, in the band.
    pub(super) rows: Range<usize>,
    /// Columns, in the window; at most [`LANES`].
    pub(super) columns: Range<usize>,
    /// Which register of sixteen columns of the tile is rendered, 0 or 1.
    pub(super) register: usize,
    /// Coordinates of the columns (first axis) and of the band's rows (other axes), in steps.
    pub(super) lines: [&'a [i32]; MOST_AXES],
    /// Origin of the candidates' coordinates, in steps.
    pub(super) low: [i32; MOST_AXES],
    pub(super) candidates: &'a [Candidate],
    pub(super) lookup: &'a Lookup,
    /// Limit of reliable keys (see [`metric`](crate::metric)). A pixel whose key is at or above it may miss a nearer
    /// point.
    pub(super) limit: f32,
}

/// The nearest points of up to sixteen adjacent pixels of a row. Arrays come first, so that registers do not cross
/// cache lines.
#[repr(C, align(64))]
pub(super) struct Found {
    pub(super) distances: [[f32; LANES]; MAX_NEAREST],
    /// Vectors with interleaved components.
    pub(super) vectors: [[f32; MOST_AXES * LANES]; MAX_NEAREST],
    pub(super) ids: [[u64; LANES]; MAX_NEAREST],
    /// Bit mask of the lanes in which the order of points is unknown.
    pub(super) unknown: u64,
    pub(super) row: usize,
    pub(super) columns: Range<usize>,
    pub(super) n_axes: usize,
    /// Number of nearest points per pixel.
    depth: usize,
}

/// The smallest keys of sixteen pixels, with the indices of their candidates in the low bits.
struct Keys<S: Simd, const K: usize> {
    /// Keys of the nearest points in the last `depth` ranks; earlier ranks are unused.
    best: [u32x16<S>; K],
    /// Smallest key of all points that are not among the nearest.
    next: u32x16<S>,
    /// Mask of the low bits, which hold the candidate's index.
    mask: u32,
    /// Number of unused ranks at the start of `best`.
    unused: usize,
}

impl TrackedRows<'_> {
    /// Finds the `depth` nearest points (at most `K`) row by row. Returns the first row that has a key at or above the
    /// limit, or the end of the rows.
    #[inline(always)]
    pub(super) fn fill<S: Simd, M: Measure, const K: usize>(
        &self,
        simd: S,
        measure: M,
        depth: usize,
        put: &mut dyn FnMut(&Found),
    ) -> usize {
        let mut found = Found {
            row: self.rows.start,
            columns: self.columns.clone(),
            n_axes: self.lookup.n_axes,
            depth,
            distances: [[0.0; LANES]; MAX_NEAREST],
            vectors: [[0.0; MOST_AXES * LANES]; MAX_NEAREST],
            ids: [[0; LANES]; MAX_NEAREST],
            unknown: 0,
        };
        // Convert the columns to cells. The other coordinates are set for each row.
        let columns = i32x16::from_slice(simd, &self.lines[0][..LANES]);
        let mut places = [(columns - self.low[0]).to_float::<f32x16<S>>() * STEP; MOST_AXES];
        // The number of low bits that an index needs.
        let n_bits = usize::BITS - self.candidates.len().leading_zeros();
        let mask = (1_u32 << n_bits) - 1;
        for row in self.rows.clone() {
            for axis in 1..found.n_axes {
                let ahead = self.lines[axis][row] - self.low[axis];
                places[axis] = f32x16::splat(simd, ahead as f32 * STEP);
            }
            // Find the nearest candidates; stop at the first row with a key at or above the limit.
            let keys = self.smallest::<S, M, K>(simd, measure, depth, row, mask);
            // With all low bits set, the coded key is an upper bound of the exact one.
            let last = (keys.best[K - 1] | mask).bitcast::<f32x16<S>>();
            if !last.simd_lt(self.limit).all_true() {
                return row;
            }
            // Look up the features of the nearest candidates.
            found.row = row;
            found.unknown = 0;
            match found.n_axes {
                2 => self.look_up_all::<S, M, K, 2>(measure, &places, &keys, &mut found),
                3 => self.look_up_all::<S, M, K, 3>(measure, &places, &keys, &mut found),
                _ => self.look_up_all::<S, M, K, 4>(measure, &places, &keys, &mut found),
            }
            put(&found);
        }
        self.rows.end
    }

    /// Finds the keys of the `depth` nearest points and of the next one, for sixteen pixels of a row. The low bits
    /// hold the indices of their candidates.
    #[inline(always)]
    fn smallest<S: Simd, M: Measure, const K: usize>(
        &self,
        simd: S,
        measure: M,
        depth: usize,
        row: usize,
        mask: u32,
    ) -> Keys<S, K> {
        let nothing = f32::from_bits(NOTHING);
        let mut best = empty::<S, K>(simd, depth, nothing);
        let mut next = f32x16::splat(simd, nothing);
        let row = row - self.rows.start;
        for (number, candidate) in self.candidates.iter().enumerate() {
            let columns = &candidate.columns.as_chunks::<LANES>().0[self.register % 2];
            let columns = f32x16::from_slice(simd, columns);
            let row_term = f32x16::splat(simd, candidate.rows[row]);
            let key = measure.accumulate(columns, row_term);
            // Replace the low bits by the index, and insert the key.
            let coded = (key.to_bits() & !mask) | number as u32;
            let mut coded = f32x16::from_bits(coded);
            for best in &mut best {
                let larger = greater(*best, coded);
                *best = lesser(*best, coded);
                coded = larger;
            }
            // The key that drops out may be the smallest of all other points.
            next = lesser(next, coded);
        }
        let mut bits = [next.to_bits(); K];
        for rank in 0..K {
            bits[rank] = best[rank].to_bits();
        }
        Keys {
            best: bits,
            next: next.to_bits(),
            mask,
            unused: K - depth,
        }
    }

    /// Looks up distances, vectors and ids of the nearest points.
    #[inline(always)]
    fn look_up_all<S: Simd, M: Measure, const K: usize, const N: usize>(
        &self,
        measure: M,
        places: &[f32x16<S>; MOST_AXES],
        keys: &Keys<S, K>,
        found: &mut Found,
    ) {
        let Keys { mask, unused, .. } = *keys;
        for rank in unused..K {
            let best = keys.best[rank];
            let after = if rank + 1 < K {
                keys.best[rank + 1]
            } else {
                keys.next
            };
            // The order of two points is unknown if their keys are equal without the low bits.
            let is_unknown = (best | mask).simd_ge(after | mask);
            found.unknown |= is_unknown.to_bitmask();
            self.look_up::<S, M, N>(measure, places, best & mask, found, rank - unused);
        }
    }

    /// Looks up distances, vectors and ids of the nearest points of one rank.
    #[inline(always)]
    fn look_up<S: Simd, M: Measure, const N: usize>(
        &self,
        measure: M,
        places: &[f32x16<S>; MOST_AXES],
        numbers: u32x16<S>,
        found: &mut Found,
        rank: usize,
    ) {
        let simd = numbers.simd;
        let lookup = self.lookup;
        let mut keys = f32x16::splat(simd, 0.0);
        let mut vectors = [keys; N];
        // Compute the vector and the exact key from the coordinates of the candidates.
        for axis in (0..N).rev() {
            let points = look_up(simd, &lookup.coordinates[axis], numbers);
            vectors[axis] = places[axis] - points;
            let [terms] = measure.terms([vectors[axis]]);
            keys = measure.accumulate(terms, keys);
        }
        measure
            .distances(keys)
            .store_slice(&mut found.distances[rank]);
        interleave(&vectors, &mut found.vectors[rank]);
        if !lookup.ids.is_empty() {
            let mut lanes = [0; LANES];
            numbers.store_slice(&mut lanes);
            for lane in 0..LANES {
                found.ids[rank][lane] = lookup.ids[lanes[lane] as usize];
            }
        }
    }
}

/// Stores sixteen vectors with interleaved components.
#[inline(always)]
fn interleave<S: Simd>(parts: &[f32x16<S>], out: &mut [f32; MOST_AXES * LANES]) {
    let out = out.as_chunks_mut::<LANES>().0;
    match *parts {
        [x, y] => {
            x.zip_low(y).store_slice(&mut out[0]);
            x.zip_high(y).store_slice(&mut out[1]);
        }
        [x, y, z, w] => {
            let [low, high] = [x.zip_low(z), x.zip_high(z)];
            let [other_low, other_high] = [y.zip_low(w), y.zip_high(w)];
            low.zip_low(other_low).store_slice(&mut out[0]);
            low.zip_high(other_low).store_slice(&mut out[1]);
            high.zip_low(other_high).store_slice(&mut out[2]);
            high.zip_high(other_high).store_slice(&mut out[3]);
        }
        _ => {
            // Three components are stored lane by lane.
            let out = out.as_flattened_mut();
            let mut lanes = [0.0; LANES];
            for (axis, parts) in parts.iter().enumerate() {
                parts.store_slice(&mut lanes);
                for lane in 0..LANES {
                    out[lane * 3 + axis] = lanes[lane];
                }
            }
        }
    }
}

/// Returns the elements of a table at sixteen indices. The table is padded to a whole register.
#[inline(always)]
fn look_up<S: Simd>(simd: S, table: &[f32], indices: u32x16<S>) -> f32x16<S> {
    if table.len() <= LANES {
        // Expand each index to the indices of its four bytes.
        let bytes = indices * 0x0404_0404 + 0x0302_0100;
        return f32x16::from_slice(simd, table).swizzle_dyn(bytes.bitcast::<u8x64<S>>());
    }
    // Read larger tables lane by lane.
    let mut lanes = [0; LANES];
    indices.store_slice(&mut lanes);
    let values = lanes.map(|index| table[index as usize]);
    f32x16::from_slice(simd, &values)
}

impl Found {
    /// Copies the points of these pixels to the views of a band. Pixels whose order is unknown are overwritten later.
    pub(super) fn put(&self, band: &Band<'_>, features: &mut [FeatureRows<'_>]) {
        let columns = self.columns.clone();
        let n = columns.len();
        for (rank, out) in features.iter_mut().enumerate() {
            if let Some(out) = out.distance.get_mut(self.row) {
                out[columns.clone()].copy_from_slice(&self.distances[rank][..n]);
            }
            if let Some(out) = out.vector.get_mut(self.row) {
                let out = &mut out[columns.start * self.n_axes..columns.end * self.n_axes];
                out.copy_from_slice(&self.vectors[rank][..n * self.n_axes]);
            }
            if let Some(out) = out.position.get_mut(self.row) {
                let out = &mut out[columns.start * self.n_axes..columns.end * self.n_axes];
                self.put_positions(band, rank, out);
            }
            if let Some(out) = out.id.get_mut(self.row) {
                out[columns.clone()].copy_from_slice(&self.ids[rank][..n]);
            }
            if let Some(out) = out.cell_value.get_mut(self.row) {
                for (out, &id) in out[columns.clone()].iter_mut().zip(&self.ids[rank]) {
                    *out = cell_value(id);
                }
            }
        }
    }

    /// Stores the positions of the nearest points of one rank, with interleaved components.
    fn put_positions(&self, band: &Band<'_>, rank: usize, out: &mut [f64]) {
        let vectors = self.vectors[rank].chunks(self.n_axes);
        let pixels = self.columns.clone().zip(out.chunks_mut(self.n_axes));
        for ((column, out), vector) in pixels.zip(vectors) {
            for (axis, (out, &way)) in out.iter_mut().zip(vector).enumerate() {
                let place = match axis {
                    0 => band.columns.places[column],
                    _ => band.rows[axis].places[self.row],
                };
                *out = position(place, way);
            }
        }
    }

    /// Returns the vectors of the nearest points to one pixel, nearest point first.
    pub(super) fn vectors<const N: usize>(&self, lane: usize) -> [[f32; N]; MAX_NEAREST] {
        let mut vectors = [[0.0; N]; MAX_NEAREST];
        for rank in 0..self.depth {
            for axis in 0..N {
                vectors[rank][axis] = self.vectors[rank][lane * N + axis];
            }
        }
        vectors
    }
}
