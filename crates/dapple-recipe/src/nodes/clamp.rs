//! Clamps numbers to a range.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use dapple_wgsl::number_value;
use serde::{Deserialize, Serialize};

/// Number clamped to a range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Clamp {
    /// Number to clamp.
    pub input: Input,
    /// Lower bound.
    #[serde(default)]
    pub low: f32,
    /// Upper bound, at least the lower bound.
    #[serde(default = "one")]
    pub high: f32,
}

fn one() -> f32 {
    1.0
}

const BOUND: Range = range!(finite);

impl NodeKind for Clamp {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (low, high) = (self.low, self.high);
        for bound in [low, high] {
            RecipeError::check_in(BOUND, "bound", bound.into())?;
        }
        RecipeError::check(
            low <= high,
            "upper bound",
            high.into(),
            "at least the lower bound",
        )?;
        plan.each(&self.input, move |value| value.clamp(low, high))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.number(&self.input)?;
        let [low, high] = [self.low, self.high].map(number_value);
        Ok(Code::number(format!(
            "number_clamp({input}, {low}, {high}, zero)"
        )))
    }
}
