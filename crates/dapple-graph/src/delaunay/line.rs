//! The graph of sites on a straight line: a path, or a cycle along an axis that wraps.
//!
//! A triangulation of collinear vertices would take quadratic time.

use super::images::key;
use super::order::sort;
use super::patch::Rows;
use super::{Refusal, check};
use crate::lattice::Lattice;
use crate::{Axis, IsCancelled};
use dapple_points::PointIdx;
use glam::DVec2;
use robust::{Coord, orient2d};

/// Returns whether all sites are on one straight line.
pub(super) fn are_collinear(sites: &[DVec2]) -> bool {
    let Some(&first) = sites.first() else {
        return true;
    };
    let Some(&second) = sites.iter().find(|&&site| site != first) else {
        return true;
    };
    let coord = |at: DVec2| Coord { x: at.x, y: at.y };
    let turn = |&site: &DVec2| orient2d(coord(first), coord(second), coord(site));
    sites.iter().all(|site| turn(site) == 0.0)
}

/// Computes the rows if the sites, with all of their images, are on one straight line.
pub(super) fn rows(
    lattice: &Lattice,
    sites: &[DVec2],
    is_cancelled: &IsCancelled,
) -> Result<Option<Rows>, Refusal> {
    // Along a wrapped axis, all sites must have the same other coordinate.
    let is_level = |axis: usize| sites.iter().all(|site| site[axis] == sites[0][axis]);
    let period = match lattice.wrap {
        [false, false] if are_collinear(sites) => None,
        [true, false] if is_level(1) => Some(DVec2::new(lattice.size.x, 0.0)),
        [false, true] if is_level(0) => Some(DVec2::new(0.0, lattice.size.y)),
        _ => return Ok(None),
    };
    let mut order: Vec<u32> = (0..sites.len() as u32).collect();
    sort(
        &mut order,
        &|&point| key(sites[point as usize]),
        is_cancelled,
    )?;
    let mut places = vec![0; sites.len()];
    for (place, &point) in order.iter().enumerate() {
        places[point as usize] = place;
    }
    // Returns the axis from a place on the line to the next one.
    let next = |place: usize| {
        let (from, to) = (order[place], order.get(place + 1));
        let (to, shift) = match (to, period) {
            (Some(&to), _) => (to, DVec2::ZERO),
            (None, Some(period)) => (order[0], period),
            (None, None) => return None,
        };
        Some((from, to, sites[to as usize] + shift - sites[from as usize]))
    };
    let axis = |to: u32, steps: DVec2| Axis {
        to: PointIdx(to),
        vector: lattice.vector(steps),
    };
    let (mut offsets, mut axes) = (vec![0], Vec::with_capacity(2 * sites.len()));
    for (point, &place) in places.iter().enumerate() {
        if point.is_multiple_of(1 << 16) {
            check(is_cancelled)?;
        }
        let before = match place {
            0 => period.and_then(|_| next(sites.len() - 1)),
            _ => next(place - 1),
        };
        let start = axes.len();
        axes.extend(next(place).map(|(_, to, steps)| axis(to, steps)));
        axes.extend(before.map(|(from, _, steps)| axis(from, -steps)));
        axes[start..].sort_by(Axis::order);
        if axes[start..].iter().any(|axis| axis.vector == DVec2::ZERO) {
            return Err(Refusal::Coincident);
        }
        offsets.push(axes.len() as u32);
    }
    Ok(Some(Rows { offsets, axes }))
}
