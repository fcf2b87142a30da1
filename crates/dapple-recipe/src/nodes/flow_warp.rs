//! Warp along the slope of a height, in steps.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use dapple_filter::FlowDirection;
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// A number or a color that flows along the slope or the contour lines of a height: eddies, marbling, drips.
///
/// The value of a pixel is that at the end of a path against the flow. Every step of the path has the same length and
/// follows the slope at its place, so that the flow bends with the height. On level ground the path ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FlowWarpNode {
    /// Number or color that is moved.
    pub input: Input,
    /// Height whose slope the values follow: a number.
    pub height: Input,
    /// Length of the path, in units of the plane.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub amount: f64,
    /// Direction of the flow.
    #[serde(default)]
    pub direction: FlowDirection,
    /// Number of steps of the path.
    #[serde(default = "steps")]
    #[cfg_attr(feature = "schema", schemars(transform = { STEPS }))]
    pub steps: u32,
}

fn steps() -> u32 {
    16
}

const STEPS: Range = range!(from 1 to 64);

impl NodeKind for FlowWarpNode {
    inputs!(input, height);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(STEPS, "number of steps", f64::from(self.steps))?;
        let amount = plan.radius(Some(self.amount), 0.0)?;
        let height = plan.number(&self.height)?;
        let input = plan.any(&self.input)?;
        let warp = dapple_filter::FlowWarp::new(amount, self.steps, self.direction);
        let is_color = plan.is_color(input);
        let of_halo = warp.clone();
        let halo = move |pixel| of_halo.halo(pixel);
        let step = plan.neighborhood(vec![input, height], halo, move |around| {
            let heights = around.inputs[1].numbers();
            Ok(around.inputs[0].filtered(
                |numbers| warp.apply(numbers, heights, &around.part),
                |colors| warp.apply_colors(colors, heights, &around.part),
            ))
        });
        Ok(if is_color { step } else { step.with_numbers() })
    }
}
