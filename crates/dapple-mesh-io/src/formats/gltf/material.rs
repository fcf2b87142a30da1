//! Converts a glTF material, and lists the properties that a model cannot represent.

use super::Source;
use super::document::{Material as Entry, Pbr, TextureInfo};
use crate::FileResolver;
use crate::texture::{encoded, is_outside, shown, unreadable};
use dapple_color::LinearRgba;
use dapple_mesh::{AlphaMode, EncodedImage, Material, Model};
use glam::{DAffine2, DVec2};

/// Repeating wrap mode, the only one that models support.
const REPEAT: u32 = 10497;

/// Texture coordinates of a texture: the index of their set, and the transform applied to them.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Placement {
    pub(super) set: u32,
    pub(super) map: DAffine2,
}

impl Placement {
    /// The first texture coordinate set, without a transform.
    pub(super) const PLAIN: Self = Self {
        set: 0,
        map: DAffine2::IDENTITY,
    };

    fn new(info: &TextureInfo) -> Self {
        let extensions = info.extensions.as_deref();
        let Some(transform) = extensions.and_then(|extensions| extensions.transform.as_ref())
        else {
            return Self {
                set: info.tex_coord,
                ..Self::PLAIN
            };
        };
        let angle = transform.rotation.unwrap_or(0.0);
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let scale = transform.scale.map_or(DVec2::ONE, DVec2::from_array);
        Self {
            set: transform.tex_coord.unwrap_or(info.tex_coord),
            // Counterclockwise as seen on the texture, although v points down.
            map: DAffine2::from_cols(
                DVec2::new(cos, -sin) * scale.x,
                DVec2::new(sin, cos) * scale.y,
                transform.offset.map_or(DVec2::ZERO, DVec2::from_array),
            ),
        }
    }
}

impl Source<'_> {
    /// Returns the placement of a material's textures, taken from the first of these textures: base color, normal map,
    /// metallic-roughness.
    pub(super) fn placement(&self, material: usize) -> Placement {
        let material = self.document.materials.get(material);
        let pbr = material.and_then(|material| material.pbr_metallic_roughness.as_deref());
        let info = pbr
            .and_then(|pbr| pbr.base_color_texture.as_ref())
            .or(material.and_then(|material| material.normal_texture.as_ref()))
            .or(pbr.and_then(|pbr| pbr.metallic_roughness_texture.as_ref()));
        info.map_or(Placement::PLAIN, Placement::new)
    }

    /// Reads a material into a model. The texture coordinates of the model must be set already.
    pub(super) fn read_material(
        &self,
        index: usize,
        model: &mut Model,
        resolve: &mut FileResolver<'_>,
    ) {
        let Some(material) = self.document.materials.get(index) else {
            return;
        };
        let pbr = material.pbr_metallic_roughness.as_deref();
        let base = pbr.and_then(|pbr| pbr.base_color_texture.as_ref());
        let factor = pbr.and_then(|pbr| pbr.base_color_factor);
        let placement = self.placement(index);
        let left_out = &mut model.left_out;
        let mut image = |what: &str, info: Option<&TextureInfo>| {
            let info = info?;
            if Placement::new(info) == placement {
                let image = self.image(info.index, resolve);
                return image.map_err(|why| left_out.push(why)).ok();
            }
            left_out.push(format!(
                "the texture of {what}, which has other texture coordinates"
            ));
            None
        };
        let occlusion = material.occlusion_texture.as_ref();
        model.material = Material {
            base_color_factor: factor.map_or(
                Material::default().base_color_factor,
                |[r, g, b, alpha]| {
                    let color = [r, g, b].into();
                    LinearRgba { color, alpha }
                },
            ),
            base_color: image("colors", base),
            normal: image("normals", material.normal_texture.as_ref()),
            metallic_roughness: image(
                "roughness",
                pbr.and_then(|pbr| pbr.metallic_roughness_texture.as_ref()),
            ),
            occlusion: image("occlusion", occlusion),
            alpha: match material.alpha_mode.as_deref() {
                Some("MASK") => AlphaMode::Mask,
                Some("BLEND") => AlphaMode::Blend,
                _ => AlphaMode::Opaque,
            },
            alpha_cutoff: material.alpha_cutoff.unwrap_or(0.5),
            double_sided: material.double_sided,
            ..Material::default()
        };
        let properties = left_out_of(material);
        if !properties.is_empty() {
            let properties = shown(&properties.join(", "));
            model
                .left_out
                .push(format!("properties of the material: {properties}"));
        }
        let wrap = base
            .and_then(|base| self.wrap(base.index))
            .filter(|_| is_outside(model));
        if let Some(wrap) = wrap {
            let what = format!("the wrap {wrap} of the texture, which repeats here");
            model.left_out.push(what);
        }
    }

    /// Returns the name of the wrap mode of a texture; `None` if it repeats.
    fn wrap(&self, texture: usize) -> Option<&'static str> {
        let sampler = self.document.textures.get(texture)?.sampler?;
        let sampler = self.document.samplers.get(sampler)?;
        let wraps = [sampler.wrap_s, sampler.wrap_t].into_iter().flatten();
        let wrap = wraps.into_iter().find(|&wrap| wrap != REPEAT)?;
        Some(if wrap == 33648 {
            "MIRRORED_REPEAT"
        } else {
            "CLAMP_TO_EDGE"
        })
    }

    /// Returns the image of a texture. An error is the text for [`Model::left_out`].
    fn image(&self, index: usize, resolve: &mut FileResolver<'_>) -> Result<EncodedImage, String> {
        let no_image = || format!("texture {index}, which has no image");
        let texture = self.document.textures.get(index).ok_or_else(no_image)?;
        let Some(at) = texture.source else {
            let extensions = texture.extensions.as_ref();
            let name = extensions.and_then(|extensions| extensions.keys().next());
            let named = |name: &String| {
                format!(
                    "texture {index}, which only the extension {} has",
                    shown(name)
                )
            };
            return Err(name.map_or_else(no_image, named));
        };
        let image = self.document.images.get(at).ok_or_else(no_image)?;
        let uri = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
        let name = uri
            .or(image.name.as_deref())
            .map_or_else(|| at.to_string(), str::to_owned);
        let Some(bytes) = self.image_bytes(image, resolve) else {
            return Err(unreadable("texture", &name));
        };
        encoded(&name, bytes)
    }
}

/// Returns the names of the properties of a material that a model cannot represent, if they differ from their
/// defaults.
fn left_out_of(material: &Entry) -> Vec<&str> {
    let pbr = material.pbr_metallic_roughness.as_deref();
    let factor = |of: fn(&Pbr) -> Option<f64>, plain: f64, textured: f64| {
        let has_texture = pbr.is_some_and(|pbr| pbr.metallic_roughness_texture.is_some());
        let plain = if has_texture { textured } else { plain };
        pbr.and_then(of).is_some_and(|factor| factor != plain)
    };
    let number = |number: Option<f64>, plain: f64| number.is_some_and(|number| number != plain);
    let (normal, occlusion) = (&material.normal_texture, &material.occlusion_texture);
    let emits = material
        .emissive_factor
        .as_deref()
        .is_some_and(|factor| *factor != [0.0; 3]);
    let all = [
        (
            "metallicFactor",
            factor(|pbr| pbr.metallic_factor, 0.0, 1.0),
        ),
        (
            "roughnessFactor",
            factor(|pbr| pbr.roughness_factor, 1.0, 1.0),
        ),
        (
            "scale",
            number(normal.as_ref().and_then(|info| info.scale), 1.0),
        ),
        (
            "strength",
            number(occlusion.as_ref().and_then(|info| info.strength), 1.0),
        ),
        ("emissiveFactor", emits),
        (
            "emissiveTexture",
            emits && material.emissive_texture.is_some(),
        ),
    ];
    let properties = all.into_iter().filter(|(_, is_there)| *is_there);
    let extensions = material
        .extensions
        .iter()
        .flat_map(|extensions| extensions.keys());
    properties
        .map(|(name, _)| name)
        .chain(extensions.map(String::as_str))
        .collect()
}
