//! The Yao graph: the nearest neighbor in each of several cones.
//!
//! Reference: Andrew Chi-Chih Yao, "On Constructing Minimum Spanning Trees in k-Dimensional Spaces and Related
//! Problems", SIAM Journal on Computing 11(4), 1982, doi:10.1137/0211059. Caron and Mould suggest it as future work
//! for partition of unity parametrics.
//!
//! Cone `i` of `k` contains the directions from the angle `2π i / k` (included) to `2π (i + 1) / k`. The borders are
//! vectors that are computed once, equal for all points and on every machine. Borders along the axes are exact; the
//! others are rounded. An exact test decides on which side of a border a neighbor is.

use crate::angle::{by_angle, turn};
use crate::build::{Choice, EdgeDirection, graph_of};
use crate::grid::{Budget, Grid};
use crate::lattice::{Lattice, check_distinct};
use crate::nearest::{made, near, rows_of};
use crate::{Graph, GraphError, GraphErrorKind, IsCancelled};
use core::cmp::Ordering;
use core::f64::consts::TAU;
use dapple_points::PointSet;
use glam::DVec2;

/// Creates the Yao graph: each point has an axis to its nearest neighbor in each of `cones` equal cones, the first of
/// which starts at the x axis.
///
/// Images count as separate neighbors, including images of the point itself. On a tie, the neighbor with the smaller
/// index is chosen, then the one with the smaller angle. A point has no axis in an empty cone, which occurs at the
/// border of a domain that does not wrap.
///
#[cfg_attr(doc, doc = include_str!("../docs/yao.md"))]
///
/// # Errors
///
/// [`GraphErrorKind::Cones`] for zero cones or more than 32; [`GraphErrorKind::Coincident`] if two points coincide;
/// [`GraphErrorKind::TooManyAxes`] for more than 2^32 axes; [`GraphErrorKind::Thin`] on a wrapping domain that is too
/// thin for the distance between its points.
///
/// # Examples
///
/// ```
/// use dapple_graph::{EdgeDirection, PointIdx, PointSet, glam::DVec2, points::Domain, yao};
///
/// let points = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::ONE), vec![DVec2::ZERO])?;
/// let graph = yao(&points, 4, EdgeDirection::Directed)?;
/// assert_eq!(graph.axes(PointIdx(0)).len(), 4, "its own images");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn yao(points: &PointSet, cones: u32, direction: EdgeDirection) -> Result<Graph, GraphError> {
    yao_cancellable(points, cones, direction, &|| false)
}

/// Same as [`yao`], but fails if `is_cancelled` returns true. The callback is called about once per 256 points.
///
/// # Errors
///
/// Same as [`yao`], plus [`GraphErrorKind::Cancelled`].
pub fn yao_cancellable(
    points: &PointSet,
    cones: u32,
    direction: EdgeDirection,
    is_cancelled: &IsCancelled,
) -> Result<Graph, GraphError> {
    if cones == 0 || cones > MAX_CONES {
        return Err(GraphError::new(GraphErrorKind::Cones {
            cones,
            limit: MAX_CONES,
        }));
    }
    let borders: Vec<DVec2> = (0..cones).map(|index| border(index, cones)).collect();
    let lattice = Lattice::new(points.domain());
    let sites = lattice.sites(points);
    check_distinct(&sites)?;
    let grid = Grid::new(&lattice, &sites);
    let mut budget = Budget::new(sites.len());
    let rows = rows_of(&sites, is_cancelled, |site| {
        let mut radius = (2.0 * grid.mean_distance()).min(grid.farthest());
        loop {
            let chosen = nearest_per_cone(&near(&grid, site, radius, &mut budget)?, &borders);
            if chosen.iter().all(Option::is_some) || radius == grid.farthest() {
                return Ok(chosen.into_iter().flatten().collect());
            }
            radius = (2.0 * radius).min(grid.farthest());
        }
    });
    graph_of(lattice, sites, made(rows, points)?, direction)
}

/// Maximum number of cones.
const MAX_CONES: u32 = 32;

/// Returns the first neighbor in each cone; `None` for an empty cone.
fn nearest_per_cone(neighbors: &[Choice], borders: &[DVec2]) -> Vec<Option<Choice>> {
    let mut chosen = vec![None; borders.len()];
    let mut left = borders.len();
    for &neighbor in neighbors {
        // The first border is the x axis, where angles start, so no neighbor precedes it.
        let after = borders.partition_point(|&border| is_at_or_after(neighbor.steps, border));
        let slot: &mut Option<Choice> = &mut chosen[after - 1];
        if slot.is_none() {
            *slot = Some(neighbor);
            left -= 1;
            if left == 0 {
                break;
            }
        }
    }
    chosen
}

/// Returns whether the angle of `v` is at least the angle of `border`.
fn is_at_or_after(v: DVec2, border: DVec2) -> bool {
    turn(border, v) == 0.0 && v.dot(border) > 0.0 || by_angle(v, border) == Ordering::Greater
}

/// Returns the start direction of a cone; exact for multiples of a quarter turn.
fn border(index: u32, cones: u32) -> DVec2 {
    let quarter = 4 * index / cones;
    let rest = f64::from(4 * index % cones) / f64::from(4 * cones);
    let (sine, cosine) = libm::sincos(rest * TAU);
    let first = DVec2::new(cosine, sine);
    match quarter {
        0 => first,
        1 => DVec2::new(-first.y, first.x),
        2 => -first,
        _ => DVec2::new(first.y, -first.x),
    }
}
