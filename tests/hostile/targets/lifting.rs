//! The target for synthesis on meshes, also from the texture of a mesh: arbitrary meshes, scales, texture coordinates
//! and masks.

use super::accepted;
use super::bytes::Bytes;
use core::ops::ControlFlow;
use dapple::mesh::glam::{DVec2, DVec3};
use dapple::mesh::{Mesh, Surface};
use dapple::raster::Raster;
use dapple::synth::{
    Atlas, Edges, Exemplar, HierarchyOptions, MeshExemplar, Options, SurfaceTexture, SynthError,
    Synthesizer, bake_values,
};

/// Maximum number of vertices. The constants below limit the numbers of faces and sites.
const MOST_VERTICES: u8 = 8;
const MOST_FACES: u8 = 12;
const MOST_SITES: u8 = 64;
/// Side of the example and of the baked map, in pixels.
const SIDE: u32 = 16;
const MAP_SIDE: u32 = 64;

/// Synthesizes a texture on a mesh from an image or from the mesh's own texture, or repairs that texture. The input
/// must be rejected, or all baked values must be within the range of the example.
pub fn lift(bytes: &[u8]) {
    let mut bytes = Bytes(bytes);
    let choice = bytes.byte();
    let options = Options {
        n_levels: 1 + usize::from(choice & 1),
        ..Options::default()
    };
    let edges = if choice & 2 == 0 {
        Edges::Cut
    } else {
        Edges::Wrap
    };
    let Some(synthesizer) = synthesizer(&mut bytes, options.n_levels) else {
        return;
    };
    let synthesizer = if choice & 32 == 0 {
        synthesizer
    } else {
        let bounds = [(); 2].map(|()| bytes.number() as f32);
        let Some(scaled) = accepted(synthesizer.with_conformal_scales(bounds)) else {
            return;
        };
        scaled
    };
    let faces = synthesizer.surface().mesh().faces().iter();
    let uvs = faces.map(|_| [(); 3].map(|()| DVec2::new(bytes.number(), bytes.number())));
    let uvs: Vec<_> = uvs.collect();
    let value = |column, row| (column * 7 + row * 3) as f32 % 16.0 / 15.0;
    let texture = Raster::from_fn([SIDE; 2], value).expect("a small raster");
    let texture_of_planes = Exemplar::from_planes(&[(&texture, 1.0)], edges);
    let mut example = texture_of_planes.expect("finite values");
    if choice & 4 != 0 {
        let rows = [bytes.byte(), bytes.byte()];
        let is_used = |column: u32, row: u32| rows[row as usize % 2] >> (column % 8) & 1 != 0;
        let mask = Raster::from_fn([SIDE; 2], is_used).expect("a small raster");
        let Some(masked) = accepted(example.with_mask(&mask)) else {
            return;
        };
        example = masked;
    }
    let go_on = |_| ControlFlow::Continue(());
    let made = if choice & 16 == 0 {
        let of_mesh = MeshExemplar::new(synthesizer.clone(), &uvs, &example);
        let Some(example) = accepted(of_mesh) else {
            return;
        };
        match choice & 8 {
            0 => synthesizer.lift(&example, &[], &options, go_on),
            _ => example.repair(&options, go_on),
        }
    } else {
        synthesizer.synthesize_with(&example, &options, go_on)
    };
    if let Some(made) = accepted(made)
        && let Some(map) = accepted(baked(&synthesizer, &made, &texture))
    {
        let is_between = |value: &f32| (0.0..=1.0).contains(value);
        assert!(map.pixels().iter().all(is_between), "values of no texture");
    }
}

/// Builds a small mesh with sites; `None` if it is rejected.
fn synthesizer(bytes: &mut Bytes<'_>, n_levels: usize) -> Option<Synthesizer> {
    let [n_vertices, n_faces, n_sites] =
        [MOST_VERTICES, MOST_FACES, MOST_SITES].map(|most| 1 + bytes.byte() % most);
    let mut position = |_| DVec3::new(bytes.number(), bytes.number(), bytes.number());
    let positions: Vec<_> = (0..n_vertices).map(&mut position).collect();
    let faces: Vec<_> = (0..n_faces)
        .map(|_| [(); 3].map(|()| u32::from(bytes.byte() % n_vertices)))
        .collect();
    let (mesh, _) = accepted(Mesh::new(positions, &faces))?.repair();
    let surface = accepted(Surface::new(mesh))?;
    let sites = HierarchyOptions {
        n_sites: n_sites.into(),
        n_levels,
        ..HierarchyOptions::default()
    };
    accepted(Synthesizer::new(surface, &[], &sites))
}

/// Bakes the texture to a texture map for the mesh.
fn baked(
    synthesizer: &Synthesizer,
    made: &SurfaceTexture,
    texture: &Raster<f32>,
) -> Result<Raster<f32>, SynthError> {
    let atlas = Atlas::uniform(synthesizer.surface(), MAP_SIDE)?;
    bake_values(synthesizer, made, texture, &atlas)
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    // The corner coordinates of a tetrahedron, as the codes for 0 and 1.
    let corners = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let seed = |choice: u8| {
        let mut seed = vec![choice, 3, 3, 47];
        seed.extend(corners.as_flattened());
        seed.extend(faces.as_flattened());
        if choice & 32 != 0 {
            seed.extend([4, 5]); // From 0.5 to 2.
        }
        // Texture coordinates from 0 to 1, each as a code and two bytes with the number.
        seed.extend((0..24_u8).flat_map(|at| [200, at, at.wrapping_mul(53)]));
        seed.extend([0xf0, 0x7e]);
        seed
    };
    (0..64).map(seed).collect()
}
