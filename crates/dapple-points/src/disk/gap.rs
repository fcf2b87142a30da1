//! Exact search for positions in a cell that no disc covers.
//!
//! The open subcells of a cell are squares of lattice positions. A square inside a single disc is dropped. One random
//! position of the remaining squares is tried, then each square is split into four, and so on down to single
//! positions. The result is uniformly distributed among the free positions of the cell, and there is always a result
//! if a free position exists.
//!
//! Rounding does not affect the decisions. The corners of squares are lattice positions and the distance is monotonic,
//! so a square whose farthest corner is covered is covered everywhere.

use super::grid::{Cell, FAR, Grid, HALO, LATTICE, STEP};
use super::mask::{REACH, SIDE};
use super::sheet::{COLUMNS, LANES, Sheet};
use dapple_hash::CellHash;
use fearless_simd::{f32x8, prelude::*};

/// The first lattice position of a square, in steps from the corner of the cell.
type Corner = [u32; 2];

/// Maximum number of discs that reach into a cell, one per surrounding cell, rounded up to whole lanes.
const MAX_DISCS: usize = (REACH * REACH).next_multiple_of(LANES);

/// Searches for gaps, with scratch memory that is reused from cell to cell.
#[derive(Clone, Debug)]
pub(crate) struct GapSearch {
    /// Centers of the discs that reach into the cell, relative to it; unused lanes are far away.
    x: [f32; MAX_DISCS],
    y: [f32; MAX_DISCS],
    n_discs: usize,
    squares: Vec<Corner>,
    quarters: Vec<Corner>,
}

impl Default for GapSearch {
    fn default() -> Self {
        Self {
            x: [FAR; MAX_DISCS],
            y: [FAR; MAX_DISCS],
            n_discs: 0,
            squares: Vec::new(),
            quarters: Vec::new(),
        }
    }
}

impl GapSearch {
    /// Collects the discs that reach into a cell. The sheet must contain only points, no proposals.
    #[inline(always)]
    pub(crate) fn gather<S: Simd>(&mut self, simd: S, grid: &Grid, sheet: &Sheet, cell: Cell) {
        let [first, last] = span(0, LATTICE);
        self.n_discs = 0;
        for row in 0..REACH {
            let start =
                grid.index(cell) + row * grid.stride() - HALO as usize * (grid.stride() + 1);
            let xs = f32x8::from_slice(simd, &sheet.x[start..start + LANES]);
            let ys = f32x8::from_slice(simd, &sheet.y[start..start + LANES]);
            let xs = xs + f32x8::from_slice(simd, &COLUMNS);
            let ys = ys + (row as f32 - HALO as f32);
            // Distance to the nearest position of the cell
            let dx = (first - xs).max(xs - last).max(0.0) * grid.scale[0];
            let dy = (first - ys).max(ys - last).max(0.0) * grid.scale[1];
            let mut near = (dx * dx + dy * dy).simd_lt(1.0).to_bitmask();
            while near != 0 {
                let column = near.trailing_zeros() as usize;
                near &= near - 1;
                self.x[self.n_discs] = sheet.x[start + column] + COLUMNS[column];
                self.y[self.n_discs] = sheet.y[start + column] + (row as f32 - HALO as f32);
                self.n_discs += 1;
            }
        }
        let end = self.n_discs.next_multiple_of(LANES);
        self.x[self.n_discs..end].fill(FAR);
        self.y[self.n_discs..end].fill(FAR);
    }

    /// Returns a random free position of the cell whose discs were [gathered](Self::gather) and whose mask is `mask`;
    /// `None` if all positions are covered.
    ///
    /// Clears the bits in `mask` of subcells that a single disc covers.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &mut self,
        simd: S,
        grid: &Grid,
        mask: &mut u64,
        hash: CellHash,
    ) -> Option<[f32; 2]> {
        let mut size = LATTICE / SIDE as u32;
        self.start(simd, grid, mask, size);
        let mut draws = 1;
        while !self.squares.is_empty() {
            let place = self.random_place(size, hash.at(draws));
            if !self.is_covered(simd, grid, [[place[0]; 2], [place[1]; 2]]) {
                return Some(place);
            }
            draws += 1;
            size /= 2;
            self.cut(simd, grid, size);
        }
        None
    }

    /// Initializes the squares with the open subcells that no single disc covers.
    #[inline(always)]
    fn start<S: Simd>(&mut self, simd: S, grid: &Grid, mask: &mut u64, size: u32) {
        self.squares.clear();
        let mut left = *mask;
        while left != 0 {
            let bit = left.trailing_zeros();
            left &= left - 1;
            let square = [bit % SIDE as u32 * size, bit / SIDE as u32 * size];
            if self.is_covered(simd, grid, [span(square[0], size), span(square[1], size)]) {
                *mask &= !(1 << bit);
            } else {
                self.squares.push(square);
            }
        }
    }

    /// Splits every square into four of side `size`, and drops quarters that a single disc covers.
    #[inline(always)]
    fn cut<S: Simd>(&mut self, simd: S, grid: &Grid, size: u32) {
        let mut quarters = core::mem::take(&mut self.quarters);
        quarters.resize(4 * self.squares.len(), [0; 2]);
        let mut n_open = 0;
        for &[x, y] in &self.squares {
            let covered = self.covered_quarters(simd, grid, [x, y], size);
            for (quarter, covered) in covered.into_iter().enumerate() {
                let [right, down] = [quarter as u32 & 1, quarter as u32 >> 1];
                quarters[n_open] = [x + right * size, y + down * size];
                n_open += usize::from(covered == 0);
            }
        }
        quarters.truncate(n_open);
        self.quarters = core::mem::replace(&mut self.squares, quarters);
    }

    /// Returns the covered quarters of a square, row by row; nonzero if a single disc covers the quarter of side
    /// `size`.
    #[inline(always)]
    fn covered_quarters<S: Simd>(
        &self,
        simd: S,
        grid: &Grid,
        [x, y]: Corner,
        size: u32,
    ) -> [u64; 4] {
        // Written out, since closures passed to `array::map` are not compiled for the SIMD level.
        let (left, right) = (span(x, size), span(x + size, size));
        let (top, bottom) = (span(y, size), span(y + size, size));
        let [sx, sy] = grid.scale;
        let discs = self.x.chunks_exact(LANES).zip(self.y.chunks_exact(LANES));
        let mut covered = [0; 4];
        for (xs, ys) in discs.take(self.n_discs.div_ceil(LANES)) {
            let xs = f32x8::from_slice(simd, xs);
            let ys = f32x8::from_slice(simd, ys);
            let (left, right) = (far_sq(xs, left, sx), far_sq(xs, right, sx));
            let (top, bottom) = (far_sq(ys, top, sy), far_sq(ys, bottom, sy));
            covered[0] |= (left + top).simd_lt(1.0).to_bitmask();
            covered[1] |= (right + top).simd_lt(1.0).to_bitmask();
            covered[2] |= (left + bottom).simd_lt(1.0).to_bitmask();
            covered[3] |= (right + bottom).simd_lt(1.0).to_bitmask();
        }
        covered
    }

    /// Returns whether a single disc covers a whole square. The square is given by its first and last position along
    /// each axis.
    #[inline(always)]
    fn is_covered<S: Simd>(&self, simd: S, grid: &Grid, [x, y]: [[f32; 2]; 2]) -> bool {
        let discs = self.x.chunks_exact(LANES).zip(self.y.chunks_exact(LANES));
        let mut covered = 0;
        for (xs, ys) in discs.take(self.n_discs.div_ceil(LANES)) {
            let xs = f32x8::from_slice(simd, xs);
            let ys = f32x8::from_slice(simd, ys);
            let far_sq = far_sq(xs, x, grid.scale[0]) + far_sq(ys, y, grid.scale[1]);
            covered |= far_sq.simd_lt(1.0).to_bitmask();
        }
        covered != 0
    }

    /// Returns a random position in the squares, uniformly distributed.
    #[inline(always)]
    fn random_place(&self, size: u32, bits: u64) -> [f32; 2] {
        let rank = ((bits >> 40) * self.squares.len() as u64) >> 24;
        let [x, y] = self.squares[rank as usize];
        let within = |bits: u64| bits as u32 & (size - 1);
        let [x, y] = [x + within(bits), y + within(bits >> 20)];
        [x as f32 * STEP, y as f32 * STEP]
    }
}

/// Returns a square's first and last position along an axis, in cells, from its first lattice step and its side in
/// steps.
#[inline(always)]
fn span(first: u32, size: u32) -> [f32; 2] {
    [first as f32 * STEP, (first + size - 1) as f32 * STEP]
}

/// Returns the squared distances along an axis from disc centers to the farther end of a span.
#[inline(always)]
fn far_sq<S: Simd>(centers: f32x8<S>, [first, last]: [f32; 2], scale: f32) -> f32x8<S> {
    let far = (centers - first).max(last - centers) * scale;
    far * far
}
