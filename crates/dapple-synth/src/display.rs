//! Exports the two displays of the paper as models: the sites with their colors, and the input mesh with a texture map.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, section 6,
//! <https://doi.org/10.1145/383259.383297>. `M_1` is a graph, not a mesh;
//! [`Hierarchy::triangles`](crate::Hierarchy::triangles) explains how it is triangulated. The caller can change the
//! fields of a [`Model`], for example to replace its mesh with a [displaced](crate::displaced_mesh) one.

use crate::maps::check_column;
use crate::{Atlas, SynthError, SynthErrorKind, Synthesizer};
use dapple_color::LinearRgba;
use dapple_mesh::{EncodedImage, Mesh, Model, Surface};
use glam::{DVec2, DVec3};

/// Exports the first display: the triangles of the finest sites, with a color per site.
///
/// # Errors
///
/// [`SynthErrorKind::Count`] unless `colors` has one color per site.
///
/// # Examples
///
/// ```
/// use dapple_color::{LinearRgb, LinearRgba};
/// use dapple_synth::mesh::{Mesh, Surface, glam::DVec3};
/// use dapple_synth::{HierarchyOptions, Synthesizer, point_model, site_model};
///
/// let sites = HierarchyOptions { n_sites: 2000, ..Default::default() };
/// // A tetrahedron; `dapple_mesh_io::read_model` reads yours.
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = Mesh::new(corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let covered = Synthesizer::new(Surface::new(mesh)?, &[], &sites)?;
/// let colors = vec![LinearRgba::opaque(LinearRgb::gray(0.5)); 2000];
/// let (triangles, points) = (site_model(&covered, colors.clone())?, point_model(&covered, colors)?);
/// assert!(triangles.mesh.faces().len() > 3000);
/// assert_eq!(triangles.mesh.positions(), points.mesh.positions());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn site_model(synthesizer: &Synthesizer, colors: Vec<LinearRgba>) -> Result<Model, SynthError> {
    let mesh = synthesizer.hierarchy().triangles(0)?.mesh;
    sites(synthesizer, mesh, colors)
}

/// Exports the finest sites as a point cloud with normals and a color per point.
///
/// [`Orientation::vectors`](crate::Orientation::vectors) has the directions of the texture in the same order. To draw
/// the points as touching discs, use a radius of about half of [`Level::spacing`](crate::Level::spacing).
///
/// # Errors
///
/// Same as [`site_model`].
pub fn point_model(
    synthesizer: &Synthesizer,
    colors: Vec<LinearRgba>,
) -> Result<Model, SynthError> {
    let positions = synthesizer.hierarchy().sites().positions();
    let mesh = Mesh::new(positions.to_vec(), &[])?;
    sites(synthesizer, mesh, colors)
}

/// Exports the second display: the input mesh with a texture map in the layout of an atlas. `base_color` is the map's
/// encoded image.
///
/// Every corner of every face has its own texture coordinates and its own normal. `shading` holds the normals, from the
/// mesh's file or from [`Mesh::corner_normals`]. Further maps go into the model's [`material`](Model::material). Faces
/// that are not in the map show its first corner. Mipmaps are disabled for layouts of tiles, whose coarse levels mix
/// faces that are far apart, and enabled for charts and for the caller's layouts.
///
/// # Errors
///
/// [`SynthErrorKind::Count`] if the atlas or the normals have a different number of faces than the surface.
///
/// # Examples
///
/// ```
/// use dapple_color::LinearRgb;
/// use dapple_image::{Transfer, encode_png};
/// use dapple_mesh_io::gltf;
/// use dapple_synth::mesh::{CREASE, EncodedImage, Mesh, glam::DVec3};
/// use dapple_raster::Raster;
/// use dapple_synth::{Atlas, Edges, Exemplar, HierarchyOptions, Options, bake_colors, synthesize, textured_model};
///
/// let image = Raster::filled([16, 16], LinearRgb::gray(0.2))?;
/// let exemplar = Exemplar::new(&image, Edges::Wrap)?;
/// let sites = HierarchyOptions { n_sites: 500, ..Default::default() };
/// // A tetrahedron; `dapple_mesh_io::read_model` reads yours.
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = Mesh::new(corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let (covered, texture) = synthesize(mesh, &exemplar, &[], &sites, &Options::default())?;
/// let atlas = Atlas::uniform(covered.surface(), 128)?;
/// let map = bake_colors(&covered, &texture, &image, &atlas)?;
/// let png = encode_png(map.map(|color| color.to_srgb::<u8>()).view(), Transfer::Srgb)?;
/// let shading = covered.surface().mesh().corner_normals(CREASE);
/// let model = textured_model(covered.surface(), &atlas, shading, EncodedImage::new(png)?)?;
/// let glb = gltf::write(&model)?;
/// assert!(glb.starts_with(b"glTF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn textured_model(
    surface: &Surface,
    atlas: &Atlas,
    shading: Vec<[DVec3; 3]>,
    base_color: EncodedImage,
) -> Result<Model, SynthError> {
    check_shading(surface, &shading)?;
    let uvs = atlas.uvs();
    if uvs.len() != surface.mesh().faces().len() {
        return Err(SynthError::new(SynthErrorKind::Count {
            what: "faces with texture coordinates",
            count: uvs.len(),
            needed: "as many as the mesh has",
        }));
    }
    // Faces that are not in the map have NaN, which files do not allow.
    let placed = |uv: DVec2| if uv.is_finite() { uv } else { DVec2::ZERO };
    let mut model = Model::from(surface.mesh().clone());
    model.uvs = Some(uvs.into_iter().map(|face| face.map(placed)).collect());
    model.corner_normals = Some(shading);
    model.material.base_color = Some(base_color);
    model.material.mipmaps = atlas.mipmaps();
    Ok(model)
}

/// Returns an error unless `shading` has normals for each face.
pub(crate) fn check_shading(surface: &Surface, shading: &[[DVec3; 3]]) -> Result<(), SynthError> {
    if shading.len() == surface.mesh().faces().len() {
        return Ok(());
    }
    Err(SynthError::new(SynthErrorKind::Count {
        what: "faces with normals",
        count: shading.len(),
        needed: "as many as the mesh has",
    }))
}

/// Builds a model whose vertices are the finest sites.
fn sites(
    synthesizer: &Synthesizer,
    mesh: Mesh,
    colors: Vec<LinearRgba>,
) -> Result<Model, SynthError> {
    check_column(synthesizer, "colors", colors.len())?;
    let normals = synthesizer.hierarchy().sites().normals();
    let mut model = Model::from(mesh);
    model.colors = Some(colors);
    model.normals = Some(normals.to_vec());
    Ok(model)
}

#[cfg(test)]
mod tests;
