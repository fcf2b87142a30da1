//! The built-in recipes, which reproduce textures of the papers.

use crate::{Recipe, RecipeError, RecipeErrorKind};

/// The names and texts of the built-in recipes, sorted by name.
const BUILTIN: [(&str, &str); 20] = [
    ("clouds", include_str!("builtin/clouds.toml")),
    ("coastline", include_str!("builtin/coastline.toml")),
    ("cow", include_str!("builtin/cow.toml")),
    ("craters", include_str!("builtin/craters.toml")),
    (
        "crumpled-paper",
        include_str!("builtin/crumpled-paper.toml"),
    ),
    ("crusty-skin", include_str!("builtin/crusty-skin.toml")),
    ("flagstone", include_str!("builtin/flagstone.toml")),
    ("giraffe", include_str!("builtin/giraffe.toml")),
    ("ice", include_str!("builtin/ice.toml")),
    ("marble", include_str!("builtin/marble.toml")),
    ("mountains", include_str!("builtin/mountains.toml")),
    ("polka-dots", include_str!("builtin/polka-dots.toml")),
    ("radial-hull", include_str!("builtin/radial-hull.toml")),
    ("rock", include_str!("builtin/rock.toml")),
    ("sea-water", include_str!("builtin/sea-water.toml")),
    (
        "spaceship-hull",
        include_str!("builtin/spaceship-hull.toml"),
    ),
    (
        "stone-and-grass",
        include_str!("builtin/stone-and-grass.toml"),
    ),
    ("tinfoil", include_str!("builtin/tinfoil.toml")),
    ("vein-tracery", include_str!("builtin/vein-tracery.toml")),
    ("wood-grain", include_str!("builtin/wood-grain.toml")),
];

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
