//! Cell contents: at most one point or proposal per cell.

use super::grid::{Cell, FAR, Grid, HALO};
use super::mask::REACH;
use core::ops::Range;
use fearless_simd::{f32x8, i32x8, prelude::*};

/// Rank of a point placed in this run; above all proposals.
pub(crate) const POINT: i32 = i32::MAX;

/// Rank of a given point; above all proposals.
pub(crate) const GIVEN: i32 = i32::MAX - 1;

/// Maximum rank of a proposal.
pub(crate) const HIGHEST_PROPOSAL: i32 = i32::MAX - 2;

/// Number of lanes processed together; a row of [`REACH`] cells fits.
pub(crate) const LANES: usize = 8;

/// Column offsets of five adjacent cells, relative to the middle one. The other lanes are far away, so that they never
/// conflict.
pub(crate) const COLUMNS: [f32; LANES] = [-2.0, -1.0, 0.0, 1.0, 2.0, FAR, FAR, FAR];

/// Offsets and ranks of all cells including the margin, row by row.
///
/// An empty cell has the x offset [`FAR`]; its other values are undefined.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) x: Vec<f32>,
    pub(crate) y: Vec<f32>,
    pub(crate) rank: Vec<i32>,
}

/// Mutable rows of a [`Sheet`].
#[derive(Debug)]
pub(crate) struct SheetRows<'a> {
    first_row: u32,
    x: &'a mut [f32],
    y: &'a mut [f32],
    rank: &'a mut [i32],
}

impl Sheet {
    /// Creates a sheet of empty cells.
    pub(crate) fn new(grid: &Grid) -> Self {
        // Rows of neighbors are read in whole lanes, so reads extend beyond the last cell.
        let length = grid.stride() * grid.rows() + LANES;
        Self {
            x: vec![FAR; length],
            y: vec![0.0; length],
            rank: vec![0; length],
        }
    }

    /// Divides the rows of the domain into bands of `band_rows` rows.
    pub(crate) fn bands(
        &mut self,
        grid: &Grid,
        band_rows: u32,
    ) -> impl Iterator<Item = SheetRows<'_>> {
        let rows = domain_rows(grid);
        let band = band_rows as usize * grid.stride();
        let x = self.x[rows.clone()].chunks_mut(band);
        let y = self.y[rows.clone()].chunks_mut(band);
        let rank = self.rank[rows].chunks_mut(band);
        let first_rows = (HALO..).step_by(band_rows as usize);
        x.zip(y)
            .zip(rank)
            .zip(first_rows)
            .map(|(((x, y), rank), first_row)| SheetRows {
                first_row,
                x,
                y,
                rank,
            })
    }

    /// Copies the outermost rows of the domain to the margin on the other side, if y wraps.
    pub(crate) fn wrap_rows(&mut self, grid: &Grid) {
        if !grid.domain.wrap[1] {
            return;
        }
        let (stride, count) = (grid.stride(), grid.cells[1] as usize);
        let margin = HALO as usize * stride;
        for (from, to) in [(count * stride, 0), (margin, margin + count * stride)] {
            self.x.copy_within(from..from + margin, to);
            self.y.copy_within(from..from + margin, to);
            self.rank.copy_within(from..from + margin, to);
        }
    }

    /// Finds the conflicts of a position with the five cells starting at `start`, as two bit masks: cells with a
    /// conflicting point, and cells with a conflicting point or proposal of at least `rank`.
    #[inline(always)]
    fn conflicts_in_row<S: Simd>(
        &self,
        simd: S,
        grid: &Grid,
        start: usize,
        [x, y]: [f32; 2],
        rank: i32,
    ) -> [u64; 2] {
        let xs = f32x8::from_slice(simd, &self.x[start..start + LANES]);
        let ys = f32x8::from_slice(simd, &self.y[start..start + LANES]);
        let ranks = i32x8::from_slice(simd, &self.rank[start..start + LANES]);
        let columns = f32x8::from_slice(simd, &COLUMNS);
        let dx = (xs + columns - x) * grid.scale[0];
        let dy = (ys - y) * grid.scale[1];
        let near = (dx * dx + dy * dy).simd_lt(1.0);
        let above = near & ranks.simd_ge(rank);
        let points = near & ranks.simd_ge(GIVEN);
        [points.to_bitmask(), above.to_bitmask()]
    }

    /// Finds the conflicts of the position stored in `cell`.
    #[inline(always)]
    pub(crate) fn rivals<S: Simd>(&self, simd: S, grid: &Grid, cell: Cell) -> Rivals {
        let middle = grid.index(cell);
        let (x, y, rank) = (self.x[middle], self.y[middle], self.rank[middle]);
        let (mut points, mut proposals) = (0, 0);
        for row in 0..REACH {
            let start = middle + row * grid.stride() - (HALO as usize) * (grid.stride() + 1);
            let place = [x, y - (row as f32 - HALO as f32)];
            let [found, above] = self.conflicts_in_row(simd, grid, start, place, rank);
            points |= found;
            proposals |= (above as u32) << (REACH * row);
        }
        if points != 0 {
            return Rivals::Point;
        }
        Rivals::Proposals(proposals & !(1 << (REACH as u32 * HALO + HALO)))
    }
}

/// The conflicts of a proposed point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rivals {
    /// Conflict with a point, and possibly with proposals.
    Point,
    /// Conflicts only with proposals of equal or higher rank, one bit per surrounding cell; no conflict if it is 0.
    Proposals(u32),
}

impl Rivals {
    /// Calls `rival` with the surrounding cells of the set bits until it returns true; returns whether it did.
    #[inline(always)]
    pub(crate) fn any(bits: u32, cell: Cell, mut rival: impl FnMut(Cell) -> bool) -> bool {
        let mut left = bits;
        while left != 0 {
            let bit = left.trailing_zeros();
            left &= left - 1;
            let (row, column) = (bit / REACH as u32, bit % REACH as u32);
            let other = Cell {
                row: cell.row + row - HALO,
                column: cell.column + column - HALO,
            };
            if rival(other) {
                return true;
            }
        }
        false
    }
}

impl SheetRows<'_> {
    /// Stores an offset and a rank in a cell, and in its copies in the margin of the same row.
    #[inline(always)]
    pub(crate) fn put(&mut self, grid: &Grid, cell: Cell, offset: [f32; 2], rank: i32) {
        let own = Cell {
            row: cell.row - self.first_row,
            ..cell
        };
        self.put_one(grid.index(own), offset, rank);
        if grid.domain.wrap[0] {
            let (column, count) = (cell.column, grid.cells[0]);
            if column < 2 * HALO {
                self.put_one(
                    grid.index(Cell {
                        column: column + count,
                        ..own
                    }),
                    offset,
                    rank,
                );
            }
            if column >= count {
                self.put_one(
                    grid.index(Cell {
                        column: column - count,
                        ..own
                    }),
                    offset,
                    rank,
                );
            }
        }
    }

    #[inline(always)]
    fn put_one(&mut self, index: usize, [x, y]: [f32; 2], rank: i32) {
        self.x[index] = x;
        self.y[index] = y;
        self.rank[index] = rank;
    }
}

/// Returns the range that the domain's rows occupy in the arrays.
pub(crate) fn domain_rows(grid: &Grid) -> Range<usize> {
    let margin = HALO as usize * grid.stride();
    margin..margin + grid.cells[1] as usize * grid.stride()
}
