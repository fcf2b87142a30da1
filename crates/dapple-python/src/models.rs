//! Textures that are synthesized on meshes.

mod along;
mod example_mesh;
mod repair;
mod surface_guides;

use crate::data;
use crate::error::{Error, Result};
use crate::images::encode;
use crate::meshes::{corners, faces, positions, vectors};
use crate::pictures::{self, Content, Kind, Layout};
use crate::seed::SeedArgument;
use crate::synthesis::{Coherence, Matching, check_sizes, exemplar};
use crate::{threads, watch};
pub(crate) use along::synthesize_along;
use dapple::color::{Code, LinearRgb, LinearRgba, NormalY};
use dapple::image::{Depth, Encoding};
use dapple::mesh::glam::{DVec2, DVec3};
use dapple::mesh::{CREASE, EncodedImage, FaceIdx, Mesh, Repair, Surface};
use dapple::mesh_io::{self, MaterialPlace, MeshFormat};
use dapple::raster::Raster;
use dapple::synth::{
    Atlas, Axes, Direction, Hierarchy, HierarchyOptions, Orientation, SurfaceTexture, Symmetry,
    SynthError, Synthesizer, bake_colors, bake_normals, bake_values, site_model, textured_model,
};
use dapple::tile::Map;
use example_mesh::ExampleMesh;
use pyo3::prelude::*;
use pyo3::types::PyDict;
pub(crate) use repair::repair_on;
use std::path::PathBuf;
use surface_guides::{Guide, SitesOfMesh, SurfaceGuides, SurfaceScales};

dapple::raster::named! {
    /// The layout of a mesh in a texture.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum AtlasKind {
        /// Large pieces of the surface, each flattened as a whole.
        Charts = "charts",
        /// Right triangles whose sizes follow the areas of the faces.
        Area = "area",
        /// Right triangles of one size, as in the paper.
        Uniform = "uniform",
        /// The mesh's own texture coordinates.
        Uv = "uv",
    }
}

/// A mesh with a synthesized texture, and the maps that follow it. Made by `synthesize_on`.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct Model {
    synthesizer: Synthesizer,
    atlas: Atlas,
    shading: Vec<[DVec3; 3]>,
    is_double_sided: bool,
    layout: Layout,
    /// The maps of the atlas, in the order of the layout.
    baked: Vec<Map>,
    /// The colors of the sites.
    colors: Vec<LinearRgba>,
}

/// Covers a mesh with a texture that looks like an example, after Turk (2001): points on the surface take pixels of the
/// example.
///
/// Faults of the mesh are repaired first.
///
/// Parameters
/// ----------
/// mesh : anything with `.vertices` (n, 3) and `.faces` (m, 3), such as a `trimesh.Trimesh`, or a pair of such arrays.
/// exemplar : (rows, columns), or (rows, columns, 3) in linear light; or a dictionary of maps, of which the first is matched and
///     the others follow it: `normal` and `orm` go into the material of the files, too.
/// texels : the side of the square texture in pixels, up to 16384.
/// sites : the number of points of the surface that get a color, 1 to 2**28.
/// directions : (positions, vectors), each (n, 3): the direction of the example's down at these positions; in between
///     they are interpolated.
/// down : the direction for pieces of the surface without any.
/// symmetry : how many directions at a place are as good as each other: 2 for examples that look alike upside down, such as
///     bricks, and 4 for those that look alike lying on their side, such as a checker; the texture then has fewer tears.
/// atlas : the layout of faces: `"charts"` (large pieces), `"area"` (triangles by their areas), `"uniform"`, or `"uv"` (`mesh.uv`, (m, 3, 2), v down).
/// padding : the number of pixels around each piece of the texture that continue it.
/// crease : the angle of an edge in degrees above which it is shaded as a crease.
/// axes : how neighborhoods continue over the surface: `"followed"` or `"carried"`.
/// scales : how large a pixel of the example is, in distances of points, from 1/8 to 8, by default 1: a number for each vertex,
///     (n,), or an image that is read at `mesh.uv` and repeats, (rows, columns). Or two bounds, between which sizes follow the
///     directions: features grow where these spread and shrink where they meet, and so they go on there.
/// matching : the values that are compared, `"appearance"` by default, or `"colors"` as in the paper; always colors with
///     `example_mesh`.
/// guides : a list of (of_example, of_mesh, weight): numbers in the size of the example, and for the mesh a number for each
///     vertex, (n,), or an image that is read at `mesh.uv` and repeats, (rows, columns); parts of the example go where both
///     are alike. Weights are as for `synthesize`, and `evenness` has no effect.
/// example_mesh : the mesh that `exemplar` is the texture of, with `.uv` (m, 3, 2), v down, such as a `MeshFile` or a `Model`:
///     its texture is lifted onto the other mesh. The `"auto"` of `coherence` is 2 then.
/// example_sites : the number of points of `example_mesh`, by default `sites`: more make its features larger.
/// example_directions : (positions, vectors) on `example_mesh`, like `directions`: where nothing else is said, its texture runs down.
/// seed, edges, levels, coherence, evenness, paper, progress : as for `synthesize`.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> checker = np.kron([[0, 1], [1, 0]], np.ones((8, 8)))
/// >>> roof = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
/// >>> model = dp.synthesize_on(roof, checker, texels=64, sites=500, edges="wrap", levels=2)
/// >>> model.texture.shape, model.uv.shape
/// ((64, 64), (2, 3, 2))
#[pyfunction]
#[pyo3(signature = (mesh, exemplar, *, texels = 1024, sites = 65536, directions = None, down = [0.0, -1.0, 0.0], symmetry = 1,
    scales = None, atlas = "charts", padding = None, crease = None, axes = None, matching = None, seed = SeedArgument::default(), edges = "cut", levels = 3,
    coherence = None, evenness = None, paper = false, guides = Vec::new(), example_mesh = None, example_sites = None,
    example_directions = None, progress = None),
    text_signature = "(mesh, exemplar, *, texels=1024, sites=65536, directions=None, down=(0.0, -1.0, 0.0), symmetry=1, scales=None, atlas=\"charts\", \
    padding=None, crease=30.0, axes=None, matching=None, seed=0, edges=\"cut\", levels=3, coherence=None, evenness=None, paper=False, \
    guides=(), example_mesh=None, example_sites=None, example_directions=None, progress=None)")]
pub(crate) fn synthesize_on<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyAny>,
    exemplar: &Bound<'py, PyAny>,
    texels: u32,
    sites: usize,
    directions: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>,
    down: [f64; 3],
    symmetry: u8,
    scales: Option<&Bound<'py, PyAny>>,
    atlas: &str,
    padding: Option<u32>,
    crease: Option<f64>,
    axes: Option<&str>,
    matching: Option<&str>,
    seed: SeedArgument,
    edges: &str,
    levels: usize,
    coherence: Option<Coherence>,
    evenness: Option<f32>,
    paper: bool,
    guides: Vec<Guide<'py>>,
    example_mesh: Option<&Bound<'py, PyAny>>,
    example_sites: Option<usize>,
    example_directions: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)>,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Model> {
    let atlas = data::named("atlas", atlas)?;
    let guides = SurfaceGuides::read(&guides)?;
    let scales = scales.map(SurfaceScales::read).transpose()?;
    let needs_uvs = atlas == AtlasKind::Uv
        || guides.have_images()
        || scales.as_ref().is_some_and(SurfaceScales::are_image);
    let uvs = match needs_uvs {
        true => uvs_of("mesh", mesh)?,
        false => Vec::new(),
    };
    let mesh = crate::meshes::mesh(mesh)?;
    guides.check(&mesh)?;
    scales.iter().try_for_each(|scales| scales.check(&mesh))?;
    let (layout, maps) = pictures::read("exemplar", exemplar)?;
    check_sizes(&maps)?;
    refuse_alpha(&layout)?;
    let example = guides.of_example(self::exemplar(&maps, edges)?)?;
    let example_mesh = ExampleMesh::read(example_mesh, example_sites, example_directions)?;
    let options = Matching {
        seed,
        levels,
        coherence,
        evenness,
        axes: axes
            .map(|axes| data::named::<Axes>("axes", axes))
            .transpose()?,
        matching: matching
            .map(|matching| data::named("matching", matching))
            .transpose()?,
        paper,
    };
    let [hierarchy, sites_of_example] = ["sites", "example sites"].map(|name| HierarchyOptions {
        n_sites: sites,
        n_levels: levels,
        seed: seed.0.child(name, 0),
        ..HierarchyOptions::default()
    });
    let options = options.options()?;
    let directions = self::directions(directions)?;
    let symmetry: Symmetry = data::named("symmetry", &symmetry.to_string())?;
    let crease = crease.map_or(CREASE, f64::to_radians);
    let cover = |heard: watch::Heard<'_>| -> Result<Model> {
        let (repaired, repair) = mesh.repair();
        let surface = Surface::new(repaired)?;
        let uvs = match needs_uvs {
            true => own_uvs(&surface, &mesh, &repair, &uvs)?,
            false => Vec::new(),
        };
        let atlas = match (atlas, padding) {
            (AtlasKind::Charts, None) => Atlas::charts(&surface, texels)?,
            (AtlasKind::Charts, Some(padding)) => Atlas::charts_padded(&surface, texels, padding)?,
            (AtlasKind::Area, None) => Atlas::by_area(&surface, texels)?,
            (AtlasKind::Area, Some(padding)) => Atlas::by_area_padded(&surface, texels, padding)?,
            (AtlasKind::Uniform, None) => Atlas::uniform(&surface, texels)?,
            (AtlasKind::Uniform, Some(padding)) => {
                Atlas::uniform_padded(&surface, texels, padding)?
            }
            (AtlasKind::Uv, padding) => {
                Atlas::from_uvs(&surface, &uvs, [texels; 2], padding.unwrap_or(texels))?
            }
        };
        let shading = surface.mesh().corner_normals(crease);
        let is_double_sided = repair.before.back_to_back_faces > 0;
        let hierarchy = Hierarchy::new(&surface, &hierarchy)?;
        let orientation = Orientation::symmetric(&hierarchy, &directions, down.into(), symmetry)?;
        let mut synthesizer = Synthesizer::from_parts(surface, hierarchy, orientation, None)?;
        if let Some(scales) = &scales {
            synthesizer = scales.scaled(synthesizer, &mesh, &repair, &uvs)?;
        }
        let columns = guides.at_sites(&SitesOfMesh {
            synthesizer: &synthesizer,
            before: &mesh,
            repair: &repair,
            uvs: &uvs,
        })?;
        let columns: Vec<_> = columns.iter().map(Vec::as_slice).collect();
        let texture = match example_mesh {
            None => synthesizer.synthesize_guided(&example, &columns, &options, heard)?,
            Some(source) => {
                let (lifted, _) = source.textured(&sites_of_example, &example)?;
                synthesizer.lift(&lifted, &columns, &options, heard)?
            }
        };
        let bake = |map: &Map| bake(&synthesizer, &texture, &atlas, &shading, map);
        let baked = maps
            .iter()
            .map(bake)
            .collect::<core::result::Result<_, _>>()?;
        Ok(Model {
            colors: site_colors(&texture, &maps[0])?,
            synthesizer,
            atlas,
            shading,
            is_double_sided,
            layout,
            baked,
        })
    };
    watch::run(py, progress, cover)?
}

/// Refuses colors with alpha, which is not baked.
fn refuse_alpha(layout: &Layout) -> Result<()> {
    let has_alpha = |kind: &Kind| kind.content == Content::Color && kind.n_channels == 4;
    if layout.kinds.iter().any(has_alpha) {
        let message = "the texture cannot keep alpha: give three channels";
        return Err(Error::new("channels", message));
    }
    Ok(())
}

/// Reads the directions of a texture at positions.
fn directions(directions: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>) -> Result<Vec<Direction>> {
    let Some((positions, at_each)) = directions else {
        return Ok(Vec::new());
    };
    let positions = vectors::<3>("positions of directions", &positions, &[3])?;
    let at_each = vectors::<3>("vectors of directions", &at_each, &[3])?;
    if positions.len() != at_each.len() {
        let message = format!(
            "there are {} positions, but {} vectors",
            positions.len(),
            at_each.len()
        );
        return Err(Error::new("count", message));
    }
    let pairs = positions.into_iter().zip(at_each);
    let direction = |(at, vector): ([f64; 3], [f64; 3])| Direction {
        at: at.into(),
        vector: vector.into(),
    };
    Ok(pairs.map(direction).collect())
}

/// Reads the texture coordinates of the corners of a mesh, which may have none.
fn uvs_of(what: &str, mesh: &Bound<'_, PyAny>) -> Result<Vec<[f64; 2]>> {
    let uvs = mesh.getattr("uv").ok().filter(|uvs| !uvs.is_none());
    let uvs = uvs.ok_or_else(|| Error::new("uv", format!("the {what} has no attribute uv")))?;
    vectors::<2>("uv", &uvs, &[3, 2])
}

/// The mesh's own texture coordinates, for the faces that remain after repair.
fn own_uvs(
    surface: &Surface,
    before: &Mesh,
    repair: &Repair,
    uvs: &[[f64; 2]],
) -> Result<Vec<[DVec2; 3]>> {
    let uvs = uvs.as_chunks::<3>().0;
    if uvs.len() != before.faces().len() {
        let message = "uv has another number of faces than the mesh";
        return Err(Error::new("uv", message));
    }
    let uv = |face: FaceIdx, corner: usize| DVec2::from(uvs[face.index()][corner]);
    at_corners(surface, before, repair, uv).ok_or_else(|| {
        Error::new(
            "uv",
            "a face was cut in repair, and its texture coordinates are gone",
        )
    })
}

/// The values that the corners of faces had before a repair, for the faces that remain; none if a face was cut.
fn at_corners<T: Copy>(
    surface: &Surface,
    before: &Mesh,
    repair: &Repair,
    value: impl Fn(FaceIdx, usize) -> T,
) -> Option<Vec<[T; 3]>> {
    let mesh = surface.mesh();
    let faces = mesh.faces().iter().zip(&repair.face_before);
    let whole = faces.map(|(face, &at)| {
        // Repair may have turned the face, or merged its vertices with others at the same places.
        let corners = before.corners(at);
        let own = face.map(|vertex| {
            let here = mesh.positions()[vertex.index()];
            let corner = corners.iter().position(|&other| other == here)?;
            Some(value(at, corner))
        });
        Some([own[0]?, own[1]?, own[2]?])
    });
    whole.collect()
}

/// A map of the example as a texture of the mesh.
fn bake(
    synthesizer: &Synthesizer,
    texture: &SurfaceTexture,
    atlas: &Atlas,
    shading: &[[DVec3; 3]],
    map: &Map,
) -> core::result::Result<Map, SynthError> {
    Ok(match map {
        Map::Value(raster) => Map::Value(bake_values(synthesizer, texture, raster, atlas)?),
        Map::Color(raster) => Map::Color(bake_colors(synthesizer, texture, raster, atlas)?),
        Map::Normal(raster) => Map::Normal(bake_normals(
            synthesizer,
            texture,
            raster,
            NormalY::OpenGl,
            atlas,
            shading,
        )?),
    })
}

/// The color that a gray value is displayed as: its sRGB code is the value, as in a gray PNG file.
fn color_of(value: f32) -> LinearRgb {
    LinearRgb::from_srgb([u16::from_unit(value); 3])
}

fn site_colors(
    texture: &SurfaceTexture,
    map: &Map,
) -> core::result::Result<Vec<LinearRgba>, SynthError> {
    let colors = match map {
        Map::Color(raster) => texture.transfer(raster)?,
        Map::Value(raster) => {
            let values = texture.transfer(raster)?;
            values.into_iter().map(color_of).collect()
        }
        Map::Normal(_) => Vec::new(),
    };
    Ok(colors.into_iter().map(LinearRgba::opaque).collect())
}

#[pymethods]
impl Model {
    /// The vertices of the repaired mesh, (n, 3).
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        positions(py, self.synthesizer.surface().mesh().positions())
    }

    /// The vertices of each face, (m, 3).
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        faces(py, self.synthesizer.surface().mesh())
    }

    /// The texture coordinates of the corners of each face, (m, 3, 2), from 0 to 1; v goes down, as the rows of the texture do.
    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let uvs = self.atlas.uvs();
        corners(py, uvs.iter().map(|face| face.map(|uv| uv.to_array())))
    }

    /// The normals of the corners of each face, (m, 3, 3).
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let normals = self.shading.iter();
        corners(py, normals.map(|face| face.map(|normal| normal.to_array())))
    }

    /// The texture: the first map of the example on the mesh, (texels, texels[, 3]).
    #[getter]
    fn texture<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let maps = self.picture(0);
        self.layout.kinds[0].array(py, maps)
    }

    /// All maps by name; the map of an example without names is `texture`.
    #[getter]
    fn maps<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let maps = PyDict::new(py);
        for (at, name) in self.layout.names_or("texture").into_iter().enumerate() {
            maps.set_item(name, self.layout.kinds[at].array(py, self.picture(at))?)?;
        }
        Ok(maps)
    }

    /// Whether the mesh has faces that are visible from both sides.
    #[getter]
    fn double_sided(&self) -> bool {
        self.is_double_sided
    }

    /// Writes the mesh with its texture: `.glb` in one file, `.obj` with files beside it; `.ply` has the points of the
    /// surface as a mesh, with a color for each. Every file is replaced as a whole.
    ///
    /// The maps `normal` (y up) and `orm` are written to the material.
    fn export(&self, py: Python<'_>, path: PathBuf) -> Result<()> {
        threads::run(py, || -> Result<()> {
            let format =
                MeshFormat::of_path(&path).filter(|format| format.written_ending().is_some());
            let has_material =
                format.is_none_or(|format| format.material_place() != MaterialPlace::Nowhere);
            let model = match has_material {
                true => self.model()?,
                false => site_model(&self.synthesizer, self.colors.clone())?,
            };
            Ok(mesh_io::write_model(&path, &model)?)
        })?
    }

    /// A `trimesh.Trimesh` with the texture as its material. Corners of faces are separate vertices.
    fn to_trimesh<'py>(model: &Bound<'py, Self>) -> Result<Bound<'py, PyAny>> {
        let helper = model.py().import("dapple_textures._meshes")?;
        Ok(helper.call_method1("to_trimesh", (model,))?)
    }

    fn __repr__(&self) -> String {
        let mesh = self.synthesizer.surface().mesh();
        format!(
            "Model({} vertices, {} faces, {} texels, maps {})",
            mesh.positions().len(),
            mesh.faces().len(),
            self.atlas.size()[0],
            self.layout.names_or("texture").join(", ")
        )
    }
}

impl Model {
    /// The maps of a picture.
    fn picture(&self, at: usize) -> Vec<Map> {
        let before: usize = self.layout.kinds[..at]
            .iter()
            .map(|kind| kind.n_maps())
            .sum();
        self.baked[before..before + self.layout.kinds[at].n_maps()].to_vec()
    }

    /// The mesh with its material, whose textures are PNG.
    fn model(&self) -> Result<dapple::mesh::Model> {
        let base = match &self.baked[0] {
            Map::Value(values) => values.map(|&value| color_of(value)),
            Map::Color(colors) => colors.clone(),
            Map::Normal(_) => return Err(Error::new("channels", "normals are no colors")),
        };
        let surface = self.synthesizer.surface();
        let base = png(Content::Color, &base.map(|color| color.to_array()))?;
        let mut model = textured_model(surface, &self.atlas, self.shading.clone(), base)?;
        model.material.double_sided = self.is_double_sided;
        for (at, name) in self.layout.names_or("texture").into_iter().enumerate() {
            match (name, self.picture(at).as_slice()) {
                ("normal", [Map::Normal(normals)]) => {
                    let normals = normals.map(|normal| normal.to_array());
                    model.material.normal = Some(png(Content::Normal, &normals)?);
                }
                ("orm", [Map::Value(o), Map::Value(r), Map::Value(m)]) => {
                    let or = o.zip_map(r, |&o, &r| [o, r])?;
                    let image = png(Content::Data, &or.zip_map(m, |&[o, r], &m| [o, r, m])?)?;
                    model.material.occlusion = Some(image.clone());
                    model.material.metallic_roughness = Some(image);
                }
                _ => {}
            }
        }
        Ok(model)
    }
}

/// An image of three channels as PNG with 8 bits.
fn png(content: Content, raster: &Raster<[f32; 3]>) -> Result<EncodedImage> {
    let kind = Kind {
        content,
        n_channels: 3,
    };
    let values = raster.pixels().as_flattened();
    let bytes = encode(kind, raster.size(), values, Encoding::Png(Depth::Eight))?;
    Ok(EncodedImage::new(bytes)?)
}
