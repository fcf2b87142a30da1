//! Bakes a material described as text to maps: cobbles in sand, 512 × 512, with height, normals, occlusion, color and
//! roughness.
//!
//! `Recipe::builtin("flagstone")` is a ready-made recipe, and `Recipe::builtin_names()` lists all of them.
//!
//! ```sh
//! cargo run -p dapple --example 09_recipe_bake
//! ```

mod out;

use dapple::image::{Depth, write_color_png, write_gray_png, write_normal_png};
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, Recipe};

/// The nodes by name, and the material that uses them. The README of `dapple-recipe` describes the format.
const COBBLES: &str = include_str!("09_recipe_bake.toml");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Errors name the line, the node and the nearest valid word.
    let recipe = Recipe::from_toml(COBBLES)?;
    let plan = Plan::new(&recipe, &Images::new(), 0.0)?;

    let maps = vec![
        MapKind::Height,
        MapKind::Normal,
        MapKind::Occlusion,
        MapKind::Albedo,
        MapKind::Roughness,
    ];
    let options = BakeOptions {
        size: [512, 512],
        maps,
        ..BakeOptions::default()
    };

    // A bake returns bands, so that large images can be written in parts. These maps are joined.
    for (kind, rows) in Bake::new(&plan, &options)?.whole_maps()? {
        let path = out::path(&format!("09_recipe_bake_{}.png", kind.name()))?;
        match rows {
            MapRows::Gray(rows) => write_gray_png(&path, &rows, Depth::Sixteen)?,
            MapRows::Color(rows) => write_color_png(&path, &rows, Depth::Eight)?,
            MapRows::Normal(rows) => write_normal_png(&path, &rows, Depth::Eight)?,
            MapRows::Packed(_) => continue,
        }
        out::wrote(&path);
    }
    Ok(())
}
