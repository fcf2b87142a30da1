//! Stretches images over the tile.

use super::{ImageAlpha, NodeKind};
use crate::RecipeError;
use crate::plan::{Builder, Step, StretchedImage};
use serde::{Deserialize, Serialize};

/// An image, laid over the tile and interpolated between its pixels, or averaged over each pixel of a smaller bake; past its
/// edges it repeats or is clamped, as the recipe is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ImageNode {
    /// The image file; the command reads it from the folder of the recipe.
    pub file: String,
    /// The use of its alpha; by default a partly transparent image is an error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<ImageAlpha>,
    /// The layer of an OpenEXR file with several, such as `ViewLayer.DiffCol`; by default the one without a name,
    /// `Combined`, `rgba` or `beauty`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<String>,
}

impl NodeKind for ImageNode {
    fn images(&self) -> Vec<&str> {
        vec![&self.file]
    }

    fn alpha(&self) -> Option<ImageAlpha> {
        self.alpha
    }

    fn layer(&self) -> Option<&str> {
        self.layer.as_deref()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        Ok(Step::Image(StretchedImage {
            picture: plan.layer_of(&self.file, self.layer())?.clone(),
            origin: plan.domain().origin,
            extent: plan.domain().size,
            wrap: plan.wrap(),
        }))
    }
}
