//! Divides large sets on a torus into independent tiles, whose triangulations fit the cache.

use super::images::Cover;
use super::patch::{Image, Patch, Rows};
use super::{Refusal, check};
use crate::IsCancelled;
use crate::grid::LazyGrid;
use crate::lattice::Lattice;
use dapple_raster::parallel;
use glam::DVec2;

/// Approximate number of points per tile.
const POINTS_PER_TILE: f64 = 8192.0;

/// The tiles of a domain.
pub(super) struct Tiles<'a> {
    lattice: &'a Lattice,
    margin: f64,
    /// Start coordinates of the columns and rows, and the end of the last one.
    starts: [Vec<f64>; 2],
}

/// A tile: its images, and the points whose rows it computes.
#[derive(Default)]
struct Tile {
    images: Vec<Image>,
    points: Vec<u32>,
}

impl<'a> Tiles<'a> {
    /// Creates tiles for `n` points; `None` if there are too few points, or if the domain does not wrap along both
    /// axes.
    pub(super) fn new(lattice: &'a Lattice, n: usize, margin: f64) -> Option<Self> {
        let size = lattice.size;
        let edge = (size.x * (size.y * POINTS_PER_TILE / n.max(1) as f64)).sqrt();
        let counts = [size.x, size.y].map(|side| (side / edge).floor());
        // Each tile must only need images from its eight neighbors.
        let fits = counts[0].min(counts[1]) >= 2.0 && 2.0 * margin < edge;
        let starts = |axis: usize| {
            let count = counts[axis];
            (0..=count as u32)
                .map(|index| (f64::from(index) / count * size[axis]).floor())
                .collect()
        };
        (fits && lattice.wrap == [true, true]).then(|| Self {
            lattice,
            margin,
            starts: [starts(0), starts(1)],
        })
    }

    /// Computes the rows of all points.
    pub(super) fn rows(
        &self,
        sites: &[DVec2],
        is_cancelled: &IsCancelled,
    ) -> Result<Rows, Refusal> {
        let tiles = self.fill(sites);
        let grid = LazyGrid::new(self.lattice, sites);
        let parts = parallel::map(tiles.len(), |index| {
            check(is_cancelled)?;
            let tile = &tiles[index];
            let (column, row) = (index % self.count(0), index / self.count(0));
            let corner =
                |column: usize, row: usize| DVec2::new(self.starts[0][column], self.starts[1][row]);
            let (low, high) = (corner(column, row), corner(column + 1, row + 1));
            let cover = Cover::new(self.lattice, low, high, self.margin);
            let mut patch = Patch::new(self.lattice, cover, &tile.images, tile.points.len())?;
            Ok::<Rows, Refusal>(patch.rows(&grid)?)
        });
        // Return the error of the first failing tile, regardless of the order of threads.
        let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok(merged(&tiles, &parts, sites.len()))
    }

    fn count(&self, axis: usize) -> usize {
        self.starts[axis].len() - 1
    }

    /// Assigns to each tile its points, and the images within the margin.
    fn fill(&self, sites: &[DVec2]) -> Vec<Tile> {
        let mut tiles: Vec<Tile> = Vec::new();
        tiles.resize_with(self.count(0) * self.count(1), Tile::default);
        for (point, &site) in (0..).zip(sites) {
            let [columns, rows] = [0, 1].map(|axis| self.near(axis, site[axis]));
            for (i, (row, shift_y)) in rows.into_iter().flatten().enumerate() {
                for (j, &(column, shift_x)) in columns.iter().flatten().enumerate() {
                    let tile = &mut tiles[row * self.count(0) + column];
                    let at = site + DVec2::new(shift_x, shift_y);
                    let mut image = Image::new(at, point, Image::FOREIGN);
                    if i + j == 0 {
                        image.row = tile.points.len() as u32;
                        tile.points.push(point);
                    }
                    tile.images.push(image);
                }
            }
        }
        tiles
    }

    /// Returns the column (or row) that contains a coordinate, followed by those within the margin, each with the
    /// shift to add.
    fn near(&self, axis: usize, at: f64) -> [Option<(usize, f64)>; 3] {
        let starts = &self.starts[axis];
        let (count, size) = (self.count(axis), self.lattice.size[axis]);
        let mut own = ((at / size * count as f64) as usize).min(count - 1);
        while at < starts[own] {
            own -= 1;
        }
        while at >= starts[own + 1] {
            own += 1;
        }
        let before = (at - starts[own] <= self.margin).then(|| match own {
            0 => (count - 1, size),
            _ => (own - 1, 0.0),
        });
        let after = (starts[own + 1] - at <= self.margin).then(|| match own + 1 {
            next if next == count => (0, -size),
            next => (next, 0.0),
        });
        [Some((own, 0.0)), before, after]
    }
}

/// Merges the rows of all tiles, in the order of the points.
fn merged(tiles: &[Tile], parts: &[Rows], n: usize) -> Rows {
    let mut places = vec![(0_u32, 0_u32); n];
    for (index, tile) in (0..).zip(tiles) {
        for (row, &point) in (0..).zip(&tile.points) {
            places[point as usize] = (index, row);
        }
    }
    let mut offsets = Vec::with_capacity(n + 1);
    offsets.push(0);
    let mut axes = Vec::with_capacity(parts.iter().map(|part| part.axes.len()).sum());
    for (tile, row) in places {
        let part = &parts[tile as usize];
        let [start, end] = [row, row + 1].map(|at| part.offsets[at as usize] as usize);
        axes.extend_from_slice(&part.axes[start..end]);
        offsets.push(axes.len() as u32);
    }
    Rows { offsets, axes }
}
