//! Nested sets of even points on a surface, each with about four times as many as the one before.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1: the
//! coarsest points are repelled, then stay; new ones are added and repelled by all. The paper begins with random points
//! at every level. Here a level begins with the middles of the edges between the points before it, which is nearly even
//! from the start; and since the coarsest level is free to move, it is itself made from still coarser ones in this way.
//! The pieces of the surface get their shares by area.
//!
//! The new points of a level are in Morton order (G. M. Morton, "A Computer Oriented Geodetic Data Base", IBM, 1966):
//! points near each other are mostly near each other in memory.

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

/// The most points that begin at random.
const RANDOM_MOST: usize = 256;
/// Iterations for random points, which cost nothing, for there are few of them.
const ITERATIONS_RANDOM: usize = 40;
/// The points of the coarsest count and of those before it, which are few as well, get this many times the iterations.
const ITERATIONS_HIDDEN: usize = 4;
/// Bits of a position along one axis in Morton order.
const MORTON_BITS: u32 = 21;

/// Even points on a surface for each of `counts`, which ascend: the first `counts[0]` points are even by themselves, so
/// are the first `counts[1]`, and so on.
///
/// Each count is best four times the one before; one that is less adds no points. `iterations` is how often the new
/// points of a count push each other, of which six are enough; those of the first count do so four times as often. A
/// piece of the surface with less than about half of the area of a point has none.
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

/// The coarsest count, and a quarter of it, and so on, until there are few enough to begin at random.
fn hidden_counts(coarsest: usize) -> Vec<usize> {
    let mut counts = vec![coarsest];
    let mut count = coarsest;
    while count > RANDOM_MOST {
        count = count.div_ceil(4);
        counts.push(count);
    }
    counts
}

/// Points that become more from level to level.
struct Nest<'a> {
    surface: &'a Surface,
    pieces: Pieces,
    points: Vec<SurfacePoint>,
}

impl Nest<'_> {
    /// Adds points until there are `count`, and makes those from `n_fixed` on even.
    fn add_level(&mut self, count: usize, n_fixed: usize, iterations: usize, seed: Seed) {
        self.grow(count, seed);
        // Before the repulsion, which reads neighbors all the time, and after it, for the steps that follow.
        sort(self.surface, &mut self.points[n_fixed..]);
        self.relax(n_fixed, iterations, seed.child("stuck", 0));
        sort(self.surface, &mut self.points[n_fixed..]);
    }

    /// Adds points until there are `count`, on each piece its share.
    fn grow(&mut self, count: usize, seed: Seed) {
        let (surface, pieces) = (self.surface, &self.pieces);
        let piece_of = |point: SurfacePoint| pieces.of_face[point.face.index()] as usize;
        let mut missing = pieces.shares(count);
        for &point in &self.points {
            let missing = &mut missing[piece_of(point)];
            *missing = missing.saturating_sub(1);
        }
        let mut split = vec![Vec::new(); missing.len()];
        let edges = edges(surface, &self.points);
        for edge in longest_first(&edges) {
            split[piece_of(edges[edge as usize].middle)].push(edge);
        }
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

    /// Repels the points from `n_fixed` on, and halfway moves those that are stuck.
    fn relax(&mut self, n_fixed: usize, iterations: usize, seed: Seed) {
        let (surface, points) = (self.surface, &mut self.points);
        repel(surface, points, n_fixed, iterations / 2);
        if iterations > 1 {
            unstick(surface, &self.pieces, points, n_fixed, seed);
        }
        repel(surface, points, n_fixed, iterations - iterations / 2);
    }
}

/// The numbers of edges, sorted by length, for long ones have the most room in their middle.
fn longest_first(edges: &[Edge]) -> Vec<u32> {
    // The bits of positive numbers are in the order of the numbers.
    sorted(edges.iter().map(|edge| !edge.length.to_bits()))
}

/// Adds `missing` points on edges, the longest of which come first: one in the middle, or two on the first edges if
/// there are too few.
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

/// Sorts points along Morton's curve through their bounding box.
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

/// The numbers of keys in the order of the keys, and those of equal keys in the order of the numbers.
fn sorted(keys: impl Iterator<Item = u64>) -> Vec<u32> {
    let mut numbered: Vec<u128> = (0..)
        .zip(keys)
        .map(|(number, key)| u128::from(key) << 32 | number)
        .collect();
    parallel::sort(&mut numbered);
    numbered.into_iter().map(|key| key as u32).collect()
}

/// The bits of the three coordinates in turn.
fn morton(cell: DVec3) -> u64 {
    spread(cell.x as u64) | spread(cell.y as u64) << 1 | spread(cell.z as u64) << 2
}

/// Moves bit i of the lower 21 bits to bit 3i.
fn spread(bits: u64) -> u64 {
    let mut bits = bits & 0x1F_FFFF;
    bits = (bits | bits << 32) & 0x001F_0000_0000_FFFF;
    bits = (bits | bits << 16) & 0x001F_0000_FF00_00FF;
    bits = (bits | bits << 8) & 0x100F_00F0_0F00_F00F;
    bits = (bits | bits << 4) & 0x10C3_0C30_C30C_30C3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests;
