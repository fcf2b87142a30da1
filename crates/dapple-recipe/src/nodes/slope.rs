//! Steepness of a height.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use core::f64::consts::FRAC_2_PI;
use dapple_filter::{difference_spans, gradients};
use serde::{Deserialize, Serialize};

/// Steepness of a height: 0 where it is level, ½ at 45 degrees, and 1 where it is vertical.
///
/// It is the angle of the surface as a part of a right angle, from central differences. It is 0 where a height is not
/// finite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Slope {
    /// Height: a number.
    pub input: Input,
    /// Height of the value 1, in units of the plane [default: the material's relief].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RELIEF }))]
    pub relief: Option<f64>,
    /// Radius of the differences, in units of the plane [default: one pixel]. It is rounded to whole pixels and is at
    /// least one pixel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: Option<f64>,
}

impl NodeKind for Slope {
    inputs!(input);

    fn reads_relief(&self) -> bool {
        self.relief.is_none()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let relief = plan.relief(self.relief)?;
        let radius = match self.radius {
            None => 0.0,
            radius => plan.radius(radius, 0.0)?,
        };
        let input = plan.number(&self.input)?;
        let halo = move |pixel| difference_spans(radius, pixel);
        Ok(plan.neighborhood_of_heights(input, halo, move |around| {
            let angle = |steepness: f64| match steepness.is_finite() {
                true => (libm::atan(steepness) * FRAC_2_PI) as f32,
                false => 0.0,
            };
            let heights = around.inputs[0].numbers();
            let angles = gradients(heights, &around.part, relief, &angle);
            Ok(Values::Numbers(angles))
        }))
    }
}
