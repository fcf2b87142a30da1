//! Computes the triangles of a Delaunay graph by traversing its faces axis by axis.
//!
//! Every face except the outer one is inscribed in an empty circle. A face with more than three corners is a polygon,
//! which is divided into a fan.

use super::delaunay_cancellable;
use crate::IsCancelled;
use crate::angle::turn;
use crate::{Axis, Graph, GraphError, GraphErrorKind};
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

/// A triangle of points, or of images of points on a domain that wraps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Points at the corners, counterclockwise (from the x axis toward the y axis).
    pub corners: [PointIdx; 3],
    /// Vectors from the first corner to the images of the second and third, in the units of the positions.
    pub sides: [DVec2; 2],
}

/// Computes the triangles of the Delaunay triangulation, whose circumcircles contain no other point or image of a
/// point.
///
/// On a torus there are twice as many triangles as points, and they cover it once. If more than three points are on an
/// empty circle, the triangulation is not unique: their polygon is divided by the diagonals from one of them.
///
/// # Errors
///
/// Same as [`delaunay`](crate::delaunay).
///
/// # Examples
///
/// ```
/// use dapple_graph::{PointSet, delaunay_triangles, glam::DVec2, points::Domain};
///
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
/// let positions = square.map(DVec2::from).to_vec();
/// let points = PointSet::new(Domain::rectangle(DVec2::ZERO, DVec2::ONE), positions)?;
/// let corners = delaunay_triangles(&points)?.into_iter().map(|triangle| triangle.corners.map(|point| point.0));
/// assert_eq!(corners.collect::<Vec<_>>(), [[0, 1, 2], [0, 2, 3]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn delaunay_triangles(points: &PointSet) -> Result<Vec<Triangle>, GraphError> {
    delaunay_triangles_cancellable(points, &|| false)
}

/// Same as [`delaunay_triangles`], but fails if `is_cancelled` returns true. The callback is called as in
/// [`delaunay_cancellable`].
///
/// # Errors
///
/// Same as [`delaunay_cancellable`].
pub fn delaunay_triangles_cancellable(
    points: &PointSet,
    is_cancelled: &IsCancelled,
) -> Result<Vec<Triangle>, GraphError> {
    delaunay_cancellable(points, is_cancelled)?.triangles_cancellable(is_cancelled)
}

impl Graph {
    /// Computes the triangles of a Delaunay graph. They equal the result of [`delaunay_triangles`] for its points.
    ///
    /// # Errors
    ///
    /// [`GraphErrorKind::NotDelaunay`](crate::GraphErrorKind::NotDelaunay) unless the graph [was created as a Delaunay
    /// graph](Self::is_delaunay).
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_graph::points::{Domain, hash::Seed, white_noise};
    /// use dapple_graph::{delaunay, delaunay_triangles};
    ///
    /// let points = white_noise(Domain::paper_torus(), 100, Seed(7))?;
    /// let graph = delaunay(&points)?;
    /// assert_eq!(graph.triangles()?, delaunay_triangles(&points)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn triangles(&self) -> Result<Vec<Triangle>, GraphError> {
        self.triangles_cancellable(&|| false)
    }

    fn triangles_cancellable(
        &self,
        is_cancelled: &IsCancelled,
    ) -> Result<Vec<Triangle>, GraphError> {
        self.check_delaunay()?;
        let mut triangles = Vec::with_capacity(2 * self.n_points());
        visit_faces(self, is_cancelled, |first, face| {
            push_fan(first, face, &mut triangles);
        })?;
        Ok(triangles)
    }
}

/// Calls `visit` for every face that is inscribed in an empty circle, with its first point and the axes around it,
/// counterclockwise (from the x axis toward the y axis). Skips the outer face. Calls the callback once per 65,536 points.
pub(crate) fn visit_faces(
    graph: &Graph,
    is_cancelled: &IsCancelled,
    mut visit: impl FnMut(PointIdx, &[FaceAxis]),
) -> Result<(), GraphError> {
    let next = next_around_faces(graph, is_cancelled)?;
    let mut is_walked = vec![false; graph.n_axes()];
    let mut face: Vec<FaceAxis> = Vec::new();
    for first in (0..graph.n_points() as u32).map(PointIdx) {
        check_at(first, is_cancelled)?;
        let start = graph.offsets[first.index()] as usize;
        for index in start..start + graph.axes(first).len() {
            face.clear();
            let mut at = index;
            while !is_walked[at] {
                is_walked[at] = true;
                face.push(FaceAxis {
                    index: at,
                    axis: graph.axes[at],
                });
                at = next[at] as usize;
            }
            let [a, b, ..] = &face[..] else {
                continue;
            };
            // All corners of an inner face turn one way; corners of the outer face turn the other way or are
            // collinear.
            let steps = |axis: &FaceAxis| graph.lattice.steps(axis.axis.vector);
            if turn(steps(a), steps(b)) > 0.0 {
                visit(first, &face);
            }
        }
    }
    Ok(())
}

/// Fails if the caller's callback, which is called for one point of 65,536, cancels.
fn check_at(point: PointIdx, is_cancelled: &IsCancelled) -> Result<(), GraphError> {
    match point.0.is_multiple_of(1 << 16) && is_cancelled() {
        true => Err(GraphError::new(GraphErrorKind::Cancelled)),
        false => Ok(()),
    }
}

/// An axis on the border of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceAxis {
    /// Index of the axis among all axes of the graph.
    pub(crate) index: usize,
    pub(crate) axis: Axis,
}

/// Returns, for each axis, the next axis around its face, counterclockwise (from the x axis toward the y axis).
fn next_around_faces(graph: &Graph, is_cancelled: &IsCancelled) -> Result<Vec<u32>, GraphError> {
    let next = |from: PointIdx, axis: &Axis| {
        let row = graph.axes(axis.to);
        let is_back = |back: &Axis| back.to == from && back.vector == -axis.vector;
        // The graph is symmetric, so the opposite axis exists.
        let back = row.iter().position(is_back).unwrap_or(0);
        graph.offsets[axis.to.index()] + ((back + row.len() - 1) % row.len()) as u32
    };
    let mut around = Vec::with_capacity(graph.n_axes());
    for from in (0..graph.n_points() as u32).map(PointIdx) {
        check_at(from, is_cancelled)?;
        around.extend(graph.axes(from).iter().map(|axis| next(from, axis)));
    }
    Ok(around)
}

/// Divides a face into triangles at its first corner.
fn push_fan(first: PointIdx, face: &[FaceAxis], triangles: &mut Vec<Triangle>) {
    let mut corner = face[0].axis;
    let mut side = corner.vector;
    for FaceAxis { axis, .. } in &face[1..face.len() - 1] {
        triangles.push(Triangle {
            corners: [first, corner.to, axis.to],
            sides: [side, side + axis.vector],
        });
        corner = *axis;
        side += axis.vector;
    }
}

#[cfg(test)]
mod tests {
    use super::{Triangle, delaunay_triangles};
    use crate::{GraphErrorKind, delaunay, gabriel};
    use dapple_points::hash::Seed;
    use dapple_points::{Domain, PointSet, white_noise};
    use glam::DVec2;
    use robust::{Coord, incircle};

    fn domain(wrap: [bool; 2]) -> Domain {
        let torus = Domain::torus(DVec2::new(-1.0, 2.0), DVec2::new(2.0, 1.0));
        Domain { wrap, ..torus }
    }

    fn area(triangle: &Triangle) -> f64 {
        0.5 * triangle.sides[0].perp_dot(triangle.sides[1])
    }

    #[test]
    fn triangles_cover_the_torus_once_and_hold_no_other_point() {
        for n_points in [1, 2, 3, 10, 400] {
            let points = white_noise(domain([true; 2]), n_points, Seed(5)).unwrap();
            let triangles = delaunay_triangles(&points).unwrap();
            assert_eq!(triangles.len(), 2 * points.len());
            assert!(triangles.iter().all(|triangle| area(triangle) > 0.0));
            let covered: f64 = triangles.iter().map(area).sum();
            // Tolerance: a few hundred roundings.
            assert!((covered - 2.0).abs() < 1e-12, "{covered}");
            for triangle in triangles.iter().take(50) {
                let [a, b, c] = triangle.corners.map(|corner| points.position(corner));
                let [to_b, to_c] = triangle.sides;
                let wrapped = points.domain().wrap(a + to_b) - b;
                // Sites are snapped to 2^-50.
                let whole = (wrapped / points.domain().size).fract().abs();
                assert!(whole.min_element() < 1e-12, "{triangle:?}");
                for &other in points
                    .positions()
                    .iter()
                    .filter(|&&p| ![a, b, c].contains(&p))
                {
                    let delta = points.domain().delta(a, other);
                    let coord = |at: DVec2| Coord { x: at.x, y: at.y };
                    let inside =
                        incircle(coord(DVec2::ZERO), coord(to_b), coord(to_c), coord(delta));
                    assert!(inside < 1e-12, "{triangle:?} holds {other}");
                }
            }
        }
    }

    #[test]
    fn triangles_in_the_plane_and_on_a_cylinder_fulfill_eulers_formula() {
        for wrap in [[false; 2], [true, false], [false, true]] {
            let points = white_noise(domain(wrap), 300, Seed(6)).unwrap();
            let triangles = delaunay_triangles(&points).unwrap();
            let n_edges = delaunay(&points).unwrap().n_axes() / 2;
            // A disc has V - E + F = 1, a strip around a cylinder 0.
            let characteristic = usize::from(wrap == [false; 2]);
            assert_eq!(
                points.len() + triangles.len(),
                n_edges + characteristic,
                "{wrap:?}"
            );
        }
    }

    #[test]
    fn graphs_that_were_not_made_as_delaunay_graphs_have_no_triangles() {
        let points = white_noise(domain([true; 2]), 60, Seed(5)).unwrap();
        let graph = delaunay(&points).unwrap();
        assert_eq!(
            graph.triangles().unwrap(),
            delaunay_triangles(&points).unwrap()
        );
        let other = gabriel(&points).unwrap();
        assert!(!other.is_delaunay());
        assert_eq!(
            other.triangles().unwrap_err().kind(),
            &GraphErrorKind::NotDelaunay
        );
    }

    #[test]
    fn squares_are_cut_in_two_and_points_on_a_line_have_no_triangles() {
        let grid: Vec<DVec2> = (0..12)
            .map(|i| DVec2::new(f64::from(i % 4), f64::from(i / 4)))
            .collect();
        let size = DVec2::new(4.0, 3.0);
        let torus = PointSet::new(Domain::torus(DVec2::ZERO, size), grid.clone()).unwrap();
        assert_eq!(delaunay_triangles(&torus).unwrap().len(), 24);
        let plane = PointSet::new(Domain::rectangle(DVec2::ZERO, size), grid.clone()).unwrap();
        assert_eq!(delaunay_triangles(&plane).unwrap().len(), 12);
        let line = PointSet::new(Domain::rectangle(DVec2::ZERO, size), grid[..4].to_vec()).unwrap();
        assert_eq!(delaunay_triangles(&line).unwrap(), []);
    }
}
