//! Drops points that are closer to other points than the spacing.
//!
//! Every point has a random priority. A point is kept if no kept point with a higher priority is closer than the
//! spacing: random sequential addition in the order of priorities (a Matérn process of type III), as in
//! `dapple_points::EndlessPoissonDisk`. Whether a point is kept thus depends on the points around it that have a
//! higher priority, which depend on the points around them. These chains end after a few points and are followed
//! completely.

use super::{Point, Stamps};
use std::collections::BTreeMap;

/// Decides which points are kept, and caches the decisions.
pub(super) struct Spacing<'a> {
    stamps: &'a Stamps,
    /// Points of each cell, each with the decision whether it is kept, if known.
    cells: BTreeMap<[i64; 2], Vec<(Point, Option<bool>)>>,
}

impl<'a> Spacing<'a> {
    pub(super) fn new(stamps: &'a Stamps) -> Self {
        Self {
            stamps,
            cells: BTreeMap::new(),
        }
    }

    /// Returns whether a point of a cell is kept.
    pub(super) fn keeps(&mut self, cell: [i64; 2], index: usize) -> bool {
        let stamps = self.stamps;
        if stamps.options.spacing == 0.0 {
            return true;
        }
        let (point, known) = self.points(cell)[index];
        if let Some(known) = known {
            return known;
        }
        // A point may be shifted by up to a cell to the right.
        let reach = [
            stamps.options.spacing,
            stamps.options.spacing / stamps.options.cell_height,
        ];
        let [columns, rows] = reach.map(|reach| reach.ceil() as i64);
        let columns = columns + i64::from(stamps.options.row_offset != 0.0);
        let mut is_kept = true;
        'cells: for y in -rows..=rows {
            for x in -columns..=columns {
                let other = [cell[0].wrapping_add(x), cell[1].wrapping_add(y)];
                for rival in 0..self.points(other).len() {
                    let (candidate, _) = self.points(other)[rival];
                    let dx = candidate.position[0] + x as f64 - point.position[0];
                    let dy = (candidate.position[1] + y as f64 - point.position[1])
                        * stamps.options.cell_height;
                    let is_close =
                        dx * dx + dy * dy < stamps.options.spacing * stamps.options.spacing;
                    // A point does not compete with itself, nor with a copy of itself.
                    let is_stronger = candidate.priority() > point.priority();
                    if is_close && is_stronger && self.keeps(other, rival) {
                        is_kept = false;
                        break 'cells;
                    }
                }
            }
        }
        if let Some(points) = self.cells.get_mut(&cell) {
            points[index].1 = Some(is_kept);
        }
        is_kept
    }

    fn points(&mut self, cell: [i64; 2]) -> &[(Point, Option<bool>)] {
        let points = || self.stamps.points(cell);
        self.cells
            .entry(cell)
            .or_insert_with(|| points().map(|point| (point, None)).collect())
    }
}

impl Point {
    /// Returns the random priority, 64 bits, equal for copies of the point.
    fn priority(&self) -> u64 {
        self.hash.at(self.first + 7)
    }
}
