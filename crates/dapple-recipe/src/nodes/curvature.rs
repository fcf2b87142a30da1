//! Curvature of a height as a gray value.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_color::{CurvatureOptions, HeightPlane, curvature_of_part, curvature_to_gray};
use dapple_filter::difference_spans;
use serde::{Deserialize, Serialize};

/// Curvature of a height as a gray value: ½ where it is flat, up to 1 on edges, and down to 0 in grooves.
///
/// It is the mean curvature of the surface times the radius, as in the curvature map of a bake. `levels` of it select
/// worn edges or dirty grooves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Curvature {
    /// Height: a number.
    pub input: Input,
    /// Height of the value 1, in units of the plane [default: the material's relief].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RELIEF }))]
    pub relief: Option<f64>,
    /// Radius of the differences, in units of the plane [default: 1/100 of the shorter side of the tile]. It is rounded to
    /// whole pixels and is at least one pixel. A hill with the shape of a sphere of this radius is white.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: Option<f64>,
}

impl NodeKind for Curvature {
    inputs!(input);

    fn reads_relief(&self) -> bool {
        self.relief.is_none()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (relief, radius) = (
            plan.relief(self.relief)?,
            plan.radius(self.radius, 1.0 / 100.0)?,
        );
        let input = plan.number(&self.input)?;
        let halo = move |pixel| difference_spans(radius, pixel);
        Ok(plan.neighborhood_of_heights(input, halo, move |around| {
            let options = CurvatureOptions {
                plane: HeightPlane {
                    strength: relief,
                    extent: around.part.pixel,
                    ..HeightPlane::default()
                },
                radius,
            };
            // One pixel is the whole raster of this extent.
            let curved = curvature_of_part(&around.raster(0)?, [1; 2], &options)?;
            let curved = curved.crop(around.part.halo, around.part.size)?;
            let gray = curved.map(|&curvature| curvature_to_gray(curvature, radius as f32));
            Ok(Values::Numbers(gray.into_pixels()))
        }))
    }
}
