//! Which sites are near a position: cells of a cubic grid, of which only those with sites are kept.

use crate::SiteIdx;
use glam::DVec3;

/// Sites sorted into the cells of a cubic grid, found by an open-addressed table.
#[derive(Clone, Debug)]
pub struct SiteGrid {
    side: f64,
    low: DVec3,
    /// For each slot of the table the cell and where its sites begin; `EMPTY` where there is none.
    table: Vec<Slot>,
    members: Vec<SiteIdx>,
}

#[derive(Clone, Copy, Debug)]
struct Slot {
    cell: u64,
    first: u32,
    end: u32,
}

const EMPTY: u64 = u64::MAX;
/// The bits of a cell's number along one axis.
const BITS: u32 = 21;

impl SiteGrid {
    /// Sorts positions into cells of the given side; the sites are numbered in the order of `positions`.
    ///
    /// The side is widened if more than 2^21 cells would lie along an axis.
    #[must_use]
    pub fn new(positions: &[DVec3], side: f64) -> Self {
        let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = positions
            .iter()
            .copied()
            .fold(DVec3::NEG_INFINITY, DVec3::max);
        let widest = (high - low).max_element().max(0.0);
        let least = widest / f64::from((1_u32 << BITS) - 4);
        let side = if side > least {
            side
        } else {
            least.max(f64::MIN_POSITIVE)
        };
        let mut grid = Self {
            side,
            low,
            table: Vec::new(),
            members: Vec::new(),
        };
        let mut keyed: Vec<(u64, u32)> = (0..)
            .zip(positions)
            .map(|(site, &position)| (key(grid.cell(position)), site))
            .collect();
        keyed.sort_unstable();
        let n_cells = keyed.chunk_by(|a, b| a.0 == b.0).count();
        let empty = Slot {
            cell: EMPTY,
            first: 0,
            end: 0,
        };
        grid.table = vec![empty; (2 * n_cells).next_power_of_two().max(2)];
        let mut first = 0;
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            let end = first + group.len() as u32;
            let cell = group[0].0;
            let mut at = grid.slot(cell);
            while grid.table[at].cell != EMPTY {
                at = (at + 1) & (grid.table.len() - 1);
            }
            grid.table[at] = Slot { cell, first, end };
            first = end;
        }
        grid.members = keyed.into_iter().map(|(_, site)| SiteIdx(site)).collect();
        grid
    }

    /// Calls `visit` with every site in the cells that a ball meets: all sites in the ball, and some around it.
    ///
    /// The order is that of the cells, x first, and of the sites within a cell.
    #[inline]
    pub fn visit(&self, center: DVec3, radius: f64, mut visit: impl FnMut(SiteIdx)) {
        let [low, high] = [self.cell(center - radius), self.cell(center + radius)];
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    for &site in self.members_of(key([x, y, z])) {
                        visit(site);
                    }
                }
            }
        }
    }

    /// The cell of a position, from 1 on, so that there is room around the outermost ones; positions outside of the grid
    /// are taken for the nearest ones within one cell of it.
    #[inline]
    fn cell(&self, position: DVec3) -> [u32; 3] {
        let most = f64::from((1_u32 << BITS) - 1);
        ((position - self.low) / self.side + 1.0)
            .to_array()
            .map(|part| part.clamp(0.0, most) as u32)
    }

    #[inline]
    fn members_of(&self, cell: u64) -> &[SiteIdx] {
        let mut at = self.slot(cell);
        loop {
            let slot = &self.table[at];
            if slot.cell == cell {
                return &self.members[slot.first as usize..slot.end as usize];
            }
            if slot.cell == EMPTY {
                return &[];
            }
            at = (at + 1) & (self.table.len() - 1);
        }
    }

    /// Where the search for a cell begins.
    #[inline]
    fn slot(&self, cell: u64) -> usize {
        // Fibonacci hashing: the upper bits of the product with 2^64 over the golden ratio.
        let mixed = cell.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mixed >> 32) as usize & (self.table.len() - 1)
    }
}

#[inline]
fn key([x, y, z]: [u32; 3]) -> u64 {
    u64::from(x) | u64::from(y) << BITS | u64::from(z) << (2 * BITS)
}
