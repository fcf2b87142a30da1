//! The image that a texture is to look like, and its Gaussian pyramid.

use crate::SynthError;
use dapple_color::LinearRgb;
use dapple_raster::Raster;

/// What lies past the edges of an exemplar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Edges {
    /// Nothing: neighborhoods that reach past an edge are not compared.
    #[default]
    Cut,
    /// The exemplar again: it tiles.
    Wrap,
}

/// An image whose neighborhoods are matched: pixels of one or several channels, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Exemplar {
    pub(crate) size: [u32; 2],
    pub(crate) n_channels: usize,
    pub(crate) edges: Edges,
    /// `n_channels` values for each pixel, row by row.
    pub(crate) pixels: Vec<f32>,
}

/// A Gaussian pyramid: the exemplar and its smaller versions, the finest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid {
    pub(crate) levels: Vec<Exemplar>,
}

impl Exemplar {
    /// A color image, matched in its sRGB codes from 0 to 1, as the paper's were.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::NotFinite`](crate::SynthErrorKind::NotFinite).
    pub fn new(image: &Raster<LinearRgb>, edges: Edges) -> Result<Self, SynthError> {
        let _ = (image, edges);
        todo!()
    }

    /// Any planes, each with the weight of its squared differences.
    ///
    /// # Errors
    ///
    /// Typed errors for no plane, different sizes, weights below zero and pixels that are not finite.
    pub fn from_planes(planes: &[(&Raster<f32>, f32)], edges: Edges) -> Result<Self, SynthError> {
        let _ = (planes, edges);
        todo!()
    }

    /// The pyramid with `n_levels` levels, this image the first.
    ///
    /// # Errors
    ///
    /// Typed errors for no level, and for a level without pixels.
    pub fn pyramid(&self, n_levels: usize) -> Result<Pyramid, SynthError> {
        let _ = n_levels;
        todo!()
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }
}

impl Pyramid {
    /// The levels, the finest first.
    #[must_use]
    pub fn levels(&self) -> &[Exemplar] {
        &self.levels
    }
}
