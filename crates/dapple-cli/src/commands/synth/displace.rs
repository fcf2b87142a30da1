//! Geometry that the heights of the example move.

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
    /// Refuses a displacement without heights.
    ///
    /// # Errors
    ///
    /// If there is such.
    pub(super) fn check_displacement(&self) -> Result<()> {
        let mut names = self.map.iter().map(|map| &map.name);
        if self.surface.displace.is_none() || names.any(|name| is_of(name, MapKind::Height)) {
            return Ok(());
        }
        Err(usage("--displace needs heights").hint("add --map height=FILE"))
    }

    /// Moves the vertices of the mesh in a model, if that is asked for.
    ///
    /// With a map of normals, which already says the slopes, the mesh keeps the normals in whose frames that map is.
    /// Otherwise the normals of its corners turn as those of its vertices do, so that it has no other creases than before.
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

    /// Moves the sites in a model of them, if that is asked for; they get the normals of the new shape.
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

    /// The heights of all sites.
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
        // Beside a larger version of the example, maps have its size.
        let factor = values.size()[0] / size[0];
        let reduced = Exemplar::from_planes(&[(&values, 1.0)], edges)?.reduced(factor)?;
        let reduced = Raster::from_vec(size, reduced.pixels().to_vec())?;
        Ok(texture.transfer(&reduced)?)
    }
}

/// Turns the normals of corners as those of the vertices turn from one shape of a mesh to another.
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
