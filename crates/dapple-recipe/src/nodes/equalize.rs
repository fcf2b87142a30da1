//! Numbers spread evenly from 0 to 1.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_tile::rank_equalize;
use serde::{Deserialize, Serialize};

/// Number spread evenly from 0 to 1: the share of the tile's pixels with lower numbers.
///
/// A threshold of 0.3 then covers 30 % of the tile, whatever the input. Equal numbers are ranked in random order. The
/// result depends on the whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Equalize {
    /// Number, or a color, whose luminance is used.
    pub input: Input,
}

impl NodeKind for Equalize {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let inputs = vec![plan.any(&self.input)?];
        let step = plan.global(inputs, [1; 2], |tile| {
            let numbers = tile.inputs[0].raster(tile.window.size)?;
            Ok(Values::Numbers(rank_equalize(&numbers)?.into_pixels()))
        });
        Ok(step.with_numbers())
    }
}
