//! What the cells hold: at most one place each, a point or the proposal of one.

use super::grid::{Cell, FAR, Grid, HALO};
use super::mask::REACH;
use core::ops::Range;

/// The rank of a point that was placed in this run; above all proposals.
pub(crate) const POINT: u32 = u32::MAX;

/// The rank of a point that was given; above all proposals.
pub(crate) const GIVEN: u32 = u32::MAX - 1;

/// The highest rank of a proposal.
pub(crate) const HIGHEST_PROPOSAL: u32 = u32::MAX - 2;

/// Lanes that are looked at together; a row of [`REACH`] cells fits.
const LANES: usize = 8;

/// The columns of a row of neighbors, relative to the middle one; lanes beyond the reach are far away.
const COLUMNS: [f32; LANES] = [-2.0, -1.0, 0.0, 1.0, 2.0, FAR, FAR, FAR];

/// Rows of neighbors, the most likely to conflict first.
const ROWS: [isize; REACH] = [0, -1, 1, -2, 2];

/// Offsets and ranks of all cells, margin included, row by row.
///
/// An empty cell is at [`FAR`] and has rank 0.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) x: Vec<f32>,
    pub(crate) y: Vec<f32>,
    pub(crate) rank: Vec<u32>,
}

/// Some rows of a [`Sheet`], to be written.
#[derive(Debug)]
pub(crate) struct SheetRows<'a> {
    first_row: u32,
    x: &'a mut [f32],
    y: &'a mut [f32],
    rank: &'a mut [u32],
}

impl Sheet {
    /// A sheet of empty cells.
    pub(crate) fn new(grid: &Grid) -> Self {
        // Rows of neighbors are read in whole lanes, so the last one reaches beyond the end.
        let length = grid.stride() * grid.rows() + LANES;
        Self {
            x: vec![FAR; length],
            y: vec![FAR; length],
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

    /// Where the points around a cell are, relative to the cell.
    pub(crate) fn points_around<'a>(
        &'a self,
        grid: &Grid,
        cell: Cell,
    ) -> impl Iterator<Item = [f32; 2]> + 'a {
        let (middle, stride) = (grid.index(cell), grid.stride());
        (0..REACH).flat_map(move |row| {
            let start = middle + row * stride - HALO as usize * stride - HALO as usize;
            (0..REACH).filter_map(move |column| {
                let (x, y) = (self.x[start + column], self.y[start + column]);
                (x < FAR).then(|| {
                    [
                        x + column as f32 - HALO as f32,
                        y + row as f32 - HALO as f32,
                    ]
                })
            })
        })
    }

    /// Calls `rival` with every cell around `cell` that holds a place in conflict and of no lower rank, until it
    /// returns true; returns whether it did.
    #[inline(always)]
    pub(crate) fn any_rival(
        &self,
        grid: &Grid,
        cell: Cell,
        mut rival: impl FnMut(Cell) -> bool,
    ) -> bool {
        let middle = grid.index(cell);
        let (x, y, rank) = (self.x[middle], self.y[middle], self.rank[middle]);
        for row in ROWS {
            let start = (middle as isize + row * grid.stride() as isize) as usize - HALO as usize;
            let mut found = self.rivals_in_row(grid, start, [x, y - row as f32], rank);
            if row == 0 {
                found &= !(1 << HALO);
            }
            while found != 0 {
                let column = found.trailing_zeros();
                found &= found - 1;
                let other = Cell {
                    row: (cell.row as isize + row) as u32,
                    column: cell.column + column - HALO,
                };
                if rival(other) {
                    return true;
                }
            }
        }
        false
    }

    /// Which of the five cells from `start` hold a place in conflict with `place` and of no lower rank than `rank`.
    #[inline(always)]
    fn rivals_in_row(&self, grid: &Grid, start: usize, [x, y]: [f32; 2], rank: u32) -> u32 {
        let xs: &[f32; LANES] = self.x[start..start + LANES]
            .try_into()
            .expect("a slice of this length");
        let ys: &[f32; LANES] = self.y[start..start + LANES]
            .try_into()
            .expect("a slice of this length");
        let ranks: &[u32; LANES] = self.rank[start..start + LANES]
            .try_into()
            .expect("a slice of this length");
        let mut found = 0;
        for lane in 0..LANES {
            let distance_sq = grid.distance_sq(xs[lane] + COLUMNS[lane] - x, ys[lane] - y);
            found |= u32::from(distance_sq < 1.0 && ranks[lane] >= rank) << lane;
        }
        found
    }
}

impl SheetRows<'_> {
    /// Puts a place into a cell, and into its copies in the margin of the same row.
    #[inline(always)]
    pub(crate) fn put(&mut self, grid: &Grid, cell: Cell, offset: [f32; 2], rank: u32) {
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
    fn put_one(&mut self, index: usize, [x, y]: [f32; 2], rank: u32) {
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
