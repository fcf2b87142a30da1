//! Renders the image for the workspace's README: models covered from exemplars, and below them lit built-in recipes.

use super::Documented;
use super::picture::{below, colored, of_figures, row};

pub(super) const DOCUMENTED: Documented = Documented {
    folder: "",
    strips: &[],
    banner: || {
        let models = [0, 1, 2, 3, 4, 5].map(|model| ("surface-fig-05", model));
        // The numbers are indices in the list of all built-in recipes.
        let [
            flagstone,
            giraffe,
            ice,
            stone_and_grass,
            vein_tracery,
            wood_grain,
        ] = [6, 7, 8, 16, 18, 19].map(|place| ("house-fig-02", place));
        let recipes = [
            flagstone,
            wood_grain,
            vein_tracery,
            stone_and_grass,
            giraffe,
            ice,
        ];
        let rows = [
            row(&of_figures(&models, HEIGHT)?)?,
            row(&of_figures(&recipes, HEIGHT)?)?,
        ];
        Ok(colored("", &below(&rows)?, COLORS))
    },
};

/// Number of shades of each channel, low enough for a small file.
const COLORS: f32 = 16.0;

/// Height of the images of a row, in pixels.
const HEIGHT: u32 = 171;
