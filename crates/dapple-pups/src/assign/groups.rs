//! Divides points into groups that are connected by the graph (figure 9b).
//!
//! The paper groups points "into clusters of three or four points" and does not say how. Here groups grow
//! sequentially. Each starts at the free point with the lowest number of free neighbors, and adds such points, so that
//! few points become isolated. Points that remain are merged with one or two adjacent groups, and this region is
//! divided again by an exhaustive search.

mod divide;

use crate::{PupsError, Range, range};
use dapple_graph::Graph;
use dapple_hash::{Seed, hash1};
use dapple_points::PointIdx;
use divide::divide;
use std::collections::BTreeSet;

/// Valid number of points in a group.
pub(crate) const POINTS_PER_CELL: Range = range!(from 1 to 16);

/// Returns a group label for every point. Labels are consecutive numbers from 0.
///
/// Every point is in one group, and every group is connected by edges of the graph. A group has between `sizes[0]` and
/// `sizes[1]` points; each number is equally probable while enough free points are adjacent. A smaller group remains
/// only if the group and two adjacent ones cannot be divided into groups of valid sizes. This occurs if the number of
/// points in a connected component of the graph is not a sum of valid sizes (such as 5 points in groups of three or
/// four), or at a dead end of the graph.
///
/// # Errors
///
/// [`Range`](crate::PupsErrorKind::Range) if a size is not from 1 to 16, or the sizes are in descending order.
///
/// # Examples
///
/// ```
/// use dapple_pups::{graph::delaunay, grouped_labels, hash::Seed, points::{Domain, poisson_disk}};
///
/// let points = poisson_disk(Domain::paper_torus(), 0.1, Seed(1))?;
/// let labels = grouped_labels(&delaunay(&points)?, [3, 4], Seed(2))?;
/// let n_in_first = labels.iter().filter(|&&label| label == 0).count();
/// assert!((3..=4).contains(&n_in_first));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn grouped_labels(graph: &Graph, sizes: [u32; 2], seed: Seed) -> Result<Vec<u32>, PupsError> {
    for size in sizes {
        let holds = size >= sizes[0] && POINTS_PER_CELL.holds(size.into());
        PupsError::check(
            holds,
            "number of points in a group",
            f64::from(size),
            "1 to 16, the least first",
        )?;
    }
    let neighbors = neighbors(graph);
    let mut groups = Growth::new(&neighbors, seed).grow_all(sizes, seed.child("size", 0));
    mend(&neighbors, &mut groups, sizes);
    Ok(labels(&groups, neighbors.len()))
}

/// Returns the neighbors of each point over edges in either direction, without the point itself.
fn neighbors(graph: &Graph) -> Vec<Vec<u32>> {
    let mut neighbors = vec![Vec::new(); graph.n_points()];
    // Record every edge at both of its ends.
    for point in 0..graph.n_points() as u32 {
        for axis in graph.axes(PointIdx(point)) {
            neighbors[point as usize].push(axis.to.0);
            neighbors[axis.to.index()].push(point);
        }
    }
    // Remove duplicates, and edges to a point's own periodic images.
    for (point, row) in (0..).zip(&mut neighbors) {
        row.sort_unstable();
        row.dedup();
        row.retain(|&other| other != point);
    }
    neighbors
}

/// Groups under construction. A point is free until it is in a group.
struct Growth<'a> {
    neighbors: &'a [Vec<u32>],
    /// Number of free neighbors of each free point; `None` for points in a group.
    free_neighbors: Vec<Option<u32>>,
    /// Random rank of each point.
    ranks: Vec<u64>,
    /// Free points, ordered by their number of free neighbors, then by random rank.
    queue: BTreeSet<(u32, u64, u32)>,
}

impl<'a> Growth<'a> {
    fn new(neighbors: &'a [Vec<u32>], seed: Seed) -> Self {
        // A hash decides between points with the same number of free neighbors.
        let ranks = (0..neighbors.len() as i64).map(|point| hash1(seed, [point], 0));
        let mut growth = Self {
            neighbors,
            free_neighbors: neighbors.iter().map(|row| Some(row.len() as u32)).collect(),
            ranks: ranks.collect(),
            queue: BTreeSet::new(),
        };
        growth.queue = (0..neighbors.len() as u32)
            .filter_map(|point| growth.key(point))
            .collect();
        growth
    }

    fn key(&self, point: u32) -> Option<(u32, u64, u32)> {
        let free = self.free_neighbors[point as usize]?;
        Some((free, self.ranks[point as usize], point))
    }

    /// Removes `point` from the free points, and updates its neighbors.
    fn take(&mut self, point: u32) {
        if let Some(key) = self.key(point) {
            self.queue.remove(&key);
        }
        self.free_neighbors[point as usize] = None;
        // Its free neighbors have one free neighbor less: update their keys.
        for &other in &self.neighbors[point as usize] {
            let Some(key) = self.key(other) else {
                continue;
            };
            self.queue.remove(&key);
            self.free_neighbors[other as usize] = Some(key.0 - 1);
            self.queue.insert((key.0 - 1, key.1, other));
        }
    }

    fn grow_all(mut self, sizes: [u32; 2], seed: Seed) -> Vec<Vec<u32>> {
        let mut groups = Vec::new();
        while let Some(&(_, _, first)) = self.queue.first() {
            // Draw the size, uniformly between the limits.
            let random = hash1(seed, [groups.len() as i64], 0) >> 32;
            let more = (random * u64::from(sizes[1] - sizes[0] + 1)) >> 32;
            groups.push(self.grow(first, sizes[0] as usize + more as usize));
        }
        groups
    }

    /// Grows a group of up to `size` points from `first`.
    fn grow(&mut self, first: u32, size: usize) -> Vec<u32> {
        let mut group = vec![first];
        self.take(first);
        while group.len() < size {
            // Add the free point next to the group that has the fewest free neighbors, so that few become isolated.
            let around = group
                .iter()
                .flat_map(|&point| &self.neighbors[point as usize]);
            let next = around.filter_map(|&point| self.key(point)).min();
            let Some((_, _, point)) = next else {
                break;
            };
            group.push(point);
            self.take(point);
        }
        group
    }
}

/// Repairs groups that are too small: merges each with one or two adjacent groups, and divides this region again.
fn mend(neighbors: &[Vec<u32>], groups: &mut Vec<Vec<u32>>, sizes: [u32; 2]) {
    // Index the group of each point.
    let mut group_of = vec![0; neighbors.len()];
    for (index, group) in groups.iter().enumerate() {
        group
            .iter()
            .for_each(|&point| group_of[point as usize] = index);
    }
    // For each group that is too small, divide the region around it again.
    for small in 0..groups.len() {
        if groups[small].len() >= sizes[0] as usize {
            continue;
        }
        // Try the regions from small to large.
        for region in regions(neighbors, groups, &group_of, small) {
            let points: Vec<u32> = region.iter().flat_map(|&g| groups[g].clone()).collect();
            let Some(parts) = divide(neighbors, &points, sizes) else {
                continue;
            };
            region.iter().for_each(|&group| groups[group].clear());
            // Store the new groups in the emptied slots, and append the remaining ones.
            let mut homes = region.into_iter();
            for part in parts {
                let home = homes.next().unwrap_or(groups.len());
                part.iter()
                    .for_each(|&point| group_of[point as usize] = home);
                if home == groups.len() {
                    groups.push(part);
                } else {
                    groups[home] = part;
                }
            }
            break;
        }
    }
}

/// Returns candidate regions for repairing the group `small`, as lists of group indices: the group with one adjacent
/// group, then with two.
fn regions(
    neighbors: &[Vec<u32>],
    groups: &[Vec<u32>],
    group_of: &[usize],
    small: usize,
) -> Vec<Vec<usize>> {
    // Indices of the groups that are adjacent to a group.
    let beside = |group: usize| -> BTreeSet<usize> {
        let points = groups[group].iter();
        points
            .flat_map(|&point| &neighbors[point as usize])
            .map(|&point| group_of[point as usize])
            .filter(|&other| other != group)
            .collect()
    };
    // First try the small group with one adjacent group.
    let near = beside(small);
    let mut regions: Vec<Vec<usize>> = near.iter().map(|&first| vec![small, first]).collect();
    // Then try it with that group and another one that is adjacent to either.
    for &first in &near {
        let others: BTreeSet<usize> = near.union(&beside(first)).copied().collect();
        let others = others
            .into_iter()
            .filter(|&other| other != small && other != first);
        regions.extend(others.map(|second| vec![small, first, second]));
    }
    regions
}

/// Returns the label of each point. Groups are numbered in the order of their first points.
fn labels(groups: &[Vec<u32>], n_points: usize) -> Vec<u32> {
    let mut order: Vec<&Vec<u32>> = groups.iter().filter(|group| !group.is_empty()).collect();
    order.sort_by_key(|group| group.iter().min());
    let mut labels = vec![0; n_points];
    for (label, group) in (0..).zip(order) {
        group
            .iter()
            .for_each(|&point| labels[point as usize] = label);
    }
    labels
}
