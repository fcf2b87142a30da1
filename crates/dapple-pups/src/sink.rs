//! What becomes of the weights of a band, and the memory that they are summed in.

use crate::splat::TILE;
use fearless_simd::prelude::*;

/// What becomes of the weights of a band.
///
/// Weights are added to planes of numbers, which begin at zero; when all control points have been taken in, the planes
/// are resolved into values.
pub(crate) trait Sink: Sync {
    /// What a pixel is made of.
    type Value: Copy + Send;

    /// How many planes there are.
    fn n_planes(&self) -> usize;

    /// How many values there are to a pixel.
    fn per_pixel(&self) -> usize;

    /// Takes in the weights of control point `point`: for each of `N` rows a register of pixels, the first from `at` on in
    /// every plane.
    fn add<S: Simd, const N: usize>(
        &self,
        simd: S,
        point: u32,
        weights: &[S::f32s; N],
        planes: &mut Planes,
        at: usize,
    );

    /// Makes the values of a row of pixels, given its part of every plane. `nearest(i)` is the control point nearest to
    /// pixel `i`, for where no weight is left.
    fn resolve<'a, S: Simd>(
        &self,
        simd: S,
        plane: impl Fn(usize) -> &'a [f32],
        values: &mut [Self::Value],
        nearest: impl Fn(usize) -> u32,
    );

    /// What stands for a value at a position that is not finite.
    fn undefined(&self) -> Self::Value;
}

/// The numbers that a band is summed in: planes of rows, whose tiles each begin on a cache line, so that no
/// register of numbers lies across two.
#[derive(Default)]
pub(crate) struct Planes {
    numbers: Vec<f32>,
    /// Where the first cache line begins.
    origin: usize,
    /// From a row to the next.
    pub(crate) stride: usize,
    /// From a plane to the next.
    plane: usize,
}

impl Planes {
    /// Zeroed planes of `height` rows with at least `width` numbers.
    pub(crate) fn clear(&mut self, n_planes: usize, width: usize, height: usize) {
        self.stride = width.next_multiple_of(TILE);
        self.plane = height * self.stride;
        self.numbers.clear();
        self.numbers.resize(n_planes * self.plane + TILE, 0.0);
        // Where this is not possible, it is only slower.
        self.origin = self
            .numbers
            .as_ptr()
            .align_offset(TILE * size_of::<f32>())
            .min(TILE);
    }

    /// A register of numbers of a plane, `row` rows below `at`.
    #[inline(always)]
    pub(crate) fn register<S: Simd>(&mut self, plane: usize, at: usize, row: usize) -> &mut [f32] {
        let start = self.origin + plane * self.plane + at + row * self.stride;
        &mut self.numbers[start..start + S::f32s::LEN]
    }

    /// Adds to a plane: for each of `N` rows a register of numbers, the first from `at` on.
    #[expect(
        clippy::needless_range_loop,
        reason = "registers pass through plain loops only"
    )]
    #[inline(always)]
    pub(crate) fn add<S: Simd, const N: usize>(
        &mut self,
        simd: S,
        plane: usize,
        at: usize,
        summands: &[S::f32s; N],
    ) {
        for row in 0..N {
            let numbers = self.register::<S>(plane, at, row);
            (S::f32s::from_slice(simd, numbers) + summands[row]).store_slice(numbers);
        }
    }

    /// The first `width` numbers of a row of a plane.
    #[inline(always)]
    pub(crate) fn row(&self, plane: usize, row: usize, width: usize) -> &[f32] {
        let start = self.origin + plane * self.plane + row * self.stride;
        &self.numbers[start..start + width]
    }
}
