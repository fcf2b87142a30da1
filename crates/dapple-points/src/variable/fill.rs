//! Filling what is left, until no further point fits.
//!
//! Mohamed S. Ebeida, Scott A. Mitchell, Anjul Patney, Andrew A. Davidson and John D. Owens, "A Simple Algorithm for
//! Maximal Poisson-Disk Sampling in High Dimensions", Computer Graphics Forum 31(2), 2012,
//! <https://doi.org/10.1111/j.1467-8659.2012.03059.x>: a cell is quartered again and again; quarters that one disc
//! covers are dropped, darts are thrown at the rest. Here each cell is finished on its own, with the few points that
//! reach it. The radius in a quarter is bounded from below by the last one read and the slope, and read again
//! only where that bound is too loose for the size of the quarter.

use super::block::{Block, Local, Setting, cell_hash, fractions};
use super::rule::DiskRule;
use glam::DVec2;

/// How often a cell is quartered: what is left has 2^-20 of its side.
const LEVELS: u32 = 20;

/// Darts per level into one cell.
const DARTS: usize = 4;

/// A cell with more parts is left as it is. It takes a radius that jumps to get there.
const MOST_PARTS: usize = 4096;

/// A bound of the radius is loose if it is off by more than this part of the half diagonal.
const LOOSE: f64 = 0.25;

/// A part of a cell that no disc is known to cover.
#[derive(Clone, Copy, Debug)]
struct Part {
    center: DVec2,
    /// The radius is at least this.
    least: f64,
    /// How much more it may be.
    slack: f64,
}

/// Buffers for one block after another.
#[derive(Debug, Default)]
pub(super) struct Filler {
    near: Vec<Local>,
    parts: Vec<Part>,
    next: Vec<Part>,
}

impl Filler {
    /// Finishes all open cells of a block.
    pub(super) fn fill(&mut self, block: &mut Block, setting: &Setting<'_>) {
        for cell in core::mem::take(&mut block.open) {
            if block.error.is_some() {
                return;
            }
            self.fill_cell(block, cell, setting);
        }
    }

    fn fill_cell(&mut self, block: &mut Block, cell: u32, setting: &Setting<'_>) {
        let random = cell_hash(setting.seed.child("fill", 0), block.index, cell);
        let min = block.min_of(cell);
        self.gather(block, min, setting.rule);
        let radii = &block.leaf.radii;
        let mut half = block.cell * 0.5;
        self.parts.clear();
        self.next.clear();
        self.next.push(Part {
            center: min + half,
            least: radii.least,
            slack: radii.largest - radii.least,
        });
        let mut n_darts = 0;
        for level in 0..=LEVELS {
            self.keep_uncovered(block, half, setting);
            let count = if level == 0 {
                0
            } else {
                self.parts.len().min(DARTS)
            };
            for _ in 0..count {
                let part = (random.at(2 * n_darts) >> 32) * self.parts.len() as u64 >> 32;
                let place = fractions(random.at(2 * n_darts + 1));
                let corner = self.parts[part as usize].center - half;
                n_darts += 1;
                if block.throw(corner, 2.0 * half, place, setting) {
                    return;
                }
            }
            if self.parts.is_empty() || self.parts.len() > MOST_PARTS || block.error.is_some() {
                return;
            }
            half *= 0.5;
            self.quarter(half);
        }
    }

    /// Collects the points whose discs may reach into a cell.
    fn gather(&mut self, block: &Block, min: DVec2, rule: DiskRule) {
        let max = min + block.cell;
        let largest = block.leaf.radii.largest;
        let near = &mut self.near;
        near.clear();
        block.visit_near(min, max, rule.distance(largest, block.largest), |local| {
            let away = (min - local.at).max(local.at - max).max(DVec2::ZERO);
            let reach = rule.distance(largest, local.radius);
            if away.length_squared() < reach * reach {
                near.push(*local);
            }
        });
    }

    /// Moves the parts that no disc covers from `next` to `parts`.
    fn keep_uncovered(&mut self, block: &mut Block, half: DVec2, setting: &Setting<'_>) {
        let spread = half.length_squared().sqrt();
        self.parts.clear();
        for mut part in self.next.drain(..) {
            if is_covered(&self.near, &part, half, setting.rule) {
                continue;
            }
            if part.slack > LOOSE * spread {
                let position = setting.field.domain.origin + (block.leaf.min + part.center);
                let Some(radius) = block.read(position, setting) else {
                    return;
                };
                part.slack = 2.0 * block.leaf.radii.slope * spread;
                part.least = part.least.max(radius - 0.5 * part.slack);
                if is_covered(&self.near, &part, half, setting.rule) {
                    continue;
                }
            }
            self.parts.push(part);
        }
    }

    /// Cuts `parts` into quarters of half side `half`.
    fn quarter(&mut self, half: DVec2) {
        for part in &self.parts {
            for way in [
                DVec2::new(-1.0, -1.0),
                DVec2::new(1.0, -1.0),
                DVec2::new(-1.0, 1.0),
                DVec2::ONE,
            ] {
                self.next.push(Part {
                    center: part.center + half * way,
                    ..*part
                });
            }
        }
    }
}

/// Whether the disc of one point covers all of a part.
fn is_covered(near: &[Local], part: &Part, half: DVec2, rule: DiskRule) -> bool {
    near.iter().any(|local| {
        let reach = rule.distance(part.least, local.radius);
        let farthest = (local.at - part.center).abs() + half;
        farthest.length_squared() < reach * reach
    })
}
