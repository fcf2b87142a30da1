//! Corner tiles, sets of tiles that fit together in any order.
//!
//! Ares Lagae and Philip Dutré, "An Alternative for Wang Tiles: Colored Edges versus Colored Corners", ACM Transactions
//! on Graphics 25(4), 2006, <https://doi.org/10.1145/1183287.1183296>. A square tile has a color at each of its
//! corners. Tiles fit if the colors agree at the corners that they share, along edges as well as across corners. With C
//! colors there are C⁴ tiles, and a plane of randomly colored corners has exactly one tile for every position.
//!
//! Each color stands for a source, which is a material that repeats by itself and is visible near corners of that
//! color. As in the paper, pieces meet along cuts where they are most similar, and all other pixels are copies.
//!
//! Difference from the paper: instead of one graph cut there are three cuts through rows or columns (see `cut.rs`).
//! First, the left and the right source of a pair are cut from top to bottom. This cut is closed, and it is the same in
//! all tiles with this pair. Then the upper pair and the lower pair are cut from left to right. The start of this cut
//! depends only on the two colors on the left, and its end only on those on the right, so it continues in the next
//! tile.

use crate::axis::transpose_all;
use crate::cut::{Band, Cut, Ends, mix, scales};
use crate::error::{check, rows_cancellable};
use crate::map::check_planes;
use crate::piece::pieces;
use crate::{IsCancelled, Map, TileError, TileErrorKind};
use dapple_hash::{CellHash, Seed};
use dapple_raster::{Raster, Wrap};

/// Maximum number of sources, and therefore of colors.
const MOST_SOURCES: usize = 4;

/// Default fraction of a side that cuts may occupy.
const WIDTH: f64 = 0.5;

/// A set of corner tiles, built from 2 to 4 materials that repeat by themselves.
///
#[cfg_attr(doc, doc = include_str!("../docs/corner-tiles.md"))]
///
/// # Examples
///
/// ```
/// use dapple_hash::Seed;
/// use dapple_tile::{CornerTiles, Map, raster::Raster};
///
/// let source = |step: u32| Raster::from_fn([32, 32], |x, y| ((x * step + y) % 32) as f32);
/// let tiles = CornerTiles::new(&[vec![Map::Value(source(1)?)], vec![Map::Value(source(3)?)]])?;
/// assert_eq!(tiles.all()?.len(), 16);
/// let maps = tiles.render(Seed(7), [0, 0], [100, 80])?;
/// assert_eq!(maps[0].size(), [100, 80]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CornerTiles {
    /// Planes of the maps of each source.
    sources: Vec<Vec<Raster<f32>>>,
    /// One pixel of each map of the first source, which records the map's kind.
    kinds: Vec<Map>,
    /// Period of the corner colors along x and y, in tiles.
    period: [Option<u32>; 2],
    cuts: Cuts,
}

/// The cuts for a set with C colors.
#[derive(Clone, Debug, PartialEq)]
struct Cuts {
    /// Cut between color a on the left and b on the right, at index a + b C.
    beside: Vec<Cut>,
    /// Cut between the upper and the lower pair, from left to right, at the tile's index.
    across: Vec<Cut>,
}

impl CornerTiles {
    /// Creates the tiles from 2 to 4 sources. Each source has the maps of a material; all maps are the same size. Cuts
    /// may occupy half of a side.
    ///
    /// During the search for cuts, C² copies of a source are in memory.
    ///
    /// # Errors
    ///
    /// * [`TileErrorKind::Count`] if the number of sources is not 2 to 4, if a source has no maps, or if its number of
    ///   maps differs from the first source
    /// * [`TileErrorKind::KindMismatch`] if the kinds of maps differ between sources
    /// * [`TileErrorKind::Raster`] if sizes differ
    /// * [`TileErrorKind::NotFinite`] if a pixel is NaN or infinite
    pub fn new(sources: &[Vec<Map>]) -> Result<Self, TileError> {
        Self::new_cancellable(sources, WIDTH, &|| false)
    }

    /// Same as [`new`](Self::new) and then [`with_width`](Self::with_width), but fails if `is_cancelled` returns true.
    /// It is called before each of the C² + C⁴ cuts, before each plane of a cut, and once per 2^20 cells of a search.
    ///
    /// # Errors
    ///
    /// Same as [`new`](Self::new) and [`with_width`](Self::with_width), plus [`TileErrorKind::Cancelled`].
    pub fn new_cancellable(
        sources: &[Vec<Map>],
        width: f64,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, TileError> {
        let count = sources.len();
        if !(2..=MOST_SOURCES).contains(&count) {
            return Err(TileError::new(TileErrorKind::Count {
                what: "sources",
                count,
                needed: "2 to 4",
            }));
        }
        let planes = Map::planes_of_all(sources)?;
        let kind = |map: &Map| {
            let pixels = map
                .planes()
                .into_iter()
                .map(|plane| plane.crop([0, 0], [1, 1]));
            map.with_planes(pixels.collect::<Result<_, _>>()?)
        };
        Ok(Self {
            kinds: sources[0].iter().map(kind).collect::<Result<_, _>>()?,
            cuts: Cuts::new(&planes, width, is_cancelled)?,
            sources: planes,
            period: [None; 2],
        })
    }

    /// Sets the fraction of the shorter side that cuts may occupy, above 0 and at most 1. The default is ½. The larger
    /// the fraction, the less the pieces look like squares.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Range`] if the width is out of its range.
    pub fn with_width(self, width: f64) -> Result<Self, TileError> {
        let cuts = Cuts::new(&self.sources, width, &|| false)?;
        Ok(Self { cuts, ..self })
    }

    /// Sets the period of the corner colors along x and y, in tiles. A map that covers whole periods repeats. By
    /// default there are no periods.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Range`] if a period is 0.
    pub fn with_period(self, period: [Option<u32>; 2]) -> Result<Self, TileError> {
        for tiles in period.into_iter().flatten() {
            TileError::check(tiles > 0, "period in tiles", tiles.into(), "at least 1")?;
        }
        Ok(Self { period, ..self })
    }

    /// Returns the number of columns and rows of a tile.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.sources[0][0].size()
    }

    /// Builds the tile with the given corner colors: top left, top right, bottom left, bottom right.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Range`] if a color is not the index of a source.
    pub fn tile(&self, colors: [u8; 4]) -> Result<Vec<Map>, TileError> {
        for color in colors {
            let holds = usize::from(color) < self.sources.len();
            TileError::check(holds, "corner color", color.into(), "the index of a source")?;
        }
        let [width, height] = self.size();
        let mut planes = Vec::new();
        for plane in 0..self.sources[0].len() {
            planes.push(Raster::from_rows([width, height], |row| {
                let mut values = Vec::with_capacity(width as usize);
                self.join_row(colors, plane, row, 0..width, &mut values);
                values
            })?);
        }
        Map::all_with_planes(&self.kinds, planes)
    }

    /// Builds all C⁴ tiles. The tile with corner colors `[a, b, c, d]`, in the order of [`tile`](Self::tile), is at
    /// index a + b C + c C² + d C³.
    ///
    /// # Errors
    ///
    /// None for sources that [`new`](Self::new) accepts.
    pub fn all(&self) -> Result<Vec<Vec<Map>>, TileError> {
        let n_colors = self.sources.len();
        let tiles = (0..n_colors.pow(4)).map(|index| self.tile(colors_of(index, n_colors)));
        tiles.collect()
    }

    /// Renders maps of `size` pixels, starting at pixel `first` of a plane with random corner colors. With the feature
    /// `rayon`, tiles are rendered in parallel.
    ///
    /// A window equals the same crop of a larger map. Tile `[0, 0]` starts at pixel `[0, 0]` of the plane. Beyond the
    /// largest `i64`, coordinates wrap around to the smallest, in the middle of a tile.
    ///
    /// # Errors
    ///
    /// [`TileErrorKind::Raster`] if `size` is empty or too large.
    pub fn render(
        &self,
        seed: Seed,
        first: [i64; 2],
        size: [u32; 2],
    ) -> Result<Vec<Map>, TileError> {
        self.render_cancellable(seed, first, size, &|| false)
    }

    /// Renders the same maps as [`render`](Self::render), unless `is_cancelled` returns true. The callback is called
    /// once per 65,536 pixels of a plane, from any thread.
    ///
    /// # Errors
    ///
    /// Same as [`render`](Self::render), plus [`TileErrorKind::Cancelled`].
    pub fn render_cancellable(
        &self,
        seed: Seed,
        first: [i64; 2],
        size: [u32; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Map>, TileError> {
        let seed = seed.child("corner", 0);
        // Divide the columns at the borders of the tiles.
        let columns = pieces(first[0], size[0], self.size()[0]);
        let mut planes = Vec::new();
        for plane in 0..self.sources[0].len() {
            planes.push(rows_cancellable(size, is_cancelled, |row| {
                // Find the row of tiles, and the row within a tile.
                let y = first[1].wrapping_add(row.into());
                let above = y.div_euclid(self.size()[1].into());
                let row = Wrap::Repeat.index(y, self.size()[1]);
                let mut values = Vec::with_capacity(size[0] as usize);
                // Append the columns of each tile.
                for piece in &columns {
                    let colors = self.colors(seed, [piece.copy, above]);
                    let pixels = piece.from..piece.from + piece.count;
                    self.join_row(colors, plane, row, pixels, &mut values);
                }
                values
            })?);
        }
        Map::all_with_planes(&self.kinds, planes)
    }

    /// Returns the corner colors of the tile at a position in the plane.
    fn colors(&self, seed: Seed, tile: [i64; 2]) -> [u8; 4] {
        let [left, above] = tile;
        let [right, below] = tile.map(|at| at.wrapping_add(1));
        [[left, above], [right, above], [left, below], [right, below]]
            .map(|corner| self.color(seed, corner))
    }

    fn color(&self, seed: Seed, corner: [i64; 2]) -> u8 {
        // Corners one period apart have the same color.
        let [x, y] = [0, 1].map(|axis| match self.period[axis] {
            Some(period) => corner[axis].rem_euclid(period.into()),
            None => corner[axis],
        });
        let bits = CellHash::new(seed, [y]).axis(x).at(0);
        // Multiply a fixed-point number below 1 by the number of colors.
        (((bits >> 32) * self.sources.len() as u64) >> 32) as u8
    }

    /// Joins a range of columns in one row of one plane of a tile, and appends them to `values`.
    fn join_row(
        &self,
        colors: [u8; 4],
        plane: usize,
        row: u32,
        columns: core::ops::Range<u32>,
        values: &mut Vec<f32>,
    ) {
        let colors = colors.map(usize::from);
        let [nw, ne, sw, se] = colors.map(|color| self.sources[color][plane].row(row));
        // With equal colors, the tile is a copy of the source.
        if colors == [colors[0]; 4] {
            values.extend_from_slice(&nw[columns.start as usize..columns.end as usize]);
            return;
        }
        let n_colors = self.sources.len();
        // The upper pair and the lower pair have their own cuts from top to bottom.
        let [upper, lower] = [[colors[0], colors[1]], [colors[2], colors[3]]]
            .map(|[left, right]| &self.cuts.beside[left + right * n_colors]);
        let across = &self.cuts.across[index_of(colors, n_colors)];
        values.extend(columns.map(|column| {
            // Join left and right in both pairs, then the upper with the lower pair.
            let x = column as usize;
            let above = mix(nw[x], ne[x], upper.weight(column, row));
            let below = mix(sw[x], se[x], lower.weight(column, row));
            mix(above, below, across.weight(row, column))
        }));
    }
}

/// Returns the index of the tile with the given corner colors.
fn index_of(colors: [usize; 4], n_colors: usize) -> usize {
    colors
        .iter()
        .rev()
        .fold(0, |index, color| index * n_colors + color)
}

/// Returns the corner colors of the tile with the given index.
fn colors_of(index: usize, n_colors: usize) -> [u8; 4] {
    [0, 1, 2, 3].map(|place| (index / n_colors.pow(place) % n_colors) as u8)
}

impl Cuts {
    /// Finds the cheapest cuts in a band that occupies the fraction `width` of the shorter side.
    fn new(
        sources: &[Vec<Raster<f32>>],
        width: f64,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, TileError> {
        let holds = width > 0.0 && width <= 1.0;
        TileError::check(holds, "width of the cuts", width, "above 0, at most 1")?;
        let size = check_planes(&sources.concat())?;
        // Determine the bands of the cuts, and the scales that give all planes the same variance.
        let [along_x, along_y] = size.map(|side| band(side, size, width));
        let of_scales: Vec<_> = sources.iter().map(Vec::as_slice).collect();
        let scales = scales(&of_scales);
        let turned = |planes: &[Raster<f32>]| transpose_all(planes, is_cancelled);
        let turned_sources = sources.iter().map(|planes| turned(planes));
        let turned_sources: Vec<_> = turned_sources.collect::<Result<_, _>>()?;
        let n_colors = sources.len();
        // Cut each pair from top to bottom, and record where its cut from left to right starts and ends.
        let (mut beside, mut halves, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        for (a, b) in (0..n_colors).flat_map(|b| (0..n_colors).map(move |a| (a, b))) {
            check(is_cancelled)?;
            // Between equal sources, every cut is invisible.
            let cheapest = |of: &[Vec<Raster<f32>>], band| match a == b {
                true => Ok(Cut::straight(band, of[a][0].height())),
                false => {
                    let pair = [&of[a][..], &of[b]];
                    Cut::cheapest(pair, &scales, band, Ends::Closed, is_cancelled)
                }
            };
            let cut = cheapest(sources, along_x)?;
            ends.push(cheapest(&turned_sources, along_y)?.ends());
            // Join the pair along its cut. Transpose it, since the next cut runs from left to right.
            let pairs = sources[a].iter().zip(&sources[b]);
            let joined: Vec<_> = pairs
                .map(|(a, b)| cut.join([a, b]))
                .collect::<Result<_, _>>()?;
            halves.push(turned(&joined)?);
            beside.push(cut);
        }
        // Cut the upper from the lower pair of each tile, between these ends.
        let mut across = Vec::new();
        for index in 0..n_colors.pow(4) {
            check(is_cancelled)?;
            let [a, b, c, d] = colors_of(index, n_colors).map(usize::from);
            let pair = [&halves[a + b * n_colors][..], &halves[c + d * n_colors]];
            let at = Ends::At([ends[a + c * n_colors][0], ends[b + d * n_colors][1]]);
            across.push(match (a, b) == (c, d) {
                true => Cut::straight(along_y, size[0]),
                false => Cut::cheapest(pair, &scales, along_y, at, is_cancelled)?,
            });
        }
        Ok(Self { beside, across })
    }
}

/// Returns the band of the cuts in the middle of a side. It occupies a fraction of the shorter side, so a cut that
/// moves one pixel sideways in each row can connect any two pixels of the band. One pixel at each end of the side
/// remains free if the side has at least three.
fn band(side: u32, size: [u32; 2], width: f64) -> Band {
    let shorter = size[0].min(size[1]);
    let share = (f64::from(shorter) * width).round() as u32;
    let count = share.min(shorter.saturating_sub(2)).max(1);
    Band {
        first: (side - count) / 2,
        count,
    }
}

#[cfg(test)]
mod tests;
