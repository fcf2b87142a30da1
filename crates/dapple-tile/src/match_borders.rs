//! Makes different tiles fit next to each other, by giving them the same borders.
//!
//! Jin-Lian Du, Song Wang and Xianhai Meng, "Wavelet and Blend maps for texture synthesis", name an optional step of
//! their method: to "adjust the tile borders to accommodate tile meshing (if using different tiles)". They leave the
//! method open. Here all tiles get the same borders: each is put into the frame of the first tile, along a cut where
//! the two are most similar (see `cut.rs`). So every tile fits next to, above and below every other tile and itself,
//! and the pixels on both sides of a border are a piece of one texture.
//!
//! There are two sources of the borders. If the first tile repeats by itself, they are its own borders. Otherwise they
//! are its middle, which is continuous where its borders are not. The first tile is then put into the frame of itself
//! rolled by half, along one axis after the other, before the other tiles are.
//!
//! Detail is not smoothed, shifted in level, or stretched, as it would be by a correction added to the rows. The
//! quarter of the width next to the border is from the first tile, the cut is in the rest of the width, and beyond the
//! width nothing changes. All maps of a material are cut along the same path.
//!
//! Reference: Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", section 5; the
//! method is our own.

use crate::axis::Axis;
use crate::disturb::rolled;
use crate::error::check;
use crate::frame::{Frame, framed_along, in_axis};
use crate::piece::{lay, pieces};
use crate::{IsCancelled, Map, TileError, TileErrorKind};
use dapple_hash::{CellHash, Seed};
use dapple_raster::Raster;

dapple_raster::named! {
    /// Part of the first tile that becomes the border of all tiles.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum BorderSource {
        /// Border of the first tile, which must repeat by itself and is not changed.
        #[default]
        Border = "border",
        /// Row and column through the middle of the first tile, whether the tile repeats or not. The first tile changes
        /// as all others do. The width must be less than half of a side, so that the seam of the first tile is not
        /// visible.
        Middle = "middle",
    }
}

/// Gives different tiles the same borders.
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MatchBorders {
    /// Distance from a border within which a tile changes, in pixels, from 1 to half of a side.
    ///
    /// The maximum is rounded down. With [`BorderSource::Middle`], it is one pixel less. The default is 16.
    pub width: u32,
    /// Source of the pixels of all borders.
    ///
    /// The default is the first tile's own border.
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
    /// Computes tiles with equal borders, which fit next to each other in any order.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Count`] without tiles, [`TileErrorKind::Margin`] or [`TileErrorKind::Range`] if the width is
    /// too large or zero, [`TileErrorKind::Raster`] if the sizes of the tiles differ, [`TileErrorKind::NotFinite`] if a
    /// pixel is NaN or infinite.
    pub fn apply(&self, tiles: &[Raster<f32>]) -> Result<Vec<Raster<f32>>, TileError> {
        let materials: Vec<_> = tiles
            .iter()
            .map(|tile| vec![Map::Value(tile.clone())])
            .collect();
        let matched = self.matched(Map::planes_of_all(&materials)?, &|| false)?;
        Ok(matched.into_iter().flatten().collect())
    }

    /// Computes tiles of several materials with equal borders. All maps of a material are cut along the same path.
    ///
    /// # Errors
    ///
    /// Same as [`apply`](Self::apply). Also [`TileErrorKind::Count`] if the number of maps is 0 or differs from the
    /// first material, and [`TileErrorKind::KindMismatch`] if the kinds of maps differ.
    pub fn apply_maps(&self, tiles: &[Vec<Map>]) -> Result<Vec<Vec<Map>>, TileError> {
        self.apply_maps_cancellable(tiles, &|| false)
    }

    /// Computes the same tiles as [`apply_maps`](Self::apply_maps), unless `is_cancelled` returns true. The callback is
    /// called for each step of each tile.
    ///
    /// # Errors
    ///
    /// Same as [`apply_maps`](Self::apply_maps), and [`TileErrorKind::Cancelled`].
    pub fn apply_maps_cancellable(
        &self,
        tiles: &[Vec<Map>],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Vec<Map>>, TileError> {
        let matched = self.matched(Map::planes_of_all(tiles)?, is_cancelled)?;
        let pairs = tiles.iter().zip(matched);
        pairs
            .map(|(maps, planes)| Map::all_with_planes(maps, planes))
            .collect()
    }

    /// Renders maps of `size` pixels, starting at pixel `first` of a plane that is covered with the tiles in random
    /// order.
    ///
    /// A window equals the same crop of a larger map, and a map that covers whole tiles repeats. Tile `[0, 0]` starts
    /// at pixel `[0, 0]` of the plane. Beyond the largest `i64`, coordinates wrap around to the smallest, in the middle
    /// of a tile.
    ///
    /// # Errors
    ///
    /// Same as [`apply_maps`](Self::apply_maps). Also [`TileErrorKind::Raster`] if `size` is empty or too large.
    pub fn render(
        &self,
        tiles: &[Vec<Map>],
        seed: Seed,
        first: [i64; 2],
        size: [u32; 2],
    ) -> Result<Vec<Map>, TileError> {
        let matched = self.matched(Map::planes_of_all(tiles)?, &|| false)?;
        // Check the size before memory is allocated.
        Raster::<()>::filled(size, ())?;
        let seed = seed.child("match borders", 0);
        // Divide the columns and rows at the borders of the tiles.
        let side = matched[0][0].size();
        let [columns, rows] = [0, 1].map(|axis| pieces(first[axis], size[axis], side[axis]));
        // Choose a tile at random for each position.
        let tile = |[column, row]: [usize; 2]| {
            let bits = CellHash::new(seed, [rows[row].copy])
                .axis(columns[column].copy)
                .at(0);
            // Multiply a fixed-point number below 1 by the number of tiles.
            &matched[(((bits >> 32) * matched.len() as u64) >> 32) as usize]
        };
        let planes = 0..matched[0].len();
        let planes = planes.map(|plane| lay([&columns, &rows], |place| &tile(place)[plane]));
        Map::all_with_planes(&tiles[0], planes.collect::<Result<_, _>>()?)
    }

    fn matched(
        &self,
        tiles: Vec<Vec<Raster<f32>>>,
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Vec<Raster<f32>>>, TileError> {
        let first = tiles.first().ok_or(TileError::new(TileErrorKind::Count {
            what: "tiles",
            count: 0,
            needed: "at least 1",
        }))?;
        self.check_width(first[0].size())?;
        // Determine the tile whose borders all tiles get.
        let donor = match self.source {
            BorderSource::Border => first.clone(),
            BorderSource::Middle => self.with_middle_at_borders(first, is_cancelled)?,
        };
        // Put the other tiles into the frame of that tile.
        let framed = |tile: &Vec<Raster<f32>>| {
            framed_along(tile, self.frame(), is_cancelled, |_, axis| {
                in_axis(&donor, axis, is_cancelled)
            })
        };
        let others = tiles[1..].iter().map(framed);
        let others: Vec<_> = others.collect::<Result<_, _>>()?;
        Ok([donor].into_iter().chain(others).collect())
    }

    /// Checks that the width is at least 1, and that the changed borders overlap neither each other nor the seam of the
    /// rolled tile.
    fn check_width(&self, size: [u32; 2]) -> Result<(), TileError> {
        for length in size {
            let most = match self.source {
                BorderSource::Border => length / 2,
                // The rolled tile has its seam in the middle. The nearer pixel of the seam is this far from a border.
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

    /// Builds a tile whose borders come from the middle of the given tile, where it is continuous.
    fn with_middle_at_borders(
        &self,
        tile: &[Raster<f32>],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Raster<f32>>, TileError> {
        framed_along(tile, self.frame(), is_cancelled, |planes, _: Axis| {
            check(is_cancelled)?;
            // Roll the tile by half, which moves its middle to the borders.
            let half = planes[0].width() / 2;
            planes
                .iter()
                .map(|plane| rolled(plane, [half, 0]))
                .collect()
        })
    }

    /// Returns the frame. A quarter of the width, at least one pixel, belongs to the first tile.
    fn frame(&self) -> Frame {
        let whole = self.width.div_ceil(4);
        Frame {
            whole,
            band: self.width - whole,
        }
    }
}

#[cfg(test)]
mod tests;
