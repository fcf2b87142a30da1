//! Maximal Poisson-disk sets with a spatially varying radius.
//!
//! Random sequential addition: darts fall at random positions and become points if they are far enough from all
//! earlier points, until no dart fits. [`DiskRule`] defines the minimum distance between two points with different
//! radii. Reference: the rules go back to Scott A. Mitchell, Alexander Rand, Mohamed S. Ebeida and Chandrajit Bajaj,
//! "Variable Radii Poisson-Disk Sampling", Canadian Conference on Computational Geometry 2012.
//!
//! The domain is divided into rectangles of a few hundred points in which the radius hardly changes. Each rectangle
//! becomes a block with a grid of cells of suitable size. Darts come in rounds: in each round, a fraction of the open
//! cells of all blocks receives one dart. Blocks that could conflict take turns, in an order that changes between
//! rounds; other blocks run in parallel. The result depends only on the order of turns, not on threads. After the
//! last round, the open area is subdivided into quarters until all of it is covered.

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

/// Fraction of the open cells that receives a dart in each round. The first rounds, in which nearly every dart is
/// accepted, are sparse, which reduces the influence of the order of blocks. Seven rounds from 1/8 to 1 gave N r² of
/// 0.6967 instead of 0.6988 (30 sets of 2000 points on a torus), the same anisotropy of 1.05, but took a tenth
/// longer.
const ROUNDS: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

/// Maximum slope of the radius between its sampled positions. If the radius is steeper, the set is recomputed with a
/// larger slope.
const RISE: f64 = 0.1;

/// Options for Poisson-disk sets with a varying radius.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct VariablePoissonOptions {
    /// Rule for the minimum distance of points with different radii [default: mean of the radii].
    pub rule: DiskRule,
    /// Maximum estimated number of points; larger sets are rejected [default: 2^24].
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

/// Creates a maximal Poisson-disk set whose radius varies in space.
///
/// Any two points a and b are at least `rule(radius(a), radius(b))` apart, up to rounding of their coordinates. The
/// set is maximal: for every position u of the domain there is a point c closer than `rule(radius(u), radius(c))`.
/// Exceptions are spots smaller than 10^-6 radii, and dips of the radius that are too small or narrow to appear on a
/// lattice of about two radii.
///
/// Where the radius is r, the density is 0.697 / r², within 3 % on slopes up to 0.06 and within 5 % up to 0.35 with
/// the default rule. [`radius_from_density`] and [`radius_for_count`] compute the radius for a desired density. The
/// radius is evaluated about three times per point.
///
/// Along a wrapped axis, the radius should be periodic too. Otherwise there is a step at the seam, which is handled
/// but visible: next to a step from r to R, the larger discs extend across it by (r + R) / 2. For a ramp from left to
/// right, use a cylinder that wraps only along y. The order of the points is unspecified.
///
#[cfg_attr(doc, doc = include_str!("../docs/variable-poisson-disk.md"))]
///
/// # Errors
///
/// [`PointsErrorKind::Domain`] for a domain without area. [`PointsErrorKind::Radius`] if an evaluated radius is not
/// above zero and finite. [`PointsErrorKind::TooSteep`] if the slope of the radius is 1 or more: between neighboring
/// positions of a 10 × 10 lattice in each rectangle of the domain, down to a rectangle of about two radii, or from
/// there to a dart. [`PointsErrorKind::PeriodTooShort`] for a wrapped axis shorter than two of the largest radii.
/// [`PointsErrorKind::TooMany`] if the number of points would exceed the limit, before any large allocation.
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

/// Same as [`variable_poisson_disk`], but fails if `is_cancelled` returns true.
///
/// # Errors
///
/// Same as [`variable_poisson_disk`], plus [`PointsErrorKind::Cancelled`].
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
        // Steeper than the samples suggested: start again with room for any slope below 1.
        Err(error) if matches!(error.kind(), PointsErrorKind::TooSteep { .. }) => place(1.0),
        result => result,
    }
}

/// Places the points. Between lattice samples, the slope of the radius is assumed to be at most `field.rise`, or the
/// slope between the samples if that is larger.
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
    // Throw darts in rounds, block color by block color.
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
    // Fill the remaining area.
    for color in &colors {
        take_turns(&mut blocks, color, is_cancelled, |block, blocks| {
            block.pull(blocks, &setting);
            dispatch!(level, _simd => Filler::default().fill(block, &setting));
        })?;
    }
    collect(*field.domain, blocks)
}

/// Checks that the largest disc fits the periods of the domain.
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

/// Creates a block for each leaf, with its list of neighboring blocks.
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

/// Returns the shifts to the adjacent copies of the domain.
fn shifts(domain: &Domain) -> impl Iterator<Item = DVec2> {
    let turns = |axis: usize| if domain.wrap[axis] { -1..=1 } else { 0..=0 };
    let (columns, rows, size) = (turns(0), turns(1), domain.size);
    rows.flat_map(move |y| {
        let columns = columns.clone();
        columns.map(move |x| size * DVec2::new(f64::from(x), f64::from(y)))
    })
}

/// Colors the blocks, so that blocks of the same color are not neighbors.
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

/// Number of blocks between checks for cancellation; a block has a few hundred points.
const BLOCKS: usize = 64;

/// Calls `work` for each block of one color, in parallel, with all other blocks for reading.
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

/// Merges the points of all blocks, or returns the first error.
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
