//! Exact nearest-neighbor search: finds the row (a vector of `f32`) nearest to a query, with the same result as
//! comparing with every row.
//!
//! Reference: rows are centered and rotated to their principal components, as in Hertzmann, Jacobs, Oliver, Curless and
//! Salesin, "Image Analogies", SIGGRAPH 2001, who search approximately in the first components. The first components
//! are stored as 16-bit integers, in the leaves of a k-d tree. There a few components give a lower bound of a distance,
//! which rejects most rows: whole leaves by their bounding boxes, and sixteen rows at a time after every eighth
//! component. The remaining rows are compared in full by [`distance_sq`].
//!
//! Proved bounds on all rounding errors ([`margin`]) ensure that no nearer row is rejected. So the result does not
//! depend on the tree, the components, or the machine.
//!
//! Input: rows of `dims` values each, and a query of `dims` values. Output: a [`Match`] with the row's index and
//! squared distance.

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

/// Minimum number of rows for an index; fewer are compared one by one.
const FEW: usize = 64;

/// Maximum number of values per row for an index, since the size of the covariance matrix grows with its square. Longer
/// rows are compared one by one.
const MOST_DIMS: usize = 1024;

/// Result of a search: the nearest row and its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// Index of the row.
    pub row: u32,
    /// Squared distance between the row and the query, as computed by [`distance_sq`].
    pub distance_sq: f32,
}

/// Index over rows for exact nearest-neighbor search.
///
/// Memory: a copy of the rows and about 140 additional bytes per row; up to 512 additional bytes per row during
/// construction.
#[derive(Clone, Debug)]
pub struct Matcher {
    dims: usize,
    rows: PaddedRows,
    index: Option<Index>,
}

/// Scratch memory for a search, reusable for any number of searches.
#[derive(Clone, Debug, Default)]
pub struct MatcherMemory {
    query: Vec<[f32; LANES]>,
    centered: Vec<f32>,
    rotated: Vec<[f32; LANES]>,
    coordinates: Vec<i16>,
    placed: Vec<[Pairs; STEP]>,
    order: Vec<u64>,
}

/// A query, with a bound, a hint, and a factor per row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query<'a> {
    pub(crate) values: &'a [f32],
    /// Exclusive upper bound on the squared distance; infinity for no limit.
    pub(crate) below: f32,
    /// Index of a row that is likely near. It saves time and does not change the result.
    pub(crate) hint: Option<u32>,
    /// Factor on the squared distance of each row, at least 1. All comparisons, bounds and results use the product.
    pub(crate) factors: Option<&'a [f32]>,
}

/// Search structure over the rows; all its parts serve to reject rows early.
#[derive(Clone, Debug)]
struct Index {
    basis: Basis,
    lattice: Lattice,
    margin: Margin,
    tree: Tree,
}

impl Matcher {
    /// Builds an index over rows of `dims` values each, stored contiguously. An incomplete row at the end is ignored,
    /// as are rows after the first 2³² - 1.
    ///
    /// Any values are accepted. The search falls back to a slow comparison with every row if a value is not finite, if
    /// a row is farther than 10¹⁵ from the mean, or if rows have more than 1024 values. A row with a value that is not
    /// finite is never the nearest.
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
        // The first of equal rows is always returned, so the others need no place in the tree.
        Self::of(dims, rows, tree::distinct_rows(dims, rows))
    }

    /// Builds an index for queries with [`Query::factors`]. It holds duplicate rows too, since their factors may
    /// differ.
    pub(crate) fn with_factors(dims: usize, rows: &[f32]) -> Self {
        let rows = whole_rows(dims, rows);
        Self::of(dims, rows, tree::every_row(dims, rows))
    }

    /// Builds an index that searches only the rows in `order`.
    fn of(dims: usize, rows: &[f32], order: Vec<u32>) -> Self {
        Self {
            dims,
            rows: PaddedRows::new(dims, rows),
            index: Index::new(dims, rows, order),
        }
    }

    /// Returns the row nearest to a query, or `None` if no row is nearer than `below`. The first of equally near rows
    /// is returned.
    ///
    /// `below` is a squared distance; infinity means no limit. `hint` is the index of a row that is likely near; it
    /// saves time and does not change the result. Returns `None` for a query that is not finite or has another length
    /// than the rows.
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

    /// Returns the row nearest to a query, which may have factors. Returns `None` if there are fewer factors than rows,
    /// or no row is nearer than the query's bound.
    pub(crate) fn find(&self, query: Query<'_>, memory: &mut MatcherMemory) -> Option<Match> {
        self.find_at(simd::level(), query, memory)
    }

    /// Returns the nearest of the given rows. The query's `hint` is ignored.
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

    /// Returns whether the query has the length of a row, and at least one factor per row.
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
            // Without an index, the naive comparison gives the same result.
            self.search(simd, query, memory)
                .unwrap_or_else(|| self.compare(simd, query, 0..self.rows.len() as u32, memory))
        })
    }

    /// Searches with the index. The outer `None` means that the index cannot be used for this query.
    #[inline(always)]
    fn search<S: Simd>(
        &self,
        simd: S,
        query: Query<'_>,
        memory: &mut MatcherMemory,
    ) -> Option<Option<Match>> {
        // Map the query to 16-bit components.
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
        // Compare with the hint first: a small first distance rejects more rows.
        let in_range = |hint: &u32| (*hint as usize) < self.rows.len();
        if let Some(hint) = query.hint.filter(in_range) {
            search.compare(hint);
        }
        search.run(&mut memory.order);
        Some(search.best)
    }

    /// Returns the nearest of the given rows by comparing with each; of equally near rows, the one with the lowest
    /// index.
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
            // Equally near rows are ordered by index, so the order of comparisons has no effect.
            let is_first = |best: Match| distance_sq == best.distance_sq && row < best.row;
            if distance_sq < least || best.is_some_and(is_first) {
                best = Some(Match { row, distance_sq });
            }
        }
        best
    }
}

/// Returns all complete rows, up to 2³² - 1 of them.
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

    /// Maps a query to 16-bit components and returns [`Margin::error`]. Returns `None` if the query is not finite or
    /// longer than [`margin::LONGEST`].
    #[inline(always)]
    fn place<S: Simd>(&self, simd: S, query: &[f32], memory: &mut MatcherMemory) -> Option<f64> {
        // Center in `f32`, as the rows were; the margin covers this rounding.
        self.basis.center(query, &mut memory.centered);
        let length = margin::length(&memory.centered);
        // False for NaN.
        let is_short = length <= margin::LONGEST;
        if !is_short {
            return None;
        }
        // Rotate to the principal components and round to integers.
        let n_directions = self.basis.n_directions();
        memory.rotated.resize(n_directions / LANES, [0.0; LANES]);
        self.basis
            .rotate(simd, &memory.centered, &mut memory.rotated);
        memory.coordinates.resize(n_directions, 0);
        self.lattice
            .place(memory.rotated.as_flattened(), &mut memory.coordinates);
        // Repeat each pair of components in all sixteen lanes.
        memory.placed.clear();
        let (steps, _) = memory.coordinates.as_chunks::<{ 2 * STEP }>();
        for step in steps {
            let lanes = |pair: usize| std::array::from_fn(|i| step[2 * pair + i % 2]);
            memory.placed.push(std::array::from_fn(lanes));
        }
        Some(self.margin.error(length))
    }
}
