//! Neighbor lists of sites, built once and read many times.

use crate::{SiteGrid, SiteIdx};
use dapple_mesh::{Surface, SurfacePoint};
use dapple_raster::parallel;
use glam::DVec3;

/// Number of sites whose lists are built and stored together.
pub(crate) const CHUNK: usize = 1024;
/// Maximum length of a neighbor list; of more neighbors only the nearest are stored. On a single sheet of evenly spaced
/// points about twenty are in reach. The limit bounds the memory where many sheets overlap.
const CROWD_MAX: usize = 48;
/// Radius of the first search where sites are crowded, relative to the distance of the farthest neighbor in the last
/// full list. A ball of this radius contains about twice as many sites as a full list.
const SPARE: f64 = 1.25;

/// Positions and normals of points in space.
#[derive(Debug, Default)]
pub(crate) struct Places {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) normals: Vec<DVec3>,
}

/// Neighbor lists of all sites from a first index to the last. Neighbors are other sites in reach on the same sheet.
#[derive(Debug)]
pub(crate) struct Near {
    chunks: Vec<Rows>,
}

/// Neighbor lists of the sites of a chunk, in compressed rows.
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

/// Positions in the order of the grid's members, so that the positions in a row of cells are contiguous.
struct Sorted {
    grid: SiteGrid,
    positions: Vec<DVec3>,
}

/// Scratch memory for the sites in reach of the current site, reused from site to site.
#[derive(Debug, Default)]
struct Found {
    /// Sites found, with their squared distances.
    sites: Vec<(f64, SiteIdx)>,
    /// Distance of the farthest site in the last full list; `None` before the first one.
    last_full: Option<f64>,
}

impl Near {
    /// Lists the neighbors of all sites with index `first` or more. A neighbor is nearer than `reach`, and the dot
    /// product of the two normals is at least `facing`.
    ///
    /// Lists are in the order of [`SiteGrid::visit`]. If there are more than [`CROWD_MAX`] neighbors, the list has only
    /// the nearest ones, nearest first.
    pub(crate) fn new(places: &Places, first: usize, reach: f64, facing: f64) -> Self {
        let grid = SiteGrid::new(&places.positions, reach);
        let positions = |&site: &SiteIdx| places.positions[site.index()];
        let sorted = Sorted {
            positions: grid.members().iter().map(positions).collect(),
            grid,
        };
        let n_sites = places.positions.len();
        let chunks = parallel::map(n_sites.saturating_sub(first).div_ceil(CHUNK), |chunk| {
            let first = first + chunk * CHUNK;
            let mut found = Found::default();
            let mut rows = Rows {
                starts: vec![0],
                others: Vec::new(),
            };
            for site in first..n_sites.min(first + CHUNK) {
                rows.add(found.list(places, &sorted, site, [reach, facing]));
            }
            rows.others.shrink_to_fit();
            rows
        });
        Self { chunks }
    }

    /// Returns the lists of the sites in `chunk`. Chunks are counted from the first site that has a list.
    #[inline]
    pub(crate) fn chunk(&self, chunk: usize) -> &Rows {
        &self.chunks[chunk]
    }
}

impl Rows {
    /// Returns the neighbor list of `site`, an index in the chunk.
    #[inline]
    pub(crate) fn row(&self, site: usize) -> &[SiteIdx] {
        &self.others[self.starts[site] as usize..self.starts[site + 1] as usize]
    }

    fn add(&mut self, found: &[(f64, SiteIdx)]) {
        self.others.extend(found.iter().map(|&(_, other)| other));
        self.starts.push(self.others.len() as u32);
    }
}

impl Found {
    /// Lists the neighbors of `site` with their squared distances.
    fn list(
        &mut self,
        places: &Places,
        sorted: &Sorted,
        site: usize,
        [reach, facing]: [f64; 2],
    ) -> &[(f64, SiteIdx)] {
        // Where sites are crowded, only the nearest matter. Try a smaller ball first, and accept it if it fills the
        // list.
        let smaller = self.last_full.map(|far| SPARE * far);
        let smaller = smaller.filter(|&smaller| smaller < reach);
        let mut n_found = 0;
        for reach in smaller.into_iter().chain([reach]) {
            n_found = self.gather(places, sorted, site, [reach, facing]);
            if n_found > CROWD_MAX {
                break;
            }
        }
        if n_found <= CROWD_MAX {
            return &self.sites[..n_found];
        }
        let nearest_first =
            |a: &(f64, SiteIdx), b: &(f64, SiteIdx)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        // Keep the nearest neighbors, sorted.
        self.sites[..n_found].select_nth_unstable_by(CROWD_MAX, nearest_first);
        let nearest = &mut self.sites[..CROWD_MAX];
        nearest.sort_unstable_by(nearest_first);
        self.last_full = nearest.last().map(|(distance_sq, _)| distance_sq.sqrt());
        nearest
    }

    /// Writes all neighbors within `reach` of `site` to the front of `self.sites`, in grid order. Returns their number.
    fn gather(
        &mut self,
        places: &Places,
        sorted: &Sorted,
        site: usize,
        [reach, facing]: [f64; 2],
    ) -> usize {
        let (position, normal) = (places.positions[site], places.normals[site]);
        let reach_sq = reach * reach;
        let found = &mut self.sites;
        let mut n_found = 0;
        sorted.grid.visit_rows(position, reach, |row| {
            // Every site is written, and sites out of reach are then overwritten. This avoids branches, which would be
            // mispredicted: where sheets cross, about a sixth of the sites are in reach, in no order.
            if found.len() < n_found + row.len() {
                found.resize(n_found + row.len(), (0.0, SiteIdx(0)));
            }
            let members = &sorted.grid.members()[row.clone()];
            for (&other, &at) in members.iter().zip(&sorted.positions[row]) {
                let distance_sq = (at - position).length_squared();
                found[n_found] = (distance_sq, other);
                n_found += usize::from(distance_sq < reach_sq);
            }
        });
        // Drop sites on other sheets, and the site itself.
        let mut n_kept = 0;
        for at in 0..n_found {
            let (_, other) = found[at];
            let faces = normal.dot(places.normals[other.index()]) >= facing;
            found[n_kept] = found[at];
            n_kept += usize::from(faces & (other.index() != site));
        }
        n_kept
    }
}

#[cfg(test)]
mod tests {
    use super::{CROWD_MAX, Near, Places};
    use crate::scatter;
    use crate::shapes::tangle;
    use dapple_hash::Seed;
    use dapple_mesh::Surface;

    #[test]
    fn neighbors_are_those_of_a_plain_loop_where_sheets_cross() {
        let surface = Surface::new(tangle(30)).unwrap();
        let points = scatter(&surface, 1500, Seed(5));
        let places = Places::new(&surface, &points);
        // About 20 neighbors on average, and far more in the middle, where most triangles cross.
        let (reach, facing, first) = (0.18, -0.5, 100);
        let near = Near::new(&places, first, reach, facing);
        let mut n_crowded = 0;
        for site in first..points.len() {
            let place = places.positions[site];
            let distance_sq = |other: usize| (places.positions[other] - place).length_squared();
            let mut expected: Vec<usize> = (0..points.len())
                .filter(|&other| distance_sq(other) < reach * reach && other != site)
                .filter(|&other| places.normals[site].dot(places.normals[other]) >= facing)
                .collect();
            expected.sort_by(|&a, &b| distance_sq(a).total_cmp(&distance_sq(b)).then(a.cmp(&b)));
            let row = (site - first) % super::CHUNK;
            let list = near.chunk((site - first) / super::CHUNK).row(row);
            let mut list: Vec<usize> = list.iter().map(|other| other.index()).collect();
            if expected.len() > CROWD_MAX {
                n_crowded += 1;
                expected.truncate(CROWD_MAX);
            } else {
                list.sort_by(|&a, &b| distance_sq(a).total_cmp(&distance_sq(b)).then(a.cmp(&b)));
            }
            assert_eq!(list, expected, "of site {site}");
        }
        assert!((100..1300).contains(&n_crowded), "{n_crowded} crowds");
    }
}
