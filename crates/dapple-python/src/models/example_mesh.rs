//! Reads an example that is a textured mesh.

use super::{directions, own_uvs, uvs_of};
use crate::error::{Error, Result};
use crate::meshes::{mesh, plain};
use crate::options::{self, Vectors};
use dapple::mesh::glam::DVec2;
use dapple::mesh::{Mesh, Surface};
use dapple::synth::{Direction, Exemplar, HierarchyOptions, MeshExemplar, Synthesizer};
use pyo3::prelude::*;

/// A mesh used as the example: its texture coordinates, and the options for placing its sites.
pub(super) struct ExampleMesh {
    mesh: Mesh,
    uvs: Vec<[f64; 2]>,
    n_sites: Option<usize>,
    directions: Vec<Direction>,
}

impl ExampleMesh {
    /// Reads the mesh of an exemplar; `None` if it has none.
    pub(super) fn of(exemplar: options::Exemplar<'_>) -> Result<Option<Self>> {
        let (n_sites, directions) = (exemplar.sites, exemplar.directions);
        let Some(mesh) = exemplar.mesh else {
            if n_sites.is_some() || directions.is_some() {
                let message = "exemplar: sites and directions have no effect without mesh";
                return Err(Error::new("conflict", message));
            }
            return Ok(None);
        };
        Self::new(&mesh, "mesh of the exemplar", n_sites, directions).map(Some)
    }

    /// Reads a mesh and its texture directions. `name` is the name of the caller's argument in error messages.
    pub(super) fn new(
        of: &Bound<'_, PyAny>,
        name: &str,
        n_sites: Option<usize>,
        directions: Option<Vectors<'_>>,
    ) -> Result<Self> {
        let (of, _) = plain(of)?;
        Ok(Self {
            mesh: mesh(&of)?,
            uvs: uvs_of(name, &of)?,
            n_sites,
            directions: self::directions(directions)?,
        })
    }

    /// Places sites on the mesh and samples its texture. Returns the exemplar, and the texture coordinates of the
    /// repaired mesh. `sites` holds the options of the target mesh, which are used with a different seed.
    pub(super) fn textured(
        self,
        sites: &HierarchyOptions,
        texture: &Exemplar,
    ) -> Result<(MeshExemplar, Vec<[DVec2; 3]>)> {
        let (repaired, repair) = self.mesh.repair();
        let surface = Surface::new(repaired)?;
        let uvs = own_uvs(&surface, &self.mesh, &repair, &self.uvs)?;
        let sites = HierarchyOptions {
            n_sites: self.n_sites.unwrap_or(sites.n_sites),
            ..sites.clone()
        };
        let source = Synthesizer::new(surface, &self.directions, &sites)?;
        Ok((MeshExemplar::new(source, &uvs, texture)?, uvs))
    }
}
