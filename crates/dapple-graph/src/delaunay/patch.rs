//! A patch: a triangulated part of the periodic plane, and the graph rows for the points inside it.

use super::hull::Hull;
use super::images::{Cover, Missing};
use super::star::Star;
use super::triangulate::triangulate;
use super::{Refusal, check};
use crate::grid::{Budget, LazyGrid};
use crate::lattice::Lattice;
use crate::{Axis, IsCancelled};
use glam::DVec2;
use spade::handles::{FixedVertexHandle, VertexHandle};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// An image of a point: the point itself, or its copy in another period.
#[derive(Clone, Copy, Debug)]
pub(super) struct Image {
    pub(super) position: Point2<f64>,
    /// Index of the point.
    pub(super) point: u32,
    /// The image's row in the patch, or [`Image::FOREIGN`].
    pub(super) row: u32,
}

impl Image {
    /// Row of an image whose axes are not needed.
    pub(super) const FOREIGN: u32 = u32::MAX;

    pub(super) fn new(at: DVec2, point: u32, row: u32) -> Self {
        Self {
            position: Point2::new(at.x, at.y),
            point,
            row,
        }
    }
}

impl HasPosition for Image {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// A vertex of a patch.
pub(super) type Vertex<'a> = VertexHandle<'a, Image>;

/// The axes of a range of points as compressed rows. The axes of row `i` are `axes[offsets[i]..offsets[i + 1]]`.
#[derive(Debug)]
pub(super) struct Rows {
    pub(super) offsets: Vec<u32>,
    pub(super) axes: Vec<Axis>,
}

/// Number of stars that are read between two calls of the callback.
const STARS_PER_CALL: u32 = 1 << 16;

/// A triangulation of all images in a rectangle, and of some outside it.
pub(super) struct Patch<'a> {
    lattice: &'a Lattice,
    cover: Cover,
    triangulation: DelaunayTriangulation<Image>,
    /// Triangulation vertex of each row.
    vertices: Vec<FixedVertexHandle>,
}

impl<'a> Patch<'a> {
    /// Triangulates the images, `n_rows` of which have a row in the graph. `images` must contain all images in
    /// `cover`.
    pub(super) fn new(
        lattice: &'a Lattice,
        cover: Cover,
        images: &[Image],
        n_rows: usize,
        is_cancelled: &IsCancelled,
    ) -> Result<Self, Refusal> {
        let triangulation = triangulate(images, is_cancelled)?;
        let mut vertices = vec![FixedVertexHandle::from_index(0); n_rows];
        for vertex in triangulation.vertices() {
            let row = vertex.data().row;
            if row != Image::FOREIGN {
                vertices[row as usize] = vertex.fix();
            }
        }
        Ok(Self {
            lattice,
            cover,
            triangulation,
            vertices,
        })
    }

    /// Computes the axes of all points with a row, after inserting the missing images.
    pub(super) fn rows(
        &mut self,
        grid: &LazyGrid<'a>,
        hull: Option<&Hull>,
        budget: Budget,
        is_cancelled: &IsCancelled,
    ) -> Result<Rows, Refusal> {
        let mut star = Star::default();
        let mut rows = Rows {
            offsets: Vec::with_capacity(self.vertices.len() + 1),
            // The mean number of neighbors in a triangulation is below six.
            axes: Vec::with_capacity(6 * self.vertices.len() + 6),
        };
        rows.offsets.push(0);
        let mut doubtful = Vec::new();
        for (row, &vertex) in (0_u32..).zip(&self.vertices) {
            if row.is_multiple_of(STARS_PER_CALL) {
                check(is_cancelled)?;
            }
            let vertex = self.triangulation.vertex(vertex);
            star.read(vertex, self.cover.depth(at(vertex)));
            if self.cover.is_bounded() && star.is_doubtful() {
                doubtful.push(row);
            }
            star.push_axes(self.lattice, &mut rows.axes);
            rows.offsets.push(rows.axes.len() as u32);
        }
        let missing = Missing::new(self.lattice, self.cover, grid, hull, budget);
        if self.complete(&doubtful, missing, is_cancelled)? {
            rows = self.replaced(&rows, &doubtful);
        }
        Ok(rows)
    }

    /// Inserts images until the stars of the given rows are correct. Returns whether any image was inserted.
    fn complete(
        &mut self,
        doubtful: &[u32],
        mut missing: Missing<'_, 'a>,
        is_cancelled: &IsCancelled,
    ) -> Result<bool, Refusal> {
        let mut star = Star::default();
        let mut is_over = false;
        let mut changed = false;
        let mut doubtful = doubtful.to_vec();
        loop {
            // A star whose circumcircles contain no missing image is correct, and no other image affects it.
            doubtful.retain(|&row| {
                is_over = is_over || is_cancelled();
                if is_over {
                    return false;
                }
                let vertex = self.triangulation.vertex(self.vertices[row as usize]);
                star.read(vertex, f64::INFINITY);
                missing.search(row, at(vertex), &star)
            });
            if is_over {
                return Err(Refusal::Cancelled);
            }
            let found = missing.take()?;
            if found.is_empty() {
                return Ok(changed);
            }
            changed = true;
            for (image, row) in found {
                let near = self.vertices[row as usize];
                // Sites are finite integers, which are always accepted.
                let _ = self.triangulation.insert_with_hint(image, near);
            }
        }
    }

    /// Returns a copy of `rows` in which the rows `again` are read again from the triangulation.
    fn replaced(&self, rows: &Rows, again: &[u32]) -> Rows {
        let mut star = Star::default();
        let mut result = Rows {
            offsets: vec![0],
            axes: Vec::with_capacity(rows.axes.len()),
        };
        let mut again = again.iter().copied().peekable();
        for (row, &vertex) in (0..).zip(&self.vertices) {
            if again.next_if_eq(&row).is_some() {
                star.read(self.triangulation.vertex(vertex), f64::INFINITY);
                star.push_axes(self.lattice, &mut result.axes);
            } else {
                let [start, end] = [row as usize, row as usize + 1].map(|at| rows.offsets[at]);
                result
                    .axes
                    .extend_from_slice(&rows.axes[start as usize..end as usize]);
            }
            result.offsets.push(result.axes.len() as u32);
        }
        result
    }
}

/// Returns the position of a vertex.
fn at(vertex: Vertex<'_>) -> DVec2 {
    let position = vertex.position();
    DVec2::new(position.x, position.y)
}
