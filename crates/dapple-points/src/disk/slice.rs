//! One slice of time: every open cell proposes at most one place, and the proposals are settled among themselves.
//!
//! Proposals have random ranks. One is accepted if it conflicts with no point and with no accepted proposal of higher
//! rank: what sequential dart throwing in the order of the ranks would do, but whether a proposal is accepted depends
//! only on a few around it, so nobody has to go in order.

use super::gap::GapSearch;
use super::grid::{Cell, Grid, HALO};
use super::mask::{Coverage, REACH, SIDE, select};
use super::sheet::{GIVEN, HIGHEST_PROPOSAL, Sheet, SheetRows};
use core::ops::Range;
use dapple_hash::{CellHash, Seed};

/// A place that a cell would like to have a point at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proposal {
    pub(crate) cell: Cell,
    pub(crate) offset: [f32; 2],
    pub(crate) rank: u32,
    pub(crate) accepted: bool,
}

/// How cells come to their proposals.
#[derive(Clone, Debug)]
pub(crate) enum Draw {
    /// By throwing darts at the set subcells: the chance to propose, as a part of 2^32, by the number of set bits.
    Darts([u64; SIDE * SIDE + 1]),
    /// By an exact search for free places; a cell without any is closed.
    Gaps,
}

impl Draw {
    /// Darts at a cell for a time in which a cell without points is hit `mean` times on average.
    pub(crate) fn darts(mean: f64) -> Self {
        let subcells = (SIDE * SIDE) as f64;
        Self::Darts(core::array::from_fn(|open| {
            let hit = -libm::expm1(-mean * open as f64 / subcells);
            (hit * f64::from(u32::MAX)) as u64
        }))
    }
}

/// Consecutive rows of cells, which are worked on together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Band {
    /// Its rows, counted with the margin.
    pub(crate) rows: Range<u32>,
    /// Cells that may still take a point.
    pub(crate) open: Vec<Cell>,
    pub(crate) proposals: Vec<Proposal>,
    /// What is known about the proposals of this band, by cell.
    verdicts: Vec<Verdict>,
    search: GapSearch,
}

/// What is known about a proposal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Verdict {
    #[default]
    Unknown,
    Accepted,
    Rejected,
}

impl Band {
    /// A band whose cells are all open.
    pub(crate) fn new(grid: &Grid, rows: Range<u32>) -> Self {
        let columns = HALO..HALO + grid.cells[0];
        let open = rows
            .clone()
            .flat_map(|row| columns.clone().map(move |column| Cell { row, column }))
            .collect();
        Self {
            open,
            verdicts: vec![Verdict::Unknown; rows.len() * grid.stride()],
            rows,
            ..Self::default()
        }
    }

    /// Drops the closed cells and draws the proposals of the others. `masks` are those of the band's rows.
    pub(crate) fn draw(
        &mut self,
        grid: &Grid,
        sheet: &Sheet,
        masks: &mut [u64],
        draw: &Draw,
        seed: Seed,
    ) {
        let Self {
            rows,
            open,
            proposals,
            search,
            ..
        } = self;
        proposals.clear();
        open.retain(|&cell| {
            let mask = &mut masks[grid.index(Cell {
                row: cell.row - rows.start,
                ..cell
            })];
            if *mask == 0 {
                return false;
            }
            let hash = CellHash::new(seed, [i64::from(cell.column), i64::from(cell.row)]);
            let place = match draw {
                Draw::Darts(chances) => dart(*mask, chances, hash),
                Draw::Gaps => search.find(grid, mask, sheet.points_around(grid, cell), hash),
            };
            let rank = (hash.at(u32::MAX) >> 32) as u32;
            proposals.extend(place.map(|offset| Proposal {
                cell,
                offset,
                rank: rank.clamp(1, HIGHEST_PROPOSAL),
                accepted: false,
            }));
            // An exact search that found nothing has proved that there is nothing.
            place.is_some() || matches!(draw, Draw::Darts(_))
        });
    }

    /// Writes the proposals into the sheet.
    pub(crate) fn place(&self, grid: &Grid, mut rows: SheetRows<'_>) {
        for proposal in &self.proposals {
            rows.put(grid, proposal.cell, proposal.offset, proposal.rank);
        }
    }

    /// Decides which proposals are accepted.
    pub(crate) fn settle(&mut self, grid: &Grid, sheet: &Sheet) {
        let mut proposals = core::mem::take(&mut self.proposals);
        for proposal in &mut proposals {
            proposal.accepted = self.is_accepted(grid, sheet, proposal.cell);
        }
        for proposal in &proposals {
            let index = self.own_index(grid, proposal.cell);
            self.verdicts[index] = Verdict::Unknown;
        }
        self.proposals = proposals;
    }

    /// Whether the proposal of a cell is accepted.
    ///
    /// The answers within the band are kept; those of proposals in other bands are worked out again by each band that
    /// needs them, so that bands share nothing.
    fn is_accepted(&mut self, grid: &Grid, sheet: &Sheet, cell: Cell) -> bool {
        let own = self
            .rows
            .contains(&cell.row)
            .then(|| self.own_index(grid, cell));
        match own.map_or(Verdict::Unknown, |own| self.verdicts[own]) {
            Verdict::Accepted => return true,
            Verdict::Rejected => return false,
            Verdict::Unknown => {}
        }
        let accepted = !sheet.any_rival(grid, cell, |rival| {
            let rank = sheet.rank[grid.index(rival)];
            let original = grid.original(rival);
            let above = (rank, original) > (sheet.rank[grid.index(cell)], cell);
            above && (rank >= GIVEN || self.is_accepted(grid, sheet, original))
        });
        if let Some(own) = own {
            self.verdicts[own] = if accepted {
                Verdict::Accepted
            } else {
                Verdict::Rejected
            };
        }
        accepted
    }

    fn own_index(&self, grid: &Grid, cell: Cell) -> usize {
        grid.index(Cell {
            row: cell.row - self.rows.start,
            ..cell
        })
    }

    /// Makes points of the accepted proposals and takes the others out of the sheet.
    pub(crate) fn keep_accepted(&self, grid: &Grid, mut rows: SheetRows<'_>, rank: u32) {
        for proposal in &self.proposals {
            if proposal.accepted {
                rows.put(grid, proposal.cell, proposal.offset, rank);
            } else {
                rows.put(grid, proposal.cell, [super::grid::FAR; 2], 0);
            }
        }
    }

    /// The accepted proposals.
    pub(crate) fn accepted(&self) -> impl DoubleEndedIterator<Item = &Proposal> {
        self.proposals.iter().filter(|proposal| proposal.accepted)
    }
}

/// A dart into the set subcells of `mask`, if one hits within the slice.
#[inline(always)]
fn dart(mask: u64, chances: &[u64; SIDE * SIDE + 1], hash: CellHash) -> Option<[f32; 2]> {
    let open = mask.count_ones();
    if (hash.at(0) & 0xFFFF_FFFF) >= chances[open as usize] {
        return None;
    }
    let bits = hash.at(1);
    let subcell = select(mask, ((bits >> 38) * u64::from(open) >> 26) as u32);
    let within = super::grid::LATTICE / SIDE as u32;
    let along = |subcell: u32, bits: u64| {
        (subcell * within + (bits as u32 & (within - 1))) as f32 * super::grid::STEP
    };
    let side = SIDE as u32;
    Some([
        along(subcell % side, bits),
        along(subcell / side, bits >> 19),
    ])
}

/// Clears in `masks`, those of the rows `rows`, what the accepted proposals of a band cover.
pub(crate) fn cover(
    grid: &Grid,
    coverage: &Coverage,
    masks: &mut [u64],
    rows: &Range<u32>,
    band: &Band,
) {
    for proposal in band.accepted() {
        let kept = coverage.kept(proposal.offset);
        for (row, kept) in (0..).zip(kept) {
            let row = grid.original_index(1, proposal.cell.row + row - HALO);
            if rows.contains(&row) {
                let row =
                    &mut masks[(row - rows.start) as usize * grid.stride()..][..grid.stride()];
                cover_row(grid, row, proposal.cell.column, kept);
            }
        }
        if rows.contains(&proposal.cell.row) {
            // The table leaves the edges of the cell, but the cell is no wider than the disc.
            let row = proposal.cell.row - rows.start;
            masks[grid.index(Cell {
                row,
                ..proposal.cell
            })] = 0;
        }
    }
}

/// Clears what a point in column `column` covers of a row.
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
