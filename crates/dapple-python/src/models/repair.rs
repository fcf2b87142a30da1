//! Repairs the texture of a mesh.

use super::example_mesh::ExampleMesh;
use super::{bake, refuse_alpha};
use crate::error::Result;
use crate::options::Vectors;
use crate::seed::SeedArgument;
use crate::synthesis::{Exemplar, Matching, is_set};
use crate::watch;
use dapple::mesh::CREASE;
use dapple::raster::Raster;
use dapple::synth::{Atlas, HierarchyOptions, SynthError};
use dapple::tile::Map;
use pyo3::prelude::*;

/// Re-synthesizes part of a mesh's texture, such as a stain, from its surroundings on the mesh.
///
/// Parameters
/// ----------
/// mesh : mesh
///     Any object with `.vertices` (n, 3), `.faces` (m, 3) and `.uv` (m, 3, 2), v down, such as a `MeshFile` or a
///     `Model`.
/// texture : dict of array_like, array_like or Exemplar
///     (rows, columns), or (rows, columns, 3) in linear light, at the texture coordinates of the mesh; or a dictionary
///     of maps, of which the first is matched and the others follow it.
/// hole : array_like
///     (rows, columns), at least 0.5 where the texture is re-synthesized; nothing is copied from there.
/// sites : int, default 65536
///     The number of points on the surface that get a color, 1 to 2**28.
/// directions : tuple of array_like or None, default None
///     (positions, vectors), each (n, 3): the direction of the texture at these positions. Elsewhere directions are
///     interpolated; by default the texture points down.
/// seed : int, default 0
///     As for `synthesize`.
/// matching : Matching, dict or None, default None
///     How neighborhoods are compared; by default Matching(). More levels fill larger holes. Only `levels`,
///     `coherence`, `paper` and `axes` have an effect.
/// progress : callable or None, default None
///     As for `synthesize`.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The texture, in the same form as the input: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the mesh has no texture coordinates, the mask differs in size or leaves too little to copy from, or an
///     option is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> checker = np.kron([[0, 1], [1, 0]], np.ones((8, 8)))
/// >>> roof = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
/// >>> checker = dp.Exemplar(checker, edges="wrap")
/// >>> few = {"sites": 500, "matching": {"levels": 2}}
/// >>> model = dp.synthesize_on(roof, checker, atlas={"texels": 64}, **few)
/// >>> hole = np.hypot(*(np.indices((64, 64)) - 32)) < 8
/// >>> clean = dp.repair_on(model, np.where(hole, 0.5, model.texture), hole, **few)
/// >>> bool((clean == model.texture)[~hole].all())
/// True
#[pyfunction]
#[pyo3(signature = (mesh, texture, hole, *, sites = 65536, directions = None, seed = SeedArgument::default(),
    matching = None, progress = None),
    text_signature = "(mesh, texture, hole, *, sites=65536, directions=None, seed=0, matching=None, progress=None)")]
pub(crate) fn repair_on<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyAny>,
    texture: &Bound<'py, PyAny>,
    hole: &Bound<'py, PyAny>,
    sites: usize,
    directions: Option<Vectors<'py>>,
    seed: SeedArgument,
    matching: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let source = ExampleMesh::new(mesh, "mesh", None, directions)?;
    let texture = Exemplar::read_image("texture", texture)?;
    refuse_alpha(&texture.layout)?;
    let matching = Matching::read(py, matching, &["evenness", "guides", "method", "space"])?;
    let hole = is_set("hole", hole)?;
    let example = texture.matched(Some(&hole))?;
    let Exemplar { layout, maps, .. } = texture;
    let sites = HierarchyOptions {
        n_sites: sites,
        n_levels: matching.n_levels(),
        seed: seed.0.child("example sites", 0),
        ..HierarchyOptions::default()
    };
    let options = matching.options(seed)?;
    let mended = watch::run(py, progress, move |heard, _| -> Result<Vec<Map>> {
        let (exemplar, uvs) = source.textured(&sites, &example)?;
        let repaired = exemplar.repair(&options, heard)?;
        let surface = exemplar.source().surface();
        let size = hole.size();
        let atlas = Atlas::from_uvs(surface, &uvs, size, size[0].max(size[1]))?;
        let shading = surface.mesh().corner_normals(CREASE);
        let mended = maps.iter().map(|map| {
            let new = bake(exemplar.source(), &repaired, &atlas, &shading, map)?;
            within(&hole, map, &new)
        });
        Ok(mended.collect::<core::result::Result<_, SynthError>>()?)
    })??;
    layout.python(py, mended)
}

/// Returns a map with the texels of `new` in the hole and of `old` elsewhere.
fn within(hole: &Raster<bool>, old: &Map, new: &Map) -> core::result::Result<Map, SynthError> {
    Ok(match (old, new) {
        (Map::Value(old), Map::Value(new)) => Map::Value(mixed(hole, old, new)?),
        (Map::Color(old), Map::Color(new)) => Map::Color(mixed(hole, old, new)?),
        (Map::Normal(old), Map::Normal(new)) => Map::Normal(mixed(hole, old, new)?),
        (other, _) => other.clone(),
    })
}

fn mixed<T: Copy>(
    hole: &Raster<bool>,
    old: &Raster<T>,
    new: &Raster<T>,
) -> core::result::Result<Raster<T>, SynthError> {
    let new = hole.zip_map(new, |&is_made, &new| (is_made, new))?;
    let texel = |&(is_made, new): &(bool, T), &old: &T| if is_made { new } else { old };
    Ok(new.zip_map(old, texel)?)
}
