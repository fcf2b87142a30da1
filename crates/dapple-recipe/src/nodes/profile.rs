//! Cross-section profiles of bumps, as functions of one variable.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, quotient};
use crate::{Input, RecipeError};
use dapple_worley::Profile;
use serde::{Deserialize, Serialize};

/// Cross-section of a bump: the height as a function of a number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ProfileOf {
    /// Number that is converted to a height; 0 is the middle of the bump.
    pub input: Input,
    /// Cross-section, such as `{ channels = { width = 0.1 } }` or `{ spots = { radius = 0.3 } }`.
    pub shape: Profile,
}

impl NodeKind for ProfileOf {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let shape = self.shape;
        shape.check()?;
        plan.each(&self.input, move |value| shape.height(value))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.number(&self.input)?;
        match self.shape {
            Profile::Spots { radius } => {
                let t = quotient(&input, radius);
                let t = shader.name("part", format!("number_clamp({t}, -1.0, 1.0, zero)"));
                let square = format!("number_mul({t}, {t}, zero)");
                let rest = shader.name("part", format!("number_sub(1.0, {square}, zero)"));
                Ok(Code::number(format!("number_mul({rest}, {rest}, zero)")))
            }
            Profile::Channels { width } => {
                let t = quotient(&input, width);
                let t = format!("number_clamp({t}, 0.0, 1.0, zero)");
                Ok(Code::number(format!("number_smooth({t}, zero)")))
            }
            _ => Err(Refusal::new("this profile has no shader")),
        }
    }
}
