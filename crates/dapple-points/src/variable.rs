//! Maximal Poisson disk sets with a radius that varies in space.
//!
//! Random sequential placing: darts fall at random places, and stay where they keep their distance from all points
//! before them, until no dart could. For two points of different radius, [`DiskRule`] defines the distance. Reference:
//! the rules go back to Scott A. Mitchell, Alexander Rand, Mohamed S. Ebeida and Chandrajit Bajaj, "Variable Radii
//! Poisson-Disk Sampling", Canadian Conference on Computational Geometry 2012.
//!
//! The domain is cut into rectangles of some hundred points in which the radius hardly changes, and each of these
//! blocks gets a grid of cells in its own size. Darts come in rounds. In each, a part of the open cells of all blocks
//! gets one dart. Blocks that could meet take turns, in an order that changes from round to round; the others work at
//! the same time. The result depends on the order of these turns only, not on threads. The area that is still open
//! after the last round is cut into ever smaller quarters until all of it is covered.

mod block;
mod density;
mod fill;
mod gentle;
mod leaf;
mod rule;

use crate::cancel::{IsCancelled, cancelled, check};
use crate::disk::level;
use crate::{Domain, PointSet, PointsError, PointsErrorKind};
use block::{Block, Neighbor, Setting};
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};
use dapple_hash::{Seed, hash1};
use dapple_raster::simd::dispatch;
use dapple_raster::{Varying, parallel};
pub use density::{RSA_DENSITY, radius_for_count, radius_from_density};
use fill::Filler;
pub use gentle::gentle_radius_for_count;
use glam::DVec2;
use leaf::{RadiusField, Tree};
pub use rule::DiskRule;

/// The share of the open cells that gets a dart in each round. The first rounds, in which nearly every dart stays,
/// are thin, so that it matters little which of two blocks has its turn first. Seven rounds from 1/8 to 1 gave N r² of
/// 0.6967 instead of 0.6988 (30 sets of 2000 points on a torus), the same anisotropy of 1.05, and took a tenth longer.
const ROUNDS: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

/// The slope with which a radius may rise unnoticed between the places where it is read. Where it rises faster, all is
/// done again with a larger slope.
const RISE: f64 = 0.1;

/// Options of Poisson-disk sets with a varying radius.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct VariablePoissonOptions {
    /// How far apart points of different radius must be; the mean of their radii by default.
    pub rule: DiskRule,
    /// The number of points above which a set is refused, by an estimate; 2^24 by default.
    pub point_limit: u64,
}

impl Default for VariablePoissonOptions {
    fn default() -> Self {
        Self {
            rule: DiskRule::Average,
            point_limit: 1 << 24,
        }
    }
}

/// A maximal Poisson disk set whose radius varies in space.
///
/// Any two points a and b are at least `rule(radius(a), radius(b))` apart, but for the rounding of their coordinates.
/// The set is maximal: for every place u of the domain there is a point c closer than `rule(radius(u), radius(c))`.
/// Exempt are spots smaller than 10^-6 radii, and dips of the radius that are too small or narrow to show on a lattice
/// of about two radii.
///
/// Where the radius is r, there are 0.697 / r² points per area, within 3 % on slopes up to 0.06 and within 5 % up to
/// 0.35 with the default rule; [`radius_from_density`] and [`radius_for_count`] give the radius to a wanted density. The
/// radius is read about three times per point.
///
/// Around a wrapped axis the radius has to repeat itself too, or else there is a step at the seam, which is honored
/// but looks like one: beside a step from r to R the larger discs reach over by (r + R) / 2. A ramp from left to right
/// belongs on a cylinder. The order of the points has no meaning.
///
#[cfg_attr(doc, doc = include_str!("../docs/variable-poisson-disk.md"))]
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] for a domain without area. [`PointsErrorKind::Radius`] where a radius that was read is
/// not above zero and finite. [`PointsErrorKind::TooSteep`] where the radius changes by as much as the distance or
/// more: between neighboring places of a 10 × 10 lattice in each rectangle into which the domain is cut, down to one of
/// about two radii, or from there to a dart. [`PointsErrorKind::PeriodTooShort`] for a wrapped axis shorter than two of the
/// largest radii. [`PointsErrorKind::TooMany`] if more points than the limit would be needed; nothing large has been
/// allocated then.
///
/// # Examples
///
/// ```
/// use dapple_points::raster::{Ramp, Varying};
/// use dapple_points::{Domain, VariablePoissonOptions, glam::DVec2, hash::Seed, variable_poisson_disk};
///
/// let cylinder = Domain { wrap: [false, true], ..Domain::paper_torus() };
/// let radius = Varying::GeometricRamp(Ramp { from: -DVec2::X, to: DVec2::X, start: 0.02, end: 0.16 });
/// let points = variable_poisson_disk(cylinder, &radius, &VariablePoissonOptions::default(), Seed(7))?;
/// let n_left = points.iter().filter(|(_, position)| position.x < 0.0).count();
/// // The density falls by 8² from end to end, so the left half holds about 8 times as many.
/// assert!(n_left > 6 * (points.len() - n_left));
/// # Ok::<(), dapple_points::PointsError>(())
/// ```
pub fn variable_poisson_disk(
    domain: Domain,
    radius: &Varying,
    options: &VariablePoissonOptions,
    seed: Seed,
) -> Result<PointSet, PointsError> {
    variable_poisson_disk_cancellable(domain, radius, options, seed, &|| false)
}

/// The set of [`variable_poisson_disk`], unless `is_cancelled` returns true.
///
/// # Errors
///
/// The errors of [`variable_poisson_disk`], and [`PointsErrorKind::Cancelled`].
pub fn variable_poisson_disk_cancellable(
    domain: Domain,
    radius: &Varying,
    options: &VariablePoissonOptions,
    seed: Seed,
    is_cancelled: &IsCancelled,
) -> Result<PointSet, PointsError> {
    let domain = domain.checked()?;
    let place = |rise| {
        let field = RadiusField {
            domain: &domain,
            radius,
            rise,
        };
        let seed = seed.child("variable poisson disk", 0);
        place_points(field, options, seed, is_cancelled)
    };
    match place(RISE) {
        // Rougher than it seemed at first: once more with room for anything below 1.
        Err(error) if matches!(error.kind(), PointsErrorKind::TooSteep { .. }) => place(1.0),
        result => result,
    }
}

/// Places the points for a radius that rises, between the places where it is read, no faster than along them or than
/// `field.rise`.
fn place_points(
    field: RadiusField<'_>,
    options: &VariablePoissonOptions,
    seed: Seed,
    is_cancelled: &IsCancelled,
) -> Result<PointSet, PointsError> {
    let setting = Setting {
        field,
        rule: options.rule,
        seed,
    };
    let level = level();
    let tree = Tree::new(setting.field, options.point_limit, is_cancelled)?;
    check_periods(field.domain, &tree)?;
    check(is_cancelled)?;
    let mut blocks = blocks_of(&tree, &setting);
    check(is_cancelled)?;
    let colors = colors_of(&blocks);
    let n_colors = colors.len() as u64;
    for (round, share) in (0..).zip(ROUNDS) {
        let first = hash1(setting.seed.child("turn", 0), [round], 0) % n_colors;
        for turn in 0..n_colors {
            let color = &colors[((first + turn) % n_colors) as usize];
            take_turns(&mut blocks, color, is_cancelled, |block, blocks| {
                block.pull(blocks, &setting);
                dispatch!(level, _simd => block.throw_round(round as u32, share, &setting));
            })?;
        }
    }
    for color in &colors {
        take_turns(&mut blocks, color, is_cancelled, |block, blocks| {
            block.pull(blocks, &setting);
            dispatch!(level, _simd => Filler::default().fill(block, &setting));
        })?;
    }
    collect(*field.domain, blocks)
}

/// Checks that the largest disc fits into the periods of the domain.
fn check_periods(domain: &Domain, tree: &Tree) -> Result<(), PointsError> {
    let largest = tree.leaves.iter().map(|leaf| leaf.radii.largest);
    let radius = largest.fold(0.0, f64::max);
    for axis in 0..2 {
        let period = domain.size[axis];
        if domain.wrap[axis] && period < 2.0 * radius {
            return Err(PointsError::new(PointsErrorKind::PeriodTooShort {
                axis: axis as u32,
                period,
                radius,
            }));
        }
    }
    Ok(())
}

/// The blocks, each with those around it.
fn blocks_of(tree: &Tree, setting: &Setting<'_>) -> Vec<Block> {
    parallel::map(tree.leaves.len(), |index| {
        let leaf = &tree.leaves[index];
        let mut block = Block::new(index as u32, *leaf, setting);
        for shift in shifts(setting.field.domain) {
            tree.visit_near(leaf, shift, setting.rule, |other| {
                if (other, shift) != (block.index, DVec2::ZERO) {
                    block.neighbors.push(Neighbor {
                        block: other,
                        shift,
                        seen: 0,
                    });
                }
            });
        }
        block
    })
}

/// The shifts to the copies of the domain next to it.
fn shifts(domain: &Domain) -> impl Iterator<Item = DVec2> {
    let turns = |axis: usize| if domain.wrap[axis] { -1..=1 } else { 0..=0 };
    let (columns, rows, size) = (turns(0), turns(1), domain.size);
    rows.flat_map(move |y| {
        let columns = columns.clone();
        columns.map(move |x| size * DVec2::new(f64::from(x), f64::from(y)))
    })
}

/// Sorts the blocks into classes within which no two come close to each other.
fn colors_of(blocks: &[Block]) -> Vec<Vec<u32>> {
    let mut colors: Vec<Vec<u32>> = Vec::new();
    let mut color_of = vec![usize::MAX; blocks.len()];
    for block in blocks {
        let taken: Vec<usize> = block
            .neighbors
            .iter()
            .map(|neighbor| color_of[neighbor.block as usize])
            .collect();
        let color = (0..).find(|color| !taken.contains(color)).unwrap_or(0);
        if color == colors.len() {
            colors.push(Vec::new());
        }
        colors[color].push(block.index);
        color_of[block.index as usize] = color;
    }
    colors
}

/// The number of blocks that work before it is asked again whether the set is still wanted; a block has some hundred
/// points.
const BLOCKS: usize = 64;

/// Lets the blocks of one color work, at the same time, while all others stand still.
fn take_turns(
    blocks: &mut [Block],
    color: &[u32],
    is_cancelled: &IsCancelled,
    work: impl Fn(&mut Block, &[Block]) + Sync,
) -> Result<(), PointsError> {
    let mut taken: Vec<Block> = color
        .iter()
        .map(|&index| core::mem::take(&mut blocks[index as usize]))
        .collect();
    let is_over = AtomicBool::new(false);
    parallel::for_each_mut(&mut taken, |index, block| {
        if index % BLOCKS == 0 && is_cancelled() {
            is_over.store(true, Relaxed);
        }
        if !is_over.load(Relaxed) {
            work(block, blocks);
        }
    });
    for (&index, block) in color.iter().zip(taken) {
        blocks[index as usize] = block;
    }
    cancelled(is_over.into_inner())
}

/// The points of all blocks, or the first error.
fn collect(domain: Domain, blocks: Vec<Block>) -> Result<PointSet, PointsError> {
    let mut positions = Vec::with_capacity(blocks.iter().map(|block| block.samples.len()).sum());
    for block in blocks {
        if let Some(error) = block.error {
            return Err(error);
        }
        positions.extend(block.samples.iter().map(|sample| sample.position));
    }
    PointSet::new(domain, positions)
}

#[cfg(test)]
mod tests;
