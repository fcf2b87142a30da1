//! The feature points that matter to a tile, as the inner loops want them.

use super::LANES;
use super::sieve::{PixelBox, PointList};
use crate::fixed::STEP;
use crate::metric::Norm;
use fearless_simd::{f32x16, i32x16, prelude::*};

/// The most rows of a tile.
pub(super) const TILE_ROWS: usize = 32;

/// The points that matter to a tile.
#[derive(Debug)]
pub(super) struct Shortlist<const N: usize> {
    pub(super) len: usize,
    /// Their coordinates along each axis, in cells from the lower corner of the tile; padded to whole registers.
    pub(super) coordinates: [Vec<f32>; N],
    /// What the rows of the tile add to the keys: for each point the terms of all axes but the first, joined. There is
    /// one for each row; what follows them means nothing.
    pub(super) row_terms: Vec<[f32; TILE_ROWS]>,
    /// Their ids, if they are wanted.
    pub(super) ids: Vec<u64>,
}

impl<const N: usize> Shortlist<N> {
    pub(super) fn new() -> Self {
        Self {
            len: 0,
            coordinates: core::array::from_fn(|_| Vec::new()),
            row_terms: Vec::new(),
            ids: Vec::new(),
        }
    }

    /// Takes the points of a list, for a tile whose rows have these coordinates (along the axes from the second on), in
    /// steps from `corner`. Behind each line there is a register more.
    #[inline(always)]
    pub(super) fn fill<S: Simd, M: Norm>(
        &mut self,
        simd: S,
        norm: M,
        (points, pixels): (&PointList<N>, &PixelBox<N>),
        (n_rows, lines, corner): (usize, [&[i32]; N], [i32; N]),
    ) {
        self.len = points.len;
        let room = (points.len + 1).next_multiple_of(LANES);
        if self.row_terms.len() < room {
            self.row_terms.resize(room, [0.0; TILE_ROWS]);
            for coordinates in &mut self.coordinates {
                coordinates.resize(room, 0.0);
            }
        }
        for start in (0..points.len).step_by(LANES) {
            for axis in 0..N {
                let steps = i32x16::from_slice(simd, &points.steps[axis][start..start + LANES]);
                let ahead = (steps - pixels.low[axis]).to_float::<f32x16<S>>() * STEP;
                ahead.store_slice(&mut self.coordinates[axis][start..start + LANES]);
            }
        }
        for first in (0..n_rows).step_by(LANES) {
            let mut places = [f32x16::splat(simd, 0.0); N];
            for axis in 1..N {
                let steps = i32x16::from_slice(simd, &lines[axis][first..first + LANES]);
                places[axis] = (steps - corner[axis]).to_float::<f32x16<S>>() * STEP;
            }
            for (point, terms) in self.row_terms[..points.len].iter_mut().enumerate() {
                let mut key = norm.terms(places[N - 1] - self.coordinates[N - 1][point]);
                for axis in (1..N - 1).rev() {
                    let term = norm.terms(places[axis] - self.coordinates[axis][point]);
                    key = norm.joins(term, key);
                }
                key.store_slice(&mut terms[first..first + LANES]);
            }
        }
    }

    /// Their coordinates along an axis, padded to a whole register.
    #[inline(always)]
    pub(super) fn coordinates(&self, axis: usize) -> &[f32] {
        &self.coordinates[axis][..self.len.next_multiple_of(LANES).max(LANES)]
    }
}
