//! Makes textures repeat.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, RecipeErrorKind, Values};
use dapple_tile::{Method, Seamless};
use serde::{Deserialize, Serialize};

/// Texture made to repeat seamlessly, for inputs that do not repeat, such as photographs. The result depends on the
/// whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tiled {
    /// Texture to convert: a number or a color.
    pub input: Input,
    /// Method that makes the texture repeat; lengths are in pixels of the bake.
    #[serde(default)]
    pub method: Method,
    /// Whether the result repeats along each axis, x first.
    #[serde(default = "both")]
    pub axes: [bool; 2],
}

fn both() -> [bool; 2] {
    [true; 2]
}

impl NodeKind for Tiled {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let seamless = Seamless {
            method: self.method,
            axes: self.axes,
        };
        let inputs = vec![plan.any(&self.input)?];
        Ok(plan.global(inputs, [1; 2], move |tile| {
            let tiled = seamless.apply_maps_cancellable(&tile.maps()?, &tile.is_cancelled())?;
            if tiled[0].size() != tile.window.size {
                let rule = "a tile in a recipe keeps its size, and this method does not";
                return Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
            }
            Values::of_map(tiled)
        }))
    }
}
