//! Copies of a tile that differ inside and agree on their borders.
//!
//! A tile that repeats shows its repetition. Jin-Lian Du, Song Wang and Xianhai Meng, "Wavelet and Blend maps for
//! texture synthesis", propose "using stochastic function to disturb the signal inner each tile but keep the boundary
//! not change", and leave the function open. Here each copy of the tile in the plane is mixed with the same tile,
//! shifted by a random number of whole pixels. So nothing comes in that the tile has not, and what is mixed keeps its
//! variance (see [`Crossfade`](crate::Crossfade)), the tile and its shifted self taken for independent: a shift is at
//! least a quarter of the tile along each axis, whichever way round (a side of a single pixel cannot be shifted).
//!
//! The weight of the shifted tile is the product of two profiles, one along each axis: 0 in the `frozen` pixels next to
//! both borders, then a quintic ramp over `ramp` pixels, 1 in the middle. So the frozen border, of all copies, is the
//! tile's, bit for bit; the weight is twice continuously differentiable in the plane, and so is the disturbed map where
//! the tile is. Which copy is shifted by how much is a hash of its column and row: a window is the crop of the whole.
//!
//! Reference: Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", section 4 C; the
//! mixture is our own.

use crate::crossfade::{mix_two, shares, smooth_ramp};
use crate::map::check_finite;
use crate::{Map, TileError, TileErrorKind};
use dapple_hash::{CellHash, Seed};
use dapple_raster::{Raster, Wrap};

/// A map of copies of a tile that differ inside.
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
    /// How many pixels along each border stay as they are. By default 4.
    pub frozen: u32,
    /// Over how many more pixels the disturbance sets in. Together with the frozen ones at most half of a side. By
    /// default 16.
    pub ramp: u32,
    /// Where the shifts come from. By default `Seed(0)`.
    pub seed: Seed,
}

impl Default for Disturbance {
    fn default() -> Self {
        Self::new(Seed(0))
    }
}

impl Disturbance {
    /// The disturbance of a seed, for tiles of at least 40 pixels: 4 frozen and a ramp of 16.
    #[must_use]
    pub fn new(seed: Seed) -> Self {
        Self {
            frozen: 4,
            ramp: 16,
            seed,
        }
    }

    /// A map of `size` pixels that is covered with disturbed copies of a tile which repeats, from pixel `first` of the
    /// plane; on all cores where the feature `rayon` is on.
    ///
    /// Copy `[0, 0]` of the tile begins in pixel `[0, 0]` of the plane. Past the largest `i64` the plane goes on with the
    /// smallest, in the middle of a copy.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Margin`] if the frozen pixels and the ramp are more than half of a side,
    /// [`TileErrorKind::NotFinite`] for a pixel that is NaN or infinite, [`TileErrorKind::Raster`] if `size` is empty or
    /// too large.
    pub fn render(
        &self,
        tile: &Raster<f32>,
        first: [i64; 2],
        size: [u32; 2],
    ) -> Result<Raster<f32>, TileError> {
        check_finite(tile)?;
        let [profile_x, profile_y] = [self.profile(tile.width())?, self.profile(tile.height())?];
        let mean = tile.statistics().mean;
        let seed = self.seed.child("disturb", 0);
        let rows = Raster::from_rows(size, |row| {
            let y = first[1].wrapping_add(row.into());
            let in_tile = Wrap::Repeat.index(y, tile.height());
            let row = Row {
                tile,
                mean,
                y: in_tile,
                hash: CellHash::new(seed, [y.div_euclid(tile.height().into())]),
                profile_x: &profile_x,
                weight_y: profile_y[in_tile as usize],
            };
            row.render(first[0], size[0])
        })?;
        Ok(rows)
    }

    /// The same for all maps of a material, whose copies are shifted alike.
    ///
    /// Normals are mixed as slopes, so that those of the frozen border come back within rounding.
    ///
    /// # Errors
    ///
    /// As [`render`](Self::render); [`TileErrorKind::Raster`] too if the maps differ in size.
    pub fn render_maps(
        &self,
        maps: &[Map],
        first: [i64; 2],
        size: [u32; 2],
    ) -> Result<Vec<Map>, TileError> {
        maps.iter()
            .map(|map| {
                let planes = map.planes();
                planes[0].check_same_size(maps[0].size())?;
                let planes = planes.iter().map(|plane| self.render(plane, first, size));
                map.with_planes(planes.collect::<Result<_, _>>()?)
            })
            .collect()
    }

    /// The weights along one axis, for the pixels of a tile.
    fn profile(&self, length: u32) -> Result<Vec<f64>, TileError> {
        let (margin, most) = (self.frozen.saturating_add(self.ramp), length / 2);
        if margin > most {
            return Err(TileError::new(TileErrorKind::Margin {
                margin,
                length,
                most,
            }));
        }
        let weight = |pixel: u32| {
            let from_border = pixel.min(length - 1 - pixel);
            if from_border < self.frozen {
                return 0.0;
            }
            // The center of the first pixel that is not frozen is half a pixel up the ramp.
            let up = f64::from(from_border - self.frozen) + 0.5;
            // Without a ramp the weight jumps to 1.
            smooth_ramp(up / f64::from(self.ramp).max(0.5))
        };
        Ok((0..length).map(weight).collect())
    }
}

/// What the pixels of a row of the map have in common.
struct Row<'a> {
    tile: &'a Raster<f32>,
    mean: f64,
    /// The row of the tile.
    y: u32,
    /// The seed and the row of copies.
    hash: CellHash,
    profile_x: &'a [f64],
    weight_y: f64,
}

impl Row<'_> {
    /// The pixels from column `first` of the plane.
    fn render(&self, first: i64, width: u32) -> Vec<f32> {
        let side = i64::from(self.tile.width());
        let mut values = Vec::with_capacity(width as usize);
        while values.len() < width as usize {
            let x = first.wrapping_add(values.len() as i64);
            let from = x.rem_euclid(side) as usize;
            let count = (side as usize - from).min(width as usize - values.len());
            self.copy(x.div_euclid(side), from..from + count, &mut values);
        }
        values
    }

    /// Some columns of the row of one copy.
    fn copy(&self, column: i64, columns: core::ops::Range<usize>, values: &mut Vec<f32>) {
        let own = &self.tile.row(self.y)[columns.clone()];
        if self.weight_y == 0.0 {
            values.extend_from_slice(own);
            return;
        }
        let copy = self.hash.axis(column);
        let [shift_x, shift_y] =
            [0, 1].map(|axis| shift(copy.at(axis), self.tile.size()[axis as usize]));
        let shifted_y = (u64::from(self.y) + u64::from(shift_y)) % u64::from(self.tile.height());
        let shifted = self.tile.row(shifted_y as u32);
        for (x, &own) in columns.zip(own) {
            let weight = self.profile_x[x] * self.weight_y;
            let past = x + shift_x as usize;
            let to = past.checked_sub(shifted.len()).unwrap_or(past);
            values.push(match weight {
                0.0 => own,
                1.0 => shifted[to],
                _ => mix_two(
                    [own, shifted[to]],
                    [self.mean; 2],
                    shares(weight, 0.0),
                    weight,
                ),
            });
        }
    }
}

/// A random number of pixels from a quarter to three quarters of a side, both included; 0 for a side of one pixel.
fn shift(bits: u64, side: u32) -> u32 {
    let least = side.div_ceil(4);
    // Three quarters are what a quarter leaves. For a side of one pixel nothing is left to choose from.
    let choices = u64::from((side - least + 1).saturating_sub(least));
    // The upper half of the product of a number below 1 and the choices.
    let chosen = (((bits >> 32) * choices) >> 32) as u32;
    if choices > 0 { least + chosen } else { 0 }
}

#[cfg(test)]
mod tests;
