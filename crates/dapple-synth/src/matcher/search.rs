//! Best-first search in a tree.

use super::basis::LANES;
use super::distance::distance_sq_padded;
use super::margin::Margin;
use super::tree::{BOX_DIRECTIONS, Boxes, Tree};
use super::{Match, MatcherMemory, PaddedRows};
use fearless_simd::{f32x8, f32x16, i16x16, prelude::*};

/// After how many directions the rows of a leaf are looked at again.
const STEP: usize = 8;

/// A search on its way.
struct Search<'a, S> {
    simd: S,
    tree: &'a Tree,
    rows: &'a PaddedRows,
    margin: &'a Margin,
    query: &'a [[f32; LANES]],
    /// The query along the directions.
    rotated: &'a [f32],
    rotation_error: f64,
    best: Option<Match>,
    /// The distance of `best`, or the bound that the caller gave.
    limit: f32,
    /// What has a larger sum is not nearest.
    threshold: f32,
}

/// The nearest row, given a first one that may be.
#[inline(always)]
pub(crate) fn search<S: Simd>(
    simd: S,
    (tree, margin): (&Tree, &Margin),
    rows: &PaddedRows,
    (best, limit): (Option<Match>, f32),
    memory: &mut MatcherMemory,
) -> Option<Match> {
    let n_directions = tree.basis.n_directions();
    memory.rotated.resize(n_directions / LANES, [0.0; LANES]);
    tree.basis
        .rotate(simd, &memory.centered, &mut memory.rotated);
    for coordinate in memory.rotated.as_flattened_mut() {
        *coordinate *= 1.0 / tree.unit;
    }
    let rotation_error = margin.rotation_error(memory.length);
    let mut search = Search {
        simd,
        tree,
        rows,
        margin,
        query: &memory.query,
        rotated: memory.rotated.as_flattened(),
        rotation_error,
        best,
        limit,
        threshold: margin.threshold(limit, rotation_error),
    };
    search.run(&mut memory.order);
    search.best
}

impl<S: Simd> Search<'_, S> {
    #[inline(always)]
    fn run(&mut self, order: &mut Vec<u64>) {
        order.clear();
        for (index, boxes) in self.tree.groups.iter().enumerate() {
            let sums: [f32; LANES] = self.box_sums(boxes).into();
            let first = index * LANES;
            let n = (self.tree.leaves.len() - first).min(LANES);
            for (lane, &sum) in sums[..n].iter().enumerate() {
                if sum <= self.threshold {
                    order.push(u64::from(sum.to_bits()) << 32 | (first + lane) as u64);
                }
            }
        }
        order.sort_unstable();
        for &entry in order.iter() {
            if f32::from_bits((entry >> 32) as u32) > self.threshold {
                break;
            }
            self.visit_group((entry & 0xffff_ffff) as usize);
        }
    }

    /// Looks at the leaves of a group whose boxes are near: first at the nearest one, which brings the threshold down.
    #[inline(always)]
    fn visit_group(&mut self, group: usize) {
        let first = group * LANES;
        let n = (self.tree.heads.len() - first).min(LANES);
        let sums = self.box_sums(&self.tree.leaves[group]);
        let mut all = (1_u64 << n) - 1;
        if self.threshold == f32::INFINITY {
            let (nearest, _) = least(sums.into());
            all &= !(1 << nearest);
            self.visit_leaves(first, 1 << nearest);
        }
        let near = sums.simd_le(self.threshold).to_bitmask() & all;
        self.visit_leaves(first, near);
    }

    /// Compares the rows of leaves that may be near: those of the 16 from `first` on that have a bit in `near`.
    ///
    /// All of them take the next step before one takes the step after it, and who stays is found without a branch: whether
    /// a leaf stays cannot be predicted.
    #[inline(always)]
    fn visit_leaves(&mut self, first: usize, mut near: u64) {
        let simd = self.simd;
        let (head_z, tail_z) = self.rotated.split_at(BOX_DIRECTIONS);
        let mut leaves = [0_usize; LANES];
        let mut sums = [[0.0_f32; LANES]; LANES];
        let mut n = 0;
        while near != 0 {
            let leaf = first + near.trailing_zeros() as usize;
            near &= near - 1;
            let sum = self.add_squares(f32x16::splat(simd, 0.0), head_z, &self.tree.heads[leaf]);
            leaves[n] = leaf;
            sums[n] = sum.into();
            n += usize::from(sum.simd_le(self.threshold).any_true());
        }
        for (step, z) in tail_z.chunks_exact(STEP).enumerate() {
            if n == 0 {
                return;
            }
            let mut kept = 0;
            for i in 0..n {
                let leaf = leaves[i];
                let tail = &self.tree.tails[leaf * tail_z.len() + step * STEP..][..STEP];
                let sum = self.add_squares(f32x16::simd_from(simd, sums[i]), z, tail);
                leaves[kept] = leaf;
                sums[kept] = sum.into();
                kept += usize::from(sum.simd_le(self.threshold).any_true());
            }
            n = kept;
        }
        for i in 0..n {
            self.compare_rows(leaves[i], sums[i]);
        }
    }

    /// Compares the rows of a leaf whose sums are near, the nearest first.
    #[inline(always)]
    fn compare_rows(&mut self, leaf: usize, mut sums: [f32; LANES]) {
        loop {
            let (lane, sum) = least(sums);
            if sum > self.threshold || sum == f32::INFINITY { return; }
            self.compare(self.tree.rows[leaf][lane]);
            sums[lane] = f32::INFINITY;
        }
    }

    #[inline(always)]
    fn add_squares(&self, sum: f32x16<S>, z: &[f32], values: &[[i16; LANES]]) -> f32x16<S> {
        let mut sums = [sum, f32x16::splat(self.simd, 0.0)];
        for i in 0..STEP {
            let (low, high) = i16x16::simd_from(self.simd, values[i]).widen();
            let value = f32x8::float_from(low).combine(f32x8::float_from(high));
            let difference = value - z[i];
            sums[i % 2] += difference * difference;
        }
        sums[0] + sums[1]
    }

    #[inline(always)]
    fn box_sums(&self, boxes: &Boxes) -> f32x16<S> {
        let mut sum = f32x16::splat(self.simd, 0.0);
        for i in 0..BOX_DIRECTIONS {
            let z = f32x16::splat(self.simd, self.rotated[i]);
            let below = f32x16::simd_from(self.simd, boxes.low[i]) - z;
            let above = z - f32x16::simd_from(self.simd, boxes.high[i]);
            let outside = below.max(above).max(0.0);
            sum += outside * outside;
        }
        sum
    }

    #[inline(always)]
    fn compare(&mut self, row: u32) {
        let distance_sq = distance_sq_padded(self.simd, self.query, self.rows.row(row));
        let first = self.best.is_some_and(|best| distance_sq == best.distance_sq && row < best.row);
        if distance_sq < self.limit || first {
            self.best = Some(Match { row, distance_sq });
            self.limit = distance_sq;
            self.threshold = self.margin.threshold(distance_sq, self.rotation_error);
        }
    }
}

/// The least number and its place.
#[inline(always)]
fn least(values: [f32; LANES]) -> (usize, f32) {
    let mut best = (0, values[0]);
    for (lane, &value) in values.iter().enumerate() { if value < best.1 { best = (lane, value); } }
    best
}
