//! The row that is nearest to a query: exactly the one that comparing with all of them finds.

mod basis;
mod distance;
mod jacobi;
mod margin;
mod parallel;
mod search;
mod tree;

use dapple_raster::simd;
use distance::{LANES, distance_sq_padded};
use fearless_simd::{Level, dispatch, prelude::*};
use margin::Margin;
use tree::Tree;

pub use distance::distance_sq;

/// Fewer rows than this are all compared.
const FEW: usize = 64;

/// More values than this in a row are not sorted.
const MOST_DIMS: usize = 1024;

/// What [`Matcher::nearest`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The row.
    pub row: u32,
    /// Its distance: [`distance_sq`].
    pub distance_sq: f32,
}

/// Rows prepared for finding the nearest one.
#[derive(Clone, Debug)]
pub struct Matcher {
    dims: usize,
    rows: PaddedRows,
    tree: Option<(Tree, Margin)>,
}

/// Memory that a search works in, kept between searches.
#[derive(Clone, Debug, Default)]
pub struct MatcherMemory {
    query: Vec<[f32; LANES]>,
    centered: Vec<f32>,
    length: f64,
    rotated: Vec<[f32; LANES]>,
    order: Vec<u64>,
}

/// Rows filled up with zeros.
#[derive(Clone, Debug)]
struct PaddedRows {
    values: Vec<[f32; LANES]>,
    stride: usize,
}

impl PaddedRows {
    fn new(dims: usize, rows: &[f32]) -> Self {
        let stride = dims.div_ceil(LANES);
        let mut values = Vec::with_capacity(rows.len() / dims.max(1) * stride);
        if dims > 0 {
            for row in rows.chunks_exact(dims) {
                pad(row, &mut values);
            }
        }
        Self { values, stride }
    }

    #[inline(always)]
    fn row(&self, row: u32) -> &[[f32; LANES]] {
        &self.values[row as usize * self.stride..][..self.stride]
    }
}

fn pad(row: &[f32], target: &mut Vec<[f32; LANES]>) {
    let (values, rest) = row.as_chunks::<LANES>();
    target.extend(values);
    if !rest.is_empty() {
        let mut last = [0.0; LANES];
        last[..rest.len()].copy_from_slice(rest);
        target.push(last);
    }
}

impl Matcher {
    /// Prepares rows of `dims` numbers each, one after the other.
    #[must_use]
    pub fn new(dims: usize, rows: &[f32]) -> Self {
        let n_rows = rows.len().checked_div(dims).unwrap_or(0);
        let all = &rows[..n_rows * dims];
        let tree = if n_rows < FEW || dims > MOST_DIMS { None } else { Tree::new(dims, all) };
        Self {
            dims,
            rows: PaddedRows::new(dims, rows),
            tree: tree.map(|tree| { let margin = Margin::new(dims, &tree.basis, tree.longest, tree.unit); (tree, margin) }),
        }
    }

    /// The row nearest to a query; of several at one distance the first. Nothing if none is nearer than `below`.
    ///
    /// `below` is a squared distance, infinity for no limit. `hint` is a row that may be near, which saves time.
    #[must_use]
    pub fn nearest(
        &self,
        query: &[f32],
        below: f32,
        hint: Option<u32>,
        memory: &mut MatcherMemory,
    ) -> Option<Match> {
        self.nearest_at(simd::level(), query, below, hint, memory)
    }

    fn nearest_at(
        &self,
        level: Level,
        query: &[f32],
        below: f32,
        hint: Option<u32>,
        memory: &mut MatcherMemory,
    ) -> Option<Match> {
        if query.len() != self.dims || below.is_nan() { return None; }
        dispatch!(level, simd => self.nearest_simd(simd, query, below, hint, memory))
    }

    #[inline(always)]
    fn nearest_simd<S: Simd>(
        &self,
        simd: S,
        query: &[f32],
        below: f32,
        hint: Option<u32>,
        memory: &mut MatcherMemory,
    ) -> Option<Match> {
        memory.query.clear();
        pad(query, &mut memory.query);
        if let Some((tree, margin)) = &self.tree {
            tree.basis.center(query, &mut memory.centered);
            memory.length = margin::length(&memory.centered);
            if memory.length <= margin::LONGEST {
                let mut best = None;
                let mut limit = below;
                if let Some(row) = hint && (row as usize) < self.rows.values.len() / self.rows.stride {
                    let distance_sq = distance_sq_padded(simd, &memory.query, self.rows.row(row));
                    if distance_sq < below {
                        best = Some(Match { row, distance_sq });
                        limit = distance_sq;
                    }
                }
                return search::search(simd, (tree, margin), &self.rows, (best, limit), memory);
            }
        }
        let mut best = None;
        let mut least = below;
        for (row, values) in (0..).zip(self.rows.values.chunks_exact(self.rows.stride.max(1))) {
            let distance_sq = distance_sq_padded(simd, &memory.query, values);
            if distance_sq < least {
                least = distance_sq;
                best = Some(Match { row, distance_sq });
            }
        }
        best
    }
}
