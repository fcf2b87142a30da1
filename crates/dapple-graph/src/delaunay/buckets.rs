//! Editable buckets of sites, for finding the images in a rectangle.

use crate::lattice::Lattice;
use glam::DVec2;

/// Initial number of sites per cell.
const SITES_PER_CELL: f64 = 2.0;

/// The sites in each cell of a domain, listed by number.
#[derive(Clone, Debug)]
pub(super) struct Buckets {
    size: [usize; 2],
    per_step: DVec2,
    cells: Vec<Vec<u32>>,
}

impl Buckets {
    /// Creates empty cells for about `n` sites.
    pub(super) fn new(lattice: &Lattice, n: usize) -> Self {
        let side = (lattice.size.x * (lattice.size.y * SITES_PER_CELL / n.max(1) as f64)).sqrt();
        // A thin domain has one row; more cells than sites are never useful.
        let size = [0, 1].map(|axis| ((lattice.size[axis] / side) as usize).clamp(1, n.max(1)));
        Self {
            size,
            per_step: DVec2::new(size[0] as f64, size[1] as f64) / lattice.size,
            cells: vec![Vec::new(); size[0] * size[1]],
        }
    }

    pub(super) fn n_cells(&self) -> usize {
        self.cells.len()
    }

    pub(super) fn insert(&mut self, number: u32, site: DVec2) {
        let cell = self.cell(site);
        self.cells[cell].push(number);
    }

    pub(super) fn remove(&mut self, number: u32, site: DVec2) {
        let cell = self.cell(site);
        self.cells[cell].retain(|&other| other != number);
    }

    /// Returns the numbers of the sites in the same cell as `site`.
    pub(super) fn beside(&self, site: DVec2) -> &[u32] {
        &self.cells[self.cell(site)]
    }

    /// Calls `visit` with every site that has an image in a rectangle, and with that image's shift. It may also be
    /// called for some images near the rectangle. Stops if `visit` returns false.
    pub(super) fn visit(
        &self,
        lattice: &Lattice,
        [low, high]: [DVec2; 2],
        mut visit: impl FnMut(u32, DVec2) -> bool,
    ) {
        let [columns, rows] = [0, 1].map(|axis| lattice.images(axis, low[axis], high[axis]));
        let mut image = DVec2::new(columns.0, rows.0);
        while image.y <= rows.1 {
            let shift = image * lattice.size;
            let [columns_here, rows_here] = [0, 1].map(|axis| {
                let first = self.bucket(axis, low[axis] - shift[axis]);
                first..=self.bucket(axis, high[axis] - shift[axis])
            });
            for row in rows_here {
                for column in columns_here.clone() {
                    for &number in &self.cells[row * self.size[0] + column] {
                        if !visit(number, shift) {
                            return;
                        }
                    }
                }
            }
            image.x += 1.0;
            if image.x > columns.1 {
                image = DVec2::new(columns.0, image.y + 1.0);
            }
        }
    }

    fn cell(&self, site: DVec2) -> usize {
        self.bucket(1, site.y) * self.size[0] + self.bucket(0, site.x)
    }

    fn bucket(&self, axis: usize, coordinate: f64) -> usize {
        // The cast saturates, so negative numbers become zero.
        ((coordinate * self.per_step[axis]) as usize).min(self.size[axis] - 1)
    }
}
