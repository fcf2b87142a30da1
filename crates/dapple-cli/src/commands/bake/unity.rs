//! Import settings of an image for Unity: the file `IMAGE.meta` next to it.
//!
//! References: Unity Manual, "Asset metadata" and "Texture Import Settings"; Unity Scripting API, `TextureImporter`.
//! Unity adds the settings that are left out, with their defaults, when it imports the image.

use crate::layers::Layers;
use crate::output::sha256;
use dapple::recipe::{MapKind, Recipe};

/// Returns the text of an image's import settings: linear or sRGB, whether it is a normal map, and the wrap mode of
/// each axis. `file` is the image's file name. The asset id is derived from it, so that a material still finds its
/// images after another bake.
pub(super) fn meta(recipe: &Recipe, layers: Layers, file: &str) -> String {
    let id = &sha256(format!("dapple {file}").as_bytes())[..32];
    let is_srgb = u8::from(layers.is_color());
    let texture_type = u8::from(layers == Layers::Map(MapKind::Normal));
    let is_transparent = u8::from(layers == Layers::AlbedoOpacity);
    // 0 repeats, and 1 clamps.
    let [u, v] = recipe.wrap.map(|wraps| u8::from(!wraps));
    format!(
        "\
fileFormatVersion: 2
guid: {id}
TextureImporter:
  serializedVersion: 11
  mipmaps:
    enableMipMap: 1
    sRGBTexture: {is_srgb}
  textureSettings:
    serializedVersion: 2
    filterMode: 2
    aniso: 4
    wrapU: {u}
    wrapV: {v}
    wrapW: 0
  maxTextureSize: 16384
  alphaUsage: 1
  alphaIsTransparency: {is_transparent}
  textureType: {texture_type}
  textureShape: 1
"
    )
}
