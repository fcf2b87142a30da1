//! Copies of a tile that have different interiors and equal borders.
//!
//! The repetition of a tile is visible. Jin-Lian Du, Song Wang and Xianhai Meng, "Wavelet and Blend maps for texture
//! synthesis", propose "using stochastic function to disturb the signal inner each tile but keep the boundary not
//! change", and leave the function open. Here the interior of each copy is a piece of the same tile, shifted by a
//! random number of whole pixels. The interior meets the tile's border along a cut where the two are most similar (see
//! `cut.rs`). So copies contain no content that the tile lacks. A shift is at least a quarter of the tile along each
//! axis, in either direction (a side of a single pixel cannot be shifted).
//!
//! In all copies, the `frozen` pixels next to the borders equal the tile's, bit for bit. The cut is in the `margin`
//! next to them. The shift of a copy is a hash of its column and row. So a window equals the same crop of a larger map,
//! and a map that covers whole copies repeats.
//!
//! Reference: Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", section 4 C; the
//! shifts and the cut are our own.

use crate::error::check;
use crate::frame::{Frame, framed};
use crate::map::check_planes;
use crate::piece::{Piece, lay, pieces};
use crate::{IsCancelled, Map, TileError, TileErrorKind};
use dapple_hash::{CellHash, Seed};
use dapple_raster::Raster;

/// Covers maps with copies of a tile that have different interiors and equal borders.
///
#[cfg_attr(doc, doc = include_str!("../docs/disturbance.md"))]
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_tile::{Disturbance, raster::Raster};
///
/// let tile = Raster::from_fn([64, 64], |x, y| ((x * 5 + y * 3) % 64) as f32)?;
/// let map = Disturbance::new(Seed(7)).render(&tile, [0, 0], [256, 128])?;
/// assert_eq!(map.row(64)[100], tile.row(0)[36], "the borders of the copies are the tile's");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Disturbance {
    /// Width of the unchanged strip along each border, in pixels.
    ///
    /// The default is 4.
    pub frozen: u32,
    /// Width, in pixels, of the strip next to the frozen one, where the tile and the shifted tile overlap and the cut
    /// may run.
    ///
    /// Together with the frozen pixels, it is at most half of a side. The default is 24.
    pub margin: u32,
    /// Seed of the shifts.
    ///
    /// The default is `Seed(0)`.
    pub seed: Seed,
}

impl Default for Disturbance {
    fn default() -> Self {
        Self::new(Seed(0))
    }
}

impl Disturbance {
    /// Creates options with the given seed, 4 frozen pixels and a margin of 24. They require tiles of at least 56
    /// pixels.
    #[must_use]
    pub fn new(seed: Seed) -> Self {
        Self {
            frozen: 4,
            margin: 24,
            seed,
        }
    }

    /// Renders a map of `size` pixels, starting at pixel `first` of a plane that is covered with disturbed copies of a
    /// periodic tile. With the feature `rayon`, copies are computed in parallel.
    ///
    /// Copy `[0, 0]` of the tile starts at pixel `[0, 0]` of the plane. Beyond the largest `i64`, coordinates wrap
    /// around to the smallest, in the middle of a copy.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Margin`] if the frozen pixels and the margin are more than half of a side,
    /// [`TileErrorKind::NotFinite`] if a pixel is NaN or infinite, [`TileErrorKind::Raster`] if `size` is empty or too
    /// large.
    pub fn render(
        &self,
        tile: &Raster<f32>,
        first: [i64; 2],
        size: [u32; 2],
    ) -> Result<Raster<f32>, TileError> {
        let mut maps = self.render_planes(core::slice::from_ref(tile), first, size, &|| false)?;
        Ok(maps.swap_remove(0))
    }

    /// Renders maps covered with disturbed copies of a material's tiles. All maps are shifted and cut in the same way.
    ///
    /// Normals are blended as slopes, so normals of the frozen border are unchanged only up to rounding.
    ///
    /// # Errors
    ///
    /// Same as [`render`](Self::render). Also [`TileErrorKind::Count`] if no maps are given, and
    /// [`TileErrorKind::Raster`] if their sizes differ.
    pub fn render_maps(
        &self,
        maps: &[Map],
        first: [i64; 2],
        size: [u32; 2],
    ) -> Result<Vec<Map>, TileError> {
        self.render_maps_cancellable(maps, first, size, &|| false)
    }

    /// Renders the same maps as [`render_maps`](Self::render_maps), unless `is_cancelled` returns true. The callback is
    /// called for each step of each copy and map.
    ///
    /// # Errors
    ///
    /// Same as [`render_maps`](Self::render_maps), and [`TileErrorKind::Cancelled`].
    pub fn render_maps_cancellable(
        &self,
        maps: &[Map],
        first: [i64; 2],
        size: [u32; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Map>, TileError> {
        let planes: Vec<_> = maps.iter().flat_map(Map::planes).collect();
        Map::all_with_planes(
            maps,
            self.render_planes(&planes, first, size, is_cancelled)?,
        )
    }

    fn render_planes(
        &self,
        tile: &[Raster<f32>],
        first: [i64; 2],
        size: [u32; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Raster<f32>>, TileError> {
        let sides = check_planes(tile)?;
        self.check_width(sides)?;
        // Check the size before memory is allocated.
        Raster::<()>::filled(size, ())?;
        let seed = self.seed.child("disturb", 0);
        // Divide the columns and rows at the borders of the copies.
        let [columns, rows] = [0, 1].map(|axis| pieces(first[axis], size[axis], sides[axis]));
        // Compute each copy that the window touches, and assemble the map.
        let copies = Raster::from_rows([columns.len() as u32, rows.len() as u32], |row| {
            let hash = CellHash::new(seed, [rows[row as usize].copy]);
            let copy = move |column: &Piece| {
                check(is_cancelled)?;
                self.copy(tile, hash.axis(column.copy), is_cancelled)
            };
            columns.iter().map(copy)
        })?;
        let copies = copies.into_pixels().into_iter();
        let copies = copies.collect::<Result<Vec<_>, _>>()?;
        let at = |[column, row]: [usize; 2]| &copies[row * columns.len() + column];
        let planes = 0..tile.len();
        let lay = |plane| {
            check(is_cancelled)?;
            lay([&columns, &rows], |place: [usize; 2]| &at(place)[plane])
        };
        planes.map(lay).collect()
    }

    /// Computes the planes of the copy whose shift comes from `hash`.
    fn copy(
        &self,
        tile: &[Raster<f32>],
        hash: CellHash,
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Raster<f32>>, TileError> {
        // Roll the tile by a random shift along each axis.
        let [x, y] = [0, 1].map(|axis| shift(hash.at(axis), tile[0].size()[axis as usize]));
        let shifted = tile.iter().map(|plane| rolled(plane, [x, y]));
        let width = Frame {
            whole: self.frozen,
            band: self.margin,
        };
        // Surround it with the borders of the tile itself.
        let shifted = shifted.collect::<Result<Vec<_>, _>>()?;
        framed(&shifted, tile, width, is_cancelled)
    }

    /// Checks that the frozen pixels and the margin fit into half of a side.
    fn check_width(&self, size: [u32; 2]) -> Result<(), TileError> {
        for length in size {
            let (margin, most) = (self.frozen.saturating_add(self.margin), length / 2);
            if margin > most {
                return Err(TileError::new(TileErrorKind::Margin {
                    margin,
                    length,
                    most,
                }));
            }
        }
        Ok(())
    }
}

/// Rolls a periodic tile so that it starts at another pixel.
pub(crate) fn rolled(plane: &Raster<f32>, [x, y]: [u32; 2]) -> Result<Raster<f32>, TileError> {
    Ok(Raster::from_rows(plane.size(), |row| {
        let row = (u64::from(row) + u64::from(y)) % u64::from(plane.height());
        let row = plane.row(row as u32);
        row[x as usize..].iter().chain(&row[..x as usize]).copied()
    })?)
}

/// Returns a random number of pixels from a quarter to three quarters of a side, both inclusive; 0 for a side of one
/// pixel.
fn shift(bits: u64, side: u32) -> u32 {
    let least = side.div_ceil(4);
    // The largest shift is the side minus a quarter. A side of one pixel cannot be shifted.
    let choices = u64::from((side - least + 1).saturating_sub(least));
    // Multiply a fixed-point number below 1 by the number of choices.
    let chosen = (((bits >> 32) * choices) >> 32) as u32;
    if choices > 0 { least + chosen } else { 0 }
}

#[cfg(test)]
mod tests;
