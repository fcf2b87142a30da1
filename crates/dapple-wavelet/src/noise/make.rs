//! Generates noise tiles as white noise minus its projection.

use super::band::Band;
use super::place::Period;
use super::scale::LineSums;
use super::tile::Tile;
use super::white::{white, white_raster};
use super::{WaveletNoise, WaveletNoise2, WaveletNoise3};
use crate::error::cancelled;
use crate::{Border, IsCancelled, SplineFilter, WaveletError, WaveletErrorKind};
use dapple_hash::{CellHash, Seed};
use dapple_raster::Raster;

/// Maximum number of cells in a tile, which take half a gigabyte.
const MOST_CELLS: u32 = 1 << 27;

/// Minimum number of cells along an axis that can be halved and doubled.
const FEWEST_CELLS: u32 = 4;

impl WaveletNoise2 {
    /// Creates 2-D noise with a period of `size` cells along both axes and one band of weight 1.
    ///
    /// The tile takes `4 (size + 2)²` bytes, and several times as much while it is created.
    ///
    /// # Errors
    ///
    /// [`WaveletErrorKind::Range`] if `size` is below 4 or above 11584, [`WaveletErrorKind::NotDivisible`] if `size`
    /// is odd.
    pub fn new(size: u32, seed: Seed) -> Result<Self, WaveletError> {
        Self::of_size([size; 2], seed)
    }

    /// Creates 2-D noise with a period of `size[0]` by `size[1]` cells and one band of weight 1.
    ///
    /// For equal sizes, the result equals [`new`](Self::new). The variance is 1 for any size.
    ///
    /// # Errors
    ///
    /// [`WaveletErrorKind::Range`] for fewer than 4 cells along an axis or more than 2^27 cells in total,
    /// [`WaveletErrorKind::NotDivisible`] if a size is odd.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_wavelet::{WaveletNoise2, hash::Seed, raster::glam::DVec2};
    ///
    /// let noise = WaveletNoise2::of_size([96, 64], Seed(7))?;
    /// let position = DVec2::new(0.25, -3.5);
    /// assert_eq!(noise.sample(position), noise.sample(position + DVec2::new(96.0, 64.0)));
    /// # Ok::<(), dapple_wavelet::WaveletError>(())
    /// ```
    pub fn of_size(size: [u32; 2], seed: Seed) -> Result<Self, WaveletError> {
        Self::of_size_cancellable(size, seed, &|| false)
    }

    /// Same as [`of_size`](Self::of_size), but fails if `is_cancelled` returns true. It is called before each batch of
    /// 256 lines and once per 65,536 cells, or more often.
    ///
    /// # Errors
    ///
    /// Same as [`of_size`](Self::of_size), plus [`WaveletErrorKind::Cancelled`].
    pub fn of_size_cancellable(
        size: [u32; 2],
        seed: Seed,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, WaveletError> {
        check_size(size)?;
        let white = white_raster(size, white_words(seed), is_cancelled)?;
        let filter = SplineFilter::default();
        let low = filter.project_cancellable(&white, 1, [Border::Periodic; 2], is_cancelled)?;
        Self::from_white(size, seed, [&white, &low], is_cancelled)
    }
}

impl WaveletNoise3 {
    /// Creates 3-D noise with a period of `size` cells along each axis and one band of weight 1.
    ///
    /// The tile takes `4 (size + 2)³` bytes, and several times as much while it is created.
    ///
    /// # Errors
    ///
    /// [`WaveletErrorKind::Range`] if `size` is below 4 or above 512, [`WaveletErrorKind::NotDivisible`] if `size` is
    /// odd.
    pub fn new(size: u32, seed: Seed) -> Result<Self, WaveletError> {
        Self::of_size([size; 3], seed)
    }

    /// Creates 3-D noise with a period of `size` cells along each axis and one band of weight 1.
    ///
    /// For equal sizes, the result equals [`new`](Self::new). The variance is 1 for any size.
    ///
    /// # Errors
    ///
    /// [`WaveletErrorKind::Range`] for fewer than 4 cells along an axis or more than 2^27 cells in total,
    /// [`WaveletErrorKind::NotDivisible`] if a size is odd.
    pub fn of_size(size: [u32; 3], seed: Seed) -> Result<Self, WaveletError> {
        Self::of_size_cancellable(size, seed, &|| false)
    }

    /// Same as [`of_size`](Self::of_size), but fails if `is_cancelled` returns true. It is called before each batch of
    /// 256 lines and once per 65,536 cells, or more often.
    ///
    /// # Errors
    ///
    /// Same as [`of_size`](Self::of_size), plus [`WaveletErrorKind::Cancelled`].
    pub fn of_size_cancellable(
        size: [u32; 3],
        seed: Seed,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, WaveletError> {
        check_size(size)?;
        let [width, height, depth] = size;
        let words = white_words(seed);
        // Stack the slices vertically in one raster.
        let rows = [width, height * depth];
        let white = Raster::from_rows_cancellable(rows, is_cancelled, |row| {
            let [row, slice] = [row % height, row / height].map(i64::from);
            let row = CellHash::new(words, [row, slice]);
            (0..width).map(move |column| white(row, column))
        })?;
        let white = white.ok_or_else(cancelled)?;
        let low = SplineFilter::default().project_volume_cancellable(
            white.pixels(),
            size,
            1,
            [Border::Periodic; 3],
            is_cancelled,
        )?;
        let low = Raster::from_vec(rows, low)?;
        Self::from_white(size, seed, [&white, &low], is_cancelled)
    }
}

impl<const N: usize> WaveletNoise<N> {
    /// Creates noise with one band of weight 1 from the difference between white noise and its projection.
    fn from_white(
        size: [u32; N],
        seed: Seed,
        [white, low]: [&Raster<f32>; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Self, WaveletError> {
        let cells = size.map(|cells| cells as usize);
        let mut sums = [LineSums::of_values(cells[0])?; N];
        for axis in 1..N {
            sums[axis] = LineSums::of_values(cells[axis])?;
        }
        let factor = LineSums::factor(sums);
        let coefficients = Raster::from_rows_cancellable(white.size(), is_cancelled, |row| {
            let parts = white.row(row).iter().zip(low.row(row));
            parts.map(|(&white, &low)| ((f64::from(white) - f64::from(low)) * factor) as f32)
        })?;
        let coefficients = coefficients.ok_or_else(cancelled)?;
        Ok(Self {
            size,
            periods: size.map(Period::new),
            seed,
            tile: Tile::new(cells, coefficients.pixels(), is_cancelled)?,
            bands: Band::all(&[1.0], size, seed),
        })
    }
}

/// Checks that all sides are even and long enough for halving and doubling, and that the number of cells is within
/// the limit.
fn check_size<const N: usize>(size: [u32; N]) -> Result<(), WaveletError> {
    let range = |what, value, range| {
        let kind = WaveletErrorKind::Range { what, value, range };
        Err(WaveletError::new(kind))
    };
    if let Some(side) = size.into_iter().find(|&side| side < FEWEST_CELLS) {
        return range("size of the tile", side.into(), "at least 4");
    }
    let cells: f64 = size.into_iter().map(f64::from).product();
    if cells > f64::from(MOST_CELLS) {
        return range(
            "number of cells of the tile",
            cells,
            "at most 2^27 = 134217728",
        );
    }
    match size.into_iter().find(|side| !side.is_multiple_of(2)) {
        None => Ok(()),
        Some(side) => Err(WaveletError::new(WaveletErrorKind::NotDivisible {
            length: side as usize,
            levels: 1,
        })),
    }
}

/// Derives the seed for the white noise.
fn white_words(seed: Seed) -> Seed {
    seed.child("wavelet noise", 0)
}
