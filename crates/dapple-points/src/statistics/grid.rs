//! A grid of square cells that contain sorted points, for searches ring by ring.

use crate::{Domain, PointSet};
use dapple_raster::Groups;
use glam::DVec2;

/// Mean number of points per cell. With more, searches would visit many distant points; with fewer, many empty cells.
const POINTS_PER_CELL: f64 = 2.0;

/// Upper bound on how far, as a fraction of a cell, rounding may move a point into a neighboring cell.
const ROUNDING: f64 = 1e-6;

/// How a search visits the cells of a wrapping domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Images {
    /// Each cell is visited once, at the shortest distance.
    Nearest,
    /// Each cell is visited together with its copies within one period on either side. A more distant copy cannot be
    /// the nearest one to a position within half a period.
    All,
}

/// Points of a set, grouped by cell in rows of cells.
#[derive(Debug)]
pub(super) struct Grid {
    domain: Domain,
    /// Numbers of columns and rows.
    counts: [i64; 2],
    /// Length of the shorter side of a cell.
    side: f64,
    cells: Groups,
}

impl Grid {
    pub(super) fn new(set: &PointSet) -> Self {
        let domain = *set.domain();
        let n_points = set.len().max(1);
        let side = (domain.area() * POINTS_PER_CELL / n_points as f64).sqrt();
        // The cast saturates, and a side has at most as many cells as there are points.
        let counts =
            [0, 1].map(|axis| ((domain.size[axis] / side) as i64).clamp(1, n_points as i64));
        let side = (domain.size.x / counts[0] as f64).min(domain.size.y / counts[1] as f64);
        let mut grid = Self {
            domain,
            counts,
            side,
            cells: Groups::default(),
        };
        // Sort the points by cell.
        let cells = set.iter().map(|(_, position)| grid.cell(position));
        let cells: Vec<u32> = cells
            .map(|[column, row]| (row * counts[0] + column) as u32)
            .collect();
        grid.cells = Groups::sort((counts[0] * counts[1]) as usize, &cells);
        grid
    }

    /// Returns the column and row of a position.
    pub(super) fn cell(&self, position: DVec2) -> [i64; 2] {
        [0, 1].map(|axis| {
            let fraction = (position[axis] - self.domain.origin[axis]) / self.domain.size[axis];
            let cell = (fraction * self.counts[axis] as f64) as i64;
            cell.clamp(0, self.counts[axis] - 1)
        })
    }

    /// Returns the lower bound of the distance to all points in ring `ring` and beyond.
    pub(super) fn distance_to_ring(&self, ring: i64) -> f64 {
        (ring as f64 - 1.0 - ROUNDING) * self.side
    }

    /// Returns the last ring that can contain a point within `distance`, or the last ring with any point if that is
    /// nearer.
    pub(super) fn last_ring(&self, distance: f64) -> i64 {
        let reach = (distance / self.side + 1.0 + ROUNDING) as i64;
        reach.clamp(0, self.counts[0].max(self.counts[1]))
    }

    /// Returns the last ring that can contain a point.
    pub(super) fn outermost_ring(&self) -> i64 {
        self.counts[0].max(self.counts[1]) + 1
    }

    /// Calls `visit` with each point in the cells of ring `ring`, and with the shift from its position to its copy in
    /// the ring.
    pub(super) fn visit_ring(
        &self,
        center: [i64; 2],
        ring: i64,
        images: Images,
        mut visit: impl FnMut(usize, DVec2),
    ) {
        let [reach_x, reach_y] = self.counts.map(|count| ring.min(count + 1));
        for dy in -reach_y..=reach_y {
            let Some((row, shift_y)) = self.along(1, center[1], dy, images) else {
                continue;
            };
            // A row at the edge of the ring is complete; any other row has only its two ends.
            let is_whole = dy.abs() == ring;
            let step = if is_whole { 1 } else { (2 * ring).max(1) };
            if !is_whole && reach_x < ring {
                continue;
            }
            for dx in (-reach_x..=reach_x).step_by(step as usize) {
                let Some((column, shift_x)) = self.along(0, center[0], dx, images) else {
                    continue;
                };
                let cell = (row * self.counts[0] + column) as usize;
                for &point in self.cells.of(cell) {
                    visit(point as usize, DVec2::new(shift_x, shift_y));
                }
            }
        }
    }

    /// Returns the column or row `offset` away from `center`, and the shift from the original cell in the domain to
    /// this copy.
    fn along(&self, axis: usize, center: i64, offset: i64, images: Images) -> Option<(i64, f64)> {
        let count = self.counts[axis];
        if !self.domain.wrap[axis] {
            let cell = center + offset;
            return (0..count).contains(&cell).then_some((cell, 0.0));
        }
        let is_nearest = offset <= count / 2 && offset >= -((count - 1) / 2);
        if images == Images::Nearest && !is_nearest {
            return None;
        }
        let turns = (center + offset).div_euclid(count);
        let cell = (center + offset).rem_euclid(count);
        Some((cell, turns as f64 * self.domain.size[axis]))
    }
}
