//! An example that is another textured mesh: its texture, maps and texture coordinates.

use super::corners::own_uvs;
use super::material::is_of;
use super::options::first_given;
use super::{Args, advise};
use crate::error::{Hint, usage};
use crate::input::{self, Kind, Loaded};
use anyhow::{Context as _, Result, anyhow};
use dapple::color::{Code, LinearRgb};
use dapple::mesh::{Model, Repair, Surface};
use dapple::mesh_io::MeshFormat;
use dapple::points::glam::DVec2;
use dapple::raster::Raster;
use dapple::recipe::MapKind;
use dapple::synth::Atlas;
use dapple::tile::Map;
use std::path::Path;

/// The side of the map that colors of vertices are drawn to.
const DRAWN_SIDE: u32 = 2048;

/// A mesh that is the example.
#[derive(Clone)]
pub(super) struct ExampleMesh {
    pub(super) model: Model,
    /// Its mesh, repaired.
    pub(super) surface: Surface,
    /// The texture coordinates of its corners.
    pub(super) uvs: Vec<[DVec2; 3]>,
    /// Its texture.
    pub(super) base: Loaded,
    /// The maps in its material, by the names of options; those that were given go before them.
    pub(super) maps: Vec<(String, Loaded)>,
}

/// Whether a file is a mesh, by its ending.
pub(super) fn is_mesh(path: &Path) -> bool {
    MeshFormat::of_path(path).is_some()
}

impl Args {
    /// Refuses options that have no effect with a mesh as the example, and those that need one.
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
        let (uvs, base) = match (&model.material.base_color, &model.colors) {
            (Some(_), _) if has_others => {
                let error = anyhow!("faces of {} have several materials", input::name(path));
                return Err(error.hint("give a mesh whose faces have one texture in all"));
            }
            (Some(image), _) => {
                let uvs = own_uvs(&surface, &model, &repair);
                let mut base = input::embedded(image, path, Kind::Colors, self.alpha.alpha)?;
                let factor = model.material.base_color_factor.color;
                // The material of a mesh that is repaired keeps it.
                if let (Map::Color(colors), None) = (&mut base.map, &self.plane.repair) {
                    let tint = |color: &LinearRgb| {
                        LinearRgb::new(color.r * factor.r, color.g * factor.g, color.b * factor.b)
                    };
                    *colors = colors.map(tint);
                }
                (uvs.hint("give the example texture coordinates")?, base)
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
        // The file of a repaired mesh keeps them.
        if model.material.base_color.is_some()
            && model.colors.is_some()
            && self.plane.repair.is_none()
        {
            model
                .left_out
                .push("the colors of vertices beside the texture".to_owned());
        }
        let maps = if model.material.base_color.is_some() {
            self.maps_of(&model)?
        } else {
            Vec::new()
        };
        Ok(Some(ExampleMesh {
            model,
            surface,
            uvs,
            base,
            maps,
        }))
    }

    /// The maps in a material, but for those that were given.
    fn maps_of(&self, model: &Model) -> Result<Vec<(String, Loaded)>> {
        let (path, material) = (&self.exemplar, &model.material);
        let load = |image, kind| input::embedded(image, path, kind, self.alpha.alpha);
        let mut maps = Vec::new();
        if let Some(image) = &material.normal {
            maps.push(("normal", load(image, Kind::Normals)?));
        }
        for (image, channels) in [
            (&material.occlusion, &[("ao", 0)][..]),
            (
                &material.metallic_roughness,
                &[("roughness", 1), ("metallic", 2)][..],
            ),
        ] {
            let Some(image) = image else { continue };
            let image = load(image, Kind::Colors)?;
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
    /// Whether there is a map of a kind.
    pub(super) fn has(&self, kind: MapKind) -> bool {
        self.maps.iter().any(|(name, _)| is_of(name, kind))
    }
}

/// The codes of a channel of an image, which are data and no colors.
fn channel_of(map: &Map, channel: usize) -> Result<Map> {
    let Map::Color(colors) = map else {
        return Err(anyhow!("a packed map has no colors"));
    };
    let code = |color: &LinearRgb| color.to_srgb::<u16>()[channel].to_unit();
    Ok(Map::Value(colors.map(code)))
}

/// The colors of vertices as a texture in charts.
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
