//! Blur along the slope of a height.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use serde::{Deserialize, Serialize};

/// Blur of a number or a color along the slope of a height: values run downhill, as rust and dirt do.
///
/// The value of a pixel is the weighted mean along the path that leads uphill from it, up to three radii. On level
/// ground the path ends. Values stay the same if the radius is below a third of a pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SlopeBlur {
    /// Number or color to blur.
    pub input: Input,
    /// Height whose slope the values follow: a number.
    pub height: Input,
    /// Standard deviation of the Gaussian weights along the path, in units of the plane.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
}

impl NodeKind for SlopeBlur {
    inputs!(input, height);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let radius = plan.radius(Some(self.radius), 0.0)?;
        let height = plan.number(&self.height)?;
        let input = plan.any(&self.input)?;
        let halo = move |pixel| dapple_filter::SlopeBlur::new(radius, pixel).halo(pixel);
        let is_color = plan.is_color(input);
        let step = plan.neighborhood(vec![input, height], halo, move |around| {
            let blur = dapple_filter::SlopeBlur::new(radius, around.part.pixel);
            let heights = around.inputs[1].numbers();
            Ok(around.inputs[0].filtered(
                |numbers| blur.apply(numbers, heights, &around.part),
                |colors| blur.apply_colors(colors, heights, &around.part),
            ))
        });
        Ok(if is_color { step } else { step.with_numbers() })
    }
}
