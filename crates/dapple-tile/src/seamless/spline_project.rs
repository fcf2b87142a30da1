//! Computes the paper's blend tile, an image halved and doubled by filters that wrap around.
//!
//! Source: Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", section 3. An image
//! `R` becomes a smaller `R_d` by equation 12, and `R_d` becomes the tile `R_n` by equation 13. Only `R_d` needs to be
//! stored. With one level it has a quarter of the pixels, and determines `R_n` exactly. The filters are those of Cook
//! and DeRose, "Wavelet Noise", ACM Transactions on Graphics 24(3) (SIGGRAPH 2005),
//! <https://doi.org/10.1145/1073204.1073264>.
//!
//! Choices that the paper leaves open: the filters are periodic along the axes on which the tile repeats, which makes
//! the tile periodic, and mirrored along the others. The phase and the number of levels are options. Pixels are
//! coefficients of the spline or, optionally, its values.
//!
//! Limitations: one level leaves 34 to 66 % of a step at the border, and removes most of the top octave. To remove the
//! seam first, use [`Method::PeriodicThenProject`](crate::Method::PeriodicThenProject).

use crate::error::filtered;
use crate::map::check_finite;
use crate::sines::{self, Axis};
use crate::{IsCancelled, TileError};
use dapple_raster::Raster;
use dapple_wavelet::{Border, Degree, Fit, Phase, SplineFilter};

/// Basis functions of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Basis {
    /// B-splines.
    Spline(Degree),
    /// Sines and cosines, the paper's alternative refinable functions. The projector is a periodic Fourier projector.
    /// The phase matters only along axes that repeat, where it has the same effect as for splines of even degree.
    Sines,
}

dapple_raster::named! {
    /// Relation of the pixels of the image to the spline.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Pixels {
        /// Pixels are the coefficients of the spline, as in the paper.
        #[default]
        Coefficients = "coefficients",
        /// Pixels are the values of the spline at the pixel centers. A prefilter computes the coefficients. With sines,
        /// pixels are always values.
        Samples = "samples",
    }
}

/// The blend tile of Du, Wang and Meng.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SplineProject {
    /// Number of times that the image is halved.
    ///
    /// The default is 1.
    pub levels: u32,
    /// Position of the coarse coefficients.
    ///
    /// The default is centered.
    pub phase: Phase,
    /// Basis functions of the tile.
    ///
    /// The default is quadratic B-splines.
    pub basis: Basis,
    /// Relation of the pixels to the spline.
    ///
    /// By default, pixels are coefficients.
    pub pixels: Pixels,
}

impl Default for SplineProject {
    fn default() -> Self {
        Self {
            levels: 1,
            phase: Phase::Centered,
            basis: Basis::Spline(Degree::Quadratic),
            pixels: Pixels::Coefficients,
        }
    }
}

impl SplineProject {
    /// Computes the small tile, the paper's `R_d`, from which [`refine`](Self::refine) computes the full tile.
    ///
    /// The small tile repeats along `axes`, x first. Along an axis that repeats, it has `1/2^levels` as many pixels.
    /// Along another axis, its length is defined by [`Border::Mirror`]. Its pixels relate to the coarse function as the
    /// pixels of the image relate to the fine one.
    ///
    /// # Errors
    ///
    /// * If a pixel is not finite
    /// * If a side that repeats is not a multiple of `2^levels`
    /// * If a side has one pixel before the last level (or, mirrored, at the last level: samples of a spline need two)
    /// * If there are more than 32 levels
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_raster::Raster;
    /// use dapple_tile::{Method, Seamless, SplineProject};
    ///
    /// let image = Raster::from_fn([64, 32], |column, row| (column * row) as f32)?;
    /// let project = SplineProject::default();
    /// let small = project.coarse(&image, [true; 2])?;
    /// assert_eq!(small.size(), [32, 16]);
    ///
    /// let tile = project.refine(&small, [64, 32], [true; 2])?;
    /// assert_eq!(tile, Seamless::new(Method::SplineProject(project)).apply(&image)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn coarse(&self, image: &Raster<f32>, axes: [bool; 2]) -> Result<Raster<f32>, TileError> {
        self.halved(image, axes, &|| false)
    }

    fn halved(
        &self,
        image: &Raster<f32>,
        axes: [bool; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, TileError> {
        check_finite(image)?;
        let sizes = self.sizes(image.size(), axes)?;
        match self.basis {
            _ if self.levels == 0 => Ok(image.clone()),
            Basis::Spline(degree) => {
                // Halve the coefficients level by level (equation 12).
                let (filter, borders) = (self.filter(degree), borders(axes));
                let mut coarse = self.coefficients(&filter, image, borders, is_cancelled)?;
                for _ in 0..self.levels {
                    coarse = filtered(filter.down_cancellable(&coarse, borders, is_cancelled))?;
                }
                self.pixels(&filter, coarse, borders, is_cancelled)
            }
            Basis::Sines => sines::coarse(image, self.sine_axes(&sizes, axes), is_cancelled),
        }
    }

    /// Computes the tile of `size` pixels, the paper's `R_n`, from a small tile.
    ///
    /// Given the result of [`coarse`](Self::coarse) and the size of the image, the result is, bit for bit, the tile
    /// that [`Seamless`](crate::Seamless) makes from the image.
    ///
    /// # Errors
    ///
    /// Same as [`coarse`](Self::coarse). Also if the small tile's size differs from `size` after halving.
    pub fn refine(
        &self,
        coarse: &Raster<f32>,
        size: [u32; 2],
        axes: [bool; 2],
    ) -> Result<Raster<f32>, TileError> {
        self.doubled(coarse, size, axes, &|| false)
    }

    fn doubled(
        &self,
        coarse: &Raster<f32>,
        size: [u32; 2],
        axes: [bool; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, TileError> {
        check_finite(coarse)?;
        let sizes = self.sizes(size, axes)?;
        // Check the sizes before memory is allocated.
        Raster::filled(size, ())?;
        Raster::filled(sizes[self.levels as usize], ())?.check_same_size(coarse.size())?;
        match self.basis {
            _ if self.levels == 0 => Ok(coarse.clone()),
            Basis::Spline(degree) => {
                // Double the coefficients level by level (equation 13).
                let (filter, borders) = (self.filter(degree), borders(axes));
                // From the coarsest level up: each step doubles the grid to the size that it was halved from.
                let mut fine = self.coefficients(&filter, coarse, borders, is_cancelled)?;
                for &size in sizes[..self.levels as usize].iter().rev() {
                    fine = filtered(filter.up_cancellable(&fine, size, borders, is_cancelled))?;
                }
                self.pixels(&filter, fine, borders, is_cancelled)
            }
            Basis::Sines => sines::refine(coarse, self.sine_axes(&sizes, axes), is_cancelled),
        }
    }

    /// Returns the sizes of an image after each halving, from its original size to the last.
    fn sizes(&self, size: [u32; 2], axes: [bool; 2]) -> Result<Vec<[u32; 2]>, TileError> {
        let filter = match self.basis {
            Basis::Spline(degree) => self.filter(degree),
            // Sines are sampled at the pixels of a centered spline of even degree.
            Basis::Sines => SplineFilter::default(),
        };
        Ok(filter.sizes(size, self.levels, borders(axes))?)
    }

    fn filter(&self, degree: Degree) -> SplineFilter {
        SplineFilter {
            degree,
            phase: self.phase,
            fit: Fit::Function,
        }
    }

    /// Computes the spline coefficients for the pixels of a raster.
    fn coefficients(
        &self,
        filter: &SplineFilter,
        raster: &Raster<f32>,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, TileError> {
        match self.pixels {
            Pixels::Coefficients => Ok(raster.clone()),
            Pixels::Samples => {
                filtered(filter.coefficients_cancellable(raster, borders, is_cancelled))
            }
        }
    }

    /// Computes the pixels for a spline with the given coefficients.
    fn pixels(
        &self,
        filter: &SplineFilter,
        coefficients: Raster<f32>,
        borders: [Border; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Raster<f32>, TileError> {
        match self.pixels {
            Pixels::Coefficients => Ok(coefficients),
            Pixels::Samples => {
                filtered(filter.samples_cancellable(&coefficients, borders, is_cancelled))
            }
        }
    }

    fn sine_axes(&self, sizes: &[[u32; 2]], axes: [bool; 2]) -> [Axis; 2] {
        let last = sizes[self.levels as usize];
        [0, 1].map(|axis| Axis {
            fine: sizes[0][axis],
            coarse: last[axis],
            repeats: axes[axis],
            phase: self.phase,
        })
    }
}

/// Makes tiles from all planes.
pub(crate) fn tile(
    planes: &[Raster<f32>],
    project: &SplineProject,
    axes: [bool; 2],
    is_cancelled: &IsCancelled,
) -> Result<Vec<Raster<f32>>, TileError> {
    let tile = |plane: &Raster<f32>| {
        let coarse = project.halved(plane, axes, is_cancelled)?;
        project.doubled(&coarse, plane.size(), axes, is_cancelled)
    };
    planes.iter().map(tile).collect()
}

/// Returns the borders of the filters: periodic along the axes on which the tile repeats, mirrored along the others.
fn borders(axes: [bool; 2]) -> [Border; 2] {
    axes.map(|repeats| match repeats {
        true => Border::Periodic,
        false => Border::Mirror,
    })
}

#[cfg(test)]
mod tests;
