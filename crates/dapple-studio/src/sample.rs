//! Thumbnails of recipes: the albedo, lit from the upper left.

use crate::picture::of_colors;
use crate::render::{planned, size_of};
use crate::{Picture, Shown, StudioError};
use dapple::color::{Normal, NormalY};
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Recipe};

/// The direction to the light: a unit vector with the components right, up and toward the viewer.
const LIGHT: [f32; 3] = [-0.48, 0.6, 0.64];
/// Intensities of the ambient light and the directional light.
const LIGHTS: [f32; 2] = [0.35, 1.0];

/// Maximum side of a thumbnail, in pixels.
const MOST: u32 = 256;

/// Renders a lit thumbnail of a recipe. Its longer side has `side` pixels, at most 256.
///
/// # Errors
///
/// If the recipe cannot be baked.
pub fn sample(
    shown: Shown,
    recipe: &Recipe,
    images: &Images,
    side: u32,
) -> Result<Picture, StudioError> {
    let (size, pixels) = lit(recipe, images, side.clamp(1, MOST))?;
    Ok(Picture::whole(shown, size, pixels))
}

/// Renders a lit thumbnail whose longer side has `side` pixels, and returns its size and its pixels.
pub(crate) fn lit(
    recipe: &Recipe,
    images: &Images,
    side: u32,
) -> Result<([u32; 2], Vec<u8>), StudioError> {
    let mut recipe = recipe.clone();
    recipe.material.normal_y = NormalY::OpenGl;
    // Bake the albedo and the normals.
    let plan = planned(&recipe, images, 0.0)?;
    let size = size_of(recipe.extent, side);
    let maps = vec![MapKind::Albedo, MapKind::Normal];
    let options = BakeOptions {
        size,
        maps,
        ..BakeOptions::default()
    };
    let mut maps = Bake::new(&plan, &options)?
        .whole_maps()?
        .into_iter()
        .map(|(_, rows)| rows);
    let (Some(MapRows::Color(colors)), Some(MapRows::Normal(normals))) = (maps.next(), maps.next())
    else {
        return Err(StudioError::new("a map was not baked"));
    };
    // Light every pixel.
    let lit = colors.zip_map(&normals, |&color, normal| color * light(normal));
    let lit = lit.map_err(|error| StudioError::new(error.to_string()))?;
    Ok((size, of_colors(&lit)))
}

/// Returns the brightness of a surface point with this normal, from 0.35 to 1.35.
fn light(normal: &Normal) -> f32 {
    let parts = normal.to_array().into_iter().zip(LIGHT);
    let facing: f32 = parts.map(|(a, b)| a * b).sum();
    LIGHTS[0] + LIGHTS[1] * facing.max(0.0)
}
