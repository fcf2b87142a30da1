//! The row that is nearest to a query: exactly the one that comparing with all of them finds.
//!
//! Rows are turned to the directions in which they differ most (principal components; Reference: Hertzmann, Jacobs,
//! Oliver, Curless and Salesin, Image Analogies, SIGGRAPH 2001, who search approximately in the first of them), and the
//! first ones are kept, in sixteen bits. There a part of a distance is known after few numbers, and most rows can be
//! skipped: whole leaves of a k-d tree by their boxes, sixteen rows at a time after every eighth number. What is left is
//! compared as it is, by [`distance_sq`]. Bounds on all rounding ([`margin`]) make sure that nothing nearer is skipped,
//! so that the result does not depend on the tree, the directions, or the machine.

mod basis;
mod distance;
mod jacobi;
#[cfg(test)]
pub(crate) use jacobi::eigen;
mod lattice;
mod margin;
mod search;
#[cfg(test)]
mod tests;
mod tree;

pub(crate) use basis::Basis;
use dapple_raster::simd;
use dapple_raster::simd::dispatch;
use distance::LANES;
pub(crate) use distance::PaddedRows;
use fearless_simd::{Level, prelude::*};
use lattice::Lattice;
use margin::Margin;
use search::Search;
use tree::{Pairs, Placed, STEP, Tree};

pub use distance::distance_sq;

/// Fewer rows than this are all compared.
const FEW: usize = 64;

/// Longer rows than this are all compared: the covariance grows with the square.
const MOST_DIMS: usize = 1024;

/// The nearest row that [`Matcher::nearest`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The row.
    pub row: u32,
    /// Its distance: [`distance_sq`].
    pub distance_sq: f32,
}

/// Rows prepared for finding the nearest one.
///
/// Holds a copy of the rows and about 140 bytes more for each; up to 512 more while it is made.
#[derive(Clone, Debug)]
pub struct Matcher {
    dims: usize,
    rows: PaddedRows,
    index: Option<Index>,
}

/// Memory that a search works in, kept between searches.
#[derive(Clone, Debug, Default)]
pub struct MatcherMemory {
    query: Vec<[f32; LANES]>,
    centered: Vec<f32>,
    rotated: Vec<[f32; LANES]>,
    coordinates: Vec<i16>,
    placed: Vec<[Pairs; STEP]>,
    order: Vec<u64>,
}

/// A row to find the nearest one of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query<'a> {
    pub(crate) values: &'a [f32],
    /// Only what is nearer is found.
    pub(crate) below: f32,
    /// A row that may be near.
    pub(crate) hint: Option<u32>,
    /// The factor of the squared distance of each row, at least 1; it counts as the row's distance everywhere.
    pub(crate) factors: Option<&'a [f32]>,
}

/// All that skips rows.
#[derive(Clone, Debug)]
struct Index {
    basis: Basis,
    lattice: Lattice,
    margin: Margin,
    tree: Tree,
}

impl Matcher {
    /// Prepares rows of `dims` numbers each, one after the other. What is left over at the end does not count, nor do
    /// rows after the first 2³² - 1.
    ///
    /// Any numbers are good, but rows are found slowly, by comparing with all of them, if one is not finite or farther
    /// than 10¹⁵ from the mean, or if they have more than 1024 numbers. A row that is not finite is never the nearest.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_synth::{Match, Matcher, MatcherMemory};
    ///
    /// let matcher = Matcher::new(2, &[0.0, 0.0, 3.0, 4.0, 6.0, 8.0]);
    /// let mut memory = MatcherMemory::default();
    /// let nearest = matcher.nearest(&[3.0, 3.0], f32::INFINITY, None, &mut memory);
    /// assert_eq!(nearest, Some(Match { row: 1, distance_sq: 1.0 }));
    /// assert_eq!(matcher.nearest(&[3.0, 3.0], 1.0, None, &mut memory), None);
    /// ```
    #[must_use]
    pub fn new(dims: usize, rows: &[f32]) -> Self {
        let rows = whole_rows(dims, rows);
        Self::of(dims, rows, tree::distinct_rows(dims, rows))
    }

    /// Prepares rows for queries with [`Query::factors`], in which equal rows may be at different distances.
    pub(crate) fn with_factors(dims: usize, rows: &[f32]) -> Self {
        let rows = whole_rows(dims, rows);
        Self::of(dims, rows, tree::every_row(dims, rows))
    }

    /// Prepares rows, of which those in `order` are looked for.
    fn of(dims: usize, rows: &[f32], order: Vec<u32>) -> Self {
        Self {
            dims,
            rows: PaddedRows::new(dims, rows),
            index: Index::new(dims, rows, order),
        }
    }

    /// The row nearest to a query; of several at one distance the first. Nothing if none is nearer than `below`.
    ///
    /// `below` is a squared distance, infinity for no limit. `hint` is a row that may be near, which saves time and
    /// changes nothing else. A query that is not finite or that has not as many numbers as the rows has no nearest row.
    #[must_use]
    pub fn nearest(
        &self,
        query: &[f32],
        below: f32,
        hint: Option<u32>,
        memory: &mut MatcherMemory,
    ) -> Option<Match> {
        let query = Query {
            values: query,
            below,
            hint,
            factors: None,
        };
        self.find(query, memory)
    }

    /// The row nearest to a query with factors; also nothing if there are less of them than rows.
    pub(crate) fn find(&self, query: Query<'_>, memory: &mut MatcherMemory) -> Option<Match> {
        self.find_at(simd::level(), query, memory)
    }

    /// The nearest of some rows; `hint` is left out of account.
    pub(crate) fn find_among(
        &self,
        query: Query<'_>,
        rows: &[u32],
        memory: &mut MatcherMemory,
    ) -> Option<Match> {
        if !self.can_find(query) {
            return None;
        }
        dispatch!(simd::level(), simd => {
            memory.query.clear();
            distance::pad(query.values, &mut memory.query);
            self.compare(simd, query, rows.iter().copied(), memory)
        })
    }

    /// Whether a query has as many numbers as the rows, and no less factors than there are rows.
    fn can_find(&self, query: Query<'_>) -> bool {
        let enough = |factors: &[f32]| factors.len() >= self.rows.len();
        query.values.len() == self.dims && query.factors.is_none_or(enough)
    }

    fn find_at(&self, level: Level, query: Query<'_>, memory: &mut MatcherMemory) -> Option<Match> {
        if !self.can_find(query) {
            return None;
        }
        dispatch!(level, simd => {
            memory.query.clear();
            distance::pad(query.values, &mut memory.query);
            self.search(simd, query, memory)
                .unwrap_or_else(|| self.compare(simd, query, 0..self.rows.len() as u32, memory))
        })
    }

    /// The result by the index, if it can be used for this query.
    #[inline(always)]
    fn search<S: Simd>(
        &self,
        simd: S,
        query: Query<'_>,
        memory: &mut MatcherMemory,
    ) -> Option<Option<Match>> {
        let index = self.index.as_ref()?;
        let error = index.place(simd, query.values, memory)?;
        let mut search = Search {
            simd,
            tree: &index.tree,
            margin: &index.margin,
            rows: &self.rows,
            factors: query.factors,
            query: &memory.query,
            placed: &memory.placed,
            error,
            best: None,
            below: query.below,
            threshold: index.margin.threshold(query.below, error),
        };
        let in_range = |hint: &u32| (*hint as usize) < self.rows.len();
        if let Some(hint) = query.hint.filter(in_range) {
            search.compare(hint);
        }
        search.run(&mut memory.order);
        Some(search.best)
    }

    /// The nearest of some rows: of several at one distance the one with the least number.
    #[inline(always)]
    fn compare<S: Simd>(
        &self,
        simd: S,
        query: Query<'_>,
        rows: impl Iterator<Item = u32>,
        memory: &MatcherMemory,
    ) -> Option<Match> {
        let mut best: Option<Match> = None;
        for row in rows {
            let mut distance_sq = self.rows.distance_sq(simd, &memory.query, row);
            if let Some(factors) = query.factors {
                distance_sq *= factors[row as usize];
            }
            let least = best.map_or(query.below, |best| best.distance_sq);
            let is_first = |best: Match| distance_sq == best.distance_sq && row < best.row;
            if distance_sq < least || best.is_some_and(is_first) {
                best = Some(Match { row, distance_sq });
            }
        }
        best
    }
}

/// The rows without what is left over, and no more of them than can be numbered.
fn whole_rows(dims: usize, rows: &[f32]) -> &[f32] {
    let n_rows = rows.len().checked_div(dims).unwrap_or(0);
    &rows[..n_rows.min(u32::MAX as usize) * dims]
}

impl Index {
    fn new(dims: usize, rows: &[f32], order: Vec<u32>) -> Option<Self> {
        if rows.len() < FEW * dims.max(1) || dims > MOST_DIMS {
            return None;
        }
        let basis = Basis::new(dims, rows);
        let placed = Placed::new(dims, rows, &basis)?;
        Some(Self {
            lattice: placed.lattice,
            margin: Margin::new(dims, &basis, &placed.lattice, placed.longest),
            tree: Tree::new(&placed, order),
            basis,
        })
    }

    /// Finds the whole coordinates of a query, and [`Margin::error`]. Nothing if it is not finite or too long.
    #[inline(always)]
    fn place<S: Simd>(&self, simd: S, query: &[f32], memory: &mut MatcherMemory) -> Option<f64> {
        self.basis.center(query, &mut memory.centered);
        let length = margin::length(&memory.centered);
        // This is not so for a length that is not a number.
        let is_short = length <= margin::LONGEST;
        if !is_short {
            return None;
        }
        let n_directions = self.basis.n_directions();
        memory.rotated.resize(n_directions / LANES, [0.0; LANES]);
        self.basis
            .rotate(simd, &memory.centered, &mut memory.rotated);
        memory.coordinates.resize(n_directions, 0);
        self.lattice
            .place(memory.rotated.as_flattened(), &mut memory.coordinates);
        memory.placed.clear();
        let (steps, _) = memory.coordinates.as_chunks::<{ 2 * STEP }>();
        for step in steps {
            let lanes = |pair: usize| std::array::from_fn(|i| step[2 * pair + i % 2]);
            memory.placed.push(std::array::from_fn(lanes));
        }
        Some(self.margin.error(length))
    }
}
