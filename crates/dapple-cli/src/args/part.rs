//! Defines the options that select a region of photographs: a rectangle, or a quadrilateral that is rectified.

use super::{Numbers, Region};
use crate::error::Hint;
use crate::input::Loaded;
use anyhow::{Error, Result};
use dapple::raster::Raster;
use dapple::tile::{Map, TileError, rectify, resample_with_alpha};
use serde::Serialize;

/// The part of the images to use.
#[derive(clap::Args, Clone, Copy, Debug, Serialize)]
pub(crate) struct PartArgs {
    /// Use only this part of the images, in pixels.
    #[arg(long, value_name = "X,Y,W,H")]
    pub(crate) region: Option<Region>,

    /// Straighten a flat surface that is seen at an angle: its four corners in pixels, clockwise from the top left.
    ///
    /// The size of the result is the mean length of opposite sides. Normal maps are refused: rectify the heights.
    #[arg(long, value_name = "X0,Y0,...,X3,Y3", conflicts_with = "region")]
    pub(crate) rectify: Option<Numbers<f64, 8>>,
}

impl PartArgs {
    /// Rectifies an image and its alpha. [`region`](Self::region) is applied when an image is read.
    ///
    /// # Errors
    ///
    /// If the corners are not around a convex part of the image, or if it has normals.
    pub(crate) fn rectify(&self, loaded: &mut Loaded) -> Result<()> {
        let Some(Numbers([x0, y0, x1, y1, x2, y2, x3, y3])) = self.rectify else {
            return Ok(());
        };
        let corners = [[x0, y0], [x1, y1], [x2, y2], [x3, y3]];
        let (alpha, is_associated) = (loaded.alpha.as_ref(), loaded.is_associated);
        let straight = |map: &Map| rectify(map, corners, None);
        let rectified = resampled(&loaded.map, alpha, is_associated, straight);
        (loaded.map, loaded.alpha) = rectified.map_err(|error| {
            Error::new(error)
                .hint("give --rectify the corners of the surface as x,y: top left, top right, bottom right, bottom left")
                .wrong_value()
        })?;
        Ok(())
    }
}

/// Resamples a map and its alpha. Straight colors are weighted by their alpha.
///
/// # Errors
///
/// If `resample` fails.
pub(crate) fn resampled(
    map: &Map,
    alpha: Option<&Raster<f32>>,
    is_associated: bool,
    resample: impl Fn(&Map) -> Result<Map, TileError>,
) -> Result<(Map, Option<Raster<f32>>), TileError> {
    match (map, alpha) {
        (Map::Color(colors), Some(alpha)) if !is_associated => {
            let (colors, alpha) = resample_with_alpha(colors, alpha, resample)?;
            Ok((Map::Color(colors), Some(alpha)))
        }
        (map, None) => Ok((resample(map)?, None)),
        (map, Some(alpha)) => match resample(&Map::Value(alpha.clone()))? {
            Map::Value(alpha) => Ok((resample(map)?, Some(alpha))),
            Map::Color(_) | Map::Normal(_) => Ok((resample(map)?, None)),
        },
    }
}
