//! A block: a leaf with its cells, a margin for surrounding points, and the darts thrown at it.
//!
//! The diagonal of a cell is at most the smallest radius, so a cell contains at most one point. In the margin, where
//! radii may be smaller, further points of a cell go to a separate list. Most darts are too close to a point. The
//! quick test rejects most of these in 32-bit floating point, eight cells at a time, with the smallest radius of the
//! leaf instead of the radius of the dart, and a margin for rounding. Only the remaining darts have their radius
//! evaluated and are tested in 64 bits. The quick test also finds most of the cells that need no filling.

use super::leaf::{Leaf, RadiusField};
use super::rule::DiskRule;
use crate::{PointsError, PointsErrorKind};
use dapple_hash::{CellHash, Seed, unit_f32, unit_f64};
use glam::DVec2;

/// Number of cells on each side of a dart that the quick test searches.
const QUICK_REACH: usize = 2;

/// Number of cells that the quick test reads at once from a row: those within reach, and a few beyond.
const LANES: usize = 8;

/// Relative margin of squared distances in the quick test: coordinates of up to 40 cells with 24 bits have an error of
/// at most 5e-6 of a cell.
const QUICK_MARGIN: f64 = 4e-5;

/// Maximum width of the margin in cells. Points farther away are listed separately.
const MOST_MARGIN: f64 = 6.0;

const NOBODY: u32 = u32::MAX;

/// An accepted point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) position: DVec2,
    pub(super) radius: f64,
}

/// A point in or near this block, relative to the block's minimum corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    pub(super) at: DVec2,
    pub(super) radius: f64,
}

/// A nearby block, or a copy of this block across a wrapped axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbor {
    pub(super) block: u32,
    /// Shift that moves the points of the neighbor near the block.
    pub(super) shift: DVec2,
    /// Number of points of the neighbor that this block has already read.
    pub(super) seen: usize,
}

/// The domain, radius and rule that all blocks share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a> {
    pub(super) field: RadiusField<'a>,
    pub(super) rule: DiskRule,
    pub(super) seed: Seed,
}

/// A leaf with its cells and points.
#[derive(Debug, Default)]
pub(super) struct Block {
    pub(super) index: u32,
    pub(super) leaf: Leaf,
    pub(super) neighbors: Vec<Neighbor>,
    /// Points that this block has placed.
    pub(super) samples: Vec<Sample>,
    /// Points of this block and of its neighbors.
    pub(super) locals: Vec<Local>,
    /// The first error that occurred; `None` if there was none.
    pub(super) error: Option<PointsError>,
    /// Columns and rows of the cells without a point, in random order.
    pub(super) open: Vec<[u16; 2]>,
    cursor: usize,
    /// Width and height of a cell; `per_cell` holds their inverses.
    pub(super) cell: DVec2,
    per_cell: DVec2,
    /// Margin on each side, in cells. `stride` is the number of cells in a row, including its margins and the padding
    /// that the quick test reads.
    margin: usize,
    stride: usize,
    /// Maximum radius of `locals`.
    pub(super) largest: f64,
    /// For each cell, x, y and the squared reach of its point for the quick test, in units of the smallest radius.
    quick: [Vec<f32>; 3],
    /// For each cell, the index of its point in `locals`.
    slots: Vec<u32>,
    /// Indices into `locals` of the points that are not in `slots`.
    aside: Vec<u32>,
    /// Scratch memory for the indices of points that were found.
    found: Vec<u32>,
}

impl Block {
    pub(super) fn new(index: u32, leaf: Leaf, setting: &Setting<'_>) -> Self {
        let cell = leaf.size / DVec2::new(f64::from(leaf.cells[0]), f64::from(leaf.cells[1]));
        let reach = setting.rule.distance(leaf.radii.most, leaf.radii.largest);
        let margin = (reach / cell.min_element()).ceil();
        let margin = margin.clamp(QUICK_REACH as f64, MOST_MARGIN) as usize;
        let [columns, rows] = leaf.cells.map(|count| count as usize + 2 * margin);
        let stride = columns + LANES - 2 * QUICK_REACH;
        let n_slots = stride * rows;
        let mut block = Self {
            index,
            leaf,
            cell,
            per_cell: DVec2::ONE / cell,
            margin,
            stride,
            quick: [vec![0.0; n_slots], vec![0.0; n_slots], vec![0.0; n_slots]],
            slots: vec![NOBODY; n_slots],
            // A third of the cells get a point; slightly more capacity avoids reallocation.
            locals: Vec::with_capacity(n_slots * 3 / 8),
            samples: Vec::with_capacity((leaf.cells[0] * leaf.cells[1]) as usize * 3 / 8 + 1),
            ..Self::default()
        };
        block.shuffle(setting.seed.child("order", 0));
        block
    }

    /// Opens all cells, in random order.
    fn shuffle(&mut self, seed: Seed) {
        let [columns, rows] = self.leaf.cells.map(|count| count as u16);
        self.open = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| [column, row]))
            .collect();
        let random = CellHash::new(seed, [i64::from(self.index)]);
        for last in (1..self.open.len()).rev() {
            let other = ((random.at(last as u32) >> 32) * (last as u64 + 1)) >> 32;
            self.open.swap(last, other as usize);
        }
    }

    /// Reads the points that neighboring blocks have placed since the last call.
    pub(super) fn pull(&mut self, blocks: &[Self], setting: &Setting<'_>) {
        for neighbor in 0..self.neighbors.len() {
            let Neighbor { block, shift, seen } = self.neighbors[neighbor];
            // Copies of the block itself are added when they are placed; an empty block is in its slot meanwhile.
            let samples = &blocks[block as usize].samples;
            for sample in samples.get(seen..).unwrap_or_default() {
                self.take_in(sample, shift, setting);
            }
            self.neighbors[neighbor].seen = seen.max(samples.len());
        }
    }

    /// Adds another block's point, or a copy of one of this block's points, if a dart could conflict with it.
    fn take_in(&mut self, sample: &Sample, shift: DVec2, setting: &Setting<'_>) {
        let at = (sample.position - setting.field.domain.origin) + shift - self.leaf.min;
        let away = (at - self.leaf.size).max(-at).max(DVec2::ZERO);
        let reach = setting.rule.distance(self.leaf.radii.most, sample.radius);
        if away.length_squared() <= reach * reach {
            self.insert(
                Local {
                    at,
                    radius: sample.radius,
                },
                setting.rule,
            );
        }
    }

    fn insert(&mut self, local: Local, rule: DiskRule) {
        let index = self.locals.len() as u32;
        self.locals.push(local);
        self.largest = self.largest.max(local.radius);
        let cell = local.at * self.per_cell + self.margin as f64;
        let columns = self.stride - LANES + 2 * QUICK_REACH;
        let is_inside = cell.min_element() >= 0.0 && cell.x < columns as f64;
        let slot = cell.y as usize * self.stride + cell.x as usize;
        let is_inside = is_inside && slot < self.slots.len();
        if !is_inside || self.slots[slot] != NOBODY {
            self.aside.push(index);
            return;
        }
        self.slots[slot] = index;
        let scale = 1.0 / self.leaf.radii.least;
        let reach = rule.distance(self.leaf.radii.least, local.radius) * scale;
        self.quick[0][slot] = (local.at.x * scale) as f32;
        self.quick[1][slot] = (local.at.y * scale) as f32;
        self.quick[2][slot] = (reach * reach * (1.0 - QUICK_MARGIN)) as f32;
    }

    /// Throws one dart into each of a fraction of the open cells.
    #[inline(always)]
    pub(super) fn throw_round(&mut self, round: u32, share: f64, setting: &Setting<'_>) {
        let random = CellHash::new(
            setting.seed.child("dart", 0),
            [i64::from(self.index), i64::from(round)],
        );
        let count = self.open.len() as f64 * share;
        // Round up or down at random, so that small blocks match the fraction on average.
        let count = (count + unit_f64(random.at(u32::MAX))) as u32;
        for dart in 0..count {
            if self.open.is_empty() || self.error.is_some() {
                return;
            }
            if self.cursor >= self.open.len() {
                self.cursor = 0;
            }
            let cell = self.open[self.cursor];
            let place = random.at(dart);
            let is_kept = !self.is_surely_taken(cell, place) && {
                let min = self.min_of(cell);
                self.throw(min, self.cell, fractions(place), setting)
            };
            if is_kept {
                self.open.swap_remove(self.cursor);
            } else {
                self.cursor += 1;
            }
        }
    }

    /// Returns a cell's minimum corner.
    pub(super) fn min_of(&self, [column, row]: [u16; 2]) -> DVec2 {
        DVec2::new(f64::from(column), f64::from(row)) * self.cell
    }

    /// Throws a dart into a rectangle of the block, and adds it as a point if it fits. `place` is the dart's position
    /// in the rectangle, from 0 to 1 along each axis. Returns whether a point was added.
    pub(super) fn throw(
        &mut self,
        min: DVec2,
        size: DVec2,
        place: DVec2,
        setting: &Setting<'_>,
    ) -> bool {
        let domain = setting.field.domain;
        let position = domain.origin + (self.leaf.min + (min + size * place));
        // Test the position that the caller will see, with its rounding.
        let at = (position - domain.origin) - self.leaf.min;
        if !domain.contains(position) {
            return false;
        }
        let Some(radius) = self.read(position, setting) else {
            return false;
        };
        let local = Local { at, radius };
        if !self.fits(&local, setting.rule) {
            return false;
        }
        self.insert(local, setting.rule);
        let sample = Sample { position, radius };
        self.samples.push(sample);
        for neighbor in 0..self.neighbors.len() {
            let Neighbor { block, shift, .. } = self.neighbors[neighbor];
            if block == self.index {
                self.take_in(&sample, shift, setting);
            }
        }
        true
    }

    /// Evaluates the radius at a position of this block.
    pub(super) fn read(&mut self, position: DVec2, setting: &Setting<'_>) -> Option<f64> {
        let radii = &self.leaf.radii;
        let error = match setting.field.at(position) {
            Ok(radius) if radius <= radii.most => return Some(radius),
            Ok(radius) => PointsError::new(PointsErrorKind::TooSteep {
                position,
                slope: (radius - radii.largest) / radii.spread,
            }),
            Err(error) => error,
        };
        self.error.get_or_insert(error);
        None
    }

    /// Returns whether a position in a cell is certainly too close to a point, by the quick test.
    #[inline(always)]
    fn is_surely_taken(&self, [column, row]: [u16; 2], place: u64) -> bool {
        let scale = (1.0 / self.leaf.radii.least) * self.cell;
        let x = (f32::from(column) + unit_f32(place as u32)) * scale.x as f32;
        let y = (f32::from(row) + unit_f32((place >> 32) as u32)) * scale.y as f32;
        let corner = self.quick_corner([column, row]);
        // Test the nearest rows first, and the outer rows only if necessary.
        self.is_quickly_taken(corner, [2, 1, 3], x, y)
            || self.is_quickly_taken(corner, [0, 4], x, y)
    }

    /// Returns whether a point in these rows, relative to the slot `corner`, is certainly too close.
    #[inline(always)]
    fn is_quickly_taken<const N: usize>(
        &self,
        corner: usize,
        rows: [usize; N],
        x: f32,
        y: f32,
    ) -> bool {
        let mut room = [0.0; LANES];
        for row in rows {
            let Some([xs, ys, reaches]) = self.quick_lanes(corner + row * self.stride) else {
                return false;
            };
            for lane in 0..LANES {
                let (dx, dy) = (xs[lane] - x, ys[lane] - y);
                let inside = reaches[lane] - (dx * dx + dy * dy);
                room[lane] = if inside > room[lane] {
                    inside
                } else {
                    room[lane]
                };
            }
        }
        room.iter().any(|&inside| inside > 0.0)
    }

    /// Returns whether each quarter of a cell is certainly covered by a single point's disc, by the quick test.
    #[inline(always)]
    pub(super) fn is_surely_covered(&self, [column, row]: [u16; 2]) -> bool {
        let side = (1.0 / self.leaf.radii.least) * self.cell;
        let [width, height] = [side.x as f32, side.y as f32];
        let [left, top] = [f32::from(column) * width, f32::from(row) * height];
        let corner = self.quick_corner([column, row]);
        let mut room = [[0.0; LANES]; 4];
        for row in 0..=2 * QUICK_REACH {
            let Some([xs, ys, reaches]) = self.quick_lanes(corner + row * self.stride) else {
                return false;
            };
            for lane in 0..LANES {
                let x: [f32; 2] = farthest_sq(xs[lane] - left, 0.5 * width);
                let y: [f32; 2] = farthest_sq(ys[lane] - top, 0.5 * height);
                for quarter in 0..4 {
                    let inside = reaches[lane] - (x[quarter & 1] + y[quarter >> 1]);
                    let best = &mut room[quarter][lane];
                    *best = if inside > *best { inside } else { *best };
                }
            }
        }
        let mut is_covered = true;
        for room in room {
            is_covered &= room.iter().any(|&inside| inside > 0.0);
        }
        is_covered
    }

    /// Returns the index of the first cell that the quick test reads around a cell.
    #[inline(always)]
    fn quick_corner(&self, [column, row]: [u16; 2]) -> usize {
        let first = self.margin - QUICK_REACH;
        (usize::from(row) + first) * self.stride + usize::from(column) + first
    }

    /// Returns x, y and squared reach of consecutive cells in a row, for the quick test.
    #[inline(always)]
    fn quick_lanes(&self, from: usize) -> Option<[&[f32; LANES]; 3]> {
        let [xs, ys, reaches] = &self.quick;
        Some([
            xs.get(from..)?.first_chunk()?,
            ys.get(from..)?.first_chunk()?,
            reaches.get(from..)?.first_chunk()?,
        ])
    }

    /// Returns whether a new point is far enough from all others.
    fn fits(&mut self, new: &Local, rule: DiskRule) -> bool {
        let mut found = core::mem::take(&mut self.found);
        let reach = rule.distance(new.radius, self.largest);
        let count = self.collect_near(new.at, new.at, reach, &mut found);
        let fits = found[..count].iter().all(|&index| {
            let other = &self.locals[index as usize];
            let distance = rule.distance(new.radius, other.radius);
            (other.at - new.at).length_squared() >= distance * distance
        });
        self.found = found;
        fits
    }

    /// Collects the points within `reach` of a rectangle, possibly with some others, and returns their number.
    pub(super) fn collect_near(
        &self,
        min: DVec2,
        max: DVec2,
        reach: f64,
        found: &mut Vec<u32>,
    ) -> usize {
        let columns = self.stride - LANES + 2 * QUICK_REACH;
        let rows = self.slots.len() / self.stride;
        let counts = DVec2::new(columns as f64, rows as f64);
        let slot_of = |at: DVec2| {
            let cell = at * self.per_cell + self.margin as f64;
            let cell = cell.clamp(DVec2::ZERO, counts);
            cell.to_array().map(|count| count as usize)
        };
        let [low, high] = [slot_of(min - reach), slot_of(max + reach + self.cell)];
        let most = (high[0] - low[0]) * (high[1] - low[1]) + self.aside.len();
        if found.len() <= most {
            found.resize(most + 1, NOBODY);
        }
        let mut count = 0;
        for row in low[1]..high[1] {
            let (from, to) = (row * self.stride + low[0], row * self.stride + high[0]);
            for &slot in &self.slots[from..to] {
                // Write every slot, and advance only if it has a point: a third of the cells do, which no branch
                // predictor can guess.
                found[count] = slot;
                count += usize::from(slot != NOBODY);
            }
        }
        for &index in &self.aside {
            found[count] = index;
            count += 1;
        }
        count
    }
}

/// Returns the squared distances from `at` to the farther ends of the first `N` intervals of length `side`; the first
/// interval starts at 0.
#[inline(always)]
pub(super) fn farthest_sq<const N: usize>(at: f32, side: f32) -> [f32; N] {
    let mut squares = [0.0; N];
    for (part, square) in squares.iter_mut().enumerate() {
        let center = (part as f32 + 0.5) * side;
        let farthest = (at - center).abs() + 0.5 * side;
        *square = farthest * farthest;
    }
    squares
}

/// Converts 64 random bits to two numbers in [0, 1).
pub(super) fn fractions(bits: u64) -> DVec2 {
    let unit = 1.0 / (1_u64 << 32) as f64;
    DVec2::new(f64::from(bits as u32), f64::from((bits >> 32) as u32)) * unit
}
