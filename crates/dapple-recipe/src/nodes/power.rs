//! Raises numbers to a power.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// Number raised to a power.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Power {
    /// Base of the power: a number; negative values count as 0.
    pub input: Input,
    /// Exponent of the power, above 0.
    #[cfg_attr(feature = "schema", schemars(transform = { EXPONENT }))]
    pub exponent: f32,
}

const EXPONENT: Range = range!(above 0);

impl NodeKind for Power {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let exponent = self.exponent;
        RecipeError::check_in(EXPONENT, "exponent", exponent.into())?;
        plan.each(&self.input, move |value| {
            let positive = if value < 0.0 { 0.0 } else { value };
            libm::powf(positive, exponent)
        })
    }
}
