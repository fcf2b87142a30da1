//! A bucket grid of sites, for finding the images near a position.

use crate::lattice::Lattice;
use dapple_raster::Groups;
use glam::DVec2;
use std::sync::OnceLock;

/// Error for a domain that is so thin that a search would visit too many copies of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooThin;

/// Number of images that all searches for a point set may still visit in total.
///
/// If the points of any domain are concentrated in one spot, the number of visits approaches the square of the number
/// of points. On a square torus, up to 25 copies are within reach of a search that finds few points. On a domain that
/// is thin relative to the distance of its points, the number of copies would be unbounded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    left: u64,
}

impl Budget {
    /// Creates the budget for all searches in a set of `n` points.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            left: Self::limit(n),
        }
    }

    /// Returns the maximum number of images for `n` points. For few points, this corresponds to a tenth of a second.
    pub(crate) fn limit(n: usize) -> u64 {
        let n = n as u64;
        (1 << 21) + 32_u64.saturating_mul(n.saturating_mul(n))
    }

    /// Creates the budget for a tile of `n` points. Along axes that do not wrap, a few milliseconds or, on a cylinder, tens
    /// of milliseconds are allowed, since a single triangulation is possible as well.
    pub(crate) fn of_tile(wrap: [bool; 2], n: usize) -> Self {
        match wrap {
            [true, true] => Self::new(n),
            [false, false] => Self { left: 1 << 20 },
            _ => Self { left: 1 << 24 },
        }
    }

    fn take(&mut self, images: u64) -> Result<(), TooThin> {
        self.left = self.left.checked_sub(images).ok_or(TooThin)?;
        Ok(())
    }
}

/// Returns the maximum number of images of `n` points for the initial triangulation, or for insertion into it.
///
/// If the images are collinear, such as the images of a single point, the time is quadratic in their number.
pub(crate) fn triangulated_limit(n: usize) -> u64 {
    64 * n as u64 + 4096
}

/// Sites, sorted into equal cells with about two sites each.
#[derive(Debug)]
pub(crate) struct Grid<'a> {
    lattice: &'a Lattice,
    sites: &'a [DVec2],
    cells: [usize; 2],
    per_step: DVec2,
    /// Sites of each cell, row by row.
    groups: Groups,
}

impl<'a> Grid<'a> {
    /// Sorts the sites by cell.
    pub(crate) fn new(lattice: &'a Lattice, sites: &'a [DVec2]) -> Self {
        let size = lattice.size;
        let n = sites.len().max(1);
        let edge = (2.0 * size.x * (size.y / n as f64)).sqrt();
        let cells = [size.x, size.y].map(|side| ((side / edge) as usize).clamp(1, n));
        let mut grid = Self {
            lattice,
            sites,
            cells,
            per_step: DVec2::new(cells[0] as f64, cells[1] as f64) / size,
            groups: Groups::default(),
        };
        let of_sites: Vec<u32> = sites.iter().map(|&site| grid.cell(site) as u32).collect();
        grid.groups = Groups::sort(cells[0] * cells[1], &of_sites);
        grid
    }

    /// Calls `visit` with the index and position of every image in the box, and possibly of some images near it.
    ///
    /// Fails if the budget is exhausted, possibly after some calls of `visit`.
    pub(crate) fn visit_box(
        &self,
        low: DVec2,
        high: DVec2,
        budget: &mut Budget,
        mut visit: impl FnMut(u32, DVec2),
    ) -> Result<(), TooThin> {
        let [(x_first, x_last), (y_first, y_last)] =
            [0, 1].map(|axis| self.lattice.images(axis, low[axis], high[axis]));
        let size = self.lattice.size;
        let mut image = DVec2::new(x_first, y_first);
        while image.y <= y_last {
            let shift = image * size;
            let [columns, rows] = [0, 1].map(|axis| {
                let first = self.bucket(axis, low[axis] - shift[axis]);
                first..=self.bucket(axis, high[axis] - shift[axis])
            });
            for row in rows {
                let columns = [*columns.start(), *columns.end()];
                self.visit_row(row, columns, budget, |index, at| visit(index, at + shift))?;
            }
            image.x += 1.0;
            if image.x > x_last {
                image = DVec2::new(x_first, image.y + 1.0);
            }
        }
        Ok(())
    }

    /// Calls `visit` with the index and position of every site in a disk, and possibly of some sites near it. Images are
    /// not visited.
    ///
    /// Fails like [`visit_box`](Self::visit_box).
    pub(crate) fn visit_disk(
        &self,
        center: DVec2,
        radius: f64,
        budget: &mut Budget,
        mut visit: impl FnMut(u32, DVec2),
    ) -> Result<(), TooThin> {
        // A step is more than the rounding error of the rows' borders.
        let radius = radius + 1.0;
        let first = self.bucket(1, center.y - radius);
        for row in first..=self.bucket(1, center.y + radius) {
            let low = row as f64 / self.per_step.y;
            let high = (row + 1) as f64 / self.per_step.y;
            let across = (low - center.y).max(center.y - high).max(0.0);
            let along = ((radius - across).max(0.0) * (radius + across)).sqrt();
            let columns = [-along, along].map(|along| self.bucket(0, center.x + along));
            self.visit_row(row, columns, budget, &mut visit)?;
        }
        Ok(())
    }

    /// Calls `visit` with the index and position of every site in a row of buckets, from the first to the last column.
    fn visit_row(
        &self,
        row: usize,
        [first, last]: [usize; 2],
        budget: &mut Budget,
        mut visit: impl FnMut(u32, DVec2),
    ) -> Result<(), TooThin> {
        let row = row * self.cells[0];
        let first = self.groups.range(row + first).start;
        let end = self.groups.range(row + last).end;
        // Visiting a row takes time even if it is empty.
        budget.take((end - first) as u64 + 1)?;
        for &index in &self.groups.items[first..end] {
            visit(index, self.sites[index as usize]);
        }
        Ok(())
    }

    /// Returns the mean point spacing, which is the square root of the area per point.
    pub(crate) fn mean_distance(&self) -> f64 {
        let size = self.lattice.size;
        (size.x * (size.y / self.sites.len().max(1) as f64)).sqrt()
    }

    /// Returns a search radius, in steps, within which each point finds all neighbors that a graph may need. Up to
    /// this radius, the positions of images are exact.
    ///
    /// Without wrapping, it is the diagonal of the domain. With wrapping, ten images of each point are within five
    /// periods, so [`k_nearest`](crate::k_nearest) finds enough neighbors. A cone of [`yao`](crate::yao) is at least
    /// 1/32 of a turn wide, and reaches the width of a period within 1 / sin(2π / 32) < 5.2 periods.
    pub(crate) fn farthest(&self) -> f64 {
        let size = self.lattice.size;
        if self.lattice.wraps() {
            5.2 * size.max_element() + 1.01 * size.min_element()
        } else {
            size.length() + 1.0
        }
    }

    fn cell(&self, site: DVec2) -> usize {
        self.bucket(1, site.y) * self.cells[0] + self.bucket(0, site.x)
    }

    /// Returns the column or row that contains a coordinate, clamped to the domain.
    #[inline]
    fn bucket(&self, axis: usize, coordinate: f64) -> usize {
        // The cast saturates, so negative numbers become zero.
        ((coordinate * self.per_step[axis]) as usize).min(self.cells[axis] - 1)
    }
}

/// A grid that is built on first use.
#[derive(Debug)]
pub(crate) struct LazyGrid<'a> {
    lattice: &'a Lattice,
    sites: &'a [DVec2],
    grid: OnceLock<Grid<'a>>,
}

impl<'a> LazyGrid<'a> {
    pub(crate) fn new(lattice: &'a Lattice, sites: &'a [DVec2]) -> Self {
        Self {
            lattice,
            sites,
            grid: OnceLock::new(),
        }
    }

    pub(crate) fn sites(&self) -> &'a [DVec2] {
        self.sites
    }

    pub(crate) fn get(&self) -> &Grid<'a> {
        self.grid
            .get_or_init(|| Grid::new(self.lattice, self.sites))
    }
}

#[cfg(test)]
mod tests {
    use super::{Budget, Grid};
    use crate::lattice::Lattice;
    use dapple_points::{Domain, PointSet};
    use glam::DVec2;

    #[test]
    fn boxes_find_the_same_images_as_a_search_through_all() {
        let domain = Domain {
            wrap: [true, false],
            ..Domain::torus(DVec2::new(3.0, -1.0), DVec2::new(2.0, 0.7))
        };
        let positions = (0..50)
            .map(|i| {
                domain.origin + DVec2::new(f64::from(i * 37 % 50) * 0.04, f64::from(i) * 0.014)
            })
            .collect();
        let points = PointSet::new(domain, positions).unwrap();
        let lattice = Lattice::new(&domain);
        let sites = lattice.sites(&points);
        let grid = Grid::new(&lattice, &sites);
        for (low, high) in [([-1.3, 0.1], [2.6, 0.4]), ([0.1, -1.0], [0.13, 9.0])] {
            let [low, high] = [low, high].map(|corner| lattice.steps(DVec2::from(corner)));
            let inside = |at: DVec2| at.cmpge(low).all() && at.cmple(high).all();
            let mut found = Vec::new();
            let visited = grid.visit_box(low, high, &mut Budget::new(50), |index, at| {
                if inside(at) {
                    found.push((index, at.x));
                }
            });
            assert_eq!(visited, Ok(()), "in the box {low} to {high}");
            let mut expected = Vec::new();
            for k in -5..5 {
                for (index, &site) in (0..).zip(&sites) {
                    let at = site + DVec2::new(f64::from(k) * lattice.size.x, 0.0);
                    if inside(at) {
                        expected.push((index, at.x));
                    }
                }
            }
            found.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            expected.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            assert!(
                !expected.is_empty(),
                "the box {low} to {high} holds no image"
            );
            assert_eq!(found, expected, "in the box {low} to {high}");
        }
    }
}
