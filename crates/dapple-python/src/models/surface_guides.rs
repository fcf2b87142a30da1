//! The argument `guides` of a texture on a mesh.

use super::{at_corners, own_uvs};
use crate::error::{Error, Result};
use crate::pictures;
use dapple::mesh::glam::DVec2;
use dapple::mesh::{FaceIdx, Mesh, Repair};
use dapple::raster::{Raster, Wrap};
use dapple::synth::{Exemplar, Synthesizer};
use numpy::{AllowTypeChange, PyArrayLikeDyn};
use pyo3::prelude::*;

/// A guide as the caller gives it: that of the example, that of the mesh, and the weight.
pub(super) type Guide<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, f32);

/// The guides of an example and of the mesh that it covers.
pub(super) struct SurfaceGuides {
    of_example: Vec<(Raster<f32>, f32)>,
    of_mesh: Vec<OfMesh>,
}

/// A number for each place on a mesh.
enum OfMesh {
    /// One for each vertex, and in between those of the corners mixed.
    Vertices(Vec<f32>),
    /// An image that repeats, at the mesh's own texture coordinates.
    Image(Raster<f32>),
}

impl SurfaceGuides {
    /// Reads the guides.
    pub(super) fn read(guides: &[Guide<'_>]) -> Result<Self> {
        let (mut of_example, mut of_mesh) = (Vec::new(), Vec::new());
        for (example, mesh, weight) in guides {
            of_example.push((pictures::numbers("guides", example)?, *weight));
            let numbers: PyArrayLikeDyn<'_, f32, AllowTypeChange> = mesh.extract()?;
            let numbers = numbers.as_array();
            of_mesh.push(match numbers.ndim() {
                1 => OfMesh::Vertices(numbers.iter().copied().collect()),
                _ => OfMesh::Image(pictures::numbers("guides", mesh)?),
            });
        }
        Ok(Self {
            of_example,
            of_mesh,
        })
    }

    /// Whether texture coordinates are needed.
    pub(super) fn have_images(&self) -> bool {
        let is_image = |guide: &OfMesh| matches!(guide, OfMesh::Image(_));
        self.of_mesh.iter().any(is_image)
    }

    /// Refuses numbers for another number of vertices than the mesh has.
    pub(super) fn check(&self, mesh: &Mesh) -> Result<()> {
        let n_vertices = mesh.positions().len();
        for guide in &self.of_mesh {
            if let OfMesh::Vertices(numbers) = guide
                && numbers.len() != n_vertices
            {
                let message = format!(
                    "a guide has {} numbers, but the mesh has {n_vertices} vertices",
                    numbers.len()
                );
                return Err(Error::new("count", message));
            }
        }
        Ok(())
    }

    /// An example with its guides.
    pub(super) fn of_example(&self, exemplar: Exemplar) -> Result<Exemplar> {
        let planes = self.of_example.iter();
        let planes: Vec<_> = planes.map(|(plane, weight)| (plane, *weight)).collect();
        Ok(exemplar.with_guides(&planes)?)
    }

    /// The numbers of each guide at the sites on a mesh that was repaired.
    pub(super) fn at_sites(
        &self,
        synthesizer: &Synthesizer,
        before: &Mesh,
        repair: &Repair,
        uvs: &[[f64; 2]],
    ) -> Result<Vec<Vec<f32>>> {
        let surface = synthesizer.surface();
        let uvs = match self.have_images() {
            true => own_uvs(surface, before, repair, uvs)?,
            false => Vec::new(),
        };
        let points = synthesizer.hierarchy().sites().points();
        let column = |guide: &OfMesh| match guide {
            OfMesh::Vertices(numbers) => {
                let number = |face: FaceIdx, corner: usize| {
                    let vertex = before.faces()[face.index()][corner];
                    f64::from(numbers[vertex.index()])
                };
                let corners = at_corners(surface, before, repair, number).ok_or_else(|| {
                    Error::new(
                        "guides",
                        "a face was cut in repair, and the numbers of its vertices are gone",
                    )
                })?;
                let mixed = points.iter().map(|&point| {
                    let corners = corners[point.face.index()].iter();
                    let parts = corners.zip(surface.weights(point));
                    parts.map(|(&number, weight)| number * weight).sum::<f64>() as f32
                });
                Ok(mixed.collect())
            }
            OfMesh::Image(image) => {
                let size = image.size().map(f64::from);
                let shown = points.iter().map(|&point| {
                    let corners = uvs[point.face.index()].iter();
                    let parts = corners.zip(surface.weights(point));
                    let uv = parts.map(|(&uv, weight)| uv * weight).sum::<DVec2>();
                    let [column, row] =
                        [uv.x * size[0], uv.y * size[1]].map(|at| at.floor() as i64);
                    *image.at(column, row, [Wrap::Repeat; 2])
                });
                Ok(shown.collect())
            }
        };
        self.of_mesh.iter().map(column).collect()
    }
}
