//! Branch-and-bound search in the k-d tree for the row nearest to a query.
//!
//! Steps: compute the distances of the query from the boxes of all groups of leaves, and visit the groups in order of
//! this distance. In a group, reject leaves by their boxes, then by the partial distances of their rows. Compare the
//! remaining rows in full, which lowers the threshold for all others. A sum is a full or partial squared distance, in
//! the integer units of the [lattice](super::lattice).

use super::basis::LANES;
use super::margin::Margin;
use super::tree::{Boxes, Pairs, STEP, Tree};
use super::{Match, PaddedRows};
use fearless_simd::{i16x32, i32x16, prelude::*};

/// State of a search.
pub(crate) struct Search<'a, S> {
    pub(crate) simd: S,
    pub(crate) tree: &'a Tree,
    pub(crate) margin: &'a Margin,
    pub(crate) rows: &'a PaddedRows,
    /// Factor on the squared distance of each row. All are at least 1, so a row that is too far without its factor is
    /// also too far with it, and the bounds of the tree remain valid.
    pub(crate) factors: Option<&'a [f32]>,
    /// Query, padded with zeros.
    pub(crate) query: &'a [[f32; LANES]],
    /// Integer components of the query; each pair is repeated in all sixteen lanes.
    pub(crate) placed: &'a [[Pairs; STEP]],
    /// [`Margin::error`] of the query.
    pub(crate) error: f64,
    /// Nearest row so far.
    pub(crate) best: Option<Match>,
    /// Squared distance of `best`, or the caller's bound.
    pub(crate) below: f32,
    /// Rows with a sum above this threshold are farther than `below`.
    pub(crate) threshold: i32,
}

impl<S: Simd> Search<'_, S> {
    /// Finds the nearest row. `order` is scratch memory.
    #[inline(always)]
    pub(crate) fn run(&mut self, order: &mut Vec<u64>) {
        // Collect the groups whose boxes are near. An entry packs the squared distance (upper half) and the group's
        // index (lower half).
        order.clear();
        for (first, boxes) in (0..).step_by(LANES).zip(&self.tree.groups) {
            let sums: [i32; LANES] = self.box_sums(boxes).into();
            let n = (self.tree.leaves.len() - first).min(LANES);
            for (group, &sum) in (first..).zip(&sums[..n]) {
                if sum <= self.threshold {
                    order.push(u64::from(sum.cast_unsigned()) << 32 | group as u64);
                }
            }
        }
        // Visit them in order of distance.
        order.sort_unstable();
        for &entry in order.iter() {
            // All later groups are at least as far away, and the threshold never rises.
            if (entry >> 32) as i32 > self.threshold {
                break;
            }
            self.visit_group((entry & 0xffff_ffff) as usize);
        }
    }

    /// Compares the query with a row in full, and lowers the threshold if the row is the nearest so far.
    #[inline(always)]
    pub(crate) fn compare(&mut self, row: u32) {
        let mut distance_sq = self.rows.distance_sq(self.simd, self.query, row);
        if let Some(factors) = self.factors {
            distance_sq *= factors[row as usize];
        }
        let is_first = |best: Match| distance_sq == best.distance_sq && row < best.row;
        // A tie goes to the lower index, as in the naive comparison.
        if distance_sq < self.below || self.best.is_some_and(is_first) {
            self.best = Some(Match { row, distance_sq });
            self.below = distance_sq;
            self.threshold = self.margin.threshold(distance_sq, self.error);
        }
    }

    /// Visits the leaves of a group whose boxes are near.
    #[inline(always)]
    fn visit_group(&mut self, group: usize) {
        let first = group * LANES;
        let n = (self.tree.rows.len() - first).min(LANES);
        let mut all = (1_u64 << n) - 1;
        let sums = self.box_sums(&self.tree.leaves[group]);
        if self.best.is_none() {
            // Visit the nearest leaf first, which lowers the threshold for the others.
            let sums: [i32; LANES] = sums.into();
            let (nearest, _) = least(&sums[..n]);
            all &= !(1 << nearest);
            self.visit_leaves(first, 1 << nearest);
        }
        let near = sums.simd_le(self.threshold).to_bitmask() & all;
        self.visit_leaves(first, near);
    }

    /// Compares the rows of leaves that may be near. Leaf `first + i` is visited if bit `i` of `near` is set.
    ///
    /// All leaves advance by one step before the next step begins. The remaining leaves are determined without
    /// branches, because they are unpredictable.
    #[inline(always)]
    fn visit_leaves(&mut self, first: usize, mut near: u64) {
        let mut sums = [[0_i32; LANES]; LANES];
        // Add the next step to the sums of all remaining leaves, and drop leaves without a near row.
        for (placed, pairs) in self.placed.iter().zip(&self.tree.steps) {
            let pairs = &pairs[first..];
            let mut left = near;
            near = 0;
            while left != 0 {
                let leaf = left.trailing_zeros() as usize;
                left &= left - 1;
                let sum = self.add_squares(sums[leaf], placed, &pairs[leaf]);
                sums[leaf] = sum.into();
                near |= u64::from(sum.simd_le(self.threshold).any_true()) << leaf;
            }
            if near == 0 {
                return;
            }
        }
        // Compare the rows of the remaining leaves.
        while near != 0 {
            let leaf = near.trailing_zeros() as usize;
            near &= near - 1;
            self.compare_rows(first + leaf, sums[leaf]);
        }
    }

    /// Compares the query with the rows of a leaf whose sums are within the threshold, in order of increasing sums.
    #[inline(always)]
    fn compare_rows(&mut self, leaf: usize, mut sums: [i32; LANES]) {
        for _ in 0..LANES {
            let (lane, sum) = least(&sums);
            if sum > self.threshold {
                return;
            }
            self.compare(self.tree.rows[leaf][lane]);
            sums[lane] = i32::MAX;
        }
    }

    /// Adds the squared differences between the query and sixteen rows, along [`STEP`] pairs of directions, to the
    /// rows' sums.
    #[inline(always)]
    fn add_squares(
        &self,
        sums: [i32; LANES],
        placed: &[Pairs; STEP],
        pairs: &[Pairs; STEP],
    ) -> i32x16<S> {
        let mut sums = i32x16::simd_from(self.simd, sums);
        for i in 0..STEP {
            let placed = i16x32::simd_from(self.simd, placed[i]);
            let difference = i16x32::simd_from(self.simd, pairs[i]) - placed;
            sums += difference.pairwise_dot_product(difference);
        }
        sums
    }

    /// Returns the squared distances between the query and sixteen boxes.
    #[inline(always)]
    fn box_sums(&self, boxes: &Boxes) -> i32x16<S> {
        let mut sums = i32x16::splat(self.simd, 0);
        for i in 0..STEP {
            let placed = i16x32::simd_from(self.simd, self.placed[0][i]);
            let below = i16x32::simd_from(self.simd, boxes.low[i]) - placed;
            let above = placed - i16x32::simd_from(self.simd, boxes.high[i]);
            // The distance from the box along a direction, 0 inside of it, is a lower bound for the rows in the box.
            let outside = below.max(above).max(0);
            sums += outside.pairwise_dot_product(outside);
        }
        sums
    }
}

/// Returns the index of the minimum, and the minimum itself.
#[inline(always)]
fn least(values: &[i32]) -> (usize, i32) {
    let mut least = (0, i32::MAX);
    for (place, &value) in values.iter().enumerate() {
        if value < least.1 {
            least = (place, value);
        }
    }
    least
}
