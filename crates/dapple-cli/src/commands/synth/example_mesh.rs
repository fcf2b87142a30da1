//! Reads an example that is a textured mesh, with its texture, maps and texture coordinates.

use super::corners::own_uvs;
use super::material::is_of;
use super::options::first_given;
use super::tiles::{Sheet, Tiles};
use super::{Args, advise};
use crate::error::{Hint, usage};
use crate::input::{self, Kind, Loaded};
use anyhow::{Context as _, Result, anyhow};
use dapple::color::{Code, LinearRgb};
use dapple::mesh::{EncodedImage, Material, Model, Repair, Surface};
use dapple::mesh_io::MeshFormat;
use dapple::points::glam::DVec2;
use dapple::raster::Raster;
use dapple::recipe::MapKind;
use dapple::synth::Atlas;
use dapple::tile::Map;
use std::path::Path;

/// Side of the texture that vertex colors are baked to, in texels.
const DRAWN_SIDE: u32 = 2048;

/// A textured mesh that serves as the example.
#[derive(Clone)]
pub(super) struct ExampleMesh {
    pub(super) model: Model,
    /// The surface of the repaired mesh.
    pub(super) surface: Surface,
    /// The texture coordinates of face corners. If there is a sheet, they are positions in the sheet.
    pub(super) uvs: Vec<[DVec2; 3]>,
    /// The layout of the textures of UDIM tiles in one image; `None` for a mesh with a single texture.
    pub(super) sheet: Option<Sheet>,
    /// The base color texture of the mesh.
    pub(super) base: Loaded,
    /// The material's maps that were not given with `--map`, each with the name it has in `--map`.
    pub(super) maps: Vec<(String, Loaded)>,
}

/// Returns whether a file is a mesh, by its extension.
pub(super) fn is_mesh(path: &Path) -> bool {
    MeshFormat::of_path(path).is_some()
}

impl Args {
    /// Refuses options that have no effect on the example: if it is a mesh, options for images; if it is an image,
    /// options for meshes.
    pub(super) fn check_example(&self) -> Result<()> {
        let name = input::name(&self.exemplar);
        if !is_mesh(&self.exemplar) {
            return match self.surface.given_for_example() {
                Some(option) => {
                    let error = usage(format!("--{option} has no effect: {name} is no mesh"));
                    Err(error.hint("give a textured mesh as the example"))
                }
                None => Ok(()),
            };
        }
        if self.surface.mesh.is_none() && self.plane.repair.is_none() {
            let error = anyhow!("{name} is a mesh, whose texture needs another one");
            return Err(error.hint("add --mesh FILE, the mesh that gets it, or --repair MASK"));
        }
        let plane = self.plane.given().filter(|&option| option != "repair");
        let scales = self.guides.given_for_scales();
        let scales = scales.filter(|_| self.surface.mesh.is_none());
        let other = first_given(&[
            ("detail", self.detail.is_some()),
            ("region", self.region.is_some()),
            ("example", !self.guides.examples.is_empty()),
        ]);
        match plane.or(scales).or(other) {
            Some(option) => {
                let error = usage(format!("--{option} has no effect: {name} is a mesh"));
                Err(error.hint(format!("leave out --{option}")))
            }
            None => Ok(()),
        }
    }

    /// Reads the example, if it is a mesh.
    pub(super) fn read_example_mesh(&self) -> Result<Option<ExampleMesh>> {
        if !is_mesh(&self.exemplar) {
            return Ok(None);
        }
        let path = &self.exemplar;
        let mut model = input::model(path)?;
        let (mesh, repair) = model.mesh.repair();
        let surface = Surface::new(mesh).with_context(|| input::name(path))?;
        let mut left_out = model.left_out.iter();
        let has_others = left_out.any(|what| what == Model::FURTHER_MATERIALS);
        let mut sheet = None;
        let (uvs, base) = match (&model.material.base_color, &model.colors) {
            (Some(_), _) if has_others => {
                let error = anyhow!("faces of {} have several materials", input::name(path));
                return Err(error.hint("give a mesh whose faces have one texture in all"));
            }
            (Some(_), _) => {
                let uvs = own_uvs(&surface, &model, &repair);
                let mut uvs = uvs.hint("give the example texture coordinates")?;
                let load = |image| input::embedded(image, path, Kind::Colors, self.alpha.alpha);
                let images = images(&model, |material| &material.base_color)?.unwrap_or_default();
                let mut loaded = images.into_iter().map(load).collect::<Result<Vec<_>>>()?;
                if !model.tiles.is_empty() {
                    let numbers = model.tiles.iter().map(|tile| tile.number).collect();
                    let tiles = Tiles::new(numbers, &uvs)?;
                    let made = sheet.insert(Sheet::new(tiles, loaded[0].map.size())?);
                    uvs = made.uvs();
                    loaded = vec![made.join(loaded)?];
                }
                let mut base = loaded.remove(0);
                let factor = model.material.base_color_factor.color;
                // Multiply the texture by the base color factor. A repaired mesh keeps the factor in its material
                // instead.
                if let (Map::Color(colors), None) = (&mut base.map, &self.plane.repair) {
                    let tint = |color: &LinearRgb| {
                        LinearRgb::new(color.r * factor.r, color.g * factor.g, color.b * factor.b)
                    };
                    *colors = colors.map(tint);
                }
                (uvs, base)
            }
            (None, Some(_)) => drawn(&surface, &model, &repair)?,
            (None, None) => {
                let error = anyhow!(
                    "{} has neither a texture nor colors of vertices",
                    input::name(path)
                );
                let hint = "give a textured mesh, such as a GLB with its textures".to_owned();
                return Err(error.hint(input::not_used(path, &model).unwrap_or(hint)));
            }
        };
        // Tell the user that vertex colors are not used. A repaired mesh keeps them in its file.
        if model.material.base_color.is_some()
            && model.colors.is_some()
            && self.plane.repair.is_none()
        {
            model
                .left_out
                .push("the colors of vertices beside the texture".to_owned());
        }
        let maps = if model.material.base_color.is_some() {
            self.maps_of(&model, sheet.as_ref())?
        } else {
            Vec::new()
        };
        Ok(Some(ExampleMesh {
            model,
            surface,
            uvs,
            sheet,
            base,
            maps,
        }))
    }

    /// Reads the maps in the material, except maps that were given with `--map`.
    fn maps_of(&self, model: &Model, sheet: Option<&Sheet>) -> Result<Vec<(String, Loaded)>> {
        let path = &self.exemplar;
        let load = |of: ImageOf, kind| {
            let Some(images) = images(model, of)? else {
                return Ok(None);
            };
            let images = images.into_iter();
            let images = images.map(|image| input::embedded(image, path, kind, self.alpha.alpha));
            let mut images = images.collect::<Result<Vec<_>>>()?;
            match sheet {
                Some(sheet) => sheet.join(images).map(Some),
                None => Ok(Some(images.remove(0))),
            }
        };
        let mut maps = Vec::new();
        if let Some(map) = load(|material| &material.normal, Kind::Normals)? {
            maps.push(("normal", map));
        }
        let packed: [(ImageOf, _); 2] = [
            (|material| &material.occlusion, &[("ao", 0)][..]),
            (
                |material| &material.metallic_roughness,
                &[("roughness", 1), ("metallic", 2)][..],
            ),
        ];
        for (of, channels) in packed {
            let Some(image) = load(of, Kind::Colors)? else {
                continue;
            };
            for &(name, channel) in channels {
                maps.push((name, image.with_map(channel_of(&image.map, channel)?)));
            }
        }
        let is_given = |name: &str| {
            let kind = MapKind::from_name(name);
            let mut given = self.map.iter();
            given.any(|map| kind.is_some_and(|kind| is_of(&map.name, kind)))
        };
        let maps = maps.into_iter().filter(|(name, _)| !is_given(name));
        Ok(maps.map(|(name, map)| (name.to_owned(), map)).collect())
    }
}

impl ExampleMesh {
    /// Returns whether the material has a map of this kind.
    pub(super) fn has(&self, kind: MapKind) -> bool {
        self.maps.iter().any(|(name, _)| is_of(name, kind))
    }
}

/// Returns one of the textures of a material.
type ImageOf = fn(&Material) -> &Option<EncodedImage>;

/// Returns the images of the texture that `of` selects: one for each UDIM tile, or one for a mesh without tiles. `None`
/// if the material does not have this texture.
///
/// # Errors
///
/// If some tiles have the texture and others do not.
fn images(model: &Model, of: ImageOf) -> Result<Option<Vec<&EncodedImage>>> {
    if model.tiles.is_empty() {
        return Ok(of(&model.material).as_ref().map(|image| vec![image]));
    }
    let found = model.tiles.iter().map(|tile| of(&tile.material).as_ref());
    if found.clone().all(|image| image.is_none()) {
        return Ok(None);
    }
    let images = model.tiles.iter().zip(found).map(|(tile, image)| {
        let number = tile.number;
        image.ok_or_else(|| {
            anyhow!("the faces in unit square {number} lack a texture that others have")
        })
    });
    images.collect::<Result<_>>().map(Some)
}

/// Extracts a channel from a packed map: its stored codes from 0 to 1, without sRGB decoding.
fn channel_of(map: &Map, channel: usize) -> Result<Map> {
    let Map::Color(colors) = map else {
        return Err(anyhow!("a packed map has no colors"));
    };
    let code = |color: &LinearRgb| color.to_srgb::<u16>()[channel].to_unit();
    Ok(Map::Value(colors.map(code)))
}

/// Bakes vertex colors to a texture. Returns the texture coordinates of its atlas, and the texture.
fn drawn(surface: &Surface, model: &Model, repair: &Repair) -> Result<(Vec<[DVec2; 3]>, Loaded)> {
    let colors = model.colors.as_deref().unwrap_or_default();
    let faces = surface.mesh().faces();
    let atlas = Atlas::charts(surface, DRAWN_SIDE).map_err(advise)?;
    let drawn = Raster::from_fn(atlas.size(), |column, row| {
        let Some(point) = atlas.point(surface, [column, row]) else {
            return LinearRgb::default();
        };
        let corners = faces[point.face.index()].iter().zip(surface.weights(point));
        corners.fold(LinearRgb::default(), |sum, (vertex, weight)| {
            let before = repair.vertex_before[vertex.index()];
            sum + colors[before.index()].color * weight as f32
        })
    })?;
    Ok((atlas.uvs(), Loaded::of_colors(drawn)))
}
