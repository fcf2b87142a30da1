//! Makes a tile from an image by one of several methods. This is the entry point to all of them.

mod feather;
mod mirror;
mod periodic;
mod poisson;
mod soft_cut;
mod spline_project;

use crate::error::check;
use crate::map::{check_planes, color_from_planes, color_planes};
use crate::{IsCancelled, Map, TileError, TileErrorKind};
use dapple_color::LinearRgb;
use dapple_raster::Raster;
pub use feather::Feather;
pub use poisson::WrapGradient;
pub use soft_cut::SoftCut;
pub use spline_project::{Basis, Pixels, SplineProject};

/// Method that makes an image repeat.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum Method {
    /// The periodic part of the image (Moisan 2011).
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/method-periodic.md"))]
    #[default]
    Periodic,
    /// The periodic image whose gradients are nearest to the source image's gradients.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/method-poisson.md"))]
    Poisson(WrapGradient),
    /// A cut along the path of least difference, in a margin that overlaps the opposite side.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/method-soft-cut.md"))]
    SoftCut(SoftCut),
    /// The paper's blend tile, which is the image halved and doubled with periodic filters.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/method-spline-project.md"))]
    SplineProject(SplineProject),
    /// [`Periodic`](Self::Periodic) followed by [`SplineProject`](Self::SplineProject).
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/method-periodic-then-project.md"))]
    PeriodicThenProject(SplineProject),
    /// A crossfade, a common baseline.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/method-feather.md"))]
    Feather(Feather),
    /// The image next to its mirror image, twice as large along each axis. This is another common baseline.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/method-mirror.md"))]
    Mirror,
}

/// Makes images repeat along one or both axes.
///
/// # Examples
///
/// ```
/// use dapple_raster::Raster;
/// use dapple_tile::Seamless;
///
/// let slope = Raster::from_fn([64, 64], |column, row| (column + row) as f32)?;
/// let tile = Seamless::default().apply(&slope)?;
/// let step = tile.row(0)[63] - tile.row(0)[0];
/// assert!(step < 1.0, "of a jump of 63, less than the old slope is left");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Seamless {
    /// Method that makes the image repeat.
    ///
    /// The default is [`Method::Periodic`].
    pub method: Method,
    /// Axes along which the tile repeats, x first.
    ///
    /// The default is both.
    pub axes: [bool; 2],
}

impl Default for Seamless {
    fn default() -> Self {
        Self::new(Method::default())
    }
}

impl Seamless {
    /// Creates a converter that makes images repeat along both axes.
    #[must_use]
    pub fn new(method: Method) -> Self {
        Self {
            method,
            axes: [true; 2],
        }
    }

    /// Sets the axes along which the tile repeats, x first.
    #[must_use]
    pub fn with_axes(self, axes: [bool; 2]) -> Self {
        Self { axes, ..self }
    }

    /// Makes a tile from a scalar raster.
    ///
    /// # Errors
    ///
    /// Same as [`apply_maps`](Self::apply_maps).
    pub fn apply(&self, image: &Raster<f32>) -> Result<Raster<f32>, TileError> {
        let mut planes = self.planes(core::slice::from_ref(image), &[[1.0; 2]], &|| false)?;
        Ok(planes.swap_remove(0))
    }

    /// Makes a tile from a color raster.
    ///
    /// # Errors
    ///
    /// Same as [`apply_maps`](Self::apply_maps).
    pub fn apply_color(&self, image: &Raster<LinearRgb>) -> Result<Raster<LinearRgb>, TileError> {
        color_from_planes(self.planes(&color_planes(image), &[[1.0; 2]; 3], &|| false)?)
    }

    /// Makes tiles from all maps of a material. All maps are cut along the same paths.
    ///
    /// Normals are processed as slopes. Where an image is reflected, its normals match the reflected heights.
    ///
    /// # Errors
    ///
    /// * [`Count`](TileErrorKind::Count) without maps
    /// * [`Raster`](TileErrorKind::Raster) if the sizes of the maps differ
    /// * [`NotFinite`](TileErrorKind::NotFinite) if a pixel is NaN or infinite
    /// * [`TooSmall`](TileErrorKind::TooSmall) if a side along an axis that repeats is a single pixel
    /// * [`Wavelet`](TileErrorKind::Wavelet), [`Margin`](TileErrorKind::Margin) or [`Range`](TileErrorKind::Range) if
    ///   the method does not support the size or the options
    pub fn apply_maps(&self, maps: &[Map]) -> Result<Vec<Map>, TileError> {
        self.apply_maps_cancellable(maps, &|| false)
    }

    /// Makes the same tiles as [`apply_maps`](Self::apply_maps), unless `is_cancelled` returns true. The callback is
    /// called before each plane of a map and during long passes over a plane, from any thread.
    ///
    /// # Errors
    ///
    /// Same as [`apply_maps`](Self::apply_maps), and [`Cancelled`](TileErrorKind::Cancelled).
    pub fn apply_maps_cancellable(
        &self,
        maps: &[Map],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Map>, TileError> {
        let planes: Vec<_> = match self.method {
            // Center normals first. Otherwise, the code of a flat normal, which is slightly sloped, would change when
            // reflected.
            Method::Mirror => maps
                .iter()
                .flat_map(|map| map.centered().planes())
                .collect(),
            _ => maps.iter().flat_map(Map::planes).collect(),
        };
        let reflections: Vec<_> = maps.iter().flat_map(Map::reflections).copied().collect();
        Map::all_with_planes(maps, self.planes(&planes, &reflections, is_cancelled)?)
    }

    /// Makes tiles from planes. `reflections` are the factors of each plane for reflection along x and along y.
    fn planes(
        &self,
        planes: &[Raster<f32>],
        reflections: &[[f32; 2]],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Raster<f32>>, TileError> {
        check(is_cancelled)?;
        let size = check_planes(planes)?;
        for (length, repeats) in size.into_iter().zip(self.axes) {
            if repeats && length < 2 {
                return Err(TileError::new(TileErrorKind::TooSmall { length, least: 2 }));
            }
        }
        match &self.method {
            Method::Periodic => periodic::tile(planes, self.axes, is_cancelled),
            Method::Poisson(wrap) => poisson::tile(planes, *wrap, self.axes, is_cancelled),
            Method::SoftCut(cut) => soft_cut::tile(planes, cut, self.axes, is_cancelled),
            Method::SplineProject(project) => {
                spline_project::tile(planes, project, self.axes, is_cancelled)
            }
            Method::PeriodicThenProject(project) => {
                let planes = periodic::tile(planes, self.axes, is_cancelled)?;
                spline_project::tile(&planes, project, self.axes, is_cancelled)
            }
            Method::Feather(feather) => feather::tile(planes, feather, self.axes, is_cancelled),
            Method::Mirror => mirror::tile(planes, reflections, self.axes, is_cancelled),
        }
    }
}

#[cfg(test)]
mod tests;
