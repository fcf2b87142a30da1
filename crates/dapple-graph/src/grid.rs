//! Sites in buckets, to find the images near a place.

use crate::lattice::Lattice;
use glam::DVec2;
use std::sync::OnceLock;

/// The error of a domain so thin that a search goes through too many copies of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooThin;

/// The number of images that the searches around the points of a set may still go through, all together.
///
/// On any domain this can take up to the square of the number of points where they crowd into one spot, and a square
/// torus has up to 25 copies within the reach of a search that finds little. On a domain that is thin beside the
/// distance of its points the number of copies would have no bound.
#[derive(Debug)]
pub(crate) struct Budget {
    left: u64,
}

impl Budget {
    /// The budget of `n` points.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            left: Self::limit(n),
        }
    }

    /// The largest number of images for `n` points. For few points, this is the work of a tenth of a second.
    pub(crate) fn limit(n: usize) -> u64 {
        let n = n as u64;
        (1 << 21) + 32_u64.saturating_mul(n.saturating_mul(n))
    }

    fn take(&mut self, images: u64) -> Result<(), TooThin> {
        self.left = self.left.checked_sub(images).ok_or(TooThin)?;
        Ok(())
    }
}

/// The largest number of images of `n` points for the start of a triangulation, or for insertion into it.
///
/// If they lie on one line, as the images of a single point do, the time grows with the square of their number.
pub(crate) fn triangulated_limit(n: usize) -> u64 {
    64 * n as u64 + 4096
}

/// Sites sorted into equal cells that hold about two each.
#[derive(Debug)]
pub(crate) struct Grid<'a> {
    lattice: &'a Lattice,
    sites: &'a [DVec2],
    cells: [usize; 2],
    per_step: DVec2,
    /// The index of each cell's first site in `order`, and at the end the number of sites.
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl<'a> Grid<'a> {
    /// Sorts the sites; within a cell they keep their order.
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
            starts: vec![0; cells[0] * cells[1] + 1],
            order: vec![0; sites.len()],
        };
        for &site in sites {
            let cell = grid.cell(site);
            grid.starts[cell] += 1;
        }
        let mut end = 0;
        for start in &mut grid.starts {
            end += *start;
            *start = end;
        }
        for (index, &site) in sites.iter().enumerate().rev() {
            let cell = grid.cell(site);
            grid.starts[cell] -= 1;
            grid.order[grid.starts[cell] as usize] = index as u32;
        }
        grid
    }

    /// Calls `visit` with the number and the place of every image in the box, and maybe of some beside it.
    ///
    /// Fails past the budget, possibly after some calls of `visit`.
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
                let row = row * self.cells[0];
                let first = self.starts[row + columns.start()] as usize;
                let end = self.starts[row + columns.end() + 1] as usize;
                // A row of a copy takes a while even where it is empty.
                budget.take((end - first) as u64 + 1)?;
                for &index in &self.order[first..end] {
                    visit(index, self.sites[index as usize] + shift);
                }
            }
            image.x += 1.0;
            if image.x > x_last {
                image = DVec2::new(x_first, image.y + 1.0);
            }
        }
        Ok(())
    }

    /// The root of the area per point.
    pub(crate) fn mean_distance(&self) -> f64 {
        let size = self.lattice.size;
        (size.x * (size.y / self.sites.len().max(1) as f64)).sqrt()
    }

    /// A radius that is large enough for all neighbors that a graph may need; within it images are still exact.
    ///
    /// Without wrapping, all points lie within the domain's diagonal. With wrapping, each point has at least ten images
    /// within five periods, and one in each cone of 1/32 of a turn that has any: 1 / sin(2π / 32) is below 5.2.
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

    /// The column or row of a coordinate; those outside of the domain belong to the first or last one.
    #[inline]
    fn bucket(&self, axis: usize, coordinate: f64) -> usize {
        // The conversion saturates, so that negative numbers become zero.
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
