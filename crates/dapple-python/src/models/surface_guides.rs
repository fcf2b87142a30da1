//! The options `guides` and `scales` of synthesis on a mesh, which vary over the surface.

use crate::error::{Error, Result};
use crate::options::Guide;
use crate::pictures;
use dapple::mesh::glam::DVec2;
use dapple::mesh::{Mesh, Repair, VertexIdx};
use dapple::raster::{Raster, Wrap};
use dapple::synth::{Exemplar, Synthesizer};
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLikeDyn};
use pyo3::prelude::*;

/// The guides, with their values in the example and on the mesh.
pub(super) struct SurfaceGuides {
    of_example: Vec<(Raster<f32>, f32)>,
    of_mesh: Vec<OfMesh>,
}

/// Scales of the texture on a mesh.
pub(super) enum SurfaceScales {
    /// Scales between two bounds, derived from the directions.
    Conformal([f32; 2]),
    OfMesh(OfMesh),
}

/// A scalar that varies over a mesh.
pub(super) enum OfMesh {
    /// A number for each vertex, interpolated within faces.
    Vertices(Vec<f32>),
    /// An image, sampled at the mesh's own texture coordinates; it repeats.
    Image(Raster<f32>),
}

impl SurfaceGuides {
    /// Reads the guides.
    pub(super) fn read(guides: &[Guide<'_>]) -> Result<Self> {
        let (mut of_example, mut of_mesh) = (Vec::new(), Vec::new());
        for (example, mesh, weight) in guides {
            of_example.push((pictures::numbers("guides", example)?, *weight));
            of_mesh.push(OfMesh::read("guides", mesh)?);
        }
        Ok(Self {
            of_example,
            of_mesh,
        })
    }

    /// Returns whether any guide is an image, which is sampled at texture coordinates.
    pub(super) fn have_images(&self) -> bool {
        self.of_mesh.iter().any(OfMesh::is_image)
    }

    /// Returns an error unless every list of vertex values has as many numbers as the mesh has vertices.
    pub(super) fn check(&self, mesh: &Mesh) -> Result<()> {
        self.of_mesh
            .iter()
            .try_for_each(|guide| guide.check("a guide", mesh))
    }

    /// Adds the guides' values in the example to an exemplar, as channels with weights.
    pub(super) fn of_example(&self, exemplar: Exemplar) -> Result<Exemplar> {
        let planes = self.of_example.iter();
        let planes: Vec<_> = planes.map(|(plane, weight)| (plane, *weight)).collect();
        Ok(exemplar.with_guides(&planes)?)
    }

    /// Returns the values of each guide at the sites.
    pub(super) fn at_sites(&self, sites: &SitesOfMesh<'_>) -> Result<Vec<Vec<f32>>> {
        self.of_mesh
            .iter()
            .map(|guide| guide.at_sites(sites))
            .collect()
    }
}

impl SurfaceScales {
    /// Reads the scales: two bounds, or numbers on the mesh.
    pub(super) fn read(scales: &Bound<'_, PyAny>) -> Result<Self> {
        Ok(match bounds(scales) {
            Some(bounds) => Self::Conformal(bounds),
            None => Self::OfMesh(OfMesh::read("scales", scales)?),
        })
    }

    /// Returns whether the scales are an image, which is sampled at texture coordinates.
    pub(super) fn are_image(&self) -> bool {
        matches!(self, Self::OfMesh(numbers) if numbers.is_image())
    }

    /// Returns an error unless a list of vertex values has as many numbers as the mesh has vertices.
    pub(super) fn check(&self, mesh: &Mesh) -> Result<()> {
        match self {
            Self::Conformal(_) => Ok(()),
            Self::OfMesh(numbers) => numbers.check("the list of scales", mesh),
        }
    }

    /// Returns a synthesizer with these scales at its sites.
    pub(super) fn scaled(
        &self,
        synthesizer: Synthesizer,
        mesh: &Mesh,
        repair: &Repair,
        uvs: &[[DVec2; 3]],
    ) -> Result<Synthesizer> {
        let scales = match self {
            Self::Conformal(bounds) => return Ok(synthesizer.with_conformal_scales(*bounds)?),
            Self::OfMesh(numbers) => numbers.at_sites(&SitesOfMesh {
                synthesizer: &synthesizer,
                before: mesh,
                repair,
                uvs,
            })?,
        };
        Ok(synthesizer.with_scales(scales)?)
    }
}

/// Reads two numbers as bounds; `None` for other data, such as an image or one number per vertex.
pub(super) fn bounds(scales: &Bound<'_, PyAny>) -> Option<[f32; 2]> {
    let numbers: PyArrayLike1<'_, f32, AllowTypeChange> = scales.extract().ok()?;
    numbers.as_array().to_vec().try_into().ok()
}

/// Sites on a repaired mesh, together with the mesh before its repair.
pub(super) struct SitesOfMesh<'a> {
    pub(super) synthesizer: &'a Synthesizer,
    pub(super) before: &'a Mesh,
    pub(super) repair: &'a Repair,
    /// Texture coordinates of all face corners; empty if no image is sampled.
    pub(super) uvs: &'a [[DVec2; 3]],
}

impl OfMesh {
    fn read(name: &str, numbers: &Bound<'_, PyAny>) -> Result<Self> {
        let array: PyArrayLikeDyn<'_, f32, AllowTypeChange> = numbers.extract()?;
        let array = array.as_array();
        Ok(match array.ndim() {
            1 => Self::Vertices(array.iter().copied().collect()),
            _ => Self::Image(pictures::numbers(name, numbers)?),
        })
    }

    fn is_image(&self) -> bool {
        matches!(self, Self::Image(_))
    }

    fn check(&self, what: &str, mesh: &Mesh) -> Result<()> {
        let n_vertices = mesh.positions().len();
        match self {
            Self::Vertices(numbers) if numbers.len() != n_vertices => {
                let message = format!(
                    "{what} has {} numbers, but the mesh has {n_vertices} vertices",
                    numbers.len()
                );
                Err(Error::new("count", message))
            }
            _ => Ok(()),
        }
    }

    /// Returns the values at the sites.
    pub(super) fn at_sites(&self, sites: &SitesOfMesh<'_>) -> Result<Vec<f32>> {
        let SitesOfMesh { before, repair, .. } = *sites;
        let surface = sites.synthesizer.surface();
        let points = sites.synthesizer.hierarchy().sites().points();
        match self {
            Self::Vertices(numbers) => {
                let number = |vertex: VertexIdx| f64::from(numbers[vertex.index()]);
                let faces = before.faces().iter();
                let own: Vec<_> = faces.map(|face| face.map(number)).collect();
                let own = repair.corners_before(before, surface.mesh(), &own);
                let whole = own.map(|[a, b, c]| Some([a?, b?, c?]));
                let corners: Vec<[f64; 3]> = whole.collect::<Option<_>>().ok_or_else(|| {
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
            Self::Image(image) => {
                let size = image.size().map(f64::from);
                let shown = points.iter().map(|&point| {
                    let corners = sites.uvs[point.face.index()].iter();
                    let parts = corners.zip(surface.weights(point));
                    let uv = parts.map(|(&uv, weight)| uv * weight).sum::<DVec2>();
                    let [column, row] =
                        [uv.x * size[0], uv.y * size[1]].map(|at| at.floor() as i64);
                    *image.at(column, row, [Wrap::Repeat; 2])
                });
                Ok(shown.collect())
            }
        }
    }
}
