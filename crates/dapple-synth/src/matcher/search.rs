//! The search in a tree: groups of leaves in the order of their distance, and of each leaf no more than is needed.

use super::basis::LANES;
use super::margin::Margin;
use super::tree::{Boxes, Pairs, STEP, Tree};
use super::{Match, PaddedRows};
use fearless_simd::{i16x32, i32x16, prelude::*};

/// A search on its way.
pub(crate) struct Search<'a, S> {
    pub(crate) simd: S,
    pub(crate) tree: &'a Tree,
    pub(crate) margin: &'a Margin,
    pub(crate) rows: &'a PaddedRows,
    /// The factor of the squared distance of each row. Since none is below 1, what is too far without its factor
    /// is too far with it, and the bounds of the tree stay right.
    pub(crate) factors: Option<&'a [f32]>,
    /// The query, filled up with zeros.
    pub(crate) query: &'a [[f32; LANES]],
    /// The query along the directions, each pair of coordinates sixteen times.
    pub(crate) placed: &'a [[Pairs; STEP]],
    /// [`Margin::error`] of the query.
    pub(crate) error: f64,
    /// The nearest row so far.
    pub(crate) best: Option<Match>,
    /// The distance of `best`, or the bound that the caller gave.
    pub(crate) below: f32,
    /// Rows with a larger sum of squares are not nearer than `below`.
    pub(crate) threshold: i32,
}

impl<S: Simd> Search<'_, S> {
    /// Finds the nearest row. `order` is memory.
    #[inline(always)]
    pub(crate) fn run(&mut self, order: &mut Vec<u64>) {
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
        order.sort_unstable();
        for &entry in order.iter() {
            if (entry >> 32) as i32 > self.threshold {
                break;
            }
            self.visit_group((entry & 0xffff_ffff) as usize);
        }
    }

    /// Compares with a row.
    #[inline(always)]
    pub(crate) fn compare(&mut self, row: u32) {
        let mut distance_sq = self.rows.distance_sq(self.simd, self.query, row);
        if let Some(factors) = self.factors {
            distance_sq *= factors[row as usize];
        }
        let is_first = |best: Match| distance_sq == best.distance_sq && row < best.row;
        if distance_sq < self.below || self.best.is_some_and(is_first) {
            self.best = Some(Match { row, distance_sq });
            self.below = distance_sq;
            self.threshold = self.margin.threshold(distance_sq, self.error);
        }
    }

    /// Looks at the leaves of a group whose boxes are near.
    #[inline(always)]
    fn visit_group(&mut self, group: usize) {
        let first = group * LANES;
        let n = (self.tree.rows.len() - first).min(LANES);
        let mut all = (1_u64 << n) - 1;
        let sums = self.box_sums(&self.tree.leaves[group]);
        if self.best.is_none() {
            // One leaf alone brings the threshold down for the others.
            let sums: [i32; LANES] = sums.into();
            let (nearest, _) = least(&sums[..n]);
            all &= !(1 << nearest);
            self.visit_leaves(first, 1 << nearest);
        }
        let near = sums.simd_le(self.threshold).to_bitmask() & all;
        self.visit_leaves(first, near);
    }

    /// Compares the rows of leaves that may be near: those of the sixteen from `first` on that have a bit in `near`.
    ///
    /// All of them take a step before one takes the next, and which ones stay is found without a branch: a processor
    /// could not predict it.
    #[inline(always)]
    fn visit_leaves(&mut self, first: usize, mut near: u64) {
        let mut sums = [[0_i32; LANES]; LANES];
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
        while near != 0 {
            let leaf = near.trailing_zeros() as usize;
            near &= near - 1;
            self.compare_rows(first + leaf, sums[leaf]);
        }
    }

    /// Compares with the rows of a leaf whose sums are near, the nearest first.
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

    /// Adds the squares of the differences of the query and sixteen rows along [`STEP`] pairs of directions.
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

    /// The squared distances of the query from sixteen boxes.
    #[inline(always)]
    fn box_sums(&self, boxes: &Boxes) -> i32x16<S> {
        let mut sums = i32x16::splat(self.simd, 0);
        for i in 0..STEP {
            let placed = i16x32::simd_from(self.simd, self.placed[0][i]);
            let below = i16x32::simd_from(self.simd, boxes.low[i]) - placed;
            let above = placed - i16x32::simd_from(self.simd, boxes.high[i]);
            let outside = below.max(above).max(0);
            sums += outside.pairwise_dot_product(outside);
        }
        sums
    }
}

/// The place of the least number, and the number.
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
