//! The neighbors of sites in lists, made once and read often.

use crate::{SiteGrid, SiteIdx};
use dapple_mesh::{Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::DVec3;

/// Sites whose lists are made and kept together.
pub(crate) const CHUNK: usize = 1024;
/// The most neighbors that a list holds, the nearest ones. On a sheet of even points there are about twenty within
/// reach, and a heap of sheets must not fill the memory.
const CROWD_MAX: usize = 48;

/// Positions of points in space, and their normals.
#[derive(Debug, Default)]
pub(crate) struct Places {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) normals: Vec<DVec3>,
}

/// For each site from some number on, the other sites within reach that are on the same sheet.
#[derive(Debug)]
pub(crate) struct Near {
    chunks: Vec<Rows>,
}

/// The lists of the sites of a chunk, one after the other.
#[derive(Debug)]
pub(crate) struct Rows {
    starts: Vec<u32>,
    others: Vec<SiteIdx>,
}

impl Places {
    pub(crate) fn new(surface: &Surface, points: &[SurfacePoint]) -> Self {
        Self {
            positions: parallel::map(points.len(), |at| surface.position(points[at])),
            normals: parallel::map(points.len(), |at| surface.normal(points[at])),
        }
    }
}

impl Near {
    /// Lists the neighbors of all sites from `first` on: those nearer than `reach` whose normals have a product with
    /// the site's own of at least `facing`.
    ///
    /// Their order is that of [`SiteGrid::visit`]; where there are more than [`CROWD_MAX`], the nearest ones come,
    /// nearest first.
    pub(crate) fn new(places: &Places, first: usize, reach: f64, facing: f64) -> Self {
        let grid = SiteGrid::new(&places.positions, reach);
        let n_sites = places.positions.len();
        let chunks = parallel::map(n_sites.saturating_sub(first).div_ceil(CHUNK), |chunk| {
            let first = first + chunk * CHUNK;
            let mut rows = Rows {
                starts: vec![0],
                others: Vec::new(),
            };
            for site in first..n_sites.min(first + CHUNK) {
                rows.add(places, &grid, site, [reach, facing]);
            }
            rows.others.shrink_to_fit();
            rows
        });
        Self { chunks }
    }

    /// The lists of the sites of a chunk, counted from the first site that has one.
    #[inline]
    pub(crate) fn chunk(&self, chunk: usize) -> &Rows {
        &self.chunks[chunk]
    }
}

impl Rows {
    /// The list of a site of the chunk.
    #[inline]
    pub(crate) fn row(&self, site: usize) -> &[SiteIdx] {
        &self.others[self.starts[site] as usize..self.starts[site + 1] as usize]
    }

    fn add(&mut self, places: &Places, grid: &SiteGrid, site: usize, [reach, facing]: [f64; 2]) {
        let (position, normal) = (places.positions[site], places.normals[site]);
        let reach_sq = reach * reach;
        let first = self.others.len();
        let distance_sq =
            |other: SiteIdx| (places.positions[other.index()] - position).length_squared();
        grid.visit(position, reach, |other| {
            if distance_sq(other) < reach_sq
                && normal.dot(places.normals[other.index()]) >= facing
                && other.index() != site
            {
                self.others.push(other);
            }
        });
        if self.others.len() - first > CROWD_MAX {
            self.others[first..].sort_unstable_by(|&a, &b| {
                distance_sq(a).total_cmp(&distance_sq(b)).then(a.cmp(&b))
            });
            self.others.truncate(first + CROWD_MAX);
        }
        self.starts.push(self.others.len() as u32);
    }
}
