//! Raises numbers to a power.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use dapple_wgsl::Module;
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
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let exponent = self.exponent;
        RecipeError::check_in(EXPONENT, "exponent", exponent.into())?;
        plan.each(&self.input, move |value| {
            let positive = if value < 0.0 { 0.0 } else { value };
            libm::powf(positive, exponent)
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        if self.exponent >= 134_217_728.0 {
            return Err(Refusal::new("exponents of 2^27 and more have no shader"));
        }
        let input = shader.number(&self.input)?;
        let base = shader.name("base", format!("number_max({input}, 0.0, zero)"));
        // The CPU treats three exponents separately.
        Ok(Code::number(if self.exponent == 1.0 {
            base
        } else if self.exponent == 2.0 {
            format!("number_mul({base}, {base}, zero)")
        } else if self.exponent == 0.5 {
            shader.needs(Module::Root);
            format!("exact_root({base})")
        } else {
            shader.needs(Module::Power);
            format!("number_power({base}, {}, zero)", literal(self.exponent))
        }))
    }
}
