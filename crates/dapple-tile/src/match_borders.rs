//! Unlike tiles that fit beside each other.
//!
//! Jin-Lian Du, Song Wang and Xianhai Meng, "Wavelet and Blend maps for texture synthesis", name an optional step of their
//! method: to "adjust the tile borders to accommodate tile meshing (if using different tiles)". How is left open. Here all
//! tiles get the same borders: near them, each tile changes over to the first one, by weights that keep the variance (see
//! [`Crossfade`](crate::Crossfade)). So every tile fits beside, above and below every other, itself included, and what
//! meets at a border is a piece of one texture.
//!
//! What is seen there is either the border of the first tile, if that repeats by itself, or else its middle, which is
//! continuous where its borders are not: then the first tile is mixed with itself, rolled by half, along one axis after
//! the other, before the others are mixed with it.
//!
//! What it does to detail: nothing is smoothed, shifted in level, or stretched, as it would be if a correction were added
//! to the rows. Within the quarter of the width next to the border, the tile's own detail is lost for that of the first
//! tile; then both are seen, over each other; past the width nothing changes. A material's maps are done one channel at
//! a time, with the same options: where a tile changes depends on the place alone.
//!
//! Reference: Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", section 5; the
//! method is our own.

use crate::axis::each_axis;
use crate::crossfade::{Pair, smooth_ramp};
use crate::map::check_planes;
use crate::{Crossfade, TileError, TileErrorKind};
use dapple_raster::Raster;

/// Which part of the first tile becomes the border of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
pub enum BorderSource {
    /// Its border. The first tile has to repeat by itself, and stays as it is.
    #[default]
    Border,
    /// The row and the column through its middle, whether it repeats or not. The first tile changes as all others do. The
    /// width is less than half of a side, so that nothing is seen of where the borders of the first tile meet.
    Middle,
}

/// Gives unlike tiles the same borders.
///
#[cfg_attr(doc, doc = include_str!("../docs/match-borders.md"))]
///
/// # Examples
///
/// ```
/// use dapple_tile::{MatchBorders, raster::Raster};
///
/// let tile = |step: u32| Raster::from_fn([64, 64], |x, y| ((x * step + y) % 64) as f32);
/// let tiles = MatchBorders::default().apply(&[tile(1)?, tile(5)?])?;
/// assert_eq!(tiles[1].row(0), tiles[0].row(0), "one border");
/// assert_eq!(tiles[1].row(30)[30], tile(5)?.row(30)[30], "another middle");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct MatchBorders {
    /// How far from a border a tile changes, in pixels, from 1 to half of a side, rounded down, and to one pixel less
    /// for [`BorderSource::Middle`]. By default 16.
    pub width: u32,
    /// What the borders become. By default the border of the first tile.
    pub source: BorderSource,
}

impl Default for MatchBorders {
    fn default() -> Self {
        Self {
            width: 16,
            source: BorderSource::Border,
        }
    }
}

impl MatchBorders {
    /// Tiles that fit beside each other in any order, as many as there are.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Count`] if there is no tile, [`TileErrorKind::Margin`] or [`TileErrorKind::Range`] for a width that
    /// is too large or nothing, [`TileErrorKind::Raster`] if the tiles differ in size,
    /// [`TileErrorKind::NotFinite`] for a pixel that is NaN or infinite.
    pub fn apply(&self, tiles: &[Raster<f32>]) -> Result<Vec<Raster<f32>>, TileError> {
        if tiles.is_empty() {
            return Err(TileError::new(TileErrorKind::Count {
                what: "tiles",
                count: 0,
                needed: "at least 1",
            }));
        }
        let size = check_planes(tiles)?;
        self.check_width(size)?;
        let donor = match self.source {
            BorderSource::Border => tiles[0].clone(),
            BorderSource::Middle => self.with_middle_at_borders(&tiles[0])?,
        };
        let [along_x, along_y] = size.map(|side| self.weights(side));
        let weights = Raster::from_fn(size, |x, y| {
            1.0 - (1.0 - along_x[x as usize]) * (1.0 - along_y[y as usize])
        })?;
        let others: Result<Vec<_>, _> = tiles[1..]
            .iter()
            .map(|tile| mix(tile, &donor, &weights))
            .collect();
        let mut matched = others?;
        matched.insert(0, donor);
        Ok(matched)
    }

    /// Refuses a width of nothing, and one at which the two borders, or the seam of the rolled tile, come too near.
    fn check_width(&self, size: [u32; 2]) -> Result<(), TileError> {
        for length in size {
            let most = match self.source {
                BorderSource::Border => length / 2,
                // The rolled tile has its seam in the middle, whose nearer pixel is this far from a border.
                BorderSource::Middle => (length / 2).saturating_sub(1),
            };
            if self.width > most {
                return Err(TileError::new(TileErrorKind::Margin {
                    margin: self.width,
                    length,
                    most,
                }));
            }
        }
        TileError::check(self.width >= 1, "width", self.width.into(), "at least 1")
    }

    /// The tile with what it has along its middle at its borders, where that is continuous.
    fn with_middle_at_borders(&self, tile: &Raster<f32>) -> Result<Raster<f32>, TileError> {
        let mut tiles = each_axis(core::slice::from_ref(tile), [true; 2], |tiles, _| {
            let along = self.weights(tiles[0].width());
            let weights = Raster::from_fn(tiles[0].size(), |column, _| along[column as usize])?;
            tiles
                .iter()
                .map(|tile| mix(tile, &rolled_by_half(tile)?, &weights))
                .collect()
        })?;
        Ok(tiles.swap_remove(0))
    }

    /// The weight of the common border for each pixel of a side: 1 over a quarter of the width, then less.
    fn weights(&self, side: u32) -> Vec<f64> {
        let whole = self.width / 4;
        let ramp = f64::from(self.width - whole);
        let weight = |pixel: u32| {
            let from_border = pixel.min(side - 1 - pixel);
            1.0 - smooth_ramp((f64::from(from_border) - f64::from(whole)) / ramp)
        };
        (0..side).map(weight).collect()
    }
}

/// A tile that changes over to the donor, each with its own mean put aside.
fn mix(
    tile: &Raster<f32>,
    donor: &Raster<f32>,
    weights: &Raster<f64>,
) -> Result<Raster<f32>, TileError> {
    let images = [tile, donor];
    let means = images.map(|image| image.statistics().mean);
    Crossfade::KeepVariance.mix(Pair { images, means }, weights)
}

/// Every row rolled by half of its length: its ends meet where its middle was.
fn rolled_by_half(tile: &Raster<f32>) -> Result<Raster<f32>, TileError> {
    let half = tile.width() as usize / 2;
    Ok(Raster::from_rows(tile.size(), |row| {
        let row = tile.row(row);
        row[half..].iter().chain(&row[..half]).copied()
    })?)
}

#[cfg(test)]
mod tests;
