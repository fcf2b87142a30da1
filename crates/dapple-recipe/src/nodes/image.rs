//! Images, laid over the tile.

use super::{ImageAlpha, NodeKind};
use crate::RecipeError;
use crate::plan::{Builder, Laid, Step};
use serde::{Deserialize, Serialize};

/// An image, laid over the tile and read between its pixels; past its edges it repeats, or goes on, as the recipe does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ImageNode {
    /// The file, as it is asked for; the command takes it from the folder of the recipe.
    pub file: String,
    /// How its alpha is used; by default a partly transparent image is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<ImageAlpha>,
}

impl NodeKind for ImageNode {
    fn image(&self) -> Option<(&str, Option<ImageAlpha>)> {
        Some((&self.file, self.alpha))
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        Ok(Step::Image(Laid {
            picture: plan.image(&self.file)?.clone(),
            extent: plan.domain().size,
            wrap: plan.wrap(),
        }))
    }
}
