//! The picture of the workspace's README: a row of figures, and below it a row of lit built-in recipes.

use super::Documented;
use super::picture::{below, colored, of_figures, row};

pub(super) const DOCUMENTED: Documented = Documented {
    folder: "",
    strips: &[],
    banner: || {
        let figures = [
            ("pups-fig-02", 0),
            ("pups-fig-05", 2),
            ("pups-fig-08", 0),
            ("pups-fig-extra-colors", 0),
            ("pups-fig-14", 3),
            ("pups-fig-15", 0),
        ];
        // The numbers are places in the list of all built-in recipes.
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
            row(&of_figures(&figures, HEIGHT)?)?,
            row(&of_figures(&recipes, HEIGHT)?)?,
        ];
        Ok(colored("", &below(&rows)?, COLORS))
    },
};

/// The number of shades of each channel, kept low so that the file is small.
const COLORS: f32 = 16.0;

/// The height of the pictures of a row, in pixels.
const HEIGHT: u32 = 171;
