//! Measures an entire run, from an OBJ file in memory to a GLB file with a texture map.

use super::scene::{self, Model, N_SITES};
use anyhow::Result;
use dapple_image::{Transfer, encode_png};
use dapple_mesh::{CREASE, EncodedImage, Mesh};
use dapple_mesh_io::{gltf, obj};
use dapple_synth::{Atlas, Exemplar, Options, bake, textured_model};

/// Width and height of the texture map in texels.
const MAP_SIDE: u32 = 2048;

/// Result of a whole run.
#[derive(Debug, PartialEq)]
pub(super) struct Written {
    /// GLB file with the texture map.
    pub(super) glb: Vec<u8>,
    /// Fraction of the texture map that is covered by faces.
    pub(super) coverage: f64,
}

/// Reads a model, synthesizes a texture on it, bakes the texture, and writes the model with the map.
pub(super) fn run(model: &Model, exemplar: &Exemplar, options: &Options) -> Result<Written> {
    let synthesizer = scene::synthesizer(model, N_SITES, options.n_levels)?;
    let texture = synthesizer.synthesize(exemplar, options)?;
    let surface = synthesizer.surface();
    let atlas = Atlas::uniform(surface, MAP_SIDE)?;
    let values = texture.values(0);
    let map = bake::<3>(surface, synthesizer.hierarchy(), values, &atlas, [0.0; 3])?;
    let code = |value: f32| (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let codes = map.map(|values| values.map(code));
    let png = encode_png(codes.view(), Transfer::Srgb)?;
    let shading = surface.mesh().corner_normals(CREASE);
    let model = textured_model(surface, &atlas, shading, EncodedImage::new(png)?)?;
    Ok(Written {
        glb: gltf::write(&model)?,
        coverage: atlas.coverage(),
    })
}

/// Reads the mesh of an OBJ file and repairs it.
pub(super) fn read_obj(bytes: &[u8]) -> Result<Mesh> {
    let (mesh, _) = obj::read(bytes)?.mesh.repair();
    Ok(mesh)
}
