//! Last step of the construction: fills the open area until no further point fits.
//!
//! Mohamed S. Ebeida, Scott A. Mitchell, Anjul Patney, Andrew A. Davidson and John D. Owens, "A Simple Algorithm for
//! Maximal Poisson-Disk Sampling in High Dimensions", Computer Graphics Forum 31(2), 2012,
//! A cell is repeatedly divided into quarters; quarters that a single disc covers are dropped, and darts are thrown at
//! the rest. Here each cell is completed separately, with the few points that reach it. The radius in a quarter has a
//! lower bound from the last evaluated radius and the slope. It is evaluated again only if that bound is too loose for
//! the size of the quarter.

use super::block::{Block, Local, Setting, farthest_sq, fractions};
use super::rule::DiskRule;
use dapple_hash::CellHash;
use glam::DVec2;

/// Number of initial parts along each side of a cell.
const SIDE: usize = 4;

/// Number of subdivisions: the smallest parts have 2^-20 of the side of a cell.
const LEVELS: u32 = 18;

/// Relative margin of a squared distance for rounding to 24 bits in the first subdivision.
const MARGIN: f64 = 1e-5;

/// Maximum number of darts per level and cell.
const DARTS: usize = 4;

/// Maximum number of parts of a cell; a cell with more is left unfilled. This happens only for a discontinuous radius.
const MOST_PARTS: usize = 4096;

/// Maximum uncertainty of the radius in a part, relative to the sum of the part's half-side lengths.
const LOOSE: f64 = 0.25;

/// Directions from the center of a part to the centers of its quarters, in half-side lengths of a quarter.
const WAYS: [DVec2; 4] = [
    DVec2::NEG_ONE,
    DVec2::new(1.0, -1.0),
    DVec2::new(-1.0, 1.0),
    DVec2::ONE,
];

/// A part of a cell that no disc is known to cover.
#[derive(Clone, Copy, Debug)]
struct Part {
    center: DVec2,
    /// Lower bound on the radius.
    least: f64,
    /// Maximum amount by which the radius exceeds `least`.
    slack: f64,
}

/// Scratch memory that is reused between blocks.
#[derive(Debug, Default)]
pub(super) struct Filler {
    found: Vec<u32>,
    near: Vec<Local>,
    parts: Vec<Part>,
    /// Parts from the previous level.
    whole: Vec<Part>,
}

impl Filler {
    /// Fills all open cells of a block.
    #[inline(always)]
    pub(super) fn fill(&mut self, block: &mut Block, setting: &Setting<'_>) {
        for cell in core::mem::take(&mut block.open) {
            if block.error.is_some() {
                return;
            }
            self.fill_cell(block, cell, setting);
        }
    }

    #[inline(always)]
    fn fill_cell(&mut self, block: &mut Block, cell: [u16; 2], setting: &Setting<'_>) {
        let min = block.min_of(cell);
        if block.is_surely_covered(cell) {
            debug_assert!(!self.start(block, min, setting.rule), "{cell:?} is open");
            return;
        }
        if !self.start(block, min, setting.rule) {
            return;
        }
        let random = CellHash::new(
            setting.seed.child("fill", 0),
            [
                i64::from(block.index),
                i64::from(cell[0]),
                i64::from(cell[1]),
            ],
        );
        let mut half = block.cell * (0.5 / SIDE as f64);
        let mut n_darts = 0;
        for _ in 0..LEVELS {
            // Throw darts at random parts.
            for _ in 0..self.parts.len().min(DARTS) {
                let part = ((random.at(2 * n_darts) >> 32) * self.parts.len() as u64) >> 32;
                let part = self.parts[part as usize];
                let place = fractions(random.at(2 * n_darts + 1));
                n_darts += 1;
                let min = part.center - half;
                let at = Part {
                    center: min + 2.0 * half * place,
                    ..part
                };
                let is_taken = is_covered(&self.near, &at, DVec2::ZERO, setting.rule);
                if !is_taken && block.throw(min, 2.0 * half, place, setting) {
                    return;
                }
            }
            // Divide the remaining parts into quarters.
            half *= 0.5;
            self.quarter(block, half, setting);
            if self.parts.is_empty() || self.parts.len() > MOST_PARTS || block.error.is_some() {
                return;
            }
        }
    }

    /// Divides a cell into sixteenths and keeps the parts that no disc covers; returns whether any is left.
    #[inline(always)]
    fn start(&mut self, block: &Block, min: DVec2, rule: DiskRule) -> bool {
        let max = min + block.cell;
        let [least, most] = block.leaf.bounds(min, block.cell);
        let reach = rule.distance(most, block.largest);
        let count = block.collect_near(min, max, reach, &mut self.found);
        let found = self.found[..count]
            .iter()
            .map(|&index| &block.locals[index as usize]);
        let mut room = [0.0_f32; SIDE * SIDE];
        let scale = 1.0 / block.leaf.radii.least;
        let side = block.cell * (scale / SIDE as f64);
        for local in found.clone() {
            let reach = scale * rule.distance(least, local.radius);
            let reach_sq = (reach * reach * (1.0 - MARGIN)) as f32;
            let at = (local.at - min) * scale;
            let xs: [f32; SIDE] = farthest_sq(at.x as f32, side.x as f32);
            let ys: [f32; SIDE] = farthest_sq(at.y as f32, side.y as f32);
            for row in 0..SIDE {
                for column in 0..SIDE {
                    let inside = (reach_sq - ys[row]) - xs[column];
                    let best = &mut room[row * SIDE + column];
                    *best = if inside > *best { inside } else { *best };
                }
            }
        }
        self.parts.clear();
        for (part, _) in room.iter().enumerate().filter(|&(_, &room)| room <= 0.0) {
            let place = DVec2::new((part % SIDE) as f64, (part / SIDE) as f64);
            self.parts.push(Part {
                center: min + block.cell * ((place + 0.5) / SIDE as f64),
                least,
                slack: most - least,
            });
        }
        self.near.clear();
        if !self.parts.is_empty() {
            self.near.extend(found.filter(|local| {
                let away = (min - local.at).max(local.at - max).max(DVec2::ZERO);
                let reach = rule.distance(most, local.radius);
                away.length_squared() < reach * reach
            }));
        }
        !self.parts.is_empty()
    }

    /// Divides all parts into quarters with half-side lengths `half`.
    fn quarter(&mut self, block: &mut Block, half: DVec2, setting: &Setting<'_>) {
        core::mem::swap(&mut self.parts, &mut self.whole);
        self.parts.clear();
        for index in 0..self.whole.len() {
            let part = self.whole[index];
            for way in WAYS {
                let center = part.center + half * way;
                self.keep_uncovered(block, Part { center, ..part }, half, setting);
            }
        }
    }

    /// Adds a part to `parts` unless a disc covers it.
    fn keep_uncovered(
        &mut self,
        block: &mut Block,
        mut part: Part,
        half: DVec2,
        setting: &Setting<'_>,
    ) {
        if is_covered(&self.near, &part, half, setting.rule) {
            return;
        }
        let spread = half.x + half.y;
        if part.slack > LOOSE * spread {
            let position = setting.field.domain.origin + (block.leaf.min + part.center);
            let Some(radius) = block.read(position, setting) else {
                return;
            };
            part.slack = 2.0 * block.leaf.radii.slope * spread;
            part.least = part.least.max(radius - 0.5 * part.slack);
            if is_covered(&self.near, &part, half, setting.rule) {
                return;
            }
        }
        self.parts.push(part);
    }
}

/// Returns whether the disc of a single point covers a whole part.
fn is_covered(near: &[Local], part: &Part, half: DVec2, rule: DiskRule) -> bool {
    near.iter().any(|local| {
        let reach = rule.distance(part.least, local.radius);
        let farthest = (local.at - part.center).abs() + half;
        farthest.length_squared() < reach * reach
    })
}
