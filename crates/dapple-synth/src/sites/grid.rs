//! Which sites are near a position: cells of a cubic grid, in bricks of which only those with sites are kept.
//!
//! A surface meets few of the cells of its bounding box. Bricks of 8x8x8 cells are found by an open-addressed table;
//! the cells of a brick are laid out densely, so that a row of cells is one run of sites, and a ball of the size of a
//! cell needs about two searches in the table. Sites are sorted into their cells by counting. Reference: our own.

use crate::SiteIdx;
use core::ops::Range;
use glam::DVec3;

/// Sites sorted into the cells of a cubic grid.
#[derive(Clone, Debug)]
pub struct SiteGrid {
    /// Where the first cell begins.
    low: DVec3,
    /// One over the side of a cell.
    scale: f64,
    /// The last cell along each axis.
    last: [u32; 3],
    /// The keys of the bricks, ascending; they are numbered in this order.
    bricks: Vec<u64>,
    /// An open-addressed table of the bricks.
    table: Vec<Slot>,
    /// Where in `members` each cell of each brick begins, and the end.
    starts: Vec<u32>,
    members: Vec<SiteIdx>,
}

/// A place of the table: a brick, or [`EMPTY`].
#[derive(Clone, Copy, Debug)]
struct Slot {
    key: u64,
    brick: u32,
}

/// Cells from a first to a last one along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Block {
    low: [u32; 3],
    high: [u32; 3],
}

const EMPTY: u64 = u64::MAX;
/// The bits of a cell's number along one axis: three of them fit 64 bits.
const BITS: u32 = 21;
/// The bits of a cell's number in its brick along one axis.
const BRICK_BITS: u32 = 3;
/// The cells of a brick.
const BRICK_CELLS: usize = 1 << (3 * BRICK_BITS);
/// The least mean number of sites in a brick; below it cells are widened, which bounds the memory to 64 bytes for each
/// site.
const SITES_PER_BRICK: usize = 32;
/// The number of bricks that is always granted.
const BRICKS_LEAST: usize = 64;
/// The most bricks, whose cells can still be numbered in 32 bits.
const BRICKS_MOST: usize = (1 << 23) - 1;

impl SiteGrid {
    /// Sorts positions into cells of the given side; the sites are numbered in the order of `positions`.
    ///
    /// The side is in units of the positions. It is widened where it is so small that more than 2^21 cells would lie
    /// along an axis or most bricks of cells would hold very few sites. Takes time in proportion to the number of
    /// sites, which must be below 2^32; a position that is not finite lands in some cell.
    #[must_use]
    pub fn new(positions: &[DVec3], side: f64) -> Self {
        let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = positions
            .iter()
            .copied()
            .fold(DVec3::NEG_INFINITY, DVec3::max);
        let widest = (high - low).max_element().max(0.0);
        let least = (widest / f64::from((1_u32 << BITS) - 2)).max(f64::MIN_POSITIVE);
        let mut side = if side > least { side } else { least };
        let most = (positions.len() / SITES_PER_BRICK).clamp(BRICKS_LEAST, BRICKS_MOST);
        loop {
            let mut grid = Self::empty(low, high, side);
            if let Some(places) = grid.find_bricks(positions, most) {
                grid.sort(&places);
                return grid;
            }
            side *= 2.0;
        }
    }

    /// Calls `visit` with every site in the cells that a ball meets: all sites in the ball, and some around it. A ball
    /// with a negative radius has none.
    ///
    /// The order is that of the bricks, then of the cells in a brick, x first and z last both times, then of the sites
    /// in a cell: it depends on the positions and the side only.
    #[inline]
    pub fn visit(&self, center: DVec3, radius: f64, mut visit: impl FnMut(SiteIdx)) {
        self.visit_rows(center, radius, |row| {
            for &site in &self.members[row] {
                visit(site);
            }
        });
    }

    /// Calls `visit` with the ranges of [`members`](Self::members) that [`visit`](Self::visit) goes through.
    #[inline]
    pub(crate) fn visit_rows(&self, center: DVec3, radius: f64, visit: impl FnMut(Range<usize>)) {
        self.visit_between(
            self.cell(center - radius),
            self.cell(center + radius),
            visit,
        );
    }

    /// All sites, in the order of their cells.
    pub(crate) fn members(&self) -> &[SiteIdx] {
        &self.members
    }

    /// The cells that a ball can meet whose center is in the same cell as a position.
    #[inline]
    pub(crate) fn block(&self, position: DVec3, radius: f64) -> Block {
        // One cell more than is needed where the radius is a whole number of cells: there, rounding could matter.
        let away = (radius * self.scale) as u32;
        let cell = self.cell(position);
        Block {
            low: cell.map(|part| part.saturating_sub(away.saturating_add(1))),
            high: [0, 1, 2].map(|axis| {
                let high = cell[axis].saturating_add(away).saturating_add(1);
                high.min(self.last[axis])
            }),
        }
    }

    /// Calls `visit` with every site in the cells of a block, in the order of [`visit`](Self::visit).
    pub(crate) fn visit_block(&self, block: Block, mut visit: impl FnMut(SiteIdx)) {
        self.visit_between(block.low, block.high, |row| {
            for &site in &self.members[row] {
                visit(site);
            }
        });
    }

    /// Visits the sites of the cells from a first to a last one along each axis, row by row.
    #[inline]
    fn visit_between(&self, low: [u32; 3], high: [u32; 3], mut visit: impl FnMut(Range<usize>)) {
        if (0..3).any(|axis| low[axis] > high[axis]) {
            return;
        }
        let (first, last) = (low.map(brick_of), high.map(brick_of));
        let spans = [0, 1, 2].map(|axis| u64::from(last[axis] - first[axis]) + 1);
        if spans[0] * spans[1] * spans[2] > self.bricks.len() as u64 {
            return self.visit_all(low, high, visit);
        }
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    if let Some(brick) = self.find(key([x, y, z])) {
                        self.visit_brick(brick, [x, y, z], [low, high], &mut visit);
                    }
                }
            }
        }
    }

    fn empty(low: DVec3, high: DVec3, side: f64) -> Self {
        let mut grid = Self {
            low,
            scale: 1.0 / side,
            last: [(1 << BITS) - 1; 3],
            bricks: Vec::new(),
            table: Vec::new(),
            starts: Vec::new(),
            members: Vec::new(),
        };
        grid.last = grid.cell(high);
        grid
    }

    /// Fills the table and gives, for each site, the number of its cell among all cells of all bricks; nothing if there
    /// are more bricks than `most`.
    fn find_bricks(&mut self, positions: &[DVec3], most: usize) -> Option<Vec<u32>> {
        let slots = (2 * most.min(positions.len()) + 2).next_power_of_two();
        self.table = vec![
            Slot {
                key: EMPTY,
                brick: 0
            };
            slots
        ];
        let mut places = Vec::with_capacity(positions.len());
        let mut before = Slot {
            key: EMPTY,
            brick: 0,
        };
        for &position in positions {
            let cell = self.cell(position);
            let key = key(cell.map(brick_of));
            // Sites that follow each other are mostly near each other.
            if key != before.key {
                before = self.find_or_add(key);
                if self.bricks.len() > most {
                    return None;
                }
            }
            places.push(place(before.brick, cell));
        }
        self.number_by_key(&mut places);
        Some(places)
    }

    fn find_or_add(&mut self, key: u64) -> Slot {
        let mut at = self.slot(key);
        while self.table[at].key != key {
            if self.table[at].key == EMPTY {
                let brick = self.bricks.len() as u32;
                self.table[at] = Slot { key, brick };
                self.bricks.push(key);
                break;
            }
            at = (at + 1) & (self.table.len() - 1);
        }
        self.table[at]
    }

    /// Numbers the bricks by their keys instead of by which site came first.
    fn number_by_key(&mut self, places: &mut [u32]) {
        let found = core::mem::take(&mut self.bricks);
        self.bricks.clone_from(&found);
        self.bricks.sort_unstable();
        let mut numbers = vec![0_u32; found.len()];
        for slot in &mut self.table {
            if let Ok(number) = self.bricks.binary_search(&slot.key) {
                numbers[slot.brick as usize] = number as u32;
                slot.brick = number as u32;
            }
        }
        for place in places {
            let brick = *place as usize / BRICK_CELLS;
            *place = numbers[brick] * BRICK_CELLS as u32 + *place % BRICK_CELLS as u32;
        }
    }

    /// Sorts the sites by their cells.
    fn sort(&mut self, places: &[u32]) {
        let mut starts = vec![0_u32; self.bricks.len() * BRICK_CELLS + 1];
        for &place in places {
            starts[place as usize] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        self.members = vec![SiteIdx(0); places.len()];
        // From the last to the first, so that those of a cell stay in order and its start ends where it belongs.
        for (site, &place) in places.iter().enumerate().rev() {
            let start = &mut starts[place as usize];
            *start -= 1;
            self.members[*start as usize] = SiteIdx(site as u32);
        }
        self.starts = starts;
    }

    /// The cell of a position; outside of the grid, the nearest one.
    #[inline]
    fn cell(&self, position: DVec3) -> [u32; 3] {
        let cell = (position - self.low) * self.scale;
        // A conversion of a float saturates, and gives zero for NaN.
        [
            (cell.x as u32).min(self.last[0]),
            (cell.y as u32).min(self.last[1]),
            (cell.z as u32).min(self.last[2]),
        ]
    }

    #[inline]
    fn find(&self, key: u64) -> Option<u32> {
        let mut at = self.slot(key);
        loop {
            let slot = &self.table[at];
            if slot.key == key {
                return Some(slot.brick);
            }
            if slot.key == EMPTY {
                return None;
            }
            at = (at + 1) & (self.table.len() - 1);
        }
    }

    /// Where the search for a brick begins.
    #[inline]
    fn slot(&self, key: u64) -> usize {
        // Fibonacci hashing: the upper bits of the product with 2^64 over the golden ratio.
        let mixed = key.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mixed >> 32) as usize & (self.table.len() - 1)
    }

    /// Visits the rows of the cells of one brick that lie between two cells.
    #[inline]
    fn visit_brick(
        &self,
        brick: u32,
        at: [u32; 3],
        [low, high]: [[u32; 3]; 2],
        visit: &mut impl FnMut(Range<usize>),
    ) {
        let first = [0, 1, 2].map(|axis| low[axis].max(at[axis] << BRICK_BITS));
        let last = [0, 1, 2].map(|axis| high[axis].min(((at[axis] + 1) << BRICK_BITS) - 1));
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                let from = place(brick, [first[0], y, z]) as usize;
                let until = from + (last[0] - first[0]) as usize + 1;
                visit(self.starts[from] as usize..self.starts[until] as usize);
            }
        }
    }

    /// Visits the sites within a ball that meets more bricks than there are.
    fn visit_all(&self, low: [u32; 3], high: [u32; 3], mut visit: impl FnMut(Range<usize>)) {
        let mask = (1 << BITS) - 1;
        for (brick, &key) in (0..).zip(&self.bricks) {
            let at = [0, BITS, 2 * BITS].map(|shift| (key >> shift & mask) as u32);
            let meets =
                |axis: usize| (brick_of(low[axis])..=brick_of(high[axis])).contains(&at[axis]);
            if meets(0) && meets(1) && meets(2) {
                self.visit_brick(brick, at, [low, high], &mut visit);
            }
        }
    }
}

#[inline]
fn brick_of(cell: u32) -> u32 {
    cell >> BRICK_BITS
}

/// A brick in one number, which sorts by z, then y, then x.
#[inline]
fn key([x, y, z]: [u32; 3]) -> u64 {
    u64::from(x) | u64::from(y) << BITS | u64::from(z) << (2 * BITS)
}

/// The number of a cell of a brick among all.
#[inline]
fn place(brick: u32, cell: [u32; 3]) -> u32 {
    let [x, y, z] = cell.map(|part| part & ((1 << BRICK_BITS) - 1));
    ((brick << BRICK_BITS | z) << BRICK_BITS | y) << BRICK_BITS | x
}

#[cfg(test)]
mod tests;
