//! One leaf at work: its cells, with a margin for the points around it, and the darts thrown at them.
//!
//! A cell's diagonal is at most the smallest radius, so a cell holds at most one point. In the margin, where radii may
//! be smaller, a second point of a cell goes to a list on the side. Most darts fall too close to a point. They are
//! found out in 32-bit floating point, eight cells at a time, with the smallest radius of the leaf in the place of
//! their own, and a margin for rounding; only what passes has its radius read and is tested in 64 bits.

use super::leaf::{Leaf, RadiusField};
use super::rule::DiskRule;
use crate::{PointsError, PointsErrorKind};
use dapple_hash::{CellHash, Seed};
use glam::DVec2;

/// Cells to each side of a dart in which it looks for points by the quick test.
const QUICK_REACH: usize = 2;

/// Cells of a row that the quick test reads at once: those within reach, and some past them.
const LANES: usize = 8;

/// The part of a squared distance that the quick test gives away for rounding: coordinates of up to 40 cells with 24
/// bits are off by 5e-6 of a cell at most.
const QUICK_MARGIN: f64 = 4e-5;

/// Margins have at most as many cells; points farther out go to the list on the side.
const MOST_MARGIN: f64 = 6.0;

const NOBODY: u32 = u32::MAX;

/// A point that stays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) position: DVec2,
    pub(super) radius: f64,
}

/// A point of this block or near it, relative to the block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    pub(super) at: DVec2,
    pub(super) radius: f64,
}

/// A block close by, or this one, around a wrapped axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbor {
    pub(super) block: u32,
    /// What brings its points to where they are near.
    pub(super) shift: DVec2,
    /// How many of its points are known here.
    pub(super) seen: usize,
}

/// What all blocks share.
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
    /// The points that this block has placed.
    pub(super) samples: Vec<Sample>,
    /// Those, and the ones around.
    pub(super) locals: Vec<Local>,
    /// The first thing that went wrong.
    pub(super) error: Option<PointsError>,
    /// Cells without a point, in random order.
    pub(super) open: Vec<u32>,
    cursor: usize,
    /// The sides of a cell, and one over them.
    pub(super) cell: DVec2,
    per_cell: DVec2,
    /// Cells of margin to each side, and cells in a row with its margins and what the quick test reads past them.
    margin: usize,
    stride: usize,
    /// The largest radius among `locals`.
    pub(super) largest: f64,
    /// By cell: the place and the squared reach of its point for the quick test, in units of the smallest radius.
    quick: [Vec<f32>; 3],
    /// By cell: its point among `locals`.
    slots: Vec<u32>,
    /// Points without a cell of their own.
    aside: Vec<u32>,
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
            ..Self::default()
        };
        block.shuffle(setting.seed.child("order", 0));
        block
    }

    /// Opens all cells, in random order.
    fn shuffle(&mut self, seed: Seed) {
        let n_cells = self.leaf.cells[0] * self.leaf.cells[1];
        self.open = (0..n_cells).collect();
        let random = CellHash::new(seed, [i64::from(self.index)]);
        for last in (1..n_cells).rev() {
            let other = (random.at(last) >> 32) * u64::from(last + 1) >> 32;
            self.open.swap(last as usize, other as usize);
        }
    }

    /// Takes in what the blocks around have placed since the last time.
    pub(super) fn pull(&mut self, blocks: &[Self], setting: &Setting<'_>) {
        for neighbor in 0..self.neighbors.len() {
            let Neighbor { block, shift, seen } = self.neighbors[neighbor];
            // A block's own copies are taken in when they are placed; in its place stands an empty one.
            let samples = &blocks[block as usize].samples;
            for sample in samples.get(seen..).unwrap_or_default() {
                self.take_in(sample, shift, setting);
            }
            self.neighbors[neighbor].seen = seen.max(samples.len());
        }
    }

    /// Takes in a point of another block, or a copy of one's own, if a dart could ever meet it.
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
        let cell = (local.at * self.per_cell).floor() + DVec2::splat(self.margin as f64);
        let rows = self.slots.len() / self.stride;
        let is_inside = cell.min_element() >= 0.0
            && cell.x < (self.stride - LANES + 2 * QUICK_REACH) as f64
            && cell.y < rows as f64;
        let slot = if is_inside {
            cell.y as usize * self.stride + cell.x as usize
        } else {
            0
        };
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

    /// Throws one dart into each of a share of the open cells.
    pub(super) fn throw_round(&mut self, round: u32, share: f64, setting: &Setting<'_>) {
        let random = CellHash::new(
            setting.seed.child("dart", 0),
            [i64::from(self.index), i64::from(round)],
        );
        let count = self.open.len() as f64 * share;
        // Rounded up or down at random, so that small blocks keep the share on average.
        let count = (count + dapple_hash::unit_f64(random.at(u32::MAX))) as u32;
        for dart in 0..count {
            if self.open.is_empty() || self.error.is_some() {
                return;
            }
            if self.cursor >= self.open.len() {
                self.cursor = 0;
            }
            let cell = self.open[self.cursor];
            let place = fractions(random.at(dart));
            let min = self.min_of(cell);
            if self.throw(min, self.cell, place, setting) {
                self.open.swap_remove(self.cursor);
            } else {
                self.cursor += 1;
            }
        }
    }

    /// The corner of an inner cell.
    pub(super) fn min_of(&self, cell: u32) -> DVec2 {
        let columns = self.leaf.cells[0];
        DVec2::new(f64::from(cell % columns), f64::from(cell / columns)) * self.cell
    }

    /// Throws a dart into a part of the block and keeps it, as a point, if it fits.
    pub(super) fn throw(
        &mut self,
        min: DVec2,
        size: DVec2,
        place: DVec2,
        setting: &Setting<'_>,
    ) -> bool {
        let domain = setting.field.domain;
        let position = domain.origin + (self.leaf.min + (min + size * place));
        // What counts is the position as the caller will see it, with its rounding.
        let at = (position - domain.origin) - self.leaf.min;
        if self.is_surely_taken(at) || !domain.contains(position) {
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

    /// The radius at a position of this block.
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

    /// Whether a place is certainly too close to a point; the quick test.
    fn is_surely_taken(&self, at: DVec2) -> bool {
        let scale = 1.0 / self.leaf.radii.least;
        let (x, y) = ((at.x * scale) as f32, (at.y * scale) as f32);
        let cell = (at * self.per_cell).clamp(
            DVec2::ZERO,
            DVec2::new(
                f64::from(self.leaf.cells[0] - 1),
                f64::from(self.leaf.cells[1] - 1),
            ),
        );
        let first = self.margin - QUICK_REACH;
        let corner = (cell.y as usize + first) * self.stride + cell.x as usize + first;
        let [xs, ys, reaches] = &self.quick;
        let mut is_taken = false;
        for row in 0..=2 * QUICK_REACH {
            let row = corner + row * self.stride;
            let lanes = xs[row..row + LANES].iter().zip(&ys[row..row + LANES]);
            for ((&px, &py), &reach) in lanes.zip(&reaches[row..row + LANES]) {
                let (dx, dy) = (px - x, py - y);
                is_taken |= dx * dx + dy * dy < reach;
            }
        }
        is_taken
    }

    /// Whether a point keeps its distance from all others.
    fn fits(&self, new: &Local, rule: DiskRule) -> bool {
        let mut fits = true;
        let reach = rule.distance(new.radius, self.largest);
        self.visit_near(new.at, new.at, reach, |other| {
            let distance = rule.distance(new.radius, other.radius);
            fits &= (other.at - new.at).length_squared() >= distance * distance;
        });
        fits
    }

    /// Calls `visit` with the points within `reach` of a rectangle, and some others.
    pub(super) fn visit_near(
        &self,
        min: DVec2,
        max: DVec2,
        reach: f64,
        mut visit: impl FnMut(&Local),
    ) {
        let columns = self.stride - LANES + 2 * QUICK_REACH;
        let rows = self.slots.len() / self.stride;
        let counts = DVec2::new(columns as f64, rows as f64);
        let slot_of = |at: DVec2| {
            let cell = (at * self.per_cell).floor() + self.margin as f64;
            cell.clamp(DVec2::ZERO, counts)
                .to_array()
                .map(|count| count as usize)
        };
        let [low, high] = [slot_of(min - reach), slot_of(max + reach + self.cell)];
        for row in low[1]..high[1] {
            let (from, to) = (row * self.stride + low[0], row * self.stride + high[0]);
            for &slot in self.slots.get(from..to).unwrap_or_default() {
                if slot != NOBODY {
                    visit(&self.locals[slot as usize]);
                }
            }
        }
        for &index in &self.aside {
            visit(&self.locals[index as usize]);
        }
    }
}

/// Two numbers in [0, 1) from 64 bits.
pub(super) fn fractions(bits: u64) -> DVec2 {
    let unit = 1.0 / (1_u64 << 32) as f64;
    DVec2::new(f64::from(bits as u32), f64::from((bits >> 32) as u32)) * unit
}

/// The random bits of one cell of one block.
pub(super) fn cell_hash(seed: Seed, block: u32, cell: u32) -> CellHash {
    CellHash::new(seed, [i64::from(block), i64::from(cell)])
}
