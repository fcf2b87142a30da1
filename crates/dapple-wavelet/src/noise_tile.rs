//! Generates seamless rasters of wavelet noise, with a weight per band.
//!
//! A raster contains the coefficients of a periodic quadratic B-spline. Each band of Cook and DeRose's wavelet noise
//! (see [`WaveletNoise`](crate::WaveletNoise)) is generated at the size at which it occupies the highest octave. It is
//! then doubled to the size of the raster, which represents the same function with more coefficients. The result has
//! no seam, bands do not overlap, and each band can be recovered by halving. Prefer this to removing the seam of a
//! noise image afterward.
//!
//! Every band is generated from separate white noise, and its period is never shorter than the raster.
//!
//! Reference: Robert L. Cook and Tony DeRose, "Wavelet Noise", ACM Transactions on Graphics 24(3) (SIGGRAPH 2005),
//! <https://doi.org/10.1145/1073204.1073264>, for the bands; summing them into a raster is an original addition.

use crate::error::cancelled;
use crate::noise::{LineSums, check_weights, white_raster};
use crate::{Border, IsCancelled, SplineFilter, WaveletError, WaveletErrorKind};
use dapple_hash::Seed;
use dapple_raster::Raster;

const PERIODIC: [Border; 2] = [Border::Periodic; 2];

/// Creates a seamless raster of wavelet noise from the weights of its bands, finest first.
///
/// The pixels are the coefficients of a periodic quadratic spline. Nearly all power of band `b` is between `2^-b / 4`
/// and `2^-b / 2` cycles per pixel. Its mean is 0, and its mean square over all pixels and seeds is the square of its
/// weight. Bands are independent, so the mean squares add up. The values are nearly normally distributed, and are not
/// scaled or clamped.
///
/// [`SplineFilter::analyze`] recovers these bands from the raster. Runs on all cores if the feature `rayon` is
/// enabled.
///
#[cfg_attr(doc, doc = include_str!("../docs/wavelet-tile.md"))]
///
/// # Errors
///
/// [`WaveletErrorKind::Range`] unless there are 1 to 16 weights from -1e30 to 1e30, [`WaveletErrorKind::NotFinite`]
/// if a weight is NaN or infinite, [`WaveletErrorKind::NotDivisible`] if a side is not a multiple of `2^n` for `n`
/// weights, and [`WaveletErrorKind::Raster`] if there is no pixel or more than 2^31.
///
/// # Examples
///
/// ```
/// use dapple_wavelet::{hash::Seed, wavelet_tile};
///
/// let tile = wavelet_tile([128, 64], &[0.25, 0.5, 1.0], Seed(7))?;
/// assert_eq!(tile.size(), [128, 64]);
/// # Ok::<(), dapple_wavelet::WaveletError>(())
/// ```
pub fn wavelet_tile(
    size: [u32; 2],
    weights: &[f32],
    seed: Seed,
) -> Result<Raster<f32>, WaveletError> {
    wavelet_tile_cancellable(size, weights, seed, &|| false)
}

/// Same as [`wavelet_tile`], but fails if `is_cancelled` returns true. It is called before each batch of 256 lines and
/// once per 65,536 pixels of each band, or more often.
///
/// # Errors
///
/// Same as [`wavelet_tile`], plus [`WaveletErrorKind::Cancelled`].
pub fn wavelet_tile_cancellable(
    size: [u32; 2],
    weights: &[f32],
    seed: Seed,
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, WaveletError> {
    check_weights(weights)?;
    // There are at most 16 weights.
    let levels = weights.len() as u32;
    check_size(size, levels)?;
    let mut tile = Raster::filled(size.map(|side| side >> (levels - 1)), 0.0)?;
    for level in (0..levels).rev() {
        let size = size.map(|side| side >> level);
        if size != tile.size() {
            tile = SplineFilter::default().up_cancellable(&tile, size, PERIODIC, is_cancelled)?;
        }
        // Skip bands with weight zero.
        let weight = weights[level as usize];
        if weight != 0.0 {
            tile = add_band(&tile, weight, level, seed, is_cancelled)?;
        }
    }
    Ok(tile)
}

/// Checks that all sides can be halved `levels` times.
fn check_size(size: [u32; 2], levels: u32) -> Result<(), WaveletError> {
    // This call checks the number of pixels.
    Raster::filled(size, ())?;
    match size.into_iter().find(|side| side % (1 << levels) != 0) {
        None => Ok(()),
        Some(side) => Err(WaveletError::new(WaveletErrorKind::NotDivisible {
            length: side as usize,
            levels,
        })),
    }
}

/// Adds a band to a raster of the same size. `level` is the number of times that the raster will still be doubled.
fn add_band(
    raster: &Raster<f32>,
    weight: f32,
    level: u32,
    seed: Seed,
    is_cancelled: &IsCancelled,
) -> Result<Raster<f32>, WaveletError> {
    let size = raster.size();
    let words = seed.child("wavelet tile", level.into());
    let white = white_raster(size, words, is_cancelled)?;
    let low = SplineFilter::default().project_cancellable(&white, 1, PERIODIC, is_cancelled)?;
    let [along_rows, along_columns] =
        size.map(|side| LineSums::of_coefficients(side as usize, level));
    let factor = f64::from(weight) * LineSums::factor([along_rows?, along_columns?]);
    let sum = Raster::from_rows_cancellable(size, is_cancelled, |row| {
        let [coarser, white, low] = [raster, &white, &low].map(|part| part.row(row));
        (0..size[0] as usize).map(move |column| {
            let detail = f64::from(white[column]) - f64::from(low[column]);
            (f64::from(coarser[column]) + factor * detail) as f32
        })
    })?;
    sum.ok_or_else(cancelled)
}

#[cfg(test)]
mod tests;
