//! The code of recipes that have no value at a single position: it holds the recipe and bakes it.

use crate::{Recipe, RecipeError};

pub(super) fn code(recipe: &Recipe) -> Result<String, RecipeError> {
    let title = if recipe.name.is_empty() {
        "A material"
    } else {
        &recipe.name
    };
    let toml = recipe.to_toml()?;
    // As many marks as no quotation mark in the text is followed by.
    let mut marks = String::from("#");
    while toml.contains(&format!("\"{marks}")) {
        marks.push('#');
    }
    Ok(format!(
        "//! {title}.
//!
//! Some of its nodes need an image or see the whole tile, so it is baked and has no value at a single position. Needs the
//! crate `dapple`.

use dapple::recipe::{{Bake, BakeOptions, Band, Images, MapKind, Plan, Recipe, RecipeError}};

/// The recipe, in TOML.
pub const RECIPE: &str = r{marks}\"{toml}\"{marks};

/// The maps of the material, in bands from the top down.
///
/// # Errors
///
/// If an image is missing, or does not fit.
pub fn bake(size: [u32; 2], maps: &[MapKind], images: &Images) -> Result<Vec<Band>, RecipeError> {{
    let plan = Plan::new(&Recipe::from_toml(RECIPE)?, images, 0.0)?;
    let options = BakeOptions {{ size, maps: maps.to_vec(), ..BakeOptions::default() }};
    Bake::new(&plan, &options)?.collect()
}}
"
    ))
}
