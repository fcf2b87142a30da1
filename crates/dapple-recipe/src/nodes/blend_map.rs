//! Blend maps, which are low where another texture shows first, such as in cracks.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_tile::{BlendMap, rank_equalize};
use serde::{Deserialize, Serialize};

/// Blend map: a number from 0 to 1 that is low in the cracks of a texture, where another texture shows first.
///
/// All values are equally frequent. The map depends on the whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BlendMapOf {
    /// Texture: a number, or a color, whose luminance is used.
    pub input: Input,
    /// Size of the features, such as the diameter of stones, in units of the plane.
    pub feature_size: f64,
    /// Steepness of the map around its median, before values are equalized, at least 0.
    #[serde(default = "one")]
    pub contrast: f64,
}

fn one() -> f64 {
    1.0
}

impl NodeKind for BlendMapOf {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let how = BlendMap::new(32.0)
            .with_contrast(self.contrast)
            .with_wrap(plan.wrap());
        let feature_size = self.feature_size;
        let inputs = vec![plan.any(&self.input)?];
        let step = plan.global(inputs, [1; 2], move |tile| {
            let mut how = how;
            how.feature_size = feature_size / tile.window.pixel[0].max(tile.window.pixel[1]);
            let texture = tile.inputs[0].raster(tile.window.size)?;
            let map = how.apply_cancellable(&texture, &tile.is_cancelled())?;
            tile.watch.check()?;
            Ok(Values::Numbers(rank_equalize(&map)?.into_pixels()))
        });
        Ok(step.with_numbers())
    }
}
