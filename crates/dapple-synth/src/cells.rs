//! Cubic grid with a precomputed list of nearby cells for each cell, for reading many balls of the same radius.

use core::ops::Range;
use glam::DVec3;

/// Grid cells that contain sites, sorted by x, then y, then z.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    /// Cell of each site.
    of_site: Vec<u32>,
    /// Start of each cell's ranges in `near`, plus the end of the last one.
    offsets: Vec<u32>,
    /// Ranges of nearby cells, concatenated over the cells.
    near: Vec<Range<u32>>,
}

impl Cells {
    /// Sorts positions into cells with sides of length `side`. Two cells are near each other if some positions in them
    /// can be closer than `reach`.
    pub(crate) fn new(positions: &[DVec3], side: f64, reach: f64) -> Self {
        let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let cell_of = |position: &DVec3| {
            ((*position - low) / side)
                .to_array()
                .map(|part| part.min(f64::from(i32::MAX / 2)) as i32)
        };
        let mut keyed: Vec<([i32; 3], u32)> = positions.iter().map(cell_of).zip(0..).collect();
        // Sort the sites by cell, and number the distinct cells.
        keyed.sort_unstable();
        let mut cells: Vec<[i32; 3]> = Vec::new();
        let mut of_site = vec![0; positions.len()];
        for (cell, site) in keyed {
            if cells.last() != Some(&cell) {
                cells.push(cell);
            }
            of_site[site as usize] = cells.len() as u32 - 1;
        }
        // List the cells near each cell.
        let (mut offsets, mut near) = (vec![0], Vec::new());
        for cell in &cells {
            add_near(&cells, *cell, reach / side, &mut near);
            offsets.push(near.len() as u32);
        }
        Self {
            of_site,
            offsets,
            near,
        }
    }

    /// Returns the number of cells.
    pub(crate) fn n_cells(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Returns the index of the cell that contains `site`.
    #[inline]
    pub(crate) fn of_site(&self, site: u32) -> usize {
        self.of_site[site as usize] as usize
    }

    /// Returns the cells near `cell`, including itself, as ranges of cell indices.
    #[inline]
    pub(crate) fn near(&self, cell: usize) -> &[Range<u32>] {
        &self.near[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }
}

/// Appends to `near` the ranges of cells closer than `reach` to the cell `[x, y, z]`. Distances are in multiples of the
/// cell side.
fn add_near(cells: &[[i32; 3]], [x, y, z]: [i32; 3], reach: f64, near: &mut Vec<Range<u32>>) {
    let number = |cell: [i32; 3]| cells.partition_point(|other| *other < cell) as u32;
    let gap_sq = |step: i32| {
        let gap = f64::from((step.abs() - 1).max(0));
        gap * gap
    };
    let steps = reach.ceil() as i32;
    let first = near.len();
    for dx in -steps..=steps {
        for dy in -steps..=steps {
            let rest = reach * reach - gap_sq(dx) - gap_sq(dy);
            if rest <= 0.0 {
                continue;
            }
            // Cells along z are consecutive; the gap to a cell is one side less than the number of steps.
            let steps = rest.sqrt().ceil() as i32;
            let [from, until] = [z - steps, z + steps + 1].map(|z| number([x + dx, y + dy, z]));
            match near[first..].last_mut() {
                Some(last) if last.end == from => last.end = until,
                _ if from < until => near.push(from..until),
                _ => {}
            }
        }
    }
}
