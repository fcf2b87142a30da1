//! Supersampling: evaluates several samples per pixel along each axis, and averages them.
//!
//! The pixel is divided into a grid of equal cells, and the samples are the cell centers; their mean is a box filter.
//! Sample positions are computed from integer pixel coordinates, so a window has the same bits as a crop.

use crate::plan::TileSamples;
use crate::{RecipeError, Values};
use dapple_color::LinearRgb;
use dapple_raster::{Range, Window, parallel, range};

/// The allowed number of samples per pixel along each axis.
const SUPERSAMPLE: Range = range!(from 1 to 16);

/// Number of samples per pixel along each axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Supersample(u32);

impl Supersample {
    /// Creates a supersampling with `per_axis` samples along each axis, for maps of `size` columns and rows. Fails if
    /// `per_axis` is out of range, or a side would have too many samples.
    pub(super) fn new(per_axis: u32, size: [u32; 2]) -> Result<Self, RecipeError> {
        RecipeError::check_in(
            SUPERSAMPLE,
            "number of samples along a pixel",
            per_axis.into(),
        )?;
        for side in size {
            let samples = u64::from(side) * u64::from(per_axis);
            RecipeError::check(
                samples <= u32::MAX.into(),
                "number of samples along a side",
                samples as f64,
                "below 2^32",
            )?;
        }
        Ok(Self(per_axis))
    }

    /// Returns the number of samples per pixel along each axis.
    pub(super) fn per_axis(self) -> u32 {
        self.0
    }

    /// Converts a size in pixels to a size in samples.
    pub(super) fn samples(self, pixels: [u32; 2]) -> [u32; 2] {
        pixels.map(|pixels| pixels.saturating_mul(self.0))
    }

    /// Returns the window of samples that covers a window of pixels.
    pub(super) fn window(self, window: &Window) -> Window {
        if self.0 == 1 {
            return *window;
        }
        Window {
            pixel: window.pixel.map(|side| side / f64::from(self.0)),
            first: window
                .first
                .map(|first| first.saturating_mul(self.0.into())),
            size: self.samples(window.size),
            ..*window
        }
    }

    /// Returns the samples of a tile, given its pixels.
    pub(super) fn tile(self, tile: &TileSamples) -> TileSamples {
        TileSamples {
            window: self.window(&tile.window),
            ..*tile
        }
    }

    /// Returns the mean of the samples of each pixel. `width` is the number of pixels in a row.
    pub(super) fn average(self, values: Values, width: u32) -> Values {
        if self.0 == 1 {
            return values;
        }
        match values {
            Values::Numbers(numbers) => {
                let numbers = self.means(&numbers, width, |&number| [number]);
                Values::Numbers(numbers.into_iter().map(|[number]| number).collect())
            }
            Values::Colors(colors) => {
                let colors = self.means(&colors, width, |color| color.to_array());
                Values::Colors(colors.into_iter().map(LinearRgb::from).collect())
            }
        }
    }

    /// Returns the mean of each channel over the samples of a pixel, row by row. Sums are in double precision, so that
    /// the mean of equal numbers is this number.
    fn means<T: Sync, const N: usize>(
        self,
        samples: &[T],
        width: u32,
        channels: impl Fn(&T) -> [f32; N] + Sync,
    ) -> Vec<[f32; N]> {
        let (width, per_axis) = (width as usize, self.0 as usize);
        let n_samples = per_axis * per_axis;
        let mut means = vec![[0.0; N]; samples.len() / n_samples];
        parallel::for_each_chunk(&mut means, width.max(1), |row, means| {
            let rows = &samples[row * width * n_samples..][..means.len() * n_samples];
            let mut sums = vec![[0.0; N]; means.len()];
            for row in rows.chunks_exact(width * per_axis) {
                for (sums, samples) in sums.iter_mut().zip(row.chunks_exact(per_axis)) {
                    for sample in samples {
                        let channels = channels(sample);
                        sums.iter_mut()
                            .zip(channels)
                            .for_each(|(sum, part)| *sum += f64::from(part));
                    }
                }
            }
            for (mean, sums) in means.iter_mut().zip(sums) {
                *mean = sums.map(|sum| (sum / n_samples as f64) as f32);
            }
        });
        means
    }
}
