//! Sinks, which accumulate the weights of a band of pixels, and the memory for their sums.

use crate::splat::LANES;
use core::marker::PhantomData;
use fearless_simd::prelude::*;

/// Accumulates the weights of all control points in a band of pixels.
///
/// A sink has [`PLANES`](Self::PLANES) sums per pixel, which start at zero. When the weights of all control points
/// have been added, it converts the sums to pixel values.
pub(crate) trait Sink: Sync {
    /// Type of a pixel's value.
    type Value: Copy + Send;

    /// Number of sums per pixel.
    const PLANES: usize;

    /// Returns the number of output values per pixel.
    fn per_pixel(&self) -> usize;

    /// Adds the weights of control point `point` to `N` rows of a tile. For each row, `sums` has the sums of [`LANES`]
    /// pixels, plane by plane. The tile starts at pixel `lane` of them.
    fn add<S: Simd, V: SimdFloat<S, Element = f32>, const N: usize>(
        &self,
        simd: S,
        point: u32,
        weights: &[V; N],
        sums: &mut [f32],
        lane: usize,
    );

    /// Computes the values of up to [`LANES`] pixels of a row from their sums, given plane by plane. `nearest(i)`
    /// returns the control point nearest to pixel `i`, for pixels whose weights underflow.
    fn resolve<S: Simd>(
        &self,
        simd: S,
        sums: &[f32],
        values: &mut [Self::Value],
        nearest: impl Fn(usize) -> u32,
    );

    /// Writes the undefined value to pixels whose positions are not finite.
    fn leave_undefined(&self, values: &mut [Self::Value]);
}

/// The sums of a band of pixels.
///
/// They are stored in columns of [`LANES`] pixels: row by row, and plane by plane within a row, each plane on a
/// separate cache line. The sums of a tile are therefore contiguous.
pub(crate) struct Planes<K> {
    numbers: Vec<f32>,
    /// Index in `numbers` of the first sum, which is aligned to a cache line.
    origin: usize,
    /// Number of pixel rows.
    height: usize,
    sink: PhantomData<fn(&K)>,
}

impl<K> Default for Planes<K> {
    fn default() -> Self {
        Self {
            numbers: Vec::new(),
            origin: 0,
            height: 0,
            sink: PhantomData,
        }
    }
}

impl<K: Sink> Planes<K> {
    /// Returns the number of stored sums for a row of pixels, including padding.
    pub(crate) fn per_row(width: usize) -> usize {
        width.next_multiple_of(LANES) * K::PLANES
    }

    /// Sets the sums of `height` rows of `width` pixels to zero.
    pub(crate) fn clear(&mut self, width: usize, height: usize) {
        self.height = height;
        self.numbers.clear();
        // Reserve one more cache line, for the offset that aligns the first one.
        self.numbers
            .resize(Self::per_row(width) * height + LANES, 0.0);
        // If the memory cannot be aligned, the code is only slower.
        self.origin = self
            .numbers
            .as_ptr()
            .align_offset(LANES * size_of::<f32>())
            .min(LANES);
    }

    /// Returns the sums of `n_rows` rows in the column of [`LANES`] pixels that contains `column`, and the index of
    /// `column` within it.
    #[inline(always)]
    pub(crate) fn rows(
        &mut self,
        column: usize,
        first_row: usize,
        n_rows: usize,
    ) -> (&mut [f32], usize) {
        let line = (column / LANES * self.height + first_row) * K::PLANES;
        let start = self.origin + line * LANES;
        let numbers = &mut self.numbers[start..start + n_rows * K::PLANES * LANES];
        (numbers, column % LANES)
    }
}
