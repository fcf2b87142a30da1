//! Converts rasters to the bytes and mip levels of GPU textures.
//!
//! The bytes have the layout of `Rgba8Unorm` and `Rgba8UnormSrgb` in WebGPU and of the equivalent formats elsewhere:
//! red, green, blue, alpha, row by row from the top, without padding. Colors are sRGB codes, which the GPU decodes to
//! linear light when it samples. Data is linear in the texture too.
//!
//! A mip level has half of the columns and rows of the previous level, rounded down, and at least one. Each pixel is
//! the mean in linear light over the area it covers; along a side of odd length, adjacent areas share pixels. The
//! levels of an image that repeats also repeat.

use crate::{Code as _, LinearRgb, LinearRgba, Normal};
use dapple_raster::{Raster, RasterError, parallel};

/// A pixel of a texture: a color, a normal, a number, or three or four numbers that are not a color.
pub trait TexturePixel: Copy + Send + Sync {
    /// Returns the pixel's linear codes for the format `Rgba8Unorm`: `round(value · 255)`, and for normals
    /// `round((component + 1) / 2 · 255)`. Alpha is 255 if the pixel has none.
    #[must_use]
    fn to_rgba8(self) -> [u8; 4];

    /// Returns the mean of pixels with weights that sum to 1. Colors are also weighted by their alpha, and normals are
    /// normalized.
    #[must_use]
    fn mean(parts: &[(Self, f32)]) -> Self;
}

/// A pixel whose first three numbers are a color in linear light.
pub trait ColorPixel: TexturePixel {
    /// Returns the pixel's sRGB codes and its linear alpha for the format `Rgba8UnormSrgb`.
    #[must_use]
    fn to_rgba8_srgb(self) -> [u8; 4];
}

/// Conversion of a raster to the bytes and the mip levels of a GPU texture.
///
/// # Examples
///
/// ```
/// use dapple_color::{LinearRgb, TextureRaster};
/// use dapple_raster::Raster;
///
/// let stripes = Raster::from_fn([4, 2], |x, _| LinearRgb::gray((x % 2) as f32))?;
/// assert_eq!(stripes.to_rgba8_srgb()[..8], [0, 0, 0, 255, 255, 255, 255, 255]);
/// let levels = stripes.mip_levels()?;
/// assert_eq!(levels.iter().map(Raster::size).collect::<Vec<_>>(), [[4, 2], [2, 1], [1, 1]]);
/// // Half of the light is the code 188, not 128.
/// assert_eq!(levels[2].to_rgba8_srgb(), [188, 188, 188, 255]);
/// # Ok::<(), dapple_raster::RasterError>(())
/// ```
pub trait TextureRaster<T> {
    /// Returns the linear bytes of all pixels, 4 per pixel, row by row from the top: see [`TexturePixel::to_rgba8`].
    #[must_use]
    fn to_rgba8(&self) -> Vec<u8>
    where
        T: TexturePixel;

    /// Returns the sRGB bytes of all pixels, 4 per pixel, row by row from the top: see [`ColorPixel::to_rgba8_srgb`].
    #[must_use]
    fn to_rgba8_srgb(&self) -> Vec<u8>
    where
        T: ColorPixel;

    /// Returns the mip levels, from this raster down to a single pixel.
    ///
    /// # Errors
    ///
    /// Same as [`Raster::from_rows`]. Levels smaller than this raster never cause them.
    fn mip_levels(&self) -> Result<Vec<Raster<T>>, RasterError>
    where
        T: TexturePixel;
}

impl<T> TextureRaster<T> for Raster<T> {
    fn to_rgba8(&self) -> Vec<u8>
    where
        T: TexturePixel,
    {
        bytes(self, T::to_rgba8)
    }

    fn to_rgba8_srgb(&self) -> Vec<u8>
    where
        T: ColorPixel,
    {
        bytes(self, T::to_rgba8_srgb)
    }

    fn mip_levels(&self) -> Result<Vec<Self>, RasterError>
    where
        T: TexturePixel,
    {
        let mut levels = vec![self.clone()];
        while let Some(level) = levels.last().filter(|level| level.size() != [1, 1]) {
            let next = halved(level)?;
            levels.push(next);
        }
        Ok(levels)
    }
}

fn bytes<T: TexturePixel>(raster: &Raster<T>, code: fn(T) -> [u8; 4]) -> Vec<u8> {
    let width = raster.width() as usize;
    let mut bytes = vec![0; 4 * raster.pixels().len()];
    parallel::for_each_chunk(&mut bytes, 4 * width, |row, bytes| {
        let pixels = &raster.pixels()[row * width..][..width];
        for (bytes, &pixel) in bytes.chunks_exact_mut(4).zip(pixels) {
            bytes.copy_from_slice(&code(pixel));
        }
    });
    bytes
}

/// Returns the next mip level.
fn halved<T: TexturePixel>(raster: &Raster<T>) -> Result<Raster<T>, RasterError> {
    let [columns, rows] = raster.size().map(taps);
    let size = raster.size().map(|side| (side / 2).max(1));
    Raster::from_rows(size, |row| {
        let rows = &rows[row as usize];
        columns.iter().map(move |columns| {
            // A pixel of the next level covers at most three pixels along each axis.
            let mut parts = Vec::with_capacity(9);
            for &(row, height) in rows {
                for &(column, width) in columns {
                    parts.push((raster.row(row)[column as usize], (width * height) as f32));
                }
            }
            T::mean(&parts)
        })
    })
}

/// Returns, for each pixel of the halved side, the pixels that it covers, each with the fraction of the new pixel's
/// length that it fills.
fn taps(side: u32) -> Vec<Vec<(u32, f64)>> {
    let half = (side / 2).max(1);
    let (side, length) = (f64::from(side), f64::from(side) / f64::from(half));
    (0..half)
        .map(|index| {
            let start = f64::from(index) * side / f64::from(half);
            let end = f64::from(index + 1) * side / f64::from(half);
            let covered = |pixel: u32| {
                let pixel = f64::from(pixel);
                (end.min(pixel + 1.0) - start.max(pixel)) / length
            };
            let pixels = start as u32..end.ceil() as u32;
            pixels.map(|pixel| (pixel, covered(pixel))).collect()
        })
        .collect()
}

/// Converts numbers from 0 to 1 to 8-bit codes.
fn codes<const N: usize>(numbers: [f32; N]) -> [u8; N] {
    numbers.map(u8::from_unit)
}

/// Returns the weighted sum of numbers.
fn weighted<const N: usize>(parts: impl Iterator<Item = ([f32; N], f32)>) -> [f32; N] {
    let mut sum = [0.0; N];
    for (part, weight) in parts {
        for (sum, part) in sum.iter_mut().zip(part) {
            *sum += weight * part;
        }
    }
    sum
}

impl TexturePixel for f32 {
    fn to_rgba8(self) -> [u8; 4] {
        let code = u8::from_unit(self);
        [code, code, code, u8::MAX]
    }

    fn mean(parts: &[(Self, f32)]) -> Self {
        let [mean] = weighted(parts.iter().map(|&(value, weight)| ([value], weight)));
        mean
    }
}

impl TexturePixel for [f32; 3] {
    fn to_rgba8(self) -> [u8; 4] {
        let [r, g, b] = codes(self);
        [r, g, b, u8::MAX]
    }

    fn mean(parts: &[(Self, f32)]) -> Self {
        weighted(parts.iter().copied())
    }
}

impl TexturePixel for [f32; 4] {
    fn to_rgba8(self) -> [u8; 4] {
        codes(self)
    }

    fn mean(parts: &[(Self, f32)]) -> Self {
        weighted(parts.iter().copied())
    }
}

impl TexturePixel for LinearRgb {
    fn to_rgba8(self) -> [u8; 4] {
        self.to_array().to_rgba8()
    }

    fn mean(parts: &[(Self, f32)]) -> Self {
        let parts = parts.iter();
        weighted(parts.map(|(color, weight)| (color.to_array(), *weight))).into()
    }
}

impl ColorPixel for LinearRgb {
    fn to_rgba8_srgb(self) -> [u8; 4] {
        let [r, g, b] = self.to_srgb();
        [r, g, b, u8::MAX]
    }
}

impl TexturePixel for LinearRgba {
    fn to_rgba8(self) -> [u8; 4] {
        let [r, g, b] = self.color.to_array();
        codes([r, g, b, self.alpha])
    }

    fn mean(parts: &[(Self, f32)]) -> Self {
        let alphas = parts.iter();
        let [alpha] = weighted(alphas.map(|(pixel, weight)| ([pixel.alpha], *weight)));
        // Transparent pixels do not contribute to the color, unless all are transparent.
        let weight = |pixel: &Self, weight: f32| match alpha > 0.0 {
            true => weight * pixel.alpha / alpha,
            false => weight,
        };
        let parts: Vec<_> = (parts.iter())
            .map(|(pixel, part)| (pixel.color, weight(pixel, *part)))
            .collect();
        Self {
            color: LinearRgb::mean(&parts),
            alpha,
        }
    }
}

impl ColorPixel for LinearRgba {
    fn to_rgba8_srgb(self) -> [u8; 4] {
        self.to_srgb()
    }
}

impl TexturePixel for Normal {
    fn to_rgba8(self) -> [u8; 4] {
        let [x, y, z] = self.to_codes();
        [x, y, z, u8::MAX]
    }

    fn mean(parts: &[(Self, f32)]) -> Self {
        let parts = parts.iter();
        Self::unit(weighted(
            parts.map(|(normal, weight)| (normal.to_array(), *weight)),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::{TexturePixel, TextureRaster as _};
    use crate::{LinearRgb, LinearRgba, Normal};
    use dapple_raster::Raster;

    #[test]
    fn levels_halve_down_to_one_pixel_and_keep_the_mean() {
        for size in [[8, 8], [7, 5], [1, 9], [6, 1], [13, 2]] {
            let image =
                Raster::from_fn(size, |x, y| ((x * 7 + y * 13) % 11) as f32 / 11.0).unwrap();
            let levels = image.mip_levels().unwrap();
            let mean = image.pixels().iter().sum::<f32>() / image.pixels().len() as f32;
            for pair in levels.windows(2) {
                let expected = pair[0].size().map(|side| (side / 2).max(1));
                assert_eq!(pair[1].size(), expected);
                // The areas of a level cover the previous level uniformly. Nine `f32` products are rounded.
                let level = pair[1].pixels();
                let sum = level.iter().sum::<f32>() / level.len() as f32;
                assert!((sum - mean).abs() < 1e-5, "{size:?}: {sum} and {mean}");
            }
            assert_eq!(levels.last().unwrap().size(), [1, 1]);
        }
    }

    #[test]
    fn an_odd_side_is_shared_by_area() {
        let image = Raster::from_fn([5, 1], |x, _| [1.0, 2.0, 4.0, 8.0, 16.0][x as usize]).unwrap();
        let levels = image.mip_levels().unwrap();
        // Two pixels of 2.5 each: 1 + 2 + 4 / 2, and 4 / 2 + 8 + 16. Weights are rounded to `f32`.
        for (value, expected) in levels[1].pixels().iter().zip([2.0_f32, 10.4]) {
            assert!((value - expected).abs() < 1e-5, "{value} and {expected}");
        }
    }

    #[test]
    fn a_level_of_an_image_that_repeats_repeats() {
        let tile = |x: u32, y: u32| ((x % 8) * 3 + (y % 8)) as f32;
        let one = Raster::from_fn([8, 8], tile).unwrap().mip_levels().unwrap();
        let four = Raster::from_fn([16, 16], tile)
            .unwrap()
            .mip_levels()
            .unwrap();
        for (one, four) in one.iter().zip(&four) {
            let [width, height] = four.size();
            for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                let [columns, rows] = one.size();
                assert_eq!(
                    four.row(y)[x as usize],
                    one.row(y % rows)[(x % columns) as usize]
                );
            }
        }
    }

    #[test]
    fn clear_pixels_do_not_darken_a_rim() {
        let leaf = LinearRgba::opaque(LinearRgb::new(0.25, 0.5, 0.125));
        let clear = LinearRgba::default();
        let mean = LinearRgba::mean(&[(leaf, 0.25), (clear, 0.75)]);
        assert_eq!(
            mean,
            LinearRgba {
                alpha: 0.25,
                ..leaf
            }
        );
        let none = LinearRgba::mean(&[(LinearRgba { alpha: 0.0, ..leaf }, 1.0)]);
        assert_eq!(none, LinearRgba { alpha: 0.0, ..leaf });
    }

    #[test]
    fn normals_stay_unit_vectors() {
        let [left, right] = [-0.6_f32, 0.6].map(|x| Normal { x, y: 0.0, z: 0.8 });
        assert_eq!(Normal::mean(&[(left, 0.5), (right, 0.5)]), Normal::FLAT);
        let opposite = Normal {
            x: -0.6,
            y: 0.0,
            z: -0.8,
        };
        assert_eq!(Normal::mean(&[(right, 0.5), (opposite, 0.5)]), Normal::FLAT);
    }

    #[test]
    fn bytes_are_codes_in_the_order_of_the_pixels() {
        let packed = Raster::from_fn([2, 1], |x, _| [x as f32, 0.5, 2.0]).unwrap();
        assert_eq!(packed.to_rgba8(), [0, 128, 255, 255, 255, 128, 255, 255]);
        let gray = Raster::from_fn([1, 2], |_, y| y as f32).unwrap();
        assert_eq!(gray.to_rgba8(), [0, 0, 0, 255, 255, 255, 255, 255]);
        let flat = Raster::filled([1, 1], Normal::FLAT).unwrap();
        assert_eq!(flat.to_rgba8(), [128, 128, 255, 255]);
        let half = LinearRgba {
            color: LinearRgb::gray(0.5),
            alpha: 0.5,
        };
        let half = Raster::filled([1, 1], half).unwrap();
        assert_eq!(half.to_rgba8_srgb(), [188, 188, 188, 128]);
        assert_eq!(half.to_rgba8(), [128, 128, 128, 128]);
    }
}
