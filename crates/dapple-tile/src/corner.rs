//! Corner tiles: sets that fit in any order.
//!
//! Ares Lagae and Philip Dutré, "An Alternative for Wang Tiles: Colored Edges versus Colored Corners", ACM Transactions on
//! Graphics 25(4), 2006, <https://doi.org/10.1145/1183287.1183296>: a square tile has a color at each of its corners,
//! and tiles fit where the colors of the corners that meet agree, along edges as well as across corners. With C colors
//! there are C⁴ tiles, and a plane of randomly colored corners has exactly one tile for every place.
//!
//! Departure: the authors assemble a tile from pieces of an exemplar with a graph cut. Here each color is a source, a tile
//! that repeats by itself, and near a corner its source is seen. In between the sources are mixed by quintic ramps of the
//! place, so that along an edge only the colors of its two ends count: two tiles fit as exactly as the sources repeat, and
//! the weights are twice continuously differentiable all over the plane. The mix keeps the variance (see
//! [`Crossfade`](crate::Crossfade)) of sources that have nothing to do with each other; like sources get too much of it.
//!
//! A material's maps are done one channel at a time: the weights depend on the place and on the colors alone.

use crate::crossfade::smooth_ramp;
use crate::map::check_planes;
use crate::{TileError, TileErrorKind};
use dapple_hash::{CellHash, Seed};
use dapple_raster::{Raster, Wrap};

/// The most sources, hence colors.
const MOST_SOURCES: usize = 4;

/// A set of corner tiles, made from 2 to 4 sources that repeat by themselves.
///
#[cfg_attr(doc, doc = include_str!("../docs/corner-tiles.md"))]
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_tile::{CornerTiles, raster::Raster};
///
/// let source = |step: u32| Raster::from_fn([32, 32], |x, y| ((x * step + y) % 32) as f32);
/// let tiles = CornerTiles::new(&[source(1)?, source(3)?])?;
/// assert_eq!(tiles.all()?.len(), 16);
/// let map = tiles.render(Seed(7), [0, 0], [100, 80])?;
/// assert_eq!(map.size(), [100, 80]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CornerTiles {
    sources: Vec<Raster<f32>>,
    means: Vec<f64>,
    /// The weight of the corners on the right for each column, and of the lower ones for each row.
    ramps: [Vec<f64>; 2],
}

impl CornerTiles {
    /// The tiles of 2 to 4 sources of one size, with sources mixed over half of a side.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Count`] for fewer or more sources, [`TileErrorKind::Raster`] if they differ in size,
    /// [`TileErrorKind::NotFinite`] for a pixel that is NaN or infinite.
    pub fn new(sources: &[Raster<f32>]) -> Result<Self, TileError> {
        let count = sources.len();
        if !(2..=MOST_SOURCES).contains(&count) {
            return Err(TileError::new(TileErrorKind::Count {
                what: "sources",
                count,
                needed: "2 to 4",
            }));
        }
        let size = check_planes(sources)?;
        let means = sources.iter().map(|source| source.statistics().mean);
        Ok(Self {
            sources: sources.to_vec(),
            means: means.collect(),
            ramps: size.map(|side| ramp(side, 0.5)),
        })
    }

    /// The same tiles with sources mixed over another share of a side, above 0 and at most 1. The less, the
    /// harder the edge between two sources.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Range`] for another width.
    pub fn with_width(self, width: f64) -> Result<Self, TileError> {
        let holds = width > 0.0 && width <= 1.0;
        TileError::check(
            holds,
            "width of the transition",
            width,
            "above 0, at most 1",
        )?;
        let ramps = self.size().map(|side| ramp(side, width));
        Ok(Self { ramps, ..self })
    }

    /// Columns and rows of a tile.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.sources[0].size()
    }

    /// The tile with these colors at its corners: top left, top right, bottom left, bottom right.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Range`] for a color that is not the index of a source.
    pub fn tile(&self, colors: [u8; 4]) -> Result<Raster<f32>, TileError> {
        for color in colors {
            let holds = usize::from(color) < self.sources.len();
            TileError::check(holds, "corner color", color.into(), "the index of a source")?;
        }
        let columns = 0..self.size()[0] as usize;
        let tile = Raster::from_rows(self.size(), |row| {
            let mut values = Vec::with_capacity(columns.len());
            self.mix_row(colors, row, columns.clone(), &mut values);
            values
        })?;
        Ok(tile)
    }

    /// All C⁴ tiles. The one with corner colors `[a, b, c, d]`, in the order of [`tile`](Self::tile), is at index
    /// a + b C + c C² + d C³.
    ///
    /// # Errors
    ///
    /// None that [`new`](Self::new) lets pass.
    pub fn all(&self) -> Result<Vec<Raster<f32>>, TileError> {
        let n_colors = self.sources.len();
        (0..n_colors.pow(4))
            .map(|index| {
                let color = |place: u32| (index / n_colors.pow(place) % n_colors) as u8;
                self.tile([color(0), color(1), color(2), color(3)])
            })
            .collect()
    }

    /// A map of `size` pixels from pixel `first` of the plane, whose corners have random colors; on all cores where the
    /// feature `rayon` is on.
    ///
    /// A window is the crop of the whole. Tile `[0, 0]` begins in pixel `[0, 0]` of the plane. Past the largest `i64` the
    /// plane goes on with the smallest, in the middle of a tile.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Raster`] if `size` is empty or too large.
    pub fn render(
        &self,
        seed: Seed,
        first: [i64; 2],
        size: [u32; 2],
    ) -> Result<Raster<f32>, TileError> {
        let seed = seed.child("corner", 0);
        let map = Raster::from_rows(size, |row| {
            let y = first[1].wrapping_add(row.into());
            let above = y.div_euclid(self.size()[1].into());
            let hashes = [above, above.wrapping_add(1)].map(|row| CellHash::new(seed, [row]));
            let row = Wrap::Repeat.index(y, self.size()[1]);
            self.render_row(hashes, row, first[0], size[0] as usize)
        })?;
        Ok(map)
    }

    /// The pixels of a row of the map, tile by tile.
    fn render_row(&self, hashes: [CellHash; 2], row: u32, first: i64, width: usize) -> Vec<f32> {
        let side = i64::from(self.size()[0]);
        let mut values = Vec::with_capacity(width);
        while values.len() < width {
            let x = first.wrapping_add(values.len() as i64);
            let left = x.div_euclid(side);
            let from = x.rem_euclid(side) as usize;
            let to = (side as usize).min(from + width - values.len());
            let [nw, sw] = hashes.map(|hash| self.color(hash.axis(left)));
            let [ne, se] = hashes.map(|hash| self.color(hash.axis(left.wrapping_add(1))));
            self.mix_row([nw, ne, sw, se], row, from..to, &mut values);
        }
        values
    }

    /// The color of a corner.
    fn color(&self, corner: CellHash) -> u8 {
        // The upper half of the product of a number below 1 and the number of colors.
        (((corner.at(0) >> 32) * self.sources.len() as u64) >> 32) as u8
    }

    /// Some columns of a row of a tile.
    fn mix_row(
        &self,
        colors: [u8; 4],
        row: u32,
        columns: core::ops::Range<usize>,
        values: &mut Vec<f32>,
    ) {
        let colors = colors.map(usize::from);
        let sources = colors.map(|color| &self.sources[color].row(row)[columns.clone()]);
        if colors == [colors[0]; 4] {
            values.extend_from_slice(sources[0]);
            return;
        }
        let means = colors.map(|color| self.means[color]);
        let alike = alike(colors);
        let down = self.ramps[1][row as usize];
        let ramp = &self.ramps[0][columns];
        let [nw, ne, sw, se] = sources.map(|source| &source[..ramp.len()]);
        let start = values.len();
        values.resize(start + ramp.len(), 0.0);
        let to = &mut values[start..][..ramp.len()];
        for x in 0..ramp.len() {
            let right = ramp[x];
            let weights = [
                (1.0 - right) * (1.0 - down),
                right * (1.0 - down),
                (1.0 - right) * down,
                right * down,
            ];
            to[x] = mix(weights, [nw[x], ne[x], sw[x], se[x]], means, alike);
        }
    }
}

/// For each pair of corners 2 if they have one color, or else 0.
fn alike(colors: [usize; 4]) -> [f64; 6] {
    [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
        .map(|[a, b]| if colors[a] == colors[b] { 2.0 } else { 0.0 })
}

/// The values at all corners, mixed: means by their weights, what differs from them by weights of length 1.
///
/// Corners of one color add up before the length is taken, so that each pair of them adds twice its product.
fn mix(weights: [f64; 4], values: [f32; 4], means: [f64; 4], alike: [f64; 6]) -> f32 {
    let [a, b, c, d] = weights;
    let [mut mean, mut deviation] = [0.0; 2];
    for corner in 0..4 {
        mean += weights[corner] * means[corner];
        deviation += weights[corner] * (f64::from(values[corner]) - means[corner]);
    }
    let products = [a * b, a * c, a * d, b * c, b * d, c * d];
    let mut length_sq = a * a + b * b + c * c + d * d;
    for pair in 0..6 {
        length_sq += alike[pair] * products[pair];
    }
    // The weights are a partition of 1, so that the sum of their squares is at least a quarter.
    (mean + deviation / length_sq.sqrt()) as f32
}

/// The weight of the far corner at the pixels of a side: half and half in the middle.
fn ramp(side: u32, width: f64) -> Vec<f64> {
    let place = |pixel: u32| (f64::from(pixel) + 0.5) / f64::from(side);
    let weight = |place: f64| smooth_ramp((place - 0.5) / width + 0.5);
    (0..side).map(place).map(weight).collect()
}

#[cfg(test)]
mod tests;
