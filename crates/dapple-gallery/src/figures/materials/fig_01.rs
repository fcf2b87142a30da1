//! The built-in recipes, each baked to its maps and lit from the upper left. `dapple bake flagstone -o out/`
//! writes the maps of one of them.

use super::lit::lit;
use crate::figure::source;
use crate::{Figure, Panel};
use dapple_recipe::Recipe;

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("maps", "normal, occlusion, albedo, roughness, metallic"),
        ("light", "one sun, and a sky that is bright above"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let panel = |name| {
        let recipe = Recipe::builtin(name)?;
        Ok(Panel::color(name, lit(&recipe, size)?).repeating_along(recipe.wrap))
    };
    Recipe::builtin_names().map(panel).collect()
}
