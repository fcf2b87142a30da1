//! The Voronoi diagram of a point set, in the plane and on wrapping domains.
//!
//! Reference: Georges Voronoi, "Nouvelles applications des paramètres continus à la théorie des formes quadratiques",
//! Journal für die reine und angewandte Mathematik 134, 1908, <https://doi.org/10.1515/crll.1908.134.198>. The nearest
//! site is found by walking between neighbors, as in P. J. Green and R. Sibson ("Computing Dirichlet Tessellations in
//! the Plane", The Computer Journal 21(2), 1978, <https://doi.org/10.1093/comjnl/21.2.168>).
//!
//! The diagram is the dual of the Delaunay graph: each axis corresponds to a side of a cell, and each face to a
//! vertex, the circumcenter of its corners. The graph has no diagonals in faces of co-circular points, so vertices are
//! distinct and sides have positive length. All coordinates are relative to a site, so that cells on a torus need no
//! images.

use crate::angle::by_angle;
use crate::delaunay::triangles::{FaceAxis, visit_faces};
use crate::{Axis, Graph, GraphError, GraphErrorKind, delaunay};
use core::cmp::Ordering;
use dapple_points::{PointIdx, PointSet};
use glam::DVec2;

/// Index that stands for a missing vertex.
const NONE: u32 = u32::MAX;

/// The Voronoi diagram of a point set. It has a cell for each point (site), which contains all positions nearer to
/// this site than to any other.
///
/// On a torus every cell is a bounded polygon, in coordinates relative to its site. In the plane, the cells of sites
/// on the convex hull are unbounded: their outermost sides are rays, and [`VoronoiCell::clipped`] clips them. Four or
/// more sites on one empty circle share a single vertex.
///
/// # Examples
///
/// ```
/// use dapple_graph::points::{Domain, hash::Seed, jittered_grid};
/// use dapple_graph::{PointIdx, Voronoi, glam::DVec2};
///
/// let points = jittered_grid(Domain::torus(DVec2::ZERO, DVec2::ONE), [10, 10], 0.9, Seed(7))?;
/// let voronoi = Voronoi::new(&points)?;
/// let areas = (0..points.len() as u32).filter_map(|site| voronoi.cell(PointIdx(site)).area());
/// assert!((areas.sum::<f64>() - 1.0).abs() < 1e-12, "the cells cover the torus once");
///
/// // The cell at a position, searched from a cell nearby: that of the last query, for example.
/// let nearest = voronoi.locate([0.3, 0.9], PointIdx(0))?;
/// println!("site {}, {} away", nearest.site.0, nearest.offset.length());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Voronoi {
    graph: Graph,
    vertices: Vec<VoronoiVertex>,
    /// Sites around each vertex, vertex by vertex. `first_sites` has the index of each vertex's first site.
    vertex_sites: Vec<PointIdx>,
    first_sites: Vec<u32>,
    /// For each axis, the vertex on its left, or [`NONE`], relative to the start point of the axis.
    left: Vec<(u32, DVec2)>,
}

/// A vertex where three or more cells meet: the circumcenter of their sites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoronoiVertex {
    /// One of the nearest sites.
    pub site: PointIdx,
    /// Vector from that site to the vertex.
    pub offset: DVec2,
}

/// The cell of a site in a [`Voronoi`] diagram.
#[derive(Clone, Copy, Debug)]
pub struct VoronoiCell<'a> {
    voronoi: &'a Voronoi,
    site: PointIdx,
}

/// A side of a Voronoi cell: the positions that are equally near to two sites and farther from all others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoronoiSide {
    /// Axis of the Delaunay graph that leads to the site of the neighbor.
    pub neighbor: Axis,
    /// Vertices at both ends, counterclockwise (from the x axis toward the y axis) around the cell; `None` where the
    /// side is an unbounded ray.
    pub vertices: [Option<u32>; 2],
    /// Positions of both ends relative to the cell's site, counterclockwise; `None` for an end at infinity.
    pub ends: [Option<DVec2>; 2],
}

/// The site nearest to a queried position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestSite {
    /// The nearest site.
    pub site: PointIdx,
    /// Vector from the nearest image of the site to the position.
    pub offset: DVec2,
}

impl Voronoi {
    /// Computes the Voronoi diagram of the points from their [`delaunay`] graph.
    ///
    /// # Errors
    ///
    /// Same as [`delaunay`].
    pub fn new(points: &PointSet) -> Result<Self, GraphError> {
        Self::of_graph(delaunay(points)?)
    }

    /// Computes the Voronoi diagram that is dual to a Delaunay graph.
    ///
    /// # Errors
    ///
    /// [`GraphErrorKind::NotDelaunay`] unless the graph [was created as a Delaunay graph](Graph::is_delaunay).
    pub fn of_graph(graph: Graph) -> Result<Self, GraphError> {
        graph.check_delaunay()?;
        let mut vertices = Vec::new();
        let (mut vertex_sites, mut first_sites) = (Vec::new(), vec![0]);
        let mut left = vec![(NONE, DVec2::ZERO); graph.n_axes()];
        visit_faces(&graph, &|| false, |first, face| {
            let number = vertices.len() as u32;
            // Track the vertex relative to the current corner while walking around the face.
            let mut offset = graph.lattice.vector(circumcenter(&graph, face));
            vertices.push(VoronoiVertex {
                site: first,
                offset,
            });
            vertex_sites.push(first);
            for (at, &FaceAxis { index, axis }) in face.iter().enumerate() {
                left[index] = (number, offset);
                offset -= axis.vector;
                if at + 1 < face.len() {
                    vertex_sites.push(axis.to);
                }
            }
            first_sites.push(vertex_sites.len() as u32);
        })?;
        Ok(Self {
            graph,
            vertices,
            vertex_sites,
            first_sites,
            left,
        })
    }

    /// Returns the dual Delaunay graph.
    #[must_use]
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Returns the number of cells, one per site.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.graph.n_points()
    }

    /// Returns all vertices.
    #[must_use]
    pub fn vertices(&self) -> &[VoronoiVertex] {
        &self.vertices
    }

    /// Returns the sites whose cells meet at a vertex, counterclockwise around it. On a domain that wraps, a site
    /// occurs once per image of its cell at the vertex.
    ///
    /// # Panics
    ///
    /// If the vertex does not exist.
    #[must_use]
    pub fn vertex_sites(&self, vertex: u32) -> &[PointIdx] {
        let at = vertex as usize;
        &self.vertex_sites[self.first_sites[at] as usize..self.first_sites[at + 1] as usize]
    }

    /// Returns the cell of a site.
    ///
    /// # Panics
    ///
    /// If the site does not exist.
    #[must_use]
    pub fn cell(&self, site: PointIdx) -> VoronoiCell<'_> {
        assert!(
            site.index() < self.n_cells(),
            "site {} of {}",
            site.0,
            self.n_cells()
        );
        VoronoiCell {
            voronoi: self,
            site,
        }
    }

    /// Finds the site nearest to a position by walking from the site `hint` to ever nearer neighbors.
    ///
    /// The position is snapped like points (see [`Graph`]), and distances are compared exactly. On a tie, this is the
    /// site with the lowest index, and of its images the one with the smallest angle of `offset` from the x axis in
    /// `[0, 2π)`. The hint affects only the running time, which grows with the number of cells between the hint and
    /// the result.
    ///
    /// # Errors
    ///
    /// [`GraphErrorKind::Outside`] for a position that is not finite or is outside the domain along an axis that does
    /// not wrap; [`GraphErrorKind::NotThere`] if the site `hint` does not exist.
    pub fn locate(
        &self,
        position: impl Into<[f64; 2]>,
        hint: PointIdx,
    ) -> Result<NearestSite, GraphError> {
        let position = DVec2::from(position.into());
        let n_points = self.n_cells();
        let lattice = &self.graph.lattice;
        let outside = GraphErrorKind::Outside { position };
        let place = lattice.place(position).ok_or(GraphError::new(outside))?;
        if hint.index() >= n_points {
            let kind = GraphErrorKind::NotThere {
                point: hint,
                n_points,
            };
            return Err(GraphError::new(kind));
        }
        let mut best = Step {
            site: hint,
            steps: lattice.delta(self.graph.sites[hint.index()], place),
        };
        while let Some(nearer) = self.nearest_neighbor(&best) {
            best = nearer;
        }
        best = self.first_of_equals(best);
        Ok(NearestSite {
            site: best.site,
            offset: lattice.vector(best.steps),
        })
    }

    /// Returns the neighbor nearest to the position; `None` if no neighbor is nearer than the site itself.
    fn nearest_neighbor(&self, from: &Step) -> Option<Step> {
        let mut best = None;
        let mut best_sq = from.distance_sq();
        for next in self.neighbors(from) {
            let next_sq = next.distance_sq();
            if next_sq < best_sq {
                (best, best_sq) = (Some(next), next_sq);
            }
        }
        best
    }

    /// Returns the first, by index and then by angle, of all sites at the same minimum distance as `start`. These
    /// sites are on an empty circle, along which neighbors are connected.
    fn first_of_equals(&self, start: Step) -> Step {
        let mut equals = vec![start];
        let mut at = 0;
        while at < equals.len() {
            let from = equals[at];
            at += 1;
            for next in self.neighbors(&from) {
                if next.distance_sq() == start.distance_sq() && !equals.contains(&next) {
                    equals.push(next);
                }
            }
        }
        equals.into_iter().min_by(Step::order).unwrap_or(start)
    }

    /// Returns the neighbors of a site, each with its vector to the searched position.
    fn neighbors<'a>(&'a self, from: &'a Step) -> impl Iterator<Item = Step> + 'a {
        let axes = self.graph.axes(from.site).iter();
        axes.map(move |axis| Step {
            site: axis.to,
            steps: from.steps - self.graph.lattice.steps(axis.vector),
        })
    }
}

/// A site, and the vector from one of its images to the searched position, in lattice steps.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    site: PointIdx,
    steps: DVec2,
}

impl Step {
    /// Returns the exact squared distance: steps are integers below 2^53.
    fn distance_sq(&self) -> i128 {
        let [x, y] = self.steps.to_array().map(|part| part as i128);
        x * x + y * y
    }

    fn order(&self, other: &Self) -> Ordering {
        let by_site = self.site.cmp(&other.site);
        by_site.then_with(|| by_angle(self.steps, other.steps))
    }
}

impl<'a> VoronoiCell<'a> {
    /// Returns the cell's site.
    #[must_use]
    pub fn site(&self) -> PointIdx {
        self.site
    }

    /// Returns the site's position, snapped as described in [`Graph`].
    #[must_use]
    pub fn position(&self) -> DVec2 {
        let graph = &self.voronoi.graph;
        graph.lattice.position(graph.sites[self.site.index()])
    }

    /// Returns the sides of the cell, counterclockwise (from the x axis toward the y axis), one per neighbor. On a
    /// torus, two cells may share several sides, and a cell may be its own neighbor.
    pub fn sides(&self) -> impl ExactSizeIterator<Item = VoronoiSide> + 'a {
        let voronoi = self.voronoi;
        let axes = voronoi.graph.axes(self.site);
        let start = voronoi.graph.offsets[self.site.index()] as usize;
        axes.iter().enumerate().map(move |(at, &neighbor)| {
            let before = (at + axes.len() - 1) % axes.len();
            let ends = [before, at].map(|at| voronoi.left[start + at]);
            VoronoiSide {
                neighbor,
                vertices: ends.map(|(vertex, _)| (vertex != NONE).then_some(vertex)),
                ends: ends.map(|(vertex, offset)| (vertex != NONE).then_some(offset)),
            }
        })
    }

    /// Returns whether the cell is a bounded polygon. In the plane, cells of sites on the convex hull are unbounded.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        let mut sides = self.sides();
        // The cell of a single site in the plane is the whole plane and has no sides.
        sides.len() > 0 && sides.all(|side| side.ends[0].is_some() && side.ends[1].is_some())
    }

    /// Returns the corners of the cell, counterclockwise and relative to its site; `None` for an unbounded cell.
    #[must_use]
    pub fn polygon(&self) -> Option<Vec<DVec2>> {
        if !self.is_bounded() {
            return None;
        }
        self.sides().map(|side| side.ends[1]).collect()
    }

    /// Returns the area of the cell; `None` for an unbounded cell.
    #[must_use]
    pub fn area(&self) -> Option<f64> {
        self.polygon().map(|corners| area(&corners))
    }

    /// Clips the cell to the rectangle from `min` to `max`, in the coordinates of the points. Returns the corners,
    /// counterclockwise and relative to the site; empty if the cell does not intersect the rectangle.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_graph::{PointIdx, PointSet, Voronoi, glam::DVec2, points::Domain};
    ///
    /// let positions = vec![DVec2::new(0.25, 0.5), DVec2::new(0.75, 0.5)];
    /// let points = PointSet::new(Domain::rectangle(DVec2::ZERO, DVec2::ONE), positions)?;
    /// let voronoi = Voronoi::new(&points)?;
    /// let cell = voronoi.cell(PointIdx(0));
    /// assert_eq!(cell.polygon(), None, "half of the plane");
    /// let corners = cell.clipped([0.0, 0.0], [1.0, 1.0]);
    /// let corners: Vec<[f64; 2]> = corners.iter().map(|&corner| (cell.position() + corner).into()).collect();
    /// assert_eq!(corners, [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn clipped(&self, min: impl Into<[f64; 2]>, max: impl Into<[f64; 2]>) -> Vec<DVec2> {
        let position = self.position();
        let [min, max] = [min.into(), max.into()].map(|corner| DVec2::from(corner) - position);
        if !min.cmplt(max).all() {
            return Vec::new();
        }
        let mut corners = vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        for axis in self.voronoi.graph.axes(self.site) {
            corners = cut(&corners, axis.vector);
        }
        corners
    }
}

impl VoronoiSide {
    /// Returns the direction of the side, counterclockwise around its cell; the vector is as long as the axis to the
    /// neighbor. A side without a start comes from infinity in this direction, and a side without an end extends to
    /// infinity in it. A side without either is the line through the midpoint of the axis.
    #[must_use]
    pub fn direction(&self) -> DVec2 {
        self.neighbor.vector.perp()
    }
}

/// Clips a convex polygon to the origin's side of the bisector between the origin and a neighbor (I. E. Sutherland
/// and G. W. Hodgman, "Reentrant Polygon Clipping", Communications of the ACM 17(1), 1974).
fn cut(corners: &[DVec2], neighbor: DVec2) -> Vec<DVec2> {
    // Positive beyond the bisector
    let beyond = |corner: DVec2| (corner - 0.5 * neighbor).dot(neighbor);
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (at, &to) in corners.iter().enumerate() {
        let from = corners[(at + corners.len() - 1) % corners.len()];
        let (before, after) = (beyond(from), beyond(to));
        if (before > 0.0) != (after > 0.0) {
            kept.push(from + (to - from) * (before / (before - after)));
        }
        if after <= 0.0 {
            kept.push(to);
        }
    }
    kept
}

/// Returns the area of a polygon, given its corners.
fn area(corners: &[DVec2]) -> f64 {
    let [first, rest @ ..] = corners else {
        return 0.0;
    };
    // Sum the triangles at the first corner.
    let pairs = rest.windows(2);
    0.5 * pairs
        .map(|pair| (pair[0] - first).perp_dot(pair[1] - first))
        .sum::<f64>()
}

/// Returns the circumcenter of a face, in steps relative to the face's first corner.
///
/// The determinant is exact. The corner opposite to the longest edge of a triangle is used as the origin, since this
/// avoids cancellation of nearly equal products: the error is below 10^-15 circumradii, however thin the triangle is.
fn circumcenter(graph: &Graph, face: &[FaceAxis]) -> DVec2 {
    let steps = |at: usize| graph.lattice.steps(face[at].axis.vector);
    let corners = [DVec2::ZERO, steps(0), steps(0) + steps(1)];
    let edge_sq = |at: usize| corners[(at + 1) % 3].distance_squared(corners[(at + 2) % 3]);
    let mut origin = 0;
    for at in 1..3 {
        if edge_sq(at) > edge_sq(origin) {
            origin = at;
        }
    }
    let b = corners[(origin + 1) % 3] - corners[origin];
    let c = corners[(origin + 2) % 3] - corners[origin];
    let [bx, by, cx, cy] = [b.x, b.y, c.x, c.y].map(|part| part as i128);
    let twice = 2.0 * (bx * cy - by * cx) as f64;
    let (b_sq, c_sq) = (b.length_squared(), c.length_squared());
    let center = DVec2::new(c.y * b_sq - b.y * c_sq, b.x * c_sq - c.x * b_sq) / twice;
    corners[origin] + center
}
