//! Stretches images over the tile.

use super::{ImageAlpha, NodeKind};
use crate::RecipeError;
use crate::plan::{Builder, Step, StretchedImage};
use serde::{Deserialize, Serialize};

/// Image, stretched over the tile and interpolated between its pixels.
///
/// In a smaller bake, the image is averaged over each pixel. Past its edges, the image repeats or is clamped, depending
/// on whether the recipe repeats.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ImageNode {
    /// Name of the image file, relative to the folder of the recipe.
    pub file: String,
    /// Conversion of an image with alpha to an opaque one [default: a partly transparent image is an error].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<ImageAlpha>,
    /// Layer of an OpenEXR file with several layers, such as `ViewLayer.DiffCol` [default: the unnamed layer,
    /// `Combined`, `rgba` or `beauty`].
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
