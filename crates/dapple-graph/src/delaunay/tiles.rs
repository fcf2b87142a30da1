//! Divides large sets into independent tiles, whose triangulations fit the cache.
//!
//! Without wrapping, each tile also triangulates the corners of the hull, so that the stars of its points have gaps
//! only on the hull. On a cylinder, gaps at the borders are filled as in a single triangulation.

use super::hull::Hull;
use super::images::Cover;
use super::patch::{Image, Patch, Rows};
use super::{Refusal, check};
use crate::IsCancelled;
use crate::grid::{Budget, LazyGrid};
use crate::lattice::Lattice;
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};
use dapple_raster::parallel;
use glam::DVec2;

/// Approximate number of points per tile.
const POINTS_PER_TILE: f64 = 8192.0;

/// Number of points that are assigned to tiles between two calls of the callback.
const POINTS_PER_CALL: u32 = 1 << 18;

/// The tiles of a domain.
pub(super) struct Tiles<'a> {
    lattice: &'a Lattice,
    margin: f64,
    /// Start coordinates of the columns and rows, and the end of the last one. Infinite at the ends of axes that do not
    /// wrap.
    starts: [Vec<f64>; 2],
}

/// A tile: the images that it triangulates, and the points whose axes it computes.
#[derive(Default)]
struct Tile {
    images: Vec<Image>,
    points: Vec<u32>,
}

impl<'a> Tiles<'a> {
    /// Creates tiles for `n` points; `None` if there are too few points, or if the domain is too thin.
    pub(super) fn new(lattice: &'a Lattice, n: usize, margin: f64) -> Option<Self> {
        let size = lattice.size;
        let edge = (size.x * (size.y * POINTS_PER_TILE / n.max(1) as f64)).sqrt();
        let counts = [size.x, size.y].map(|side| (side / edge).floor().max(1.0));
        // Each tile must only need images from its eight neighbors.
        let is_wide = |axis: usize| !lattice.wrap[axis] || 2.0 * margin < size[axis];
        let has_tiles = counts[0] * counts[1] >= 2.0;
        let fits = has_tiles && 2.0 * margin < edge && is_wide(0) && is_wide(1);
        let starts = |axis: usize| {
            let count = counts[axis];
            let mut starts: Vec<f64> = (0..=count as u32)
                .map(|index| (f64::from(index) / count * size[axis]).floor())
                .collect();
            if let ([first, .., last], false) = (&mut starts[..], lattice.wrap[axis]) {
                (*first, *last) = (f64::NEG_INFINITY, f64::INFINITY);
            }
            starts
        };
        fits.then(|| Self {
            lattice,
            margin,
            starts: [starts(0), starts(1)],
        })
    }

    /// Computes the axes of all points. Fails with [`Refusal::Thin`] if the points are collinear, most of them are
    /// corners of the hull, or they are distributed too unevenly.
    pub(super) fn rows(
        &self,
        sites: &[DVec2],
        is_cancelled: &IsCancelled,
    ) -> Result<Rows, Refusal> {
        check(is_cancelled)?;
        let hull = match self.lattice.wraps() {
            true => None,
            false => Some(self.hull(sites, is_cancelled)?),
        };
        let tiles = self.fill(sites, hull.as_ref(), is_cancelled)?;
        check(is_cancelled)?;
        let grid = LazyGrid::new(self.lattice, sites);
        // After one tile without a result, the others are not worth their time.
        let is_refused = AtomicBool::new(false);
        let parts = parallel::map(tiles.len(), |index| {
            check(is_cancelled)?;
            if is_refused.load(Relaxed) {
                return Err(Refusal::Thin);
            }
            let tile = &tiles[index];
            let (column, row) = (index % self.count(0), index / self.count(0));
            let corner =
                |column: usize, row: usize| DVec2::new(self.starts[0][column], self.starts[1][row]);
            let (low, high) = (corner(column, row), corner(column + 1, row + 1));
            let cover = Cover::of_tile(low, high, self.margin);
            let (n, budget) = (
                tile.points.len(),
                Budget::of_tile(self.lattice.wrap, sites.len()),
            );
            let patch = Patch::new(self.lattice, cover, &tile.images, n, is_cancelled);
            let rows =
                patch.and_then(|mut patch| patch.rows(&grid, hull.as_ref(), budget, is_cancelled));
            is_refused.fetch_or(rows.is_err(), Relaxed);
            rows
        });
        if parts
            .iter()
            .any(|part| matches!(part, Err(Refusal::Cancelled)))
        {
            return Err(Refusal::Cancelled);
        }
        // After a refusal, the order of threads decides which error comes first. The caller looks for coincident sites
        // itself.
        let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok(merged(&tiles, &parts, sites.len()))
    }

    /// Returns the hull of all sites. Fails with [`Refusal::Thin`] if it has many corners.
    fn hull(&self, sites: &[DVec2], is_cancelled: &IsCancelled) -> Result<Hull, Refusal> {
        let n_tiles = self.count(0) * self.count(1);
        let most = sites.len() / 8 / n_tiles;
        Hull::new(sites, self.lattice.size, most, is_cancelled)?.ok_or(Refusal::Thin)
    }

    fn count(&self, axis: usize) -> usize {
        self.starts[axis].len() - 1
    }

    /// Assigns to each tile its points, the images within the margin, and the corners of the hull.
    fn fill(
        &self,
        sites: &[DVec2],
        hull: Option<&Hull>,
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Tile>, Refusal> {
        let mut tiles: Vec<Tile> = Vec::new();
        tiles.resize_with(self.count(0) * self.count(1), Tile::default);
        for (point, &site) in (0_u32..).zip(sites) {
            if point > 0 && point.is_multiple_of(POINTS_PER_CALL) {
                check(is_cancelled)?;
            }
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
        for &corner in hull.into_iter().flat_map(|hull| &hull.corners) {
            let site = sites[corner as usize];
            let [columns, rows] = [0, 1].map(|axis| self.near(axis, site[axis]));
            for (index, tile) in tiles.iter_mut().enumerate() {
                let is = |near: &[Option<(usize, f64)>; 3], at: usize| {
                    near.iter().flatten().any(|&(own, _)| own == at)
                };
                let has_it =
                    is(&columns, index % self.count(0)) && is(&rows, index / self.count(0));
                if !has_it {
                    tile.images.push(Image::new(site, corner, Image::FOREIGN));
                }
            }
        }
        Ok(tiles)
    }

    /// Returns the tile column (or row) that contains a coordinate, followed by the adjacent ones whose margin
    /// contains it. Each has the shift, in steps, to the image of the coordinate near that column.
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
