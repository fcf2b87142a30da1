//! The feature points that matter to a tile, as the inner loops want them.

use super::LANES;
use super::sieve::{PixelBox, PointList};
use crate::fixed::STEP;
use crate::metric::Norm;
use fearless_simd::{f32x16, i32x16, prelude::*};

/// The points that matter to a tile.
#[derive(Debug)]
pub(super) struct Shortlist<const N: usize> {
    pub(super) len: usize,
    /// Their coordinates along each axis, in cells from the lower corner of the tile; padded to whole registers.
    pub(super) coordinates: [Vec<f32>; N],
    /// See [`RowTerms`].
    row_terms: Vec<f32>,
    n_rows: usize,
    /// Their ids, if they are wanted.
    pub(super) ids: Vec<u64>,
}

impl<const N: usize> Shortlist<N> {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            coordinates: core::array::from_fn(|_| Vec::new()),
            row_terms: Vec::new(),
            n_rows: 0,
            ids: Vec::new(),
        }
    }

    /// Takes the points of a list, for a tile whose rows have these coordinates (along the axes from the second on), in
    /// steps from `corner`.
    #[inline(always)]
    pub(super) fn fill<S: Simd, M: Norm>(
        &mut self,
        simd: S,
        norm: M,
        (points, pixels): (&PointList<N>, &PixelBox<N>),
        (lines, corner): ([&[i32]; N], [i32; N]),
    ) {
        self.len = points.len;
        self.n_rows = lines[1].len();
        let room = (points.len + 1).next_multiple_of(CHUNK);
        if self.coordinates[0].len() < room {
            for coordinates in &mut self.coordinates {
                coordinates.resize(room, 0.0);
            }
        }
        // The inner loop may look at a few rows more.
        let n_terms = room * (self.n_rows + LANES);
        if self.row_terms.len() < n_terms {
            self.row_terms.resize(n_terms, 0.0);
        }
        for start in (0..points.len).step_by(LANES) {
            for axis in 0..N {
                let steps = i32x16::from_slice(simd, &points.steps[axis][start..start + LANES]);
                let ahead = (steps - pixels.low[axis]).to_float::<f32x16<S>>() * STEP;
                ahead.store_slice(&mut self.coordinates[axis][start..start + LANES]);
            }
        }
        for (chunk, first) in (0..points.len).step_by(CHUNK).enumerate() {
            let end = points.len.min(first + CHUNK);
            for row in 0..self.n_rows {
                let at = (chunk * (self.n_rows + LANES) + row) * CHUNK;
                let terms = &mut self.row_terms[at..at + CHUNK];
                for start in (first..end).step_by(LANES) {
                    let term = |axis: usize| {
                        let place = (lines[axis][row] - corner[axis]) as f32 * STEP;
                        let points = &self.coordinates[axis][start..start + LANES];
                        let points = f32x16::from_slice(simd, points);
                        norm.terms(f32x16::splat(simd, place) - points)
                    };
                    let mut key = term(N - 1);
                    for axis in (1..N - 1).rev() {
                        key = norm.joins(term(axis), key);
                    }
                    key.store_slice(&mut terms[start - first..start - first + LANES]);
                }
            }
        }
    }

    /// What the rows of the tile add to the keys.
    pub(super) fn row_terms(&self) -> RowTerms<'_> {
        RowTerms {
            terms: &self.row_terms,
            n_rows: self.n_rows,
        }
    }

    /// Their coordinates along an axis, padded to a whole register.
    #[inline(always)]
    pub(super) fn coordinates(&self, axis: usize) -> &[f32] {
        &self.coordinates[axis][..self.len.next_multiple_of(LANES).max(LANES)]
    }
}

/// How many points have their terms side by side.
pub(super) const CHUNK: usize = 64;

/// The terms of all axes but the first, joined: one for each row of the tile and each point.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowTerms<'a> {
    terms: &'a [f32],
    n_rows: usize,
}

impl<'a> RowTerms<'a> {
    /// The terms of `R` rows from `row` on, for the points of chunk `chunk`.
    #[inline(always)]
    pub(super) fn rows<const R: usize>(&self, chunk: usize, row: usize) -> &'a [[f32; CHUNK]; R] {
        let at = (chunk * (self.n_rows + LANES) + row) * CHUNK;
        let (rows, _) = self.terms[at..at + R * CHUNK].as_chunks::<CHUNK>();
        rows.try_into().expect("as many rows as were cut out")
    }
}
