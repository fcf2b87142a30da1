//! Bakes a material, by rendering its maps band by band.
//!
//! A band is a block of rows of all maps. Normals, occlusion and curvature depend on the neighborhood of a pixel. They
//! are computed from the heights of the band and of a margin around it, so that bands, regions and the whole map have
//! the same bits. Nodes that depend on the whole tile are evaluated beforehand. Without such nodes, the memory for a
//! bake grows with the map's width only.
//!
//! The scheme is our own. `dapple-color` has the references for occlusion, curvature and normals.

mod heights;
#[cfg(feature = "image")]
mod image;
mod maps;
mod shards;
mod supersample;

pub use maps::{MapKind, MapRows};
pub use shards::Shards;

use crate::plan::{Pass, TileSamples};
use crate::{Plan, RecipeError, Samples, Whole};
use dapple_raster::Window;
use heights::Heights;
use maps::Side;
use supersample::Supersample;

/// Bake options: the maps, their size, and the memory limit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BakeOptions {
    /// Columns and rows of the whole tile; 1024 × 1024 by default. The tile may have more pixels than a raster can
    /// hold.
    pub size: [u32; 2],
    /// Where the samples are placed; at pixel centers by default.
    pub samples: Samples,
    /// Samples per pixel along each axis, from 1 to 16; 1 by default. Their values are averaged: heights, and colors in
    /// linear light. Normals, occlusion and curvature are computed from the averaged heights. Numbers that are ids are
    /// averaged, too.
    pub supersample: u32,
    /// The region of the tile to bake; the whole tile by default.
    pub region: Option<Region>,
    /// The maps to bake; the height by default.
    pub maps: Vec<MapKind>,
    /// The memory limit. Default: [`BakeMemory::Whole`].
    pub memory: BakeMemory,
    /// Approximate maximum number of pixels per band; 2^20 by default. That is enough to use all cores, and small
    /// enough to hold several values per pixel in memory. Smaller maps are divided into about eight bands so that
    /// progress is reported, but a band has at least 2^15 pixels and 16 rows. The bits do not depend on this option.
    pub band_pixels: u32,
}

/// A rectangle of a map, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The first column and row of the region.
    pub first: [u32; 2],
    /// Columns and rows of the region.
    pub size: [u32; 2],
}

/// The memory limit for a bake.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BakeMemory {
    /// Nodes that depend on the whole tile are evaluated for all of its pixels and held in memory.
    #[default]
    Whole,
    /// Only the rows of a band are in memory; a node that depends on the whole tile is an error.
    Banded,
}

/// Minimum number of bands per map, unless its bands would be smaller than [`LEAST_PIXELS`].
const LEAST_BANDS: u32 = 8;

/// Minimum number of pixels per band, unless [`BakeOptions::band_pixels`] is smaller.
const LEAST_PIXELS: u32 = 1 << 15;

/// Minimum number of rows per band, relative to the margin that its neighborhoods need. The rows of the margin are
/// evaluated in addition to those of the band.
const MARGINS: u32 = 8;

impl Default for BakeOptions {
    fn default() -> Self {
        Self {
            size: [1024; 2],
            samples: Samples::Centers,
            supersample: 1,
            region: None,
            maps: vec![MapKind::Height],
            memory: BakeMemory::Whole,
            band_pixels: 1 << 20,
        }
    }
}

/// Consecutive rows of all baked maps.
#[derive(Clone, Debug)]
pub struct Band {
    /// The index of the first row, counted from the top of the region.
    pub first_row: u32,
    /// The maps, in the order of [`BakeOptions::maps`].
    pub maps: Vec<(MapKind, MapRows)>,
}

/// The maps of a material, as an iterator over bands from the top down.
///
/// # Examples
///
/// ```
/// use dapple_recipe::{Bake, BakeOptions, Images, MapKind, Plan, Recipe};
///
/// let plan = Plan::new(&Recipe::builtin("flagstone")?, &Images::new(), 0.0)?;
/// let maps = vec![MapKind::Height, MapKind::Normal, MapKind::Albedo];
/// let bake = Bake::new(&plan, &BakeOptions { size: [64, 64], maps, ..BakeOptions::default() })?;
/// let rows: u32 = bake.map(|band| band.map(|band| band.maps[0].1.size()[1])).sum::<Result<u32, _>>()?;
/// assert_eq!(rows, 64);
/// # Ok::<(), dapple_recipe::RecipeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bake<'a> {
    plan: &'a Plan,
    whole: Whole,
    maps: Vec<MapKind>,
    /// The samples of the tile; duplicates of other samples are left out.
    tile: TileSamples,
    /// The samples to bake. For samples on corners, the last column and row may be copies of the first ones.
    window: Window,
    /// Number of pixels per band, so that a band has as many samples as the options allow pixels.
    band_pixels: u32,
    supersample: Supersample,
    /// Height of the margin above and below a band that the neighborhoods of the plan need, in rows of samples.
    margin: u32,
    next_row: u32,
    heights: Heights,
    /// Heights around the first column of the tile, for the copy of this column at the right side.
    first_heights: Heights,
}

impl<'a> Bake<'a> {
    /// Sets up a bake. Evaluates the nodes that depend on the whole tile, which may be most of the work. Everything
    /// else is computed band by band as the iterator advances. Both steps report to the plan's
    /// [progress](crate::Plan::new_with_progress) callback.
    ///
    /// # Errors
    ///
    /// [`Range`](crate::RecipeErrorKind::Range) if a size is zero, a region exceeds the tile, or a radius is out of
    /// range, [`Global`](crate::RecipeErrorKind::Global) if a node depends on the whole tile under
    /// [`BakeMemory::Banded`], [`Cancelled`](crate::RecipeErrorKind::Cancelled) if the plan's callback asks to stop, or
    /// the error of a node that depends on the whole tile.
    pub fn new(plan: &'a Plan, options: &BakeOptions) -> Result<Self, RecipeError> {
        let tile = plan.tile_samples(options.size, options.samples)?;
        let all = Window {
            size: options.size,
            ..tile.window
        };
        let window = match options.region {
            None => all,
            Some(region) => region.of(&all)?,
        };
        if options.memory == BakeMemory::Banded {
            plan.check_local()?;
        }
        let supersample = Supersample::new(options.supersample, tile.window.size)?;
        let samples = supersample.tile(&tile);
        let heights = Heights::new(plan, &tile, supersample, &options.maps)?;
        let whole = plan.whole_at(&samples)?;
        let per_pixel = supersample.per_axis() * supersample.per_axis();
        whole.watch.begin(Pass::Rows, window.size[1] as usize);
        Ok(Self {
            plan,
            whole,
            maps: options.maps.clone(),
            tile,
            window,
            band_pixels: options.band_pixels / per_pixel,
            supersample,
            margin: plan
                .margin_rows(&samples.window)?
                .div_ceil(supersample.per_axis()),
            next_row: 0,
            first_heights: heights.clone(),
            heights,
        })
    }

    /// Returns the columns and rows of the baked region.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.window.size
    }

    /// Bakes all remaining bands, and returns each map as a single raster, in the order of [`BakeOptions::maps`].
    ///
    /// # Errors
    ///
    /// If a band fails, or [`Raster`](crate::RecipeErrorKind::Raster) if a map has more pixels than a raster can hold.
    pub fn whole_maps(self) -> Result<Vec<(MapKind, MapRows)>, RecipeError> {
        let mut whole = Vec::new();
        for band in self {
            whole = joined(whole, band?.maps, Side::Below)?;
        }
        Ok(whole)
    }

    /// Bakes the next band.
    fn band(&mut self) -> Result<Band, RecipeError> {
        let [width, height] = self.window.size;
        let first_row = self.next_row;
        self.whole.watch.reach(first_row as usize);
        self.whole.watch.check()?;
        let [left, top] = [
            self.window.first[0],
            self.window.first[1].saturating_add(first_row.into()),
        ];
        // Count the distinct columns and rows from here to the end of the tile.
        let distinct = |axis: usize, first: i64| {
            u32::try_from(i64::from(self.tile.window.size[axis]) - first).unwrap_or(0)
        };
        let columns = distinct(0, left).min(width);
        // Choose the number of rows.
        let most = self.band_pixels / width;
        let least_pixels = LEAST_PIXELS / self.supersample.per_axis().pow(2);
        let least = (least_pixels / width).min(most);
        let around = self.margin.saturating_mul(MARGINS).min(most);
        let rows = height.div_ceil(LEAST_BANDS).clamp(least.max(around), most);
        let rows = rows.max(16).min(height - first_row);
        // The row after the last distinct one is a copy of the first row.
        let (top, rows) = match distinct(1, top) {
            0 => (0, 1),
            below => (top, rows.min(below)),
        };
        self.next_row += rows;
        let mut maps = Vec::new();
        if columns > 0 {
            let band = Window {
                first: [left, top],
                size: [columns, rows],
                ..self.window
            };
            maps = self
                .heights
                .maps(self.plan, &self.whole, &band, &self.tile, &self.maps)?;
        }
        // The column after the last distinct one is a copy of the first column.
        if columns < width {
            let band = Window {
                first: [0, top],
                size: [1, rows],
                ..self.window
            };
            let copy =
                self.first_heights
                    .maps(self.plan, &self.whole, &band, &self.tile, &self.maps)?;
            maps = joined(maps, copy, Side::Right)?;
        }
        Ok(Band { first_row, maps })
    }
}

/// Appends `others` to `maps`, each map at `side`. Returns `others` if `maps` is empty.
fn joined(
    maps: Vec<(MapKind, MapRows)>,
    others: Vec<(MapKind, MapRows)>,
    side: Side,
) -> Result<Vec<(MapKind, MapRows)>, RecipeError> {
    if maps.is_empty() {
        return Ok(others);
    }
    let pairs = maps.into_iter().zip(others);
    let joined = pairs.map(|((kind, map), (_, other))| Ok((kind, map.joined(other, side)?)));
    joined.collect()
}

impl Iterator for Bake<'_> {
    type Item = Result<Band, RecipeError>;

    fn next(&mut self) -> Option<Self::Item> {
        (self.next_row < self.window.size[1]).then(|| self.band())
    }
}

impl Region {
    /// Converts the region to a window. `whole` is the window of the tile. Fails if the region exceeds the tile.
    pub(crate) fn of(self, whole: &Window) -> Result<Window, RecipeError> {
        for axis in 0..2 {
            let end = u64::from(self.first[axis]) + u64::from(self.size[axis]);
            let fits = self.size[axis] > 0 && end <= u64::from(whole.size[axis]);
            RecipeError::check(
                fits,
                "end of the region",
                end as f64,
                "within the tile, past its first pixel",
            )?;
        }
        Ok(Window {
            first: self.first.map(i64::from),
            size: self.size,
            ..*whole
        })
    }
}
