//! Textures with the borders of another texture, so that both fit next to each other.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_tile::MatchBorders;
use serde::{Deserialize, Serialize};

/// Texture with the borders of another texture, so that both fit next to each other: see [`MatchBorders`]. The result
/// depends on the whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Framed {
    /// Texture whose borders are replaced: a number or a color.
    pub input: Input,
    /// Texture that provides the borders: a number or a color.
    pub border: Input,
    /// Width of the strip that changes, in pixels, and the part of the other texture that becomes the border.
    ///
    /// The options are those of [`MatchBorders`]. One pixel is a pixel of the bake.
    #[serde(default)]
    pub options: MatchBorders,
}

impl NodeKind for Framed {
    inputs!(input, border);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let options = self.options;
        let inputs = vec![plan.any(&self.border)?, plan.any(&self.input)?];
        Ok(plan.global(inputs, [1; 2], move |tile| {
            let maps: Vec<_> = tile.maps()?.into_iter().map(|map| vec![map]).collect();
            let mut matched = options.apply_maps_cancellable(&maps, &tile.is_cancelled())?;
            Values::of_map(matched.swap_remove(1))
        }))
    }
}
