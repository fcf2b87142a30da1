//! Renders the image for the README of `dapple-recipe`: a part of each built-in recipe, lit from the upper left.

use super::Documented;
use super::picture::{below, colored, lit_recipe, row};
use crate::Panel;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use dapple_recipe::Recipe;

pub(super) const DOCUMENTED: Documented = Documented {
    folder: "crates/dapple-recipe",
    strips: &[],
    banner: || {
        let names: Vec<_> = Recipe::builtin_names().collect();
        let mut rows = Vec::new();
        for names in names.chunks(COLUMNS) {
            let panels = names.iter().map(|name| lit_recipe(name, SIDE));
            let mut panels: Vec<Panel> = panels.collect::<Result<_, _>>()?;
            // Fill the last row.
            let white = Raster::filled([SIDE; 2], LinearRgb::WHITE)?;
            panels.resize(COLUMNS, Panel::color("", white));
            rows.push(row(&panels)?);
        }
        Ok(colored("", &below(&rows)?, COLORS))
    },
};

/// Number of images in a row.
const COLUMNS: usize = 9;

/// Width and height of an image, in pixels, low enough for a small file.
const SIDE: u32 = 60;

/// Number of shades of each channel; with fewer, pale grays get a tint.
const COLORS: f32 = 16.0;
