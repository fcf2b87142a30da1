//! Computes bisecting planes between a feature point and its neighbors, and selects those that bound its Voronoi cell.

use super::cull::{PixelBox, lanes_before};
use super::table::Table;
use super::{F64_LANES, LANES};
use crate::fixed::{MOST_AXES, STEP};
use core::ops::Range;
use fearless_simd::{f32x16, f64x8, i32x16, mask32x16, prelude::*};

/// Maximum error of a distance computed in `f32`, in cells.
pub(super) const SLACK: f32 = 1.0 / (1 << 14) as f32;

/// Fraction of the search radius within which neighbors contribute to the outline of the cell.
const INNER: f32 = 0.75;

/// The neighbors of a feature point and their bisecting planes, in `f32`. Arrays are padded by a register.
#[derive(Debug)]
pub(super) struct Neighbors {
    pub(super) n_axes: usize,
    /// Coordinates of the feature point, in steps from the corner of the table.
    pub(super) point: [i32; MOST_AXES],
    /// Search radius: all neighbors up to this distance are included, in cells.
    pub(super) reach: f32,
    /// Vectors from the neighbors to the point, in cells, axis by axis. `lengths_sq` are their squared lengths.
    ways: [Vec<f32>; MOST_AXES],
    lengths_sq: Vec<f32>,
    len: usize,
    /// Unit normals of the planes, pointing toward the point, axis by axis. `distances` are the distances of the
    /// planes from the point, in cells.
    pub(super) normals: [Vec<f32>; MOST_AXES],
    pub(super) distances: Vec<f32>,
    /// Indices of the neighbors that contribute to the outline of the cell.
    pub(super) inner: Vec<usize>,
}

/// The planes that can bound a cell. Arrays are padded by a register.
#[derive(Debug)]
pub(super) struct Planes {
    pub(super) n_axes: usize,
    pub(super) len: usize,
    /// Unit normals, pointing toward the feature point, axis by axis.
    pub(super) normals: [Vec<f64>; MOST_AXES],
    /// Distances of the planes from the feature point, in cells.
    distances: Vec<f64>,
    /// Signed distances of the planes, in cells, from the position on the current row of pixels whose first coordinate
    /// equals the feature point's.
    pub(super) offsets: Vec<f64>,
}

impl Neighbors {
    pub(super) fn new() -> Self {
        Self {
            n_axes: 0,
            point: [0; MOST_AXES],
            reach: 0.0,
            ways: core::array::from_fn(|_| Vec::new()),
            lengths_sq: Vec::new(),
            len: 0,
            normals: core::array::from_fn(|_| Vec::new()),
            distances: Vec::new(),
            inner: Vec::new(),
        }
    }

    /// Finds the neighbors of a point of a table up to `reach` cells away, among the points of `runs`. Returns whether
    /// no other point coincides with it.
    #[inline(always)]
    pub(super) fn find<S: Simd>(
        &mut self,
        simd: S,
        table: &Table,
        point: [i32; MOST_AXES],
        reach: f32,
        runs: &[Range<usize>],
    ) -> bool {
        (self.point, self.reach) = (point, reach);
        self.clear(table.cells.n_axes, runs);
        let zero = f32x16::splat(simd, 0.0);
        let mut n_there = 0;
        for run in runs {
            for start in run.clone().step_by(LANES) {
                // Compute the vectors from sixteen points to this one, and their squared lengths.
                let mut ways = [zero; MOST_AXES];
                let mut length_sq = zero;
                for axis in 0..self.n_axes {
                    let other = i32x16::from_slice(simd, &table.steps[axis][start..start + LANES]);
                    let steps = i32x16::splat(simd, point[axis]) - other;
                    ways[axis] = steps.to_float::<f32x16<S>>() * STEP;
                    length_sq += ways[axis] * ways[axis];
                }
                // The point itself has the distance zero.
                let is_apart = length_sq.simd_gt(0.0);
                let is_there = lanes_before(simd, run.end - start);
                n_there += (is_there & !is_apart).to_bitmask().count_ones();
                let is_near = length_sq.simd_le(reach * reach) & is_apart & is_there;
                self.push(&ways, length_sq, is_near);
            }
        }
        // The point itself is at distance zero. Any other such point coincides with it.
        n_there == 1
    }

    /// Clears the list, and reserves memory for the points of `runs`.
    fn clear(&mut self, n_axes: usize, runs: &[Range<usize>]) {
        (self.n_axes, self.len) = (n_axes, 0);
        let mut room = LANES;
        for run in runs {
            room += run.len();
        }
        if self.distances.len() < room {
            let parts = self.ways.iter_mut().chain(&mut self.normals);
            for numbers in parts.chain([&mut self.lengths_sq, &mut self.distances]) {
                numbers.resize(room.next_power_of_two(), 0.0);
            }
        }
    }

    /// Appends the neighbors whose lanes are set in `mask`.
    #[inline(always)]
    fn push<S: Simd>(
        &mut self,
        ways: &[f32x16<S>; MOST_AXES],
        length_sq: f32x16<S>,
        mask: mask32x16<S>,
    ) {
        let to = self.len..self.len + LANES;
        for axis in 0..self.n_axes {
            let parts = ways[axis].compress(mask);
            parts.store_slice(&mut self.ways[axis][to.clone()]);
        }
        let lengths_sq = length_sq.compress(mask);
        lengths_sq.store_slice(&mut self.lengths_sq[to]);
        self.len += mask.to_bitmask().count_ones() as usize;
    }

    /// Returns whether a single neighbor is nearer than the point in the whole box. Only the part of the box within
    /// half of the search radius is considered.
    #[inline(always)]
    pub(super) fn hide<S: Simd>(&self, simd: S, pixels: &PixelBox) -> bool {
        let half = self.reach / 2.0;
        // Clip the box to the ball of half the reach around the point.
        let spare_sq = half * half - pixels.distance_sq(&self.point);
        let [mut low, mut high] = [[0.0_f32; MOST_AXES]; 2];
        for axis in 0..self.n_axes {
            let from = (pixels.low[axis] - self.point[axis]) as f32 * STEP;
            let to = (pixels.high[axis] - self.point[axis]) as f32 * STEP;
            // Distance to the box along this axis, and largest half-width of the ball inside of the box.
            let gap = from.max(-to).max(0.0);
            let widest = libm::sqrtf((spare_sq + gap * gap).max(0.0));
            (low[axis], high[axis]) = (from.max(-widest), to.min(widest));
        }
        // Test whether the whole box lies beyond the bisecting plane of a neighbor.
        for start in (0..self.len).step_by(LANES) {
            let at = start..start + LANES;
            // Find the box's largest signed distance from the plane, multiplied by the length of the vector.
            let mut ahead = f32x16::from_slice(simd, &self.lengths_sq[at.clone()]) * 0.5;
            for axis in 0..self.n_axes {
                let ways = f32x16::from_slice(simd, &self.ways[axis][at.clone()]);
                ahead += (ways * low[axis]).max(ways * high[axis]);
            }
            let is_nearer = ahead.simd_lt(-SLACK) & lanes_before(simd, self.len - start);
            if is_nearer.any_true() {
                return true;
            }
        }
        false
    }

    /// Computes the neighbors' bisecting planes.
    #[inline(always)]
    pub(super) fn make_planes<S: Simd>(&mut self, simd: S) {
        self.inner.clear();
        let inner = self.reach * INNER;
        for start in (0..self.len).step_by(LANES) {
            let at = start..start + LANES;
            // A plane is halfway to the neighbor and orthogonal to the vector.
            let lengths_sq = f32x16::from_slice(simd, &self.lengths_sq[at.clone()]);
            let lengths = lengths_sq.sqrt();
            (lengths * 0.5).store_slice(&mut self.distances[at.clone()]);
            let per_length = f32x16::splat(simd, 1.0) / lengths;
            for axis in 0..self.n_axes {
                let ways = f32x16::from_slice(simd, &self.ways[axis][at.clone()]);
                (ways * per_length).store_slice(&mut self.normals[axis][at.clone()]);
            }
            // Record the neighbors within the inner part of the reach.
            let is_there = lanes_before(simd, self.len - start);
            let mut is_inner = (lengths.simd_le(inner) & is_there).to_bitmask();
            while is_inner != 0 {
                self.inner.push(start + is_inner.trailing_zeros() as usize);
                is_inner &= is_inner - 1;
            }
        }
    }

    /// Copies the planes that can be the nearest one somewhere in the ball of squared radius `radius_sq` around the
    /// point into `planes`.
    ///
    /// A plane is dropped if another plane is nearer to every position in the ball. This is the case if the other
    /// plane is nearer to the point by more than the radius times the length of the difference of the unit normals.
    #[inline(always)]
    pub(super) fn pick<S: Simd>(&self, simd: S, radius_sq: f32, planes: &mut Planes) {
        planes.clear(self.n_axes, self.len);
        for start in (0..self.len).step_by(LANES) {
            let at = start..start + LANES;
            let distances = f32x16::from_slice(simd, &self.distances[at.clone()]);
            let mut normals = [distances; MOST_AXES];
            for axis in 0..self.n_axes {
                normals[axis] = f32x16::from_slice(simd, &self.normals[axis][at.clone()]);
            }
            let mut matters = lanes_before(simd, self.len - start);
            // Compare with the planes of the inner neighbors.
            for &other in &self.inner {
                // Compare squares: the difference of the distances, and the distance of the normals times the radius.
                let nearer = distances - self.distances[other];
                let mut apart_sq = f32x16::splat(simd, SLACK);
                for axis in 0..self.n_axes {
                    let apart = normals[axis] - self.normals[axis][other];
                    apart_sq += apart * apart;
                }
                let is_worse = (nearer * nearer).simd_gt(apart_sq * radius_sq);
                matters &= !(is_worse & nearer.simd_gt(0.0));
            }
            // Store the neighbors whose planes remain.
            let mut matters = matters.to_bitmask();
            while matters != 0 {
                let index = start + matters.trailing_zeros() as usize;
                matters &= matters - 1;
                // Store the vector. The planes are computed from it in double precision.
                for axis in 0..self.n_axes {
                    planes.normals[axis][planes.len] = f64::from(self.ways[axis][index]);
                }
                planes.len += 1;
            }
        }
        planes.make(simd);
    }
}

impl Planes {
    pub(super) fn new() -> Self {
        Self {
            n_axes: 0,
            len: 0,
            normals: core::array::from_fn(|_| Vec::new()),
            distances: Vec::new(),
            offsets: Vec::new(),
        }
    }

    /// Clears the planes, and reserves memory for `n` planes.
    fn clear(&mut self, n_axes: usize, n: usize) {
        (self.n_axes, self.len) = (n_axes, 0);
        let room = n + F64_LANES;
        if self.offsets.len() < room {
            let others = [&mut self.distances, &mut self.offsets];
            for numbers in self.normals.iter_mut().chain(others) {
                numbers.resize(room.next_power_of_two(), 0.0);
            }
        }
    }

    /// Computes the planes from the vectors to the neighbors, which `normals` contains initially.
    #[inline(always)]
    fn make<S: Simd>(&mut self, simd: S) {
        for start in (0..self.len).step_by(F64_LANES) {
            let at = start..start + F64_LANES;
            let mut length_sq = f64x8::splat(simd, 0.0);
            for axis in 0..self.n_axes {
                let ways = f64x8::from_slice(simd, &self.normals[axis][at.clone()]);
                length_sq += ways * ways;
            }
            // Normalize the vectors, and take half of their lengths as distances.
            let length = length_sq.sqrt();
            let per_length = f64x8::splat(simd, 1.0) / length;
            (length * 0.5).store_slice(&mut self.distances[at.clone()]);
            for axis in 0..self.n_axes {
                let ways = &mut self.normals[axis][at.clone()];
                (f64x8::from_slice(simd, ways) * per_length).store_slice(ways);
            }
        }
    }

    /// Computes `offsets` for a row of pixels. `rest` is the vector from the point to the row along all axes except
    /// the first, in cells.
    #[inline(always)]
    pub(super) fn take_row<S: Simd>(&mut self, simd: S, rest: &[f64; MOST_AXES]) {
        for start in (0..self.len).step_by(F64_LANES) {
            let at = start..start + F64_LANES;
            let mut offsets = f64x8::from_slice(simd, &self.distances[at.clone()]);
            for axis in 1..self.n_axes {
                let normals = f64x8::from_slice(simd, &self.normals[axis][at.clone()]);
                offsets += normals * rest[axis];
            }
            offsets.store_slice(&mut self.offsets[at]);
        }
    }

    /// Returns the smallest distance of a plane from the point, in cells.
    pub(super) fn least(&self) -> f64 {
        let distances = self.distances[..self.len].iter();
        distances.copied().fold(f64::INFINITY, f64::min)
    }
}
