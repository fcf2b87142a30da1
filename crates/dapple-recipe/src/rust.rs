//! Export of a recipe as a Rust program that contains its text and bakes it.

use crate::{Recipe, RecipeError};

impl Recipe {
    /// Generates a Rust program that contains this recipe and writes its height, normals and albedo as PNG files. The
    /// program depends on the crate `dapple` alone.
    ///
    /// # Errors
    ///
    /// Same as [`to_toml`](Self::to_toml).
    pub fn to_rust(&self) -> Result<String, RecipeError> {
        let title = if self.name.is_empty() {
            "A material"
        } else {
            &self.name
        };
        let toml = self.to_toml()?;
        // Delimit the raw string by more `#` than follow any quotation mark in the text.
        let mut marks = String::from("#");
        while toml.contains(&format!("\"{marks}")) {
            marks.push('#');
        }
        Ok(format!(
            "//! {title}.\n{PROGRAM}r{marks}\"{toml}\"{marks};\n"
        ))
    }
}

/// Source of the generated program, up to the recipe's text.
const PROGRAM: &str = "
use dapple::image::{Depth, write_color_png, write_gray_png, write_normal_png};
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, Recipe, RecipeError};

/// The maps of the material. What images the recipe names has to be put into `images`.
pub fn bake(
    size: [u32; 2],
    maps: Vec<MapKind>,
    images: &Images,
) -> Result<Vec<(MapKind, MapRows)>, RecipeError> {
    let plan = Plan::new(&Recipe::from_toml(RECIPE)?, images, 0.0)?;
    Bake::new(&plan, &BakeOptions { size, maps, ..BakeOptions::default() })?.whole_maps()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let maps = vec![MapKind::Height, MapKind::Normal, MapKind::Albedo];
    for (kind, rows) in bake([512, 512], maps, &Images::new())? {
        let path = format!(\"{}.png\", kind.name());
        match rows {
            MapRows::Gray(values) => write_gray_png(path, &values, Depth::Sixteen)?,
            MapRows::Color(colors) => write_color_png(path, &colors, Depth::Eight)?,
            MapRows::Normal(normals) => write_normal_png(path, &normals, Depth::Eight)?,
            _ => {}
        }
    }
    Ok(())
}

/// The recipe, in TOML.
const RECIPE: &str = ";
