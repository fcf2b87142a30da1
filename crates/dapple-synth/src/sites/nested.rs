//! Nested sets of evenly spaced points on a surface. Each set has about four times as many points as the one before.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1. The
//! coarsest points repel each other and are then fixed; new points are added and repelled by all points. In the paper
//! every level starts from random points. Here a level starts from the midpoints of the edges between the points of the
//! previous level, which are nearly even from the start. The coarsest level is free to move, and is itself built from
//! still coarser ones in this way. Each piece of the surface gets a share of the points in proportion to its area.
//!
//! The new points of a level are in Morton order (G. M. Morton, "A Computer Oriented Geodetic Data Base", IBM, 1966):
//! points that are near each other in space are mostly near each other in memory.

use super::between::{Edge, edges};
use super::near::Places;
use super::repel::repel;
use super::scatter::Scatter;
use super::share::Pieces;
use super::unstick::unstick;
use dapple_hash::Seed;
use dapple_mesh::{Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::DVec3;

/// Maximum size of the smallest hidden set, whose points all start at random positions.
const RANDOM_MOST: usize = 256;
/// Number of repulsion steps for random points. There are few such points, so the cost is negligible.
const ITERATIONS_RANDOM: usize = 40;
/// Factor on the number of repulsion steps for the coarsest set and for the smaller hidden sets from which it is built.
const ITERATIONS_HIDDEN: usize = 4;
/// Bits of a position along one axis in Morton order.
const MORTON_BITS: u32 = 21;

/// Returns nested sets of evenly spaced points, one for each of the ascending `counts`. The first `counts[0]` points
/// are evenly spaced by themselves, and so are the first `counts[1]` points, and so on.
///
/// A ratio of four between consecutive counts gives the most even spacing. A count below the previous one adds no
/// points. `iterations` is the number of repulsion steps for the new points of each count; 6 are enough. The points of
/// the first count take four times as many steps, or 40 steps where there are at most 256 of them. A piece of the
/// surface smaller than about half of the mean area per point gets none.
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::nested_points;
///
/// let triangle = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// let surface = Surface::new(triangle)?;
/// let points = nested_points(&surface, &[50, 200], Seed(7), 6);
/// assert_eq!(points[..50], nested_points(&surface, &[50], Seed(7), 6));
/// # Ok::<(), dapple_synth::SynthError>(())
/// ```
#[must_use]
pub fn nested_points(
    surface: &Surface,
    counts: &[usize],
    seed: Seed,
    iterations: usize,
) -> Vec<SurfacePoint> {
    let Some(&coarsest) = counts.first() else {
        return Vec::new();
    };
    let mut nest = Nest {
        surface,
        pieces: Pieces::new(surface),
        points: Vec::new(),
    };
    let seed = seed.child("nested points", 0);
    // Build the coarsest set from hidden sets; all points are free to move.
    for (level, &count) in hidden_counts(coarsest).iter().rev().enumerate() {
        let iterations = if level == 0 {
            ITERATIONS_RANDOM
        } else {
            iterations.saturating_mul(ITERATIONS_HIDDEN)
        };
        nest.add_level(
            count,
            0,
            iterations,
            seed.child("hidden level", level as u64),
        );
    }
    // Refine level by level; the points of coarser levels are fixed.
    for (level, &count) in counts.iter().enumerate().skip(1) {
        let n_fixed = nest.points.len();
        nest.add_level(
            count,
            n_fixed,
            iterations,
            seed.child("level", level as u64),
        );
    }
    nest.points
}

/// Returns the coarsest count, a quarter of it, and so on, down to a number of points that start at random positions.
fn hidden_counts(coarsest: usize) -> Vec<usize> {
    let mut counts = vec![coarsest];
    let mut count = coarsest;
    while count > RANDOM_MOST {
        count = count.div_ceil(4);
        counts.push(count);
    }
    counts
}

/// A point set that grows from level to level.
struct Nest<'a> {
    surface: &'a Surface,
    pieces: Pieces,
    points: Vec<SurfacePoint>,
}

impl Nest<'_> {
    /// Adds points until there are `count`, and relaxes the points with index `n_fixed` or more.
    fn add_level(&mut self, count: usize, n_fixed: usize, iterations: usize, seed: Seed) {
        self.grow(count, seed);
        // Sort before repulsion, which reads neighbors in every step, and again after it, for the callers of this
        // module.
        sort(self.surface, &mut self.points[n_fixed..]);
        self.relax(n_fixed, iterations, seed.child("stuck", 0));
        sort(self.surface, &mut self.points[n_fixed..]);
    }

    /// Adds points until there are `count`. Each piece of the surface gets its share.
    fn grow(&mut self, count: usize, seed: Seed) {
        let (surface, pieces) = (self.surface, &self.pieces);
        let piece_of = |point: SurfacePoint| pieces.of_face[point.face.index()] as usize;
        // Number of points that each piece still needs.
        let mut missing = pieces.shares(count);
        for &point in &self.points {
            let missing = &mut missing[piece_of(point)];
            *missing = missing.saturating_sub(1);
        }
        // Group the edges by piece, longest first.
        let mut split = vec![Vec::new(); missing.len()];
        let edges = edges(surface, &self.points);
        for edge in longest_first(&edges) {
            split[piece_of(edges[edge as usize].middle)].push(edge);
        }
        // Place new points on edges. If edges do not suffice, place the rest at random.
        for (piece, (missing, split)) in missing.into_iter().zip(split).enumerate() {
            let left = missing.saturating_sub(2 * split.len()) as u64;
            let split = split.iter().map(|&edge| &edges[edge as usize]);
            split_edges(surface, split, missing, &mut self.points);
            if left > 0 {
                let scatter = Scatter::new(surface, pieces.faces[piece].clone());
                let seed = seed.child("piece", piece as u64);
                let random = (0..left).filter_map(|number| scatter.point(surface, seed, number));
                self.points.extend(random);
            }
        }
    }

    /// Repels the points with index `n_fixed` or more. After half of the steps, stuck points are moved elsewhere.
    fn relax(&mut self, n_fixed: usize, iterations: usize, seed: Seed) {
        let (surface, points) = (self.surface, &mut self.points);
        repel(surface, points, n_fixed, iterations / 2);
        if iterations > 1 {
            unstick(surface, &self.pieces, points, n_fixed, seed);
        }
        repel(surface, points, n_fixed, iterations - iterations / 2);
    }
}

/// Returns the indices of `edges`, longest first. The midpoint of a long edge tends to be farther from other points.
fn longest_first(edges: &[Edge]) -> Vec<u32> {
    // The bits of positive floats sort like their values; the complement reverses the order.
    sorted(edges.iter().map(|edge| !edge.length.to_bits()))
}

/// Adds `missing` points on `edges`, which are sorted longest first. Each edge gets one point at its midpoint. If there
/// are too few edges, the first ones get two points, at one third and two thirds.
fn split_edges<'a>(
    surface: &Surface,
    mut edges: impl ExactSizeIterator<Item = &'a Edge>,
    missing: usize,
    points: &mut Vec<SurfacePoint>,
) {
    let n_thirds = missing.saturating_sub(edges.len()).min(edges.len());
    for edge in edges.by_ref().take(n_thirds) {
        points.extend(edge.thirds(surface));
    }
    let n_halves = missing.saturating_sub(2 * n_thirds);
    points.extend(edges.take(n_halves).map(|edge| edge.middle));
}

/// Sorts points along the Morton curve of their bounding box.
fn sort(surface: &Surface, points: &mut [SurfacePoint]) {
    let positions = Places::new(surface, points).positions;
    let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = positions
        .iter()
        .copied()
        .fold(DVec3::NEG_INFINITY, DVec3::max);
    let widest = (high - low).max_element().max(f64::MIN_POSITIVE);
    let scale = f64::from((1_u32 << MORTON_BITS) - 1) / widest;
    let keys = positions
        .iter()
        .map(|&position| morton((position - low) * scale));
    let sorted = sorted(keys).into_iter();
    let sorted: Vec<_> = sorted.map(|number| points[number as usize]).collect();
    points.copy_from_slice(&sorted);
}

/// Returns the indices of the keys, sorted by key; equal keys keep their order.
fn sorted(keys: impl Iterator<Item = u64>) -> Vec<u32> {
    let mut numbered: Vec<u128> = (0..)
        .zip(keys)
        .map(|(number, key)| u128::from(key) << 32 | number)
        .collect();
    parallel::sort(&mut numbered);
    numbered.into_iter().map(|key| key as u32).collect()
}

/// Returns the Morton code of `cell`, which interleaves the bits of the three coordinates.
fn morton(cell: DVec3) -> u64 {
    spread(cell.x as u64) | spread(cell.y as u64) << 1 | spread(cell.z as u64) << 2
}

/// Moves bit i of the lower 21 bits to bit 3i.
fn spread(bits: u64) -> u64 {
    // Insert two zeros after each bit by splitting the bits into ever smaller groups.
    let mut bits = bits & 0x1F_FFFF;
    bits = (bits | bits << 32) & 0x001F_0000_0000_FFFF;
    bits = (bits | bits << 16) & 0x001F_0000_FF00_00FF;
    bits = (bits | bits << 8) & 0x100F_00F0_0F00_F00F;
    bits = (bits | bits << 4) & 0x10C3_0C30_C30C_30C3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests;
