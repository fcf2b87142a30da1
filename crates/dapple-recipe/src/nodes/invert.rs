//! Inverts a number or a color.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError, Values};
use dapple_color::LinearRgb;
use serde::{Deserialize, Serialize};

/// 1 minus a number or a color (by linear component).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Invert(pub Input);

impl NodeKind for Invert {
    inputs!(0);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let inputs = vec![plan.any(&self.0)?];
        Ok(plan.local(inputs, |inputs| {
            Ok(match inputs[0] {
                Values::Numbers(numbers) => {
                    Values::Numbers(numbers.iter().map(|number| 1.0 - number).collect())
                }
                Values::Colors(colors) => {
                    let invert = |color: &LinearRgb| color.to_array().map(|part| 1.0 - part).into();
                    Values::Colors(colors.iter().map(invert).collect())
                }
            })
        }))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.any(&self.0)?;
        Ok(match input.is_color {
            true => Code::color(format!("exact_sub(vec4(1.0), {}, zero)", input.text)),
            false => Code::number(format!("number_sub(1.0, {}, zero)", input.text)),
        })
    }
}
