//! Sums over the weights of a band, and the memory that they are made in.

use crate::splat::LANES;
use core::marker::PhantomData;
use fearless_simd::prelude::*;

/// Takes the weights of a band and sums them up.
///
/// Weights are added to planes of numbers, which begin at zero; when all control points have been taken in, the planes
/// are resolved into values.
pub(crate) trait Sink: Sync {
    /// The value of a pixel.
    type Value: Copy + Send;

    /// How many planes there are.
    const PLANES: usize;

    /// How many values there are to a pixel.
    fn per_pixel(&self) -> usize;

    /// Takes in the weights of control point `point` in `N` rows of a tile. `sums` holds [`LANES`] numbers of every plane
    /// for each row, of which those from `lane` on are the tile's.
    fn add<S: Simd, V: SimdFloat<S, Element = f32>, const N: usize>(
        &self,
        simd: S,
        point: u32,
        weights: &[V; N],
        sums: &mut [f32],
        lane: usize,
    );

    /// Makes the values of up to [`LANES`] pixels in a row, given as many numbers of every plane. `nearest(i)` is the
    /// control point nearest to pixel `i`, for where no weight is left.
    fn resolve<S: Simd>(
        &self,
        simd: S,
        sums: &[f32],
        values: &mut [Self::Value],
        nearest: impl Fn(usize) -> u32,
    );

    /// Marks the values of pixels whose positions are not finite.
    fn leave_undefined(&self, values: &mut [Self::Value]);
}

/// The numbers that a band is summed in.
///
/// They lie in columns of [`LANES`] pixels: row by row, and plane by plane in every row, each on its own cache line. So
/// what a tile needs is in one piece.
pub(crate) struct Planes<K> {
    numbers: Vec<f32>,
    /// Where the first cache line begins.
    origin: usize,
    /// Rows of pixels.
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
    /// How many numbers a row of pixels has.
    pub(crate) fn per_row(width: usize) -> usize {
        width.next_multiple_of(LANES) * K::PLANES
    }

    /// Zeroes the numbers of `height` rows of `width` pixels.
    pub(crate) fn clear(&mut self, width: usize, height: usize) {
        self.height = height;
        self.numbers.clear();
        self.numbers
            .resize(Self::per_row(width) * height + LANES, 0.0);
        // Where this is not possible, it is only slower.
        self.origin = self
            .numbers
            .as_ptr()
            .align_offset(LANES * size_of::<f32>())
            .min(LANES);
    }

    /// The numbers of `n_rows` rows that `column` lies in, and its place in each row.
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
