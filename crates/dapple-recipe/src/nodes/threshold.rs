//! Compares a number with a threshold.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal, quotient};
use crate::{Input, RecipeError, Values};
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// 1 where a number is above a threshold and 0 where it is below, with a soft transition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Threshold {
    /// Number to compare.
    pub input: Input,
    /// Threshold: a number, in the middle of the transition.
    #[serde(default = "half")]
    pub threshold: Input,
    /// Width of the transition, in units of the input; 0 is a hard edge, where the threshold itself is above.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schemars(transform = { WIDTH }))]
    pub width: f32,
}

fn half() -> Input {
    Input::Number(0.5)
}

const WIDTH: Range = range!(at least 0);

impl NodeKind for Threshold {
    inputs!(input, threshold);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let width = self.width;
        RecipeError::check_in(WIDTH, "width of the transition", width.into())?;
        let inputs = vec![plan.number(&self.input)?, plan.number(&self.threshold)?];
        Ok(plan.local(inputs, move |inputs| {
            let pairs = inputs[0].numbers().iter().zip(inputs[1].numbers());
            Ok(Values::Numbers(
                pairs
                    .map(|(&value, &threshold)| transition(value - threshold, width))
                    .collect(),
            ))
        }))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let (input, threshold) = (shader.number(&self.input)?, shader.number(&self.threshold)?);
        let above = format!("number_sub({input}, {threshold}, zero)");
        let above = shader.name("above", above);
        let hard = format!("number(select(0.0, 1.0, {above} >= 0.0), zero)");
        if self.width == 0.0 {
            return Ok(Code::number(hard));
        }
        let t = format!("number_add({}, 0.5, zero)", quotient(&above, self.width));
        let width = literal(self.width);
        Ok(Code::number(format!(
            "select(number_smooth({t}, zero), {hard}, 2.0 * abs({above}) >= {width})"
        )))
    }
}

/// Returns a smooth step from 0 to 1 as `difference`, a value minus the threshold, passes through 0. `width` is the
/// width of the transition.
fn transition(difference: f32, width: f32) -> f32 {
    if difference.is_nan() {
        return difference;
    }
    // Also for a width so small that the quotient is not a number or infinite
    if 2.0 * difference.abs() >= width {
        return if difference >= 0.0 { 1.0 } else { 0.0 };
    }
    let t = difference / width + 0.5;
    t * t * (3.0 - 2.0 * t)
}
