//! Synthesizes textures on meshes.

mod along;
mod example_mesh;
mod repair;
mod surface_guides;

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::images::encode;
use crate::meshes::{corners, faces, positions, vectors};
use crate::options::{self, Vectors};
use crate::pictures::{self, Content, Kind, Layout};
use crate::seed::SeedArgument;
use crate::synthesis::{Exemplar, Matching};
use crate::watch::{self, Stop};
pub(crate) use along::synthesize_along;
use dapple::color::{Code, LinearRgb, LinearRgba, NormalY};
use dapple::image::{Depth, Encoding};
use dapple::mesh::glam::{DVec2, DVec3};
use dapple::mesh::{EncodedImage, Mesh, Repair, Surface};
use dapple::mesh_io::{self, MaterialPlace, MeshFormat};
use dapple::raster::Raster;
use dapple::synth::{
    Atlas, Direction, Hierarchy, HierarchyOptions, Orientation, Progress, SurfaceTexture, Symmetry,
    SynthError, Synthesizer, bake_colors, bake_normals, bake_values, site_model,
    sites_for_exemplar,
};
use dapple::tile::Map;
use example_mesh::ExampleMesh;
use pyo3::prelude::*;
use pyo3::types::PyDict;
pub(crate) use repair::repair_on;
use std::path::PathBuf;
use surface_guides::{SitesOfMesh, SurfaceGuides, SurfaceScales};

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

/// A mesh with a synthesized texture and its other maps. Created by `synthesize_on`.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct Model {
    mesh: Mesh,
    uvs: Vec<[DVec2; 3]>,
    /// Whether the texture may have mipmaps, that is, whether coarse mipmap levels do not mix faces that are far
    /// apart.
    mipmaps: bool,
    shading: Vec<[DVec3; 3]>,
    is_double_sided: bool,
    layout: Layout,
    /// The maps of the atlas, in the order of the layout.
    baked: Vec<Map>,
    /// The colors of the sites.
    points: SitePoints,
}

/// The sites of a texture as a mesh, with a color for each site.
enum SitePoints {
    /// Sites that have not been converted to a mesh yet.
    Sites(Box<Synthesizer>, Vec<LinearRgba>),
    /// The mesh of an unpickled model; `None` if its sites do not form a mesh.
    Mesh(Option<Box<dapple::mesh::Model>>),
}

impl SitePoints {
    /// Returns the mesh of the sites; an error if the sites do not form a mesh.
    fn model(&self) -> Result<dapple::mesh::Model> {
        match self {
            Self::Sites(synthesizer, colors) => Ok(site_model(synthesizer, colors.clone())?),
            Self::Mesh(Some(model)) => Ok((**model).clone()),
            Self::Mesh(None) => Err(Error::new(
                "points",
                "the points of the surface are not a mesh",
            )),
        }
    }
}

/// Covers a mesh with a texture that looks like an example, after Turk (2001): each point on the surface takes the
/// color of an example pixel.
///
/// Faults of the mesh are repaired first.
///
/// Parameters
/// ----------
/// mesh : mesh
///     Any object with `.vertices` (n, 3) and `.faces` (m, 3), such as a `trimesh.Trimesh`, or a pair of such arrays.
/// exemplar : array_like, dict of array_like or Exemplar
///     (rows, columns), or (rows, columns, 3) in linear light; or a dictionary of maps, of which the first is matched
///     and the others follow it: `normal` and `orm` are also written to the material of exported files. The texture of
///     another mesh is lifted from there: `Exemplar(maps, mesh=…)`.
/// sites : int or None, default None
///     The number of points on the surface that get a color, 1 to 2**28. By default, the exemplar repeats five times along
///     the longest side of the mesh, or as often as 400,000 points allow; 65,536 points if it is a mesh.
/// directions : Directions, dict, tuple of array_like or None, default None
///     How the texture lies on the surface; by default Directions(). A pair (positions, vectors) is `field` alone.
/// atlas : Atlas, dict or None, default None
///     The layout of the texture; by default Atlas().
/// seed : int, default 0
///     As for `synthesize`.
/// matching : Matching, dict or None, default None
///     How neighborhoods are compared; by default Matching(). `method` is not for this function.
/// progress : callable or None, default None
///     As for `synthesize`.
///
/// Returns
/// -------
/// Model
///     The mesh with its texture.
///
/// Raises
/// ------
/// DappleError
///     If the mesh has faults that leave no surface, the maps of the example differ in size, or an option is out of
///     range or conflicts with another.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> checker = np.kron([[0, 1], [1, 0]], np.ones((8, 8)))
/// >>> roof = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
/// >>> checker = dp.Exemplar(checker, edges="wrap")
/// >>> model = dp.synthesize_on(roof, checker, atlas={"texels": 64}, sites=500, matching={"levels": 2})
/// >>> model.texture.shape, model.uv.shape
/// ((64, 64), (2, 3, 2))
#[pyfunction]
#[pyo3(signature = (mesh, exemplar, *, sites = None, directions = None, atlas = None, seed = SeedArgument::default(),
    matching = None, progress = None),
    text_signature = "(mesh, exemplar, *, sites=None, directions=None, atlas=None, seed=0, matching=None, progress=None)")]
pub(crate) fn synthesize_on<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyAny>,
    exemplar: &Bound<'py, PyAny>,
    sites: Option<usize>,
    directions: Option<&Bound<'py, PyAny>>,
    atlas: Option<&Bound<'py, PyAny>>,
    seed: SeedArgument,
    matching: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Model> {
    let options::Atlas {
        texels,
        kind,
        padding,
        crease,
    } = options::read(py, "Atlas", "atlas", atlas)?;
    let atlas = data::named("kind", &kind)?;
    let directions: options::Directions<'_> =
        options::read(py, "Directions", "directions", directions)?;
    let matching = Matching::read(py, matching, &["method"])?;
    // Mipmaps of triangle atlases would mix faces that are far apart.
    let has_mipmaps = matches!(atlas, AtlasKind::Charts | AtlasKind::Uv);
    let (mesh, is_blender) = crate::meshes::plain(mesh)?;
    let mesh = &mesh;
    // Blender's vertical axis is z.
    let down = directions.down.unwrap_or(match is_blender {
        true => [0.0, 0.0, -1.0],
        false => [0.0, -1.0, 0.0],
    });
    let guides = SurfaceGuides::read(matching.guides())?;
    let scales = directions.scales.as_ref();
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
    let exemplar = Exemplar::read("exemplar", exemplar)?;
    refuse_alpha(&exemplar.layout)?;
    let example = guides.of_example(exemplar.matched(None)?)?;
    let Exemplar {
        layout,
        maps,
        given,
    } = exemplar;
    let example_mesh = ExampleMesh::of(given)?;
    let [hierarchy, sites_of_example] = ["sites", "example sites"].map(|name| HierarchyOptions {
        n_levels: matching.n_levels(),
        seed: seed.0.child(name, 0),
        ..sites.map_or_else(HierarchyOptions::default, |n_sites| HierarchyOptions {
            n_sites,
            ..HierarchyOptions::default()
        })
    });
    let size = example_mesh.is_none().then(|| example.size());
    let options = matching.options(seed)?;
    let symmetry: Symmetry = data::named("symmetry", &directions.symmetry.to_string())?;
    let directions = self::directions(directions.field)?;
    let crease = crease.to_radians();
    let is_charted = atlas == AtlasKind::Charts;
    let cover = move |heard: watch::Heard<'_>, _: &Stop| -> Result<Model> {
        let (repaired, repair) = mesh.repair();
        let surface = Surface::new(repaired)?;
        let mut hierarchy = hierarchy;
        if let (None, Some(size)) = (sites, size) {
            hierarchy.n_sites = sites_for_exemplar(&surface, size);
        }
        // Check all options before cutting charts, which takes long.
        hierarchy.check(&surface)?;
        let uvs = match needs_uvs {
            true => own_uvs(&surface, &mesh, &repair, &uvs)?,
            false => Vec::new(),
        };
        let atlas = match (atlas, padding) {
            (AtlasKind::Charts, padding) => {
                let charted = |part: f64| heard(part_of(0.0..CHARTS, part));
                Atlas::charts_with(&surface, texels, padding, charted)?
            }
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
        let first = match is_charted {
            true => CHARTS,
            false => 0.0,
        };
        let heard = |steps: dapple::synth::Progress| heard(part_of(first..1.0, steps.part()));
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
        let colors = site_colors(&texture, &maps[0])?;
        Ok(Model {
            mesh: synthesizer.surface().mesh().clone(),
            uvs: atlas.uvs(),
            mipmaps: has_mipmaps,
            points: SitePoints::Sites(Box::new(synthesizer), colors),
            shading,
            is_double_sided,
            layout,
            baked,
        })
    };
    watch::run(py, progress, cover)?
}

/// Fraction of the total progress for cutting charts.
const CHARTS: f64 = 0.3;

/// Returns the total progress. `part` is the completed fraction of a step, and `range` is the range of the total
/// progress that this step covers.
fn part_of(range: core::ops::Range<f64>, part: f64) -> Progress {
    const STEPS: u32 = 1 << 16;
    let done = range.start + (range.end - range.start) * part;
    Progress {
        pass: 0,
        n_passes: 1,
        done: (done * f64::from(STEPS)) as usize,
        n_sites: STEPS as usize,
    }
}

/// Returns an error for colors with alpha, which cannot be baked.
fn refuse_alpha(layout: &Layout) -> Result<()> {
    let has_alpha = |kind: &Kind| kind.content == Content::Color && kind.n_channels == 4;
    if layout.kinds.iter().any(has_alpha) {
        let message = "the texture cannot keep alpha: give three channels";
        return Err(Error::new("channels", message));
    }
    Ok(())
}

/// Reads the texture directions and their positions.
fn directions(directions: Option<Vectors<'_>>) -> Result<Vec<Direction>> {
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

/// Reads the texture coordinates of the face corners; an error if the mesh has none.
fn uvs_of(what: &str, mesh: &Bound<'_, PyAny>) -> Result<Vec<[f64; 2]>> {
    let uvs = mesh.getattr("uv").ok().filter(|uvs| !uvs.is_none());
    let uvs = uvs.ok_or_else(|| Error::new("uv", format!("the {what} has no attribute uv")))?;
    vectors::<2>("uv", &uvs, &[3, 2])
}

/// Returns the texture coordinates of the given mesh, for the faces that remain after repair.
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
    let own = repair.corners_before(before, surface.mesh(), uvs);
    let whole = own.map(|[a, b, c]| Some([a?, b?, c?].map(DVec2::from)));
    whole.collect::<Option<_>>().ok_or_else(|| {
        Error::new(
            "uv",
            "a face was cut in repair, and its texture coordinates are gone",
        )
    })
}

/// Bakes the texture for the mesh that corresponds to a map of the example.
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

/// Returns the color that displays a gray value, which is an sRGB code as in a gray PNG file.
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
        positions(py, self.mesh.positions())
    }

    /// The vertex indices of each face, (m, 3).
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        faces(py, &self.mesh)
    }

    /// The texture coordinates of each face corner, (m, 3, 2), from 0 to 1; v points down, like the rows of the
    /// texture.
    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        corners(py, self.uvs.iter().map(|face| face.map(|uv| uv.to_array())))
    }

    /// The normals at each face corner, (m, 3, 3).
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let normals = self.shading.iter();
        corners(py, normals.map(|face| face.map(|normal| normal.to_array())))
    }

    /// The baked texture from the example's first map, (texels, texels[, 3]).
    #[getter]
    fn texture<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let maps = self.picture(0);
        self.layout.kinds[0].array(py, maps)
    }

    /// All maps by name; if the example has no names, its map is called `texture`.
    #[getter]
    fn maps<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let maps = PyDict::new(py);
        for (at, name) in self.layout.names_or("texture").into_iter().enumerate() {
            maps.set_item(name, self.layout.kinds[at].array(py, self.picture(at))?)?;
        }
        Ok(maps)
    }

    /// Whether the mesh has faces visible from both sides.
    #[getter]
    fn double_sided(&self) -> bool {
        self.is_double_sided
    }

    /// Writes the mesh with its texture: `.glb` is a single file, `.obj` has accompanying files; `.ply` has the
    /// points on the surface as a mesh with vertex colors. Every file is replaced atomically.
    ///
    /// The maps `normal` (y up) and `orm` are written to the material.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     The path of the file.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the extension is not a supported model format.
    /// OSError
    ///     If the system cannot read or write the file: `FileNotFoundError` if it does not exist.
    fn export(&self, py: Python<'_>, path: PathBuf) -> Result<()> {
        // Wait for the work even after an interruption, so that the file is complete.
        watch::within(py, |stop| -> Result<()> {
            let format =
                MeshFormat::of_path(&path).filter(|format| format.written_ending().is_some());
            let has_material =
                format.is_none_or(|format| format.material_place() != MaterialPlace::Nowhere);
            let model = match has_material {
                true => self.model(stop)?,
                false => self.points.model()?,
            };
            Ok(mesh_io::write_model(&path, &model)?)
        })
    }

    /// Converts to a `trimesh.Trimesh` with the texture as its material. Face corners become separate vertices.
    ///
    /// Returns
    /// -------
    /// trimesh.Trimesh
    ///     The mesh.
    fn to_trimesh<'py>(model: &Bound<'py, Self>) -> Result<Bound<'py, PyAny>> {
        let helper = model.py().import("dapple_textures._meshes")?;
        Ok(helper.call_method1("to_trimesh", (model,))?)
    }

    /// Returns the function and the arrays with which another process rebuilds the model.
    fn __reduce__<'py>(&self, py: Python<'py>) -> Result<(Bound<'py, PyAny>, Parts<'py>)> {
        let make = py
            .import("dapple_textures._native")?
            .getattr("_model_from_parts")?;
        let points = match self.points.model() {
            Ok(model) => {
                let colors = model.colors.iter().flatten().flat_map(|at| {
                    let LinearRgba { color, alpha } = *at;
                    [color.r, color.g, color.b, alpha]
                });
                let colors: Vec<f32> = colors.collect();
                let n_colors = colors.len() / 4;
                let normals = model.normals.unwrap_or_default();
                Some((
                    positions(py, model.mesh.positions())?,
                    faces(py, &model.mesh)?,
                    positions(py, &normals)?,
                    arrays::array(py, colors, &[n_colors, 4])?,
                ))
            }
            Err(_) => None,
        };
        let parts = (
            self.vertices(py)?,
            self.faces(py)?,
            self.uv(py)?,
            self.normals(py)?,
            self.layout.python(py, self.baked.clone())?,
            (self.mipmaps, self.is_double_sided),
            points,
        );
        Ok((make, parts))
    }

    fn __repr__(&self) -> String {
        format!(
            "Model({} vertices, {} faces, {} texels, maps {})",
            self.mesh.positions().len(),
            self.mesh.faces().len(),
            self.baked[0].size()[0],
            self.layout.names_or("texture").join(", ")
        )
    }
}

impl Model {
    /// Returns the baked maps of the image with index `at` in the layout.
    fn picture(&self, at: usize) -> Vec<Map> {
        let before: usize = self.layout.kinds[..at]
            .iter()
            .map(|kind| kind.n_maps())
            .sum();
        self.baked[before..before + self.layout.kinds[at].n_maps()].to_vec()
    }

    /// Builds the mesh with its material, whose textures are PNG images.
    fn model(&self, stop: &Stop) -> Result<dapple::mesh::Model> {
        let base = match &self.baked[0] {
            Map::Value(values) => values.map(|&value| color_of(value)),
            Map::Color(colors) => colors.clone(),
            Map::Normal(_) => return Err(Error::new("channels", "normals are no colors")),
        };
        let base = png(Content::Color, &base.map(|color| color.to_array()), stop)?;
        // Faces outside the atlas show the first corner of the texture, as in `textured_model`.
        let placed = |uv: DVec2| if uv.is_finite() { uv } else { DVec2::ZERO };
        let mut model = dapple::mesh::Model::from(self.mesh.clone());
        model.uvs = Some(self.uvs.iter().map(|face| face.map(placed)).collect());
        model.corner_normals = Some(self.shading.clone());
        model.material.base_color = Some(base);
        model.material.mipmaps = self.mipmaps;
        model.material.double_sided = self.is_double_sided;
        for (at, name) in self.layout.names_or("texture").into_iter().enumerate() {
            match (name, self.picture(at).as_slice()) {
                ("normal", [Map::Normal(normals)]) => {
                    let normals = normals.map(|normal| normal.to_array());
                    model.material.normal = Some(png(Content::Normal, &normals, stop)?);
                }
                ("orm", [Map::Value(o), Map::Value(r), Map::Value(m)]) => {
                    let or = o.zip_map(r, |&o, &r| [o, r])?;
                    let image = png(
                        Content::Data,
                        &or.zip_map(m, |&[o, r], &m| [o, r, m])?,
                        stop,
                    )?;
                    model.material.occlusion = Some(image.clone());
                    model.material.metallic_roughness = Some(image);
                }
                _ => {}
            }
        }
        Ok(model)
    }
}

/// A mesh of sites as arrays: positions, faces, normals and colors.
type PointParts<'py> = (
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
);

/// A model as arrays: vertices, faces, texture coordinates, normals, maps, flags (mipmaps, double-sided), and sites.
type Parts<'py> = (
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    (bool, bool),
    Option<PointParts<'py>>,
);

/// Rebuilds a model from its arrays.
#[pyfunction]
pub(crate) fn _model_from_parts(
    vertices: Bound<'_, PyAny>,
    faces: Bound<'_, PyAny>,
    uv: Bound<'_, PyAny>,
    normals: Bound<'_, PyAny>,
    maps: Bound<'_, PyAny>,
    flags: (bool, bool),
    points: Option<PointParts<'_>>,
) -> Result<Model> {
    let (mipmaps, is_double_sided) = flags;
    let (layout, baked) = pictures::read("maps", &maps)?;
    let points = points.map(|(at, faces, normals, colors)| -> Result<_> {
        let mut model = dapple::mesh::Model::from(crate::meshes::mesh_of(&at, &faces)?);
        let normals = vectors::<3>("normals", &normals, &[3])?;
        model.normals = Some(normals.into_iter().map(DVec3::from).collect());
        let colors = vectors::<4>("colors", &colors, &[4])?;
        let color = |at: [f64; 4]| {
            let [r, g, b, alpha] = at.map(|part| part as f32);
            LinearRgba {
                color: LinearRgb::new(r, g, b),
                alpha,
            }
        };
        model.colors = Some(colors.into_iter().map(color).collect());
        Ok(Box::new(model))
    });
    let uvs = vectors::<2>("uv", &uv, &[3, 2])?;
    let normals = vectors::<3>("normals", &normals, &[3, 3])?;
    let (uvs, normals) = (uvs.as_chunks::<3>().0, normals.as_chunks::<3>().0);
    Ok(Model {
        mesh: crate::meshes::mesh_of(&vertices, &faces)?,
        uvs: uvs.iter().map(|face| face.map(DVec2::from)).collect(),
        mipmaps,
        shading: normals.iter().map(|face| face.map(DVec3::from)).collect(),
        is_double_sided,
        layout,
        baked,
        points: SitePoints::Mesh(points.transpose()?),
    })
}

/// Encodes a three-channel image as PNG with 8 bits per channel.
fn png(content: Content, raster: &Raster<[f32; 3]>, stop: &Stop) -> Result<EncodedImage> {
    let kind = Kind {
        content,
        n_channels: 3,
    };
    let values = raster.pixels().as_flattened();
    let bytes = encode(
        kind,
        raster.size(),
        values,
        Encoding::Png(Depth::Eight),
        stop,
    )?;
    Ok(EncodedImage::new(bytes)?)
}
