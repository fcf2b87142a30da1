//! Tiles from white noise: what is left of it without its projection.

use super::band::Band;
use super::place::Period;
use super::scale::LineSums;
use super::tile::Tile;
use super::white::{white, white_raster};
use super::{WaveletNoise, WaveletNoise2, WaveletNoise3};
use crate::{Border, SplineFilter, WaveletError, WaveletErrorKind};
use dapple_hash::{CellHash, Seed};
use dapple_raster::Raster;

/// The largest tile of the plane: below half a gigabyte.
const LARGEST_2: u32 = 11_584;

/// The largest tile of space: half a gigabyte.
const LARGEST_3: u32 = 512;

impl WaveletNoise2 {
    /// Noise of the plane that repeats after `size` cells: one band, of weight 1.
    ///
    /// The tile takes `4 (size + 2)²` bytes, and several times as many while it is made.
    ///
    /// # Errors
    ///
    /// [`WaveletErrorKind::Range`] below 4 and above 11584, [`WaveletErrorKind::NotDivisible`] if `size` is odd.
    pub fn new(size: u32, seed: Seed) -> Result<Self, WaveletError> {
        check_size(size, LARGEST_2, "from 4 to 11584")?;
        let white = white_raster([size; 2], white_words(seed))?;
        let low = SplineFilter::default().project(&white, 1, [Border::Periodic; 2])?;
        Self::from_white(size, seed, white.pixels(), low.pixels())
    }
}

impl WaveletNoise3 {
    /// Noise of space that repeats after `size` cells: one band, of weight 1.
    ///
    /// The tile takes `4 (size + 2)³` bytes, and several times as many while it is made.
    ///
    /// # Errors
    ///
    /// [`WaveletErrorKind::Range`] below 4 and above 512, [`WaveletErrorKind::NotDivisible`] if `size` is odd.
    pub fn new(size: u32, seed: Seed) -> Result<Self, WaveletError> {
        check_size(size, LARGEST_3, "from 4 to 512")?;
        let words = white_words(seed);
        // The slices, one below the other.
        let white = Raster::from_rows([size, size * size], |row| {
            let [row, slice] = [row % size, row / size].map(i64::from);
            let row = CellHash::new(words, [row, slice]);
            (0..size).map(move |column| white(row, column))
        })?;
        let periodic = [Border::Periodic; 3];
        let filter = SplineFilter::default();
        let low = filter.project_volume(white.pixels(), [size; 3], 1, periodic)?;
        Self::from_white(size, seed, white.pixels(), &low)
    }
}

impl<const N: usize> WaveletNoise<N> {
    /// One band, of weight 1, of what white noise has and its projection has not.
    fn from_white(size: u32, seed: Seed, white: &[f32], low: &[f32]) -> Result<Self, WaveletError> {
        let factor = LineSums::factor([LineSums::of_values(size as usize)?; N]);
        let parts = white.iter().zip(low);
        let coefficients: Vec<f32> = parts
            .map(|(&white, &low)| ((f64::from(white) - f64::from(low)) * factor) as f32)
            .collect();
        Ok(Self {
            size,
            period: Period::new(size),
            seed,
            tile: Tile::new(size as usize, &coefficients),
            bands: Band::all(&[1.0], size, seed),
        })
    }
}

/// Refuses tiles too small to be halved and doubled, those larger than the largest, and odd ones.
fn check_size(size: u32, largest: u32, range: &'static str) -> Result<(), WaveletError> {
    if !(4..=largest).contains(&size) {
        return Err(WaveletError::new(WaveletErrorKind::Range {
            what: "size of the tile",
            value: size.into(),
            range,
        }));
    }
    if !size.is_multiple_of(2) {
        return Err(WaveletError::new(WaveletErrorKind::NotDivisible {
            length: size as usize,
            levels: 1,
        }));
    }
    Ok(())
}

/// The seed of the white noise.
fn white_words(seed: Seed) -> Seed {
    seed.child("wavelet noise", 0)
}
