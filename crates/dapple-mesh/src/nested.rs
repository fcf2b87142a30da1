//! Nested sets of even points on a surface, each with about four times as many as the one before.
//!
//! Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.1: the coarsest points are repelled,
//! then stay; new ones are added and repelled by all. The paper begins with random points at every level. Here a level begins
//! with the middles of the edges between the points before it, which is nearly even from the start; and since the coarsest level is
//! free to move, it is itself made from still coarser ones in this way. The pieces of the surface get their shares by area.
//!
//! The new points of a level are in Morton order (G. M. Morton, "A computer oriented geodetic data base", IBM, 1966): points near
//! each other are mostly near each other in memory.

use crate::between::{Edge, edges};
use crate::near::Places;
use crate::parallel::par_sort;
use crate::repel::repel;
use crate::scatter::Scatter;
use crate::share::Pieces;
use crate::unstick::unstick;
use crate::{Surface, SurfacePoint};
use dapple_hash::Seed;
use glam::DVec3;

/// The most points that begin at random.
const RANDOM_MOST: usize = 256;
/// Iterations for random points, which cost nothing, for there are few of them.
const ITERATIONS_RANDOM: usize = 40;
/// The points of the coarsest count and of those before it, which are few as well, get so many times the iterations.
const ITERATIONS_HIDDEN: usize = 4;
/// Bits of a position along one axis in Morton order.
const MORTON_BITS: u32 = 21;

/// Even points on a surface for each of `counts`, which ascend: the first `counts[0]` points are even by themselves, so are
/// the first `counts[1]`, and so on.
///
/// Each new count is best four times the one before. `iterations` is for the points of each count after the first, the first gets
/// four times as many. A piece of the surface that has too little area for a point of some count has none there.
///
/// # Panics
///
/// Never; counts that descend add no points.
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
    let seed = seed.child("nested points", 0);
    let pieces = Pieces::new(surface);
    let mut hidden = vec![coarsest];
    while let Some(&count) = hidden.last()
        && count > RANDOM_MOST
    {
        hidden.push(count.div_ceil(4));
    }
    let mut points = Vec::new();
    for (level, &count) in hidden.iter().rev().enumerate() {
        let seed = seed.child("hidden level", level as u64);
        grow(surface, &pieces, &mut points, count, seed);
        sort(surface, &mut points);
        let iterations = if level == 0 {
            ITERATIONS_RANDOM
        } else {
            iterations.saturating_mul(ITERATIONS_HIDDEN)
        };
        relax(surface, &pieces, &mut points, (0, iterations), seed);
    }
    sort(surface, &mut points);
    for (level, &count) in counts.iter().enumerate().skip(1) {
        let seed = seed.child("level", level as u64);
        let n_fixed = points.len();
        grow(surface, &pieces, &mut points, count, seed);
        sort(surface, &mut points[n_fixed..]);
        relax(surface, &pieces, &mut points, (n_fixed, iterations), seed);
        sort(surface, &mut points[n_fixed..]);
    }
    points
}

/// Adds points until there are `count`, on each piece its share.
fn grow(
    surface: &Surface,
    pieces: &Pieces,
    points: &mut Vec<SurfacePoint>,
    count: usize,
    seed: Seed,
) {
    let piece_of = |point: SurfacePoint| pieces.of_face[point.face.index()] as usize;
    let mut missing = pieces.shares(count);
    for &point in &*points {
        let missing = &mut missing[piece_of(point)];
        *missing = missing.saturating_sub(1);
    }
    let mut split = vec![Vec::new(); missing.len()];
    for edge in longest_first(edges(surface, points)) {
        split[piece_of(edge.middle)].push(edge);
    }
    for (piece, (missing, edges)) in missing.into_iter().zip(&split).enumerate() {
        split_edges(surface, edges, missing, points);
        let left = missing.saturating_sub(2 * edges.len());
        if left > 0 {
            let scatter = Scatter::new(surface, pieces.faces[piece].clone());
            let seed = seed.child("piece", piece as u64);
            points
                .extend((0..left as u64).filter_map(|number| scatter.point(surface, seed, number)));
        }
    }
}

/// Sorts edges, for long ones have the most room in their middle.
fn longest_first(edges: Vec<Edge>) -> Vec<Edge> {
    // The bits of positive numbers are in the order of the numbers.
    let mut keyed: Vec<(u64, u32)> = (0..)
        .zip(&edges)
        .map(|(number, edge)| (!edge.length.to_bits(), number))
        .collect();
    par_sort(&mut keyed);
    keyed
        .iter()
        .map(|&(_, number)| edges[number as usize])
        .collect()
}

/// Adds `missing` points on edges, the longest of which come first: one in the middle, or two on the first edges if there are
/// too few.
fn split_edges(surface: &Surface, edges: &[Edge], missing: usize, points: &mut Vec<SurfacePoint>) {
    let n_thirds = missing.saturating_sub(edges.len()).min(edges.len());
    for edge in &edges[..n_thirds] {
        points.extend(edge.thirds(surface));
    }
    let n_halves = missing
        .saturating_sub(2 * n_thirds)
        .min(edges.len() - n_thirds);
    points.extend(edges[n_thirds..][..n_halves].iter().map(|edge| edge.middle));
}

/// Repels the points from `n_fixed` on, and halfway moves those that are stuck.
fn relax(
    surface: &Surface,
    pieces: &Pieces,
    points: &mut [SurfacePoint],
    (n_fixed, iterations): (usize, usize),
    seed: Seed,
) {
    repel(surface, points, n_fixed, iterations / 2);
    if iterations > 1 {
        unstick(surface, pieces, points, n_fixed, seed.child("stuck", 0));
    }
    repel(surface, points, n_fixed, iterations - iterations / 2);
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
    let mut keyed: Vec<(u64, u32)> = (0..)
        .zip(&positions)
        .map(|(number, &position)| (morton((position - low) * scale), number))
        .collect();
    // Equal keys are told apart by the numbers, so the order is one.
    par_sort(&mut keyed);
    let sorted: Vec<SurfacePoint> = keyed
        .iter()
        .map(|&(_, number)| points[number as usize])
        .collect();
    points.copy_from_slice(&sorted);
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
