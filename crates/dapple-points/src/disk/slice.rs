//! A time slice, in which every open cell proposes at most one point and conflicts between proposals are resolved.
//!
//! Proposals have random ranks. A proposal is accepted if it conflicts with no point and with no accepted proposal of
//! higher rank. This equals sequential dart throwing in the order of the ranks. Each decision depends only on a few
//! nearby proposals, so that proposals can be settled in any order.

use super::gap::GapSearch;
use super::grid::{Cell, FAR, Grid, HALO, LATTICE, STEP};
use super::mask::{Coverage, REACH, SIDE, select};
use super::sheet::{HIGHEST_PROPOSAL, POINT, Rivals, Sheet, SheetRows};
use core::ops::Range;
use dapple_hash::Seed;
use dapple_raster::simd::dispatch;
use fearless_simd::{Level, prelude::*};

/// The point that a cell proposes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proposal {
    pub(crate) cell: Cell,
    pub(crate) offset: [f32; 2],
    pub(crate) verdict: Verdict,
}

/// State of a proposal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Accepted,
    Rejected,
    /// Undecided: it conflicts with these proposals of equal or higher rank, one bit per surrounding cell.
    Open(u32),
}

/// Number of cells whose darts are drawn together.
const BATCH: usize = 64;

/// Probability that a cell proposes a point, in units of 2^-32, indexed by the number of its open subcells.
pub(crate) type Chances = [u64; SIDE * SIDE + 1];

/// Returns the probabilities for a slice in which an empty cell receives `mean` darts on average.
pub(crate) fn dart_chances(mean: f64) -> Chances {
    let subcells = (SIDE * SIDE) as f64;
    core::array::from_fn(|open| {
        let hit = -libm::expm1(-mean * open as f64 / subcells);
        (hit * f64::from(u32::MAX)) as u64
    })
}

/// Consecutive rows of cells that are processed together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Band {
    /// Rows of the band, as array rows that count the margin.
    pub(crate) rows: Range<u32>,
    /// Cells that may still take a point.
    pub(crate) open: Vec<Cell>,
    proposals: Vec<Proposal>,
    /// Positions of the proposals accepted in the latest slice.
    pub(crate) accepted: Vec<(Cell, [f32; 2])>,
    /// For each cell, the index of its proposal; stale if the cell has none.
    slots: Vec<u32>,
    search: GapSearch,
}

impl Band {
    /// Creates a band in which all cells are open.
    pub(crate) fn new(grid: &Grid, rows: Range<u32>) -> Self {
        let columns = HALO..HALO + grid.cells[0];
        let mut open = Vec::with_capacity(rows.len() * columns.len());
        for row in rows.clone() {
            open.extend(columns.clone().map(|column| Cell { row, column }));
        }
        Self {
            open,
            slots: vec![0; rows.len() * grid.stride()],
            rows,
            ..Self::default()
        }
    }

    /// Draws the proposals of the open cells by throwing darts, and drops closed cells. `masks` are the masks of the
    /// rows of the band.
    ///
    /// `chances` comes from [`dart_chances`].
    #[inline(always)]
    pub(crate) fn draw_darts(
        &mut self,
        grid: &Grid,
        mut sheet: SheetRows<'_>,
        masks: &[u64],
        chances: &Chances,
        seed: Seed,
    ) {
        let first = self.rows.start as usize * grid.stride();
        let mut kept = 0;
        self.proposals.clear();
        for start in (0..self.open.len()).step_by(BATCH) {
            // Three loops: one that vectorizes, one without branches, and one over the few cells that propose.
            let mut lots = [0; BATCH];
            let end = self.open.len().min(start + BATCH);
            for (lot, &cell) in lots.iter_mut().zip(&self.open[start..end]) {
                *lot = grid.hash(seed, cell).at(0);
            }
            let mut hits = [0; BATCH];
            let mut n_hits = 0;
            for at in start..end {
                let cell = self.open[at];
                let mask = masks[grid.index(cell) - first];
                self.open[kept] = cell;
                kept += usize::from(mask != 0);
                hits[n_hits] = kept.wrapping_sub(1);
                let lot = lots[at - start];
                lots[n_hits] = lot;
                n_hits += usize::from((lot & 0xFFFF_FFFF) < chances[mask.count_ones() as usize]);
            }
            for (&at, &lot) in hits[..n_hits].iter().zip(&lots) {
                let cell = self.open[at];
                let index = grid.index(cell) - first;
                let offset = dart(masks[index], grid.hash(seed, cell).at(1));
                self.propose(index, cell, offset);
                sheet.put(grid, cell, offset, rank(lot));
            }
        }
        self.open.truncate(kept);
    }

    /// Draws the proposals of the open cells by exact search, and drops cells without a free position. `masks` are the
    /// masks of the rows of the band.
    #[inline(always)]
    pub(crate) fn draw_gaps<S: Simd>(
        &mut self,
        simd: S,
        grid: &Grid,
        sheet: &Sheet,
        masks: &mut [u64],
        seed: Seed,
    ) {
        let first = self.rows.start as usize * grid.stride();
        let mut kept = 0;
        self.proposals.clear();
        for at in 0..self.open.len() {
            let cell = self.open[at];
            let index = grid.index(cell) - first;
            if masks[index] == 0 {
                continue;
            }
            let hash = grid.hash(seed, cell);
            self.search.gather(simd, grid, sheet, cell);
            let place = self.search.find(simd, grid, &mut masks[index], hash);
            if let Some(offset) = place {
                self.propose(index, cell, offset);
                self.open[kept] = cell;
                kept += 1;
            }
        }
        self.open.truncate(kept);
    }

    #[inline(always)]
    fn propose(&mut self, index: usize, cell: Cell, offset: [f32; 2]) {
        self.slots[index] = self.proposals.len() as u32;
        self.proposals.push(Proposal {
            cell,
            offset,
            verdict: Verdict::Rejected,
        });
    }

    /// Writes the proposals of the exact search to the sheet, which the search itself reads.
    pub(crate) fn place_gaps(&self, grid: &Grid, mut sheet: SheetRows<'_>, seed: Seed) {
        for proposal in &self.proposals {
            let lot = grid.hash(seed, proposal.cell).at(0);
            sheet.put(grid, proposal.cell, proposal.offset, rank(lot));
        }
    }

    /// Finds the conflicts of all proposals.
    #[inline(always)]
    pub(crate) fn judge<S: Simd>(&mut self, simd: S, grid: &Grid, sheet: &Sheet) {
        for proposal in &mut self.proposals {
            proposal.verdict = match sheet.rivals(simd, grid, proposal.cell) {
                Rivals::Point => Verdict::Rejected,
                Rivals::Proposals(0) => Verdict::Accepted,
                Rivals::Proposals(rivals) => Verdict::Open(rivals),
            }
        }
    }

    /// Decides which proposals are accepted, after [`judge`](Self::judge).
    pub(crate) fn settle(&mut self, grid: &Grid, sheet: &Sheet) {
        for slot in 0..self.proposals.len() {
            let Proposal { cell, verdict, .. } = self.proposals[slot];
            if matches!(verdict, Verdict::Open(_)) {
                self.is_accepted(grid, sheet, cell);
            }
        }
        // Write every proposal, and advance the slot only if it was accepted: there is no branch to mispredict.
        self.accepted
            .resize(self.proposals.len() + 1, (Cell::default(), [0.0; 2]));
        let mut n_accepted = 0;
        for proposal in &self.proposals {
            self.accepted[n_accepted] = (proposal.cell, proposal.offset);
            n_accepted += usize::from(proposal.verdict == Verdict::Accepted);
        }
        self.accepted.truncate(n_accepted);
    }

    /// Returns whether the proposal of a cell is accepted.
    ///
    /// Results within the band are cached. Results about proposals in other bands are recomputed by each band that
    /// needs them, so that bands share no memory.
    fn is_accepted(&mut self, grid: &Grid, sheet: &Sheet, cell: Cell) -> bool {
        let slot = self.rows.contains(&cell.row).then(|| {
            let index = grid.index(cell) - self.rows.start as usize * grid.stride();
            self.slots[index] as usize
        });
        let verdict = match slot {
            Some(slot) => self.proposals[slot].verdict,
            None => match dispatch!(Level::baseline(), simd => sheet.rivals(simd, grid, cell)) {
                Rivals::Point => Verdict::Rejected,
                Rivals::Proposals(rivals) => Verdict::Open(rivals),
            },
        };
        let rivals = match verdict {
            Verdict::Accepted => return true,
            Verdict::Rejected => return false,
            Verdict::Open(rivals) => rivals,
        };
        let rank = sheet.rank[grid.index(cell)];
        let accepted = !Rivals::any(rivals, cell, |rival| {
            let original = grid.original(rival);
            (sheet.rank[grid.index(rival)], original) > (rank, cell)
                && self.is_accepted(grid, sheet, original)
        });
        if let Some(slot) = slot {
            self.proposals[slot].verdict = if accepted {
                Verdict::Accepted
            } else {
                Verdict::Rejected
            };
        }
        accepted
    }

    /// Converts accepted proposals to points, and removes the others from the sheet.
    pub(crate) fn keep_accepted(&self, grid: &Grid, mut sheet: SheetRows<'_>) {
        for proposal in &self.proposals {
            let x = if proposal.verdict == Verdict::Accepted {
                proposal.offset[0]
            } else {
                FAR
            };
            sheet.put(grid, proposal.cell, [x, proposal.offset[1]], POINT);
        }
    }
}

/// Derives a proposal's rank from the upper half of its random bits; the lower half is used elsewhere.
#[inline(always)]
fn rank(lot: u64) -> i32 {
    ((lot >> 33) as i32).min(HIGHEST_PROPOSAL)
}

/// Returns a random position in the open subcells of `mask`.
#[inline(always)]
fn dart(mask: u64, bits: u64) -> [f32; 2] {
    let rank = ((bits >> 38) * u64::from(mask.count_ones())) >> 26;
    let subcell = select(mask, rank as u32);
    let size = LATTICE / SIDE as u32;
    let along =
        |subcell: u32, bits: u64| (subcell * size + (bits as u32 & (size - 1))) as f32 * STEP;
    let side = SIDE as u32;
    [
        along(subcell % side, bits),
        along(subcell / side, bits >> 19),
    ]
}

/// Clears the subcells that the accepted points of a band cover. `masks` are the masks of the rows `rows`.
#[inline(always)]
pub(crate) fn cover(
    grid: &Grid,
    coverage: &Coverage,
    masks: &mut [u64],
    rows: &Range<u32>,
    accepted: &[(Cell, [f32; 2])],
) {
    for &(cell, offset) in accepted {
        let kept = coverage.kept(offset);
        for (row, kept) in (0..).zip(kept) {
            let row = grid.original_index(1, cell.row + row - HALO);
            if rows.contains(&row) {
                let start = (row - rows.start) as usize * grid.stride();
                cover_row(
                    grid,
                    &mut masks[start..start + grid.stride()],
                    cell.column,
                    kept,
                );
            }
        }
        if rows.contains(&cell.row) {
            // The table keeps the edges of the cell, but a disc covers its whole cell.
            let row = cell.row - rows.start;
            masks[grid.index(Cell { row, ..cell })] = 0;
        }
    }
}

/// Clears the subcells in one row of cells that a point in column `column` covers.
#[inline(always)]
fn cover_row(grid: &Grid, row: &mut [u64], column: u32, kept: &[u64; REACH]) {
    let first = (column - HALO) as usize;
    for (mask, kept) in row[first..first + REACH].iter_mut().zip(kept) {
        *mask &= kept;
    }
    let inner = column >= 2 * HALO && column < grid.cells[0];
    if !inner && grid.domain.wrap[0] {
        for (kept, column) in kept.iter().zip(column - HALO..) {
            row[grid.original_index(0, column) as usize] &= kept;
        }
    }
}
