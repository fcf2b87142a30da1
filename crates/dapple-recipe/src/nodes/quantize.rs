//! Rounds a number to steps.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal, quotient};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// Number rounded to the nearest of a few evenly spaced values, such as terraces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Quantize {
    /// Number to round.
    pub input: Input,
    /// Number of values from 0 to 1, both included; past these ends, the spacing is the same.
    #[serde(default = "steps")]
    #[cfg_attr(feature = "schema", schemars(transform = { STEPS }))]
    pub steps: u32,
}

fn steps() -> u32 {
    4
}

const STEPS: Range = range!(from 2 to 65536);

impl NodeKind for Quantize {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(STEPS, "number of steps", self.steps.into())?;
        let last = (self.steps - 1) as f32;
        plan.each(&self.input, move |value| {
            (value * last + 0.5).floor() / last
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.number(&self.input)?;
        let last = (self.steps - 1) as f32;
        let step = format!("number_mul({input}, {}, zero)", literal(last));
        let step = format!("floor(number_add({step}, 0.5, zero))");
        Ok(Code::number(quotient(&step, last)))
    }
}
