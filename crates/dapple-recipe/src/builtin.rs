//! The built-in recipes: materials for games, and textures of the papers.

use crate::{Recipe, RecipeError, RecipeErrorKind};

/// Defines the names and texts of the built-in recipes, whose files have the same names.
macro_rules! builtin {
    ($($name:literal)*) => {
        const BUILTIN: [(&str, &str); [$($name),*].len()] =
            [$(($name, include_str!(concat!("builtin/", $name, ".toml")))),*];
    };
}

// Sorted by name.
builtin! {
    "ashlar-wall"
    "asphalt"
    "bark"
    "birch-bark"
    "black-leather"
    "black-marble"
    "brick-wall"
    "brushed-metal"
    "canvas"
    "cardboard"
    "carpet"
    "cast-iron"
    "chipped-paint"
    "clouds"
    "coastline"
    "cobblestones"
    "concrete"
    "concrete-panels"
    "coral"
    "corrugated-metal"
    "cow"
    "cracked-mud"
    "craters"
    "crumpled-paper"
    "crusty-skin"
    "denim"
    "diamond-plate"
    "fallen-leaves"
    "felt"
    "flagstone"
    "flemish-bricks"
    "floor-tiles"
    "foam"
    "forest-floor"
    "giraffe"
    "gold-leaf"
    "granite"
    "grass"
    "gravel"
    "herringbone-pavers"
    "hexagon-tiles"
    "ice"
    "knit"
    "lava"
    "leather"
    "marble"
    "meadow"
    "moss"
    "mountains"
    "old-brick-wall"
    "painted-planks"
    "pebbles"
    "perforated-metal"
    "planks"
    "plaster"
    "plywood"
    "polka-dots"
    "pool-water"
    "radial-hull"
    "riveted-plates"
    "rock"
    "rock-cliff"
    "roof-tiles"
    "rubber"
    "rusty-metal"
    "sand"
    "sand-ripples"
    "scales"
    "sci-fi-panels"
    "sea-water"
    "slate-roof"
    "snow"
    "soil"
    "spaceship-hull"
    "stone-and-grass"
    "stone-wall"
    "stucco"
    "terrazzo"
    "tinfoil"
    "vein-tracery"
    "wood-floor"
    "wood-grain"
}

impl Recipe {
    /// Returns the built-in recipe called `name`.
    ///
    /// # Errors
    ///
    /// [`UnknownRecipe`](RecipeErrorKind::UnknownRecipe), with the nearest name, if no built-in recipe has this name.
    pub fn builtin(name: &str) -> Result<Self, RecipeError> {
        Self::from_toml(Self::builtin_text(name)?)
    }

    /// Returns the text of the built-in recipe called `name`.
    ///
    /// # Errors
    ///
    /// Same as [`builtin`](Self::builtin).
    pub fn builtin_text(name: &str) -> Result<&'static str, RecipeError> {
        let found = BUILTIN.iter().find(|(known, _)| *known == name);
        found.map(|&(_, text)| text).ok_or_else(|| {
            let name = name.to_owned();
            let error = RecipeError::new(RecipeErrorKind::UnknownRecipe { name: name.clone() });
            error.meant(&name, Self::builtin_names())
        })
    }

    /// Returns the names of the built-in recipes, sorted.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        BUILTIN.iter().map(|&(name, _)| name)
    }
}
