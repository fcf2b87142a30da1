//! Repairs the texture of a mesh and the maps in its material by re-synthesis of the texels in a mask.

use super::example_mesh::ExampleMesh;
use super::reading::Input;
use super::surface::{Product, announce, exemplar_of_mesh};
use super::tiles::Sheet;
use super::{Args, STEPS, advise, shown};
use crate::args::Alpha;
use crate::encode::{Clear, Cover, Format, default_format, encode, encode_with_alpha};
use crate::error::{Exit, Hint, usage};
use crate::input::{self, Kind, Loaded};
use crate::job::{Context, Job};
use crate::output::{OutputIdx, Target};
use crate::progress::Progress;
use anyhow::{Result, bail};
use dapple::color::{LinearRgb, LinearRgba, NormalY};
use dapple::mesh::{CREASE, EncodedImage, Material, Model};
use dapple::mesh_io::{MaterialPlace, MeshFormat, replace_images};
use dapple::points::glam::DVec2;
use dapple::raster::Raster;
use dapple::synth::{
    Atlas, MeshExemplar, SurfaceTexture, bake_colors, bake_colors_alpha, bake_normals, bake_values,
};
use dapple::tile::Map;
use serde_json::Value;
use std::path::Path;

/// A mesh whose texture has been re-synthesized within a mask.
struct Repaired<'a> {
    args: &'a Args,
    exemplar: MeshExemplar,
    texture: SurfaceTexture,
    uvs: Vec<[DVec2; 3]>,
    /// The layout of the textures of UDIM tiles, if the mesh has several.
    sheet: Option<Sheet>,
    /// The re-synthesized texels.
    hole: Raster<bool>,
}

/// A repaired map, with its alpha if it has one.
type Mended = (Map, Option<Raster<f32>>);

/// Repairs the texture of the example, which is a mesh.
pub(super) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "synth", &args.image.files);
    let target = args.target(&args.exemplar, "glb")?;
    let format = model_format(&target)?;
    let Some(example) = args.read_example_mesh()? else {
        bail!("only meshes are repaired here");
    };
    check_tiles(format, &example, &args.exemplar)?;
    let outputs = claim_tiles(&target, example.sheet.as_ref(), &mut job)?;
    let map_format = args.image.format.unwrap_or(Format::Png16);
    let mut map_outputs = Vec::new();
    for name in args.map_names() {
        let target = target.part(name)?.with_ending(map_format.ending());
        map_outputs.push(claim_tiles(&target, example.sheet.as_ref(), &mut job)?);
    }
    job.claim_sidecar(&target)?;
    announce(context, &args.exemplar, &example.model);
    let Input {
        base,
        maps,
        hole,
        exemplar,
        ..
    } = args.read_with(&example)?;
    let (Some(hole), Some(_)) = (hole, &example.model.material.base_color) else {
        let error = usage(format!("{} has no texture", input::name(&args.exemplar)));
        return Err(error.hint("give a mesh with a texture, which --repair mends"));
    };
    let ExampleMesh {
        model, uvs, sheet, ..
    } = example.clone();
    let exemplar = exemplar_of_mesh(args, example, &exemplar)?;
    let progress = Progress::bar("synthesizing", STEPS.into(), context);
    let options = args.matching.options(&args.surface);
    let texture = exemplar
        .repair(&options, shown(&progress))
        .map_err(advise)?;
    drop(progress);
    let repaired = Repaired {
        args,
        exemplar,
        texture,
        uvs,
        sheet,
        hole,
    };
    for (outputs, (_, example)) in map_outputs.into_iter().zip(&maps) {
        for (output, (map, _)) in outputs.into_iter().zip(repaired.mended(example)?) {
            job.write_image(output, map, example.is_deep, &args.image)?;
        }
    }
    for (output, (map, alpha)) in outputs.into_iter().zip(repaired.mended(&base)?) {
        let Some(format) = format else {
            let cover = Cover::of(alpha.as_ref(), false, Clear::Keep);
            job.write_with_alpha(output, map, cover, base.is_deep, &args.image)?;
            continue;
        };
        let base = encoded(&map, alpha.as_ref(), base.is_deep)?;
        let new = repaired.model(model.clone(), &base)?;
        // If the input file embeds its images, replace them, and keep the rest of the document.
        match replace_images(&args.exemplar, &replaced(&model.material, &new.material))? {
            Some(bytes) => job.write(output, &bytes)?,
            None => {
                for file in format.write(&new, "")? {
                    job.write(output, &file.bytes)?;
                }
            }
        }
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

/// Refuses a model as the output if the mesh has a texture for each UDIM tile.
fn check_tiles(format: Option<&MeshFormat>, example: &ExampleMesh, path: &Path) -> Result<()> {
    let (Some(format), Some(sheet)) = (format, &example.sheet) else {
        return Ok(());
    };
    let n_tiles = sheet.tiles.numbers.len();
    let (name, format) = (input::name(path), format.name());
    let error = usage(format!(
        "{name} has textures in {n_tiles} unit squares, and {format} holds one"
    ));
    Err(error.hint("let -o end in .png, for an image of each: NAME.1001.png and so on"))
}

/// Claims a file for each UDIM tile, or one file if the mesh has a single texture.
fn claim_tiles(
    target: &Target,
    sheet: Option<&Sheet>,
    job: &mut Job<'_>,
) -> Result<Vec<OutputIdx>> {
    let Some(sheet) = sheet else {
        return Ok(vec![job.claim(target)?]);
    };
    let numbers = sheet.tiles.numbers.iter();
    numbers
        .map(|&number| job.claim(&target.tile(number)?))
        .collect()
}

/// Returns the output format if the output is a model; `None` for an image.
fn model_format(target: &Target) -> Result<Option<&'static MeshFormat>> {
    match Product::of(target)? {
        Product::Texture => Ok(None),
        Product::Model(format) if format.material_place() == MaterialPlace::Inside => {
            Ok(Some(format))
        }
        _ => {
            let error = usage(format!("{target}: a repaired mesh holds its texture"));
            Err(error.hint("let the name end in .glb, or in .png for the texture alone"))
        }
    }
}

impl Repaired<'_> {
    /// Returns the model with the repaired textures. `base` is the repaired base texture.
    fn model(&self, mut model: Model, base: &EncodedImage) -> Result<Model> {
        let material = &mut model.material;
        material.base_color = Some(base.clone());
        if let Some(image) = &material.normal {
            material.normal = Some(self.mended_image(image, Kind::Normals)?);
        }
        let packed = material.metallic_roughness.clone();
        if let Some(image) = &packed {
            material.metallic_roughness = Some(self.mended_image(image, Kind::Colors)?);
        }
        if material.occlusion == packed {
            material.occlusion = material.metallic_roughness.clone();
        } else if let Some(image) = &material.occlusion {
            material.occlusion = Some(self.mended_image(image, Kind::Colors)?);
        }
        Ok(model)
    }

    /// Returns the repaired version of an image of a material.
    fn mended_image(&self, image: &EncodedImage, kind: Kind) -> Result<EncodedImage> {
        let image = input::embedded(image, &self.args.exemplar, kind, Alpha::Keep)?;
        let (map, alpha) = self.mended_part(&image, &image, &self.uvs, &self.hole)?;
        encoded(&map, alpha.as_ref(), image.is_deep)
    }

    /// Repairs a map. Texels in the hole are new; the others are unchanged. Returns one map for each UDIM tile, or a
    /// single map.
    fn mended(&self, old: &Loaded) -> Result<Vec<Mended>> {
        let Some(sheet) = &self.sheet else {
            return Ok(vec![self.mended_part(old, old, &self.uvs, &self.hole)?]);
        };
        let mend = |tile: usize| {
            let part = sheet.part_of(old, tile)?;
            let (uvs, hole) = (sheet.tiles.uvs_of(tile), sheet.part(&self.hole, tile)?);
            self.mended_part(old, &part, &uvs, &hole)
        };
        (0..sheet.tiles.numbers.len()).map(mend).collect()
    }

    /// Repairs the texture of the faces that have finite texture coordinates in `uvs`. `old` is the texture before the
    /// repair. New texels are copied from `from`.
    fn mended_part(
        &self,
        from: &Loaded,
        old: &Loaded,
        uvs: &[[DVec2; 3]],
        hole: &Raster<bool>,
    ) -> Result<Mended> {
        let (source, texture) = (self.exemplar.source(), &self.texture);
        let surface = source.surface();
        let size = old.map.size();
        let atlas = Atlas::from_uvs(surface, uvs, size, size[0].max(size[1])).map_err(advise)?;
        Ok(match (&from.map, &old.map) {
            (Map::Value(from), Map::Value(old)) => {
                let new = bake_values(source, texture, from, &atlas)?;
                (Map::Value(within_hole(old, &new, hole)?), None)
            }
            (Map::Normal(from), Map::Normal(old)) => {
                let shading = surface.mesh().corner_normals(CREASE);
                let y = NormalY::OpenGl;
                let new = bake_normals(source, texture, from, y, &atlas, &shading)?;
                (Map::Normal(within_hole(old, &new, hole)?), None)
            }
            (Map::Color(colors), Map::Color(olds)) => {
                let (Some(alpha), Some(old_alpha)) = (&from.alpha, &old.alpha) else {
                    let new = bake_colors(source, texture, colors, &atlas)?;
                    return Ok((Map::Color(within_hole(olds, &new, hole)?), None));
                };
                let pixel = |&color: &LinearRgb, &alpha: &f32| LinearRgba { color, alpha };
                let new =
                    bake_colors_alpha(source, texture, &colors.zip_map(alpha, pixel)?, &atlas)?;
                let mended = within_hole(&olds.zip_map(old_alpha, pixel)?, &new, hole)?;
                let alpha = mended.map(|pixel| pixel.alpha);
                (Map::Color(mended.map(|pixel| pixel.color)), Some(alpha))
            }
            _ => bail!("a part of a map is of another kind"),
        })
    }
}

/// Returns a raster with the texels of `new` in the hole and of `old` elsewhere. If the hole differs in size, it is
/// scaled.
fn within_hole<T: Copy>(
    old: &Raster<T>,
    new: &Raster<T>,
    hole: &Raster<bool>,
) -> Result<Raster<T>> {
    let (size, hole_size) = (old.size(), hole.size());
    Ok(Raster::from_fn(size, |column, row| {
        let [x, y] = [(column, 0), (row, 1)]
            .map(|(at, axis)| u64::from(at) * u64::from(hole_size[axis]) / u64::from(size[axis]));
        let is_new = hole.row(y as u32)[x as usize];
        let from = if is_new { new } else { old };
        from.row(row)[column as usize]
    })?)
}

/// Pairs each image in a material with its replacement.
fn replaced(old: &Material, new: &Material) -> Vec<(EncodedImage, EncodedImage)> {
    let images = |material: &Material| {
        let Material {
            base_color,
            normal,
            metallic_roughness,
            occlusion,
            ..
        } = material.clone();
        [base_color, normal, metallic_roughness, occlusion]
    };
    let pairs = images(old).into_iter().zip(images(new));
    pairs.filter_map(|(old, new)| old.zip(new)).collect()
}

/// Encodes a map as an image for a mesh file.
fn encoded(map: &Map, alpha: Option<&Raster<f32>>, is_deep: bool) -> Result<EncodedImage> {
    let format = default_format(map, is_deep);
    let bytes = match (map, alpha) {
        (Map::Color(colors), Some(alpha)) => {
            encode_with_alpha(colors, Cover::straight(alpha, Clear::Keep), format)?
        }
        _ => encode(map, format)?,
    };
    Ok(EncodedImage::new(bytes)?)
}
