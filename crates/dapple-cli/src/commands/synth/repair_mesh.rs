//! Repair of the texture of a mesh, and of the maps in its material.

use super::example_mesh::ExampleMesh;
use super::reading::Input;
use super::surface::{Product, announce, exemplar_of_mesh};
use super::{Args, STEPS, advise, shown};
use crate::args::Alpha;
use crate::encode::{Clear, Cover, Format, default_format, encode, encode_with_alpha};
use crate::error::{Exit, Hint, usage};
use crate::input::{self, Kind, Loaded};
use crate::job::{Context, Job};
use crate::output::Target;
use crate::progress::Progress;
use anyhow::{Result, bail};
use dapple::color::{LinearRgba, NormalY};
use dapple::mesh::{CREASE, EncodedImage, Material, Model};
use dapple::mesh_io::{MaterialPlace, MeshFormat, replace_images};
use dapple::points::glam::DVec2;
use dapple::raster::Raster;
use dapple::synth::{
    Atlas, MeshExemplar, SurfaceTexture, bake_colors, bake_colors_alpha, bake_normals, bake_values,
};
use dapple::tile::Map;
use serde_json::Value;

/// A mesh whose texture is made again where a mask says so.
struct Repaired<'a> {
    args: &'a Args,
    exemplar: MeshExemplar,
    texture: SurfaceTexture,
    uvs: Vec<[DVec2; 3]>,
    /// The texels that are made again.
    hole: Raster<bool>,
}

/// Repairs the texture of the mesh that is the example.
pub(super) fn run(args: &Args, context: &Context) -> Result<Exit> {
    let mut job = Job::new(context, "synth", &args.image.files);
    let target = args.target(&args.exemplar, "glb")?;
    let format = model_format(&target)?;
    let output = job.claim(&target)?;
    let map_format = args.image.format.unwrap_or(Format::Png16);
    let map_outputs = args.claim_maps(&target, map_format.ending(), &mut job)?;
    job.claim_sidecar(&target)?;
    let Some(example) = args.read_example_mesh()? else {
        bail!("only meshes are repaired here");
    };
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
    let ExampleMesh { model, uvs, .. } = example.clone();
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
        hole,
    };
    for (output, (_, example)) in map_outputs.into_iter().zip(&maps) {
        let (map, _) = repaired.mended(example)?;
        job.write_image(output, map, example.is_deep, &args.image)?;
    }
    let (map, alpha) = repaired.mended(&base)?;
    match format {
        None => {
            let cover = Cover::of(alpha.as_ref(), false, Clear::Keep);
            job.write_with_alpha(output, map, cover, base.is_deep, &args.image)?;
        }
        Some(format) => {
            let base = encoded(&map, alpha.as_ref(), base.is_deep)?;
            let new = repaired.model(model.clone(), &base)?;
            // A file that holds images stays the same document.
            match replace_images(&args.exemplar, &replaced(&model.material, &new.material))? {
                Some(bytes) => job.write(output, &bytes)?,
                None => {
                    for file in format.write(&new, "")? {
                        job.write(output, &file.bytes)?;
                    }
                }
            }
        }
    }
    job.finish(args, Value::Null)?;
    Ok(Exit::Done)
}

/// The format of a model as the output; nothing for an image.
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
    /// The model with its textures mended.
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

    /// An image of a material, mended.
    fn mended_image(&self, image: &EncodedImage, kind: Kind) -> Result<EncodedImage> {
        let image = input::embedded(image, &self.args.exemplar, kind, Alpha::Keep)?;
        let (map, alpha) = self.mended(&image)?;
        encoded(&map, alpha.as_ref(), image.is_deep)
    }

    /// A map, and its alpha, with new texels in the hole and the old ones elsewhere.
    fn mended(&self, old: &Loaded) -> Result<(Map, Option<Raster<f32>>)> {
        let (source, texture) = (self.exemplar.source(), &self.texture);
        let surface = source.surface();
        let size = old.map.size();
        let atlas =
            Atlas::from_uvs(surface, &self.uvs, size, size[0].max(size[1])).map_err(advise)?;
        Ok(match (&old.map, &old.alpha) {
            (Map::Value(values), _) => {
                let new = bake_values(source, texture, values, &atlas)?;
                (Map::Value(self.within_hole(values, &new)?), None)
            }
            (Map::Normal(normals), _) => {
                let shading = surface.mesh().corner_normals(CREASE);
                let y = NormalY::OpenGl;
                let new = bake_normals(source, texture, normals, y, &atlas, &shading)?;
                (Map::Normal(self.within_hole(normals, &new)?), None)
            }
            (Map::Color(colors), None) => {
                let new = bake_colors(source, texture, colors, &atlas)?;
                (Map::Color(self.within_hole(colors, &new)?), None)
            }
            (Map::Color(colors), Some(alpha)) => {
                let pixels = colors.zip_map(alpha, |&color, &alpha| LinearRgba { color, alpha })?;
                let new = bake_colors_alpha(source, texture, &pixels, &atlas)?;
                let mended = self.within_hole(&pixels, &new)?;
                let alpha = mended.map(|pixel| pixel.alpha);
                (Map::Color(mended.map(|pixel| pixel.color)), Some(alpha))
            }
        })
    }

    /// The new texels in the hole, which may have another size, and the old ones elsewhere.
    fn within_hole<T: Copy>(&self, old: &Raster<T>, new: &Raster<T>) -> Result<Raster<T>> {
        let (size, hole) = (old.size(), self.hole.size());
        Ok(Raster::from_fn(size, |column, row| {
            let [x, y] = [(column, 0), (row, 1)]
                .map(|(at, axis)| u64::from(at) * u64::from(hole[axis]) / u64::from(size[axis]));
            let is_new = self.hole.row(y as u32)[x as usize];
            let from = if is_new { new } else { old };
            from.row(row)[column as usize]
        })?)
    }
}

/// The images of a material with those in their places.
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

/// A map as an image in a mesh file.
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
