//! Renders the image for the workspace's README: models with synthesized textures, and below them lit built-in recipes.

use super::Documented;
use super::picture::{below, colored, lit_recipe, of_figures, row};

pub(super) const DOCUMENTED: Documented = Documented {
    folder: "",
    strips: &[],
    banner: || {
        let models = [0, 1, 2, 3, 4, 5].map(|model| ("surface-fig-05", model));
        let recipes = [
            "pebbles",
            "brick-wall",
            "fallen-leaves",
            "wood-floor",
            "rusty-metal",
            "roof-tiles",
        ]
        .map(|name| lit_recipe(name, HEIGHT));
        let recipes: Vec<_> = recipes.into_iter().collect::<Result<_, _>>()?;
        let rows = [row(&of_figures(&models, HEIGHT)?)?, row(&recipes)?];
        Ok(colored("", &below(&rows)?, COLORS))
    },
};

/// Number of shades of each channel, low enough for a small file.
const COLORS: f32 = 16.0;

/// Height of the images of a row, in pixels.
const HEIGHT: u32 = 171;
