//! Spatial index of sites: a cubic grid of cells, stored sparsely as bricks.
//!
//! A surface meets only a few cells of its bounding box, so only bricks of 8x8x8 cells that contain sites are stored.
//! An open-addressed hash table finds them. The cells of a brick are stored densely, so the sites in a row of cells are
//! contiguous. A query with a ball the size of a cell needs about two table lookups. Sites are sorted into cells by
//! counting sort. The design is our own.

use crate::SiteIdx;
use core::ops::Range;
use dapple_raster::Groups;
use glam::DVec3;

/// Sites sorted into the cells of a cubic grid.
#[derive(Clone, Debug)]
pub struct SiteGrid {
    /// Corner of the grid with the lowest coordinates.
    low: DVec3,
    /// Inverse of the side of a cell.
    scale: f64,
    /// Index of the last cell along each axis.
    last: [u32; 3],
    /// Keys of the bricks in ascending order. The index of a brick is its position here.
    bricks: Vec<u64>,
    /// Open-addressed hash table from brick key to brick index.
    table: Vec<Slot>,
    /// Start of each cell in `members`, brick by brick, plus the end of the last one.
    starts: Vec<u32>,
    /// Sites sorted by cell.
    members: Vec<SiteIdx>,
}

/// A slot of the hash table: a brick with its key, or the key [`EMPTY`].
#[derive(Clone, Copy, Debug)]
struct Slot {
    key: u64,
    brick: u32,
}

/// A box of cells, with the first and the last cell along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Block {
    low: [u32; 3],
    high: [u32; 3],
}

/// Key of an empty slot.
const EMPTY: u64 = u64::MAX;
/// Bits of a cell coordinate. Three coordinates fit into 64 bits.
const BITS: u32 = 21;
/// Bits of a cell coordinate within its brick.
const BRICK_BITS: u32 = 3;
/// Number of cells in a brick.
const BRICK_CELLS: usize = 1 << (3 * BRICK_BITS);
/// Minimum mean number of sites per brick. With fewer, cells are made larger, which bounds the memory to 64 bytes per
/// site.
const SITES_PER_BRICK: usize = 32;
/// Number of bricks that is always allowed, however few the sites.
const BRICKS_LEAST: usize = 64;
/// Maximum number of bricks, for which the cells still have 32-bit indices.
const BRICKS_MOST: usize = (1 << 23) - 1;

impl SiteGrid {
    /// Sorts `positions` into cells with sides of length `side`, in the same unit as the positions. Site indices are
    /// indices in `positions`.
    ///
    /// The side is increased if there would be more than 2^21 cells along an axis, or fewer than 32 sites per brick on
    /// average. Time is linear in the number of sites, which must be below 2^32. A position that is not finite is put
    /// into an arbitrary cell.
    #[must_use]
    pub fn new(positions: &[DVec3], side: f64) -> Self {
        let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = positions
            .iter()
            .copied()
            .fold(DVec3::NEG_INFINITY, DVec3::max);
        let widest = (high - low).max_element().max(0.0);
        // Cells must be large enough for cell coordinates of 21 bits.
        let least = (widest / f64::from((1_u32 << BITS) - 2)).max(f64::MIN_POSITIVE);
        let mut side = if side > least { side } else { least };
        let most = (positions.len() / SITES_PER_BRICK).clamp(BRICKS_LEAST, BRICKS_MOST);
        // Double the side until the number of bricks is within the limit.
        loop {
            let mut grid = Self::empty(low, high, side);
            if let Some(places) = grid.find_bricks(positions, most) {
                grid.sort(&places);
                return grid;
            }
            side *= 2.0;
        }
    }

    /// Calls `visit` with every site in the cells that the bounding box of a ball meets. These are all sites in the
    /// ball, and some around it. A ball with a negative radius has no sites.
    ///
    /// The order depends only on the positions and the side: by brick, then by cell in the brick (x fastest and z
    /// slowest for both), then by site index in the cell.
    #[inline]
    pub fn visit(&self, center: DVec3, radius: f64, visit: impl FnMut(SiteIdx)) {
        self.visit_rows(center, radius, self.sites_of(visit));
    }

    /// Calls `visit` with the ranges of [`members`](Self::members) whose sites [`visit`](Self::visit) visits.
    #[inline]
    pub(crate) fn visit_rows(&self, center: DVec3, radius: f64, visit: impl FnMut(Range<usize>)) {
        self.visit_between(
            self.cell(center - radius),
            self.cell(center + radius),
            visit,
        );
    }

    /// Returns all sites, sorted by cell.
    pub(crate) fn members(&self) -> &[SiteIdx] {
        &self.members
    }

    /// Returns the cells that any ball of the given radius can meet if its center is in the same cell as `position`.
    #[inline]
    pub(crate) fn block(&self, position: DVec3, radius: f64) -> Block {
        // One cell more than needed if the radius is a whole number of cells, since rounding could matter there.
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

    /// Calls `visit` with every site in the cells of `block`, in the order of [`visit`](Self::visit).
    pub(crate) fn visit_block(&self, block: Block, visit: impl FnMut(SiteIdx)) {
        self.visit_between(block.low, block.high, self.sites_of(visit));
    }

    /// Returns a visitor of ranges of [`members`](Self::members) that calls `visit` with each of their sites.
    #[inline]
    fn sites_of(&self, mut visit: impl FnMut(SiteIdx)) -> impl FnMut(Range<usize>) {
        move |row| {
            for &site in &self.members[row] {
                visit(site);
            }
        }
    }

    /// Visits the sites of the cells from `low` to `high` along each axis, row by row.
    #[inline]
    fn visit_between(&self, low: [u32; 3], high: [u32; 3], mut visit: impl FnMut(Range<usize>)) {
        if (0..3).any(|axis| low[axis] > high[axis]) {
            return;
        }
        let (first, last) = (low.map(brick_of), high.map(brick_of));
        let spans = [0, 1, 2].map(|axis| u64::from(last[axis] - first[axis]) + 1);
        // If the box has more bricks than the grid, scan all bricks instead of looking each one up.
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

    /// Returns a grid over the bounding box from `low` to `high`, without sites or bricks.
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

    /// Fills the table, and returns for each site the index of its cell among the cells of all bricks. `None` if there
    /// are more than `most` bricks.
    fn find_bricks(&mut self, positions: &[DVec3], most: usize) -> Option<Vec<u32>> {
        // At most half of the slots are used, so a probe soon meets its key or an empty slot.
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
            // Consecutive sites are mostly in the same brick, so try the previous one first.
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

    /// Returns the slot of the brick with the key `key`, and adds the brick if it is new.
    fn find_or_add(&mut self, key: u64) -> Slot {
        let mut at = self.slot(key);
        // Linear probing: advance until the key or an empty slot is found.
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

    /// Renumbers the bricks from order of insertion to order of keys.
    fn number_by_key(&mut self, places: &mut [u32]) {
        // In the order of keys, visits do not depend on the order in which the sites are given.
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

    /// Sorts the sites by cell.
    fn sort(&mut self, places: &[u32]) {
        let cells = Groups::sort(self.bricks.len() * BRICK_CELLS, places);
        self.members = cells.items.into_iter().map(SiteIdx).collect();
        self.starts = cells.starts;
    }

    /// Returns the cell of a position; the nearest cell if the position is outside of the grid.
    #[inline]
    fn cell(&self, position: DVec3) -> [u32; 3] {
        let cell = (position - self.low) * self.scale;
        // Conversion from float saturates, and maps NaN to zero.
        [
            (cell.x as u32).min(self.last[0]),
            (cell.y as u32).min(self.last[1]),
            (cell.z as u32).min(self.last[2]),
        ]
    }

    /// Returns the index of the brick with the key `key`; `None` if the grid has no such brick.
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

    /// Returns the slot at which the search for `key` begins.
    #[inline]
    fn slot(&self, key: u64) -> usize {
        // Fibonacci hashing: take the upper bits of the product with 2^64 over the golden ratio.
        let mixed = key.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mixed >> 32) as usize & (self.table.len() - 1)
    }

    /// Visits the rows of cells of a brick that are in the box from `low` to `high`.
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
                // Cells of a row have consecutive indices, so their sites are one range of members.
                let from = place(brick, [first[0], y, z]) as usize;
                let until = from + (last[0] - first[0]) as usize + 1;
                visit(self.starts[from] as usize..self.starts[until] as usize);
            }
        }
    }

    /// Visits a box by scanning all bricks of the grid. Used for boxes that cover more bricks than the grid has.
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

/// Returns the coordinate along one axis of the brick that contains `cell`.
#[inline]
fn brick_of(cell: u32) -> u32 {
    cell >> BRICK_BITS
}

/// Packs the coordinates of a brick into one number that sorts by z, then y, then x.
#[inline]
fn key([x, y, z]: [u32; 3]) -> u64 {
    u64::from(x) | u64::from(y) << BITS | u64::from(z) << (2 * BITS)
}

/// Returns the index of a cell among the cells of all bricks.
#[inline]
fn place(brick: u32, cell: [u32; 3]) -> u32 {
    let [x, y, z] = cell.map(|part| part & ((1 << BRICK_BITS) - 1));
    ((brick << BRICK_BITS | z) << BRICK_BITS | y) << BRICK_BITS | x
}

#[cfg(test)]
mod tests;
