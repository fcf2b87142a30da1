//! The nearest-neighbor graph, and the nearest-first neighbor search that other graphs also use.

use crate::build::{Choice, EdgeDirection, graph_of};
use crate::delaunay::{Refusal, check};
use crate::grid::{Budget, Grid, TooThin};
use crate::lattice::{Lattice, check_distinct};
use crate::{Graph, GraphError, GraphErrorKind, IsCancelled};
use dapple_points::PointSet;
use glam::DVec2;

/// Creates the graph in which each point has axes to its `k` nearest neighbors.
///
/// Images count as separate neighbors, including images of the point itself. On a tie, the smaller index comes first,
/// then the smaller angle from the x axis.
///
#[cfg_attr(doc, doc = include_str!("../docs/k-nearest.md"))]
///
/// # Errors
///
/// [`GraphErrorKind::Neighbors`] if `k` is 0, above 4096, above the number of other points (on a rectangle), or above
/// ten times the number of points (on a wrapping domain); [`GraphErrorKind::Coincident`] if two points coincide;
/// [`GraphErrorKind::TooManyAxes`] for more than 2^32 axes; [`GraphErrorKind::Thin`] on a wrapping domain that is too
/// thin for the distance between its points.
///
/// # Examples
///
/// ```
/// use dapple_graph::{EdgeDirection, PointIdx, PointSet, glam::DVec2, k_nearest, points::Domain};
///
/// let positions = [(0.0, 0.0), (0.3, 0.0), (0.9, 0.0)].map(DVec2::from).to_vec();
/// let points = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::ONE), positions)?;
/// let graph = k_nearest(&points, 1, EdgeDirection::Directed)?;
/// assert_eq!(graph.axes(PointIdx(0))[0].to, PointIdx(2), "around the torus");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn k_nearest(points: &PointSet, k: u32, direction: EdgeDirection) -> Result<Graph, GraphError> {
    k_nearest_cancellable(points, k, direction, &|| false)
}

/// Same as [`k_nearest`], but fails if `is_cancelled` returns true. The callback is called about once per 256 points.
///
/// # Errors
///
/// Same as [`k_nearest`], plus [`GraphErrorKind::Cancelled`].
///
/// # Examples
///
/// ```
/// use dapple_graph::{EdgeDirection, GraphErrorKind, k_nearest_cancellable};
/// use dapple_graph::{glam::DVec2, points::{Domain, hash::Seed, white_noise}};
///
/// let points = white_noise(Domain::torus(DVec2::ZERO, DVec2::ONE), 1000, Seed(1))?;
/// let error = k_nearest_cancellable(&points, 6, EdgeDirection::Directed, &|| true).unwrap_err();
/// assert_eq!(error.kind(), &GraphErrorKind::Cancelled);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn k_nearest_cancellable(
    points: &PointSet,
    k: u32,
    direction: EdgeDirection,
    is_cancelled: &IsCancelled,
) -> Result<Graph, GraphError> {
    let lattice = Lattice::new(points.domain());
    let limit = if lattice.wraps() {
        MAX_NEIGHBORS.min(points.len().saturating_mul(10) as u32)
    } else {
        MAX_NEIGHBORS.min(points.len().saturating_sub(1) as u32)
    };
    if k == 0 || (k > limit && !points.is_empty()) {
        return Err(GraphError::new(GraphErrorKind::Neighbors { k, limit }));
    }
    let sites = lattice.sites(points);
    check_distinct(&sites)?;
    let grid = Grid::new(&lattice, &sites);
    let wanted = k as usize;
    let mut budget = Budget::new(sites.len());
    let rows = rows_of(&sites, is_cancelled, |site| {
        // A disc of this radius contains about twice the required number of neighbors.
        let mut radius = 0.8 * grid.mean_distance() * f64::from(k + 1).sqrt();
        loop {
            radius = radius.min(grid.farthest());
            let mut near = near(&grid, site, radius, &mut budget)?;
            if near.len() >= wanted || radius == grid.farthest() {
                near.truncate(wanted);
                return Ok(near);
            }
            radius *= 1.5;
        }
    });
    graph_of(lattice, sites, made(rows, points)?, direction)
}

/// Number of points between checks for cancellation. With the maximum number of neighbors, a point takes a tenth of a
/// millisecond.
const POINTS: usize = 256;

/// Collects the axes that `row` returns for each site, unless canceled.
pub(crate) fn rows_of(
    sites: &[DVec2],
    is_cancelled: &IsCancelled,
    mut row: impl FnMut(DVec2) -> Result<Vec<Choice>, TooThin>,
) -> Result<Vec<Vec<Choice>>, Refusal> {
    let mut rows = Vec::with_capacity(sites.len());
    for sites in sites.chunks(POINTS) {
        check(is_cancelled)?;
        for &site in sites {
            rows.push(row(site)?);
        }
    }
    Ok(rows)
}

/// Converts a [`Refusal`] to a graph error.
pub(crate) fn made<T>(rows: Result<T, Refusal>, points: &PointSet) -> Result<T, GraphError> {
    rows.map_err(|refusal| match refusal {
        Refusal::Cancelled => GraphError::new(GraphErrorKind::Cancelled),
        Refusal::Thin | Refusal::Coincident => GraphError::thin(points),
    })
}

/// Maximum number of neighbors.
const MAX_NEIGHBORS: u32 = 4096;

/// Returns all images within the given distance of a site, nearest first, without the site itself.
pub(crate) fn near(
    grid: &Grid<'_>,
    site: DVec2,
    radius: f64,
    budget: &mut Budget,
) -> Result<Vec<Choice>, TooThin> {
    let mut found: Vec<(i128, Choice)> = Vec::new();
    let radius_sq = (radius * radius) as i128;
    grid.visit_box(site - radius, site + radius, budget, |to, at| {
        let steps = at - site;
        let distance_sq = length_sq(steps);
        if distance_sq > 0 && distance_sq <= radius_sq {
            found.push((distance_sq, Choice { to, steps }));
        }
    })?;
    found.sort_unstable_by(|(a_sq, a), (b_sq, b)| {
        (a_sq.cmp(b_sq))
            .then(a.to.cmp(&b.to))
            .then_with(|| crate::angle::by_angle(a.steps, b.steps))
    });
    Ok(found.into_iter().map(|(_, choice)| choice).collect())
}

/// Returns the exact squared length in steps. Coordinates are integers below 2^53.
fn length_sq(steps: DVec2) -> i128 {
    let [x, y] = [steps.x, steps.y].map(|coordinate| coordinate as i128);
    x * x + y * y
}

#[cfg(test)]
mod tests {
    use crate::{EdgeDirection, Graph, GraphError, GraphErrorKind, IsCancelled};
    use crate::{k_nearest_cancellable, yao_cancellable};
    use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
    use dapple_points::{Domain, hash::Seed, white_noise};

    /// Function that creates a graph unless canceled.
    type Make<'a> = &'a dyn Fn(&IsCancelled) -> Result<Graph, GraphError>;

    #[test]
    fn searches_for_neighbors_can_be_cancelled_at_every_call() {
        let points = white_noise(Domain::paper_torus(), 2000, Seed(1)).unwrap();
        let makers: [Make<'_>; 2] = [
            &|stop| k_nearest_cancellable(&points, 5, EdgeDirection::Symmetric, stop),
            &|stop| yao_cancellable(&points, 6, EdgeDirection::Directed, stop),
        ];
        for make in makers {
            let whole = make(&|| false);
            // One call per 256 points
            for last in 0..=8 {
                let n_calls = AtomicUsize::new(0);
                let made = make(&|| n_calls.fetch_add(1, Relaxed) >= last);
                match last {
                    8 => assert_eq!(made, whole),
                    _ => assert_eq!(made.unwrap_err().kind(), &GraphErrorKind::Cancelled),
                }
                assert_eq!(n_calls.into_inner(), 8.min(last + 1));
            }
        }
    }
}
