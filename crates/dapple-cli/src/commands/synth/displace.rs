//! Displaces the geometry by the heights of the example.

use super::example_mesh::is_mesh;
use super::material::is_of;
use super::reading::Input;
use super::{Args, advise};
use crate::error::{Hint, usage};
use anyhow::Result;
use dapple::mesh::{Mesh, Model};
use dapple::points::glam::{DQuat, DVec3};
use dapple::raster::Raster;
use dapple::recipe::MapKind;
use dapple::synth::{Exemplar, SurfaceTexture, Synthesizer, displaced_mesh, displaced_sites};

impl Args {
    /// Refuses `--displace` without a height map.
    ///
    /// # Errors
    ///
    /// If `--displace` is given without a height map.
    pub(super) fn check_displacement(&self) -> Result<()> {
        let mut names = self.map.iter().map(|map| &map.name);
        if self.surface.displace.is_none() || names.any(|name| is_of(name, MapKind::Height)) {
            return Ok(());
        }
        Err(usage("--displace needs heights").hint("add --map height=FILE"))
    }

    /// Displaces the vertices of the mesh in a model, if `--displace` was given.
    ///
    /// If the material has a normal map, the mesh keeps its normals: the map already contains the slopes, and is
    /// relative to these normals. Otherwise, the normals of corners rotate with the normals of vertices, so that the
    /// creases stay the same.
    pub(super) fn displace_mesh(
        &self,
        model: &mut Model,
        synthesizer: &Synthesizer,
        texture: &SurfaceTexture,
        input: &Input,
    ) -> Result<()> {
        if let Some(length) = self.surface.displace {
            let heights = self.heights(texture, input)?;
            let mesh = displaced_mesh(synthesizer, &heights, length).map_err(advise)?;
            if let (None, Some(corners)) = (&model.material.normal, &mut model.corner_normals) {
                turn(corners, &model.mesh, &mesh);
            }
            model.mesh = mesh;
        }
        Ok(())
    }

    /// Displaces the sites in a model whose vertices are sites, if `--displace` was given. The sites get the normals of
    /// the displaced surface.
    pub(super) fn displace_sites(
        &self,
        model: &mut Model,
        synthesizer: &Synthesizer,
        texture: &SurfaceTexture,
        input: &Input,
    ) -> Result<()> {
        if let Some(length) = self.surface.displace {
            let heights = self.heights(texture, input)?;
            model.mesh = displaced_sites(synthesizer, &heights, length).map_err(advise)?;
            model.normals = Some(model.mesh.vertex_normals());
        }
        Ok(())
    }

    /// Returns the height at each site, looked up in the example's height map at the source of the site.
    fn heights(&self, texture: &SurfaceTexture, input: &Input) -> Result<Vec<f32>> {
        let mut maps = input.maps.iter();
        let found = maps.find(|(name, _)| is_of(name, MapKind::Height));
        let Some((_, height)) = found else {
            return Err(usage("--displace needs heights").hint("add --map height=FILE"));
        };
        let (size, edges) = (input.exemplar.size(), input.exemplar.edges());
        let values = height.numbers(&height.map)?;
        if is_mesh(&self.exemplar) {
            return Ok(texture.transfer(&values)?);
        }
        // With `--detail`, maps are as large as the larger example. Reduce them to the size of the exemplar.
        let factor = values.size()[0] / size[0];
        let reduced = Exemplar::from_planes(&[(&values, 1.0)], edges)?.reduced(factor)?;
        let reduced = Raster::from_vec(size, reduced.pixels().to_vec())?;
        Ok(texture.transfer(&reduced)?)
    }
}

/// Rotates corner normals by the rotation that takes the vertex normals of `from` to the vertex normals of `to`. Both
/// meshes have the same faces.
fn turn(corners: &mut [[DVec3; 3]], from: &Mesh, to: &Mesh) {
    let (before, after) = (from.vertex_normals(), to.vertex_normals());
    let turn = |(&before, &after): (&DVec3, &DVec3)| {
        if before.is_normalized() && after.is_normalized() {
            DQuat::from_rotation_arc(before, after)
        } else {
            DQuat::IDENTITY
        }
    };
    let turns: Vec<_> = before.iter().zip(&after).map(turn).collect();
    for (face, corners) in from.faces().iter().zip(corners) {
        for (vertex, corner) in face.iter().zip(corners) {
            *corner = (turns[vertex.index()] * *corner).normalize_or(*corner);
        }
    }
}
