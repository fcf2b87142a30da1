//! Makes textures repeat.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, RecipeErrorKind, Values};
use dapple_tile::{Method, Seamless};
use serde::{Deserialize, Serialize};

/// A texture made to repeat, for inputs that do not repeat, such as a photograph. It depends on the whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tiled {
    /// A number or a color.
    pub input: Input,
    /// The method; the periodic part by default. Lengths in it are in pixels of the bake.
    #[serde(default)]
    pub method: Method,
    /// The axes along which the result repeats; both by default.
    #[serde(default = "both")]
    pub axes: [bool; 2],
}

fn both() -> [bool; 2] {
    [true; 2]
}

impl NodeKind for Tiled {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let seamless = Seamless {
            method: self.method,
            axes: self.axes,
        };
        let inputs = vec![plan.any(&self.input)?];
        Ok(plan.global(inputs, [1; 2], move |tile| {
            let tiled = seamless.apply_maps(&tile.maps()?)?;
            if tiled[0].size() != tile.window.size {
                let rule = "a tile in a recipe keeps its size, and this method does not";
                return Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
            }
            Values::of_map(tiled)
        }))
    }
}
