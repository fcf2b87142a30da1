//! The grid for a Poisson-disk set. Its cells are small enough to contain at most one point each.
//!
//! The domain is divided into equal cells whose diagonal is at most the radius. A cell therefore contains at most one
//! point, and two points conflict only if their cells are at most two apart. A margin of [`HALO`] cells around the
//! grid contains copies from the other side along wrapped axes, and empty cells along other axes, so that neighbor
//! loops need no border checks.
//!
//! **Units.** A position is a cell and an offset in `[0, 1)²` within the cell, a multiple of 2^-22 ([`LATTICE`] steps
//! per cell). Differences of offsets across up to three cells are exact in `f32`. Two positions conflict if their
//! squared distance, relative to the reach, is below 1: `(dx * scale)² + (dy * scale)²` in `f32` with
//! [`Grid::scale`], rounded after each operation. This is monotonic in `|dx|` and `|dy|`. The reach is larger than
//! the radius by [`SLACK`], which exceeds all rounding, so no second, exact test is needed. Points that do not
//! conflict are at least a radius apart in `f64`. Where all positions conflict, no empty circle is larger than the
//! radius times 1 + 1e-6.

use crate::{Domain, PointsError, PointsErrorKind, RSA_DENSITY};
use dapple_hash::{CellHash, Seed};
use glam::DVec2;

/// Width of the margin beyond each side of the grid, in cells.
pub(crate) const HALO: u32 = 2;

/// Lattice steps per cell: 2^22, because 2^24 steps are exact in `f32` and differences span three cells.
pub(crate) const LATTICE: u32 = 1 << 22;

/// Length of a lattice step, in cells.
pub(crate) const STEP: f32 = 1.0 / LATTICE as f32;

/// Offset of an empty cell: far from every position, with a finite square.
pub(crate) const FAR: f32 = 1e9;

/// Minimum width and height of a cell, relative to the reach of a point. With it, an offset of [`FAR`] cells is out of
/// reach. In a thinner domain, cells are assumed to be this wide, which adds less than 1e-16 to a squared distance of
/// 1.
const THINNEST: f32 = 2.0 / FAR;

/// Relative difference between the reach of a point and the radius. Rounding to `f32` may shorten a distance by 6 ·
/// 2^-24 / 2 = 1.8e-7, and moving a given point to the lattice by 2^-23 = 1.2e-7.
const SLACK: f64 = 4e-7;

/// Minimum relative difference between the radius and the diagonal of a cell: given points that are a radius apart are
/// still in different cells after rounding.
const CELL_SLACK: f64 = 1e-6;

/// A cell, given by its row and column in the arrays. Both include the margin, so the first cell of the domain is
/// `(HALO, HALO)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Cell {
    pub(crate) row: u32,
    pub(crate) column: u32,
}

/// The grid cells of a domain for one radius.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    pub(crate) domain: Domain,
    /// Columns and rows without the margin.
    pub(crate) cells: [u32; 2],
    /// Width and height of a cell, in units of the domain.
    cell: DVec2,
    /// Width and height of a cell, relative to the reach.
    pub(crate) scale: [f32; 2],
}

impl Grid {
    /// Creates the grid for points at least `radius` apart.
    pub(crate) fn new(domain: Domain, radius: f64, max_points: u64) -> Result<Self, PointsError> {
        let domain = domain.checked()?;
        check_radius(&domain, radius, max_points)?;
        let side = radius * (1.0 - CELL_SLACK) * core::f64::consts::FRAC_1_SQRT_2;
        // There are at most 2^30 cells and a margin, since `check_radius` has bounded the area and each side.
        let cells = [0, 1].map(|axis| (domain.size[axis] / side).ceil().max(1.0) as u32);
        let cell = domain.size / DVec2::new(f64::from(cells[0]), f64::from(cells[1]));
        let largest = domain.origin.abs().max(domain.end().abs()).max_element();
        let reach = radius * (1.0 + SLACK) + 8.0 * f64::EPSILON * largest;
        let scale = [cell.x, cell.y].map(|side| ((side / reach) as f32).max(THINNEST));
        Ok(Self {
            domain,
            cells,
            cell,
            scale,
        })
    }

    /// Returns the length of a row of the arrays, in cells.
    pub(crate) fn stride(&self) -> usize {
        (self.cells[0] + 2 * HALO) as usize
    }

    /// Returns the number of rows of the arrays.
    pub(crate) fn rows(&self) -> usize {
        (self.cells[1] + 2 * HALO) as usize
    }

    /// Returns the index of a cell in the arrays.
    #[inline(always)]
    pub(crate) fn index(&self, cell: Cell) -> usize {
        cell.row as usize * self.stride() + cell.column as usize
    }

    /// Returns the hash of a domain cell.
    #[inline(always)]
    pub(crate) fn hash(&self, seed: Seed, cell: Cell) -> CellHash {
        // There are less than 2^32 cells, so one word identifies a cell, which is half the work of two.
        let number = (cell.row - HALO) * self.cells[0] + (cell.column - HALO);
        CellHash::new(seed, [i64::from(number)])
    }

    /// Returns the domain cell that a margin cell is a copy of.
    ///
    /// Other cells are returned unchanged, including margin cells along an axis that does not wrap.
    #[inline(always)]
    pub(crate) fn original(&self, cell: Cell) -> Cell {
        Cell {
            row: self.original_index(1, cell.row),
            column: self.original_index(0, cell.column),
        }
    }

    /// Returns the column (axis 0) or row (axis 1) of [`original`](Self::original).
    #[inline(always)]
    pub(crate) fn original_index(&self, axis: usize, index: u32) -> u32 {
        let count = self.cells[axis];
        if !self.domain.wrap[axis] {
            index
        } else if index < HALO {
            index + count
        } else if index >= count + HALO {
            index - count
        } else {
            index
        }
    }

    /// Converts a cell and an offset to a position.
    pub(crate) fn position(&self, cell: Cell, offset: [f32; 2]) -> DVec2 {
        let along = |index: u32, offset: f32| f64::from(index - HALO) + f64::from(offset);
        let cells = DVec2::new(along(cell.column, offset[0]), along(cell.row, offset[1]));
        // Rounding must not move the position across a border that does not wrap.
        (self.domain.origin + cells * self.cell).min(self.domain.end())
    }

    /// Converts a position to its cell and its offset, which is rounded to the lattice.
    pub(crate) fn place(&self, position: DVec2) -> (Cell, [f32; 2]) {
        let cells = (position - self.domain.origin) / self.cell;
        let along = |at: f64, count: u32| {
            let index = at.floor().clamp(0.0, f64::from(count - 1));
            let steps = ((at - index) * f64::from(LATTICE) + 0.5).floor();
            let steps = steps.clamp(0.0, f64::from(LATTICE - 1));
            (index as u32 + HALO, steps as f32 * STEP)
        };
        let (column, x) = along(cells.x, self.cells[0]);
        let (row, y) = along(cells.y, self.cells[1]);
        (Cell { row, column }, [x, y])
    }
}

/// Checks that the radius is valid and the set is not too large.
fn check_radius(domain: &Domain, radius: f64, max_points: u64) -> Result<(), PointsError> {
    let refuse = |kind| Err(PointsError::new(kind));
    if !(radius > 0.0 && radius.is_finite()) {
        return refuse(PointsErrorKind::NotPositive {
            what: "the radius",
            value: radius,
        });
    }
    for axis in [0, 1] {
        if domain.wrap[axis] && domain.size[axis] < 2.0 * radius {
            return refuse(PointsErrorKind::PeriodTooShort {
                axis: axis as u32,
                period: domain.size[axis],
                radius,
            });
        }
    }
    // A set has at least 0.65 points per squared radius of area, and a strip without width at least one per two radii.
    let sides = domain.size / radius;
    let needed = (RSA_DENSITY * sides.x * sides.y).max(0.5 * sides.max_element());
    if needed > max_points as f64 || needed.is_nan() {
        return refuse(PointsErrorKind::TooMany {
            needed,
            limit: max_points,
        });
    }
    Ok(())
}
