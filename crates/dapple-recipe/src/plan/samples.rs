//! Sample positions of the tile: pixel centers, or the corners of a grid that reaches the sides of the tile.

use super::Plan;
use crate::RecipeError;
use dapple_raster::{Window, named};
use glam::DVec2;

named! {
    /// Positions of the samples of an image.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Samples {
        /// Centers of pixels, for textures.
        #[default]
        Centers = "centers",
        /// Corners of a grid, for heights of terrains. The first and the last sample of an axis are on the sides of the
        /// tile, and are equal along axes that repeat.
        Corners = "corners",
    }
}

/// The sample positions of the tile; samples that duplicate another one are left out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileSamples {
    /// The samples as a window. For corners along an axis that repeats, it lacks the last sample, which equals the
    /// first.
    pub(crate) window: Window,
    /// The width and height of all pixels of the window, in units of the plane.
    pub(crate) extent: DVec2,
}

impl Plan {
    /// Returns the samples of a map of `size` columns and rows; samples that duplicate another one are left out. The
    /// map may have more pixels than a raster can hold.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RecipeErrorKind::Range) if a side has no pixel, or only a single corner.
    pub(crate) fn tile_samples(
        &self,
        size: [u32; 2],
        samples: Samples,
    ) -> Result<TileSamples, RecipeError> {
        if samples == Samples::Centers {
            return Ok(TileSamples {
                window: self.window(size)?,
                extent: self.extent(),
            });
        }
        for side in size {
            RecipeError::check(
                side > 1,
                "number of corners along a side",
                side.into(),
                "at least 2",
            )?;
        }
        let spaces = size.map(|side| side - 1);
        let pixel = self.extent() / DVec2::new(spaces[0].into(), spaces[1].into());
        let distinct = [0, 1].map(|axis| match self.wrap[axis] {
            true => spaces[axis],
            false => size[axis],
        });
        Ok(TileSamples {
            window: Window {
                // Shift by half a pixel, so that pixel centers become corners. The first corner is exact.
                origin: (-0.5 * pixel).into(),
                pixel: pixel.into(),
                first: [0, 0],
                size: distinct,
                scale: [1.0; 2],
            },
            extent: pixel * DVec2::new(distinct[0].into(), distinct[1].into()),
        })
    }
}
