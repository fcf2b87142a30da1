//! Assembles the material of a textured mesh from the maps that it can contain.
//!
//! Reference: The Khronos Group, *glTF 2.0 Specification*, 2021, section 3.9: occlusion is red, roughness green and
//! metalness blue, so that one image holds all three.

use crate::args::MapArg;
use crate::encode::{Format, encode, encode_packed};
use crate::error::{Hint, usage};
use crate::input::Loaded;
use crate::words::with_underscores;
use anyhow::Result;
use dapple::mesh::{AlphaMode, EncodedImage, Material};
use dapple::raster::Raster;
use dapple::recipe::MapKind;
use dapple::tile::Map;

/// Values of occlusion, roughness and metalness without a map: unoccluded, rough and not metallic.
const DEFAULTS: [f32; 3] = [1.0, 1.0, 0.0];

/// The baked maps of a material.
#[derive(Default)]
pub(super) struct MaterialMaps {
    normal: Option<EncodedImage>,
    /// The maps of occlusion, roughness and metalness; `None` for a missing map.
    packed: [Option<Raster<f32>>; 3],
}

/// Returns the kind of the map called `name`; `None` for an unknown name.
fn kind_of(name: &str) -> Option<MapKind> {
    MapKind::from_name(&with_underscores(name))
}

/// Returns whether the map called `name` is of this kind.
pub(super) fn is_of(name: &str, kind: MapKind) -> bool {
    kind_of(name) == Some(kind)
}

/// Refuses maps with different names that mean the same map of a material.
///
/// # Errors
///
/// If there are two such maps. The error has both names.
pub(super) fn check_names(maps: &[MapArg]) -> Result<()> {
    for (at, map) in maps.iter().enumerate() {
        let is_other_name = |other: &&MapArg| {
            other.name != map.name
                && kind_of(&other.name).is_some_and(|kind| Some(kind) == kind_of(&map.name))
        };
        if let Some(other) = maps[..at].iter().find(is_other_name) {
            let message = format!("--map {} and --map {} are one map", other.name, map.name);
            return Err(usage(message).hint("leave one of them out"));
        }
    }
    Ok(())
}

impl MaterialMaps {
    /// Adds a baked map, if materials can contain its kind. `example` is the example's map from which it was baked.
    pub(super) fn add(
        &mut self,
        name: &str,
        map: &Map,
        example: &Loaded,
        format: Format,
    ) -> Result<()> {
        match kind_of(name) {
            Some(MapKind::Normal) => {
                self.normal = Some(EncodedImage::new(encode(map, format)?)?);
            }
            Some(MapKind::Occlusion) => self.packed[0] = Some(example.numbers(map)?),
            Some(MapKind::Roughness) => self.packed[1] = Some(example.numbers(map)?),
            Some(MapKind::Metallic) => self.packed[2] = Some(example.numbers(map)?),
            _ => {}
        }
        Ok(())
    }

    /// Adds the maps to a material.
    pub(super) fn put_into(self, material: &mut Material, format: Format) -> Result<()> {
        if let Some(size) = self.packed.iter().flatten().map(Raster::size).next() {
            let packed = EncodedImage::new(encode_packed(&self.pack(size)?, format)?)?;
            material.occlusion = Some(packed.clone());
            material.metallic_roughness = Some(packed);
        }
        material.normal = self.normal;
        Ok(())
    }

    /// Packs occlusion, roughness and metalness into the channels of one image.
    fn pack(&self, size: [u32; 2]) -> Result<Raster<[f32; 3]>> {
        let mut pixels = Raster::filled(size, DEFAULTS)?;
        for (channel, map) in self.packed.iter().enumerate() {
            if let Some(map) = map {
                pixels = pixels.zip_map(map, |&(mut pixel), &value| {
                    pixel[channel] = value;
                    pixel
                })?;
            }
        }
        Ok(pixels)
    }
}

/// Returns the alpha mode of a material: mask if the example has more fully than partly transparent pixels, otherwise
/// blend.
pub(super) fn alpha_mode(alpha: &Raster<f32>) -> AlphaMode {
    let count = |is_it: fn(&&f32) -> bool| alpha.pixels().iter().filter(is_it).count();
    let n_clear = count(|&&alpha| alpha <= 0.0);
    let n_between = count(|&&alpha| alpha > 0.0 && alpha < 1.0);
    if n_clear > n_between {
        AlphaMode::Mask
    } else {
        AlphaMode::Blend
    }
}
