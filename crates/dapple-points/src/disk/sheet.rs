//! The contents of the cells: at most one place each, a point or a proposal.

use super::grid::{Cell, FAR, Grid, HALO};
use super::mask::REACH;
use core::ops::Range;
use fearless_simd::{f32x8, i32x8, prelude::*};

/// The rank of a point that was placed in this run; above all proposals.
pub(crate) const POINT: i32 = i32::MAX;

/// The rank of a point that was given; above all proposals.
pub(crate) const GIVEN: i32 = i32::MAX - 1;

/// The highest rank of a proposal.
pub(crate) const HIGHEST_PROPOSAL: i32 = i32::MAX - 2;

/// Lanes that are looked at together; a row of [`REACH`] cells fits.
pub(crate) const LANES: usize = 8;

/// The columns of a row of neighbors, relative to the middle one; lanes beyond the reach are far away.
pub(crate) const COLUMNS: [f32; LANES] = [-2.0, -1.0, 0.0, 1.0, 2.0, FAR, FAR, FAR];

/// Offsets and ranks of all cells, margin included, row by row.
///
/// An empty cell is [`FAR`] away along x; its other numbers have no meaning.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) x: Vec<f32>,
    pub(crate) y: Vec<f32>,
    pub(crate) rank: Vec<i32>,
}

/// Some rows of a [`Sheet`], to be written.
#[derive(Debug)]
pub(crate) struct SheetRows<'a> {
    first_row: u32,
    x: &'a mut [f32],
    y: &'a mut [f32],
    rank: &'a mut [i32],
}

impl Sheet {
    /// A sheet of empty cells.
    pub(crate) fn new(grid: &Grid) -> Self {
        // Rows of neighbors are read in whole lanes, so the last one reaches beyond the end.
        let length = grid.stride() * grid.rows() + LANES;
        Self {
            x: vec![FAR; length],
            y: vec![0.0; length],
            rank: vec![0; length],
        }
    }

    /// Cuts the rows of the domain into bands of `band_rows` rows.
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

    /// The cells, of the five from `start`, that hold a point in conflict with `place`, and those that hold anything in
    /// conflict with a rank of at least `rank`: two masks with a bit for each cell.
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

    /// The conflicts of the place in `cell`.
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
    /// A conflict with a point, and perhaps with proposals.
    Point,
    /// Conflicts with proposals of the same or a higher rank only: a bit for each cell around; no conflict if no bit is
    /// set.
    Proposals(u32),
}

impl Rivals {
    /// Calls `rival` with the cells around `cell` that hold the proposals until it returns true; returns whether it did.
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
    /// Puts a place into a cell, and into its copies in the margin of the same row.
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

/// Where the arrays hold the rows of the domain.
pub(crate) fn domain_rows(grid: &Grid) -> Range<usize> {
    let margin = HALO as usize * grid.stride();
    margin..margin + grid.cells[1] as usize * grid.stride()
}
