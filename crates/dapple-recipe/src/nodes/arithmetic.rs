//! Sums, products and other arithmetic of inputs at each position.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use dapple_color::LinearRgb;
use dapple_raster::PairOperation;
use serde::{Deserialize, Serialize};

/// Sum of all inputs: numbers or colors, at least one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Add(pub Vec<Input>);

/// First number minus the second.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Subtract(pub [Input; 2]);

/// Product of all inputs: numbers or colors (by component), at least one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Multiply(pub Vec<Input>);

/// First number divided by the second; 0 where the second is 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Divide(pub [Input; 2]);

/// Minimum of all inputs: numbers, at least one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Minimum(pub Vec<Input>);

/// Maximum of all inputs: numbers, at least one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Maximum(pub Vec<Input>);

/// Absolute value of a number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Absolute(pub Input);

impl NodeKind for Add {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold_any(&self.0, |a, b| a + b, |a, b| a + b)
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        fold(shader, &self.0, "add")
    }
}

impl NodeKind for Subtract {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| a - b)
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        fold(shader, &self.0, "sub")
    }
}

impl NodeKind for Multiply {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let of_colors =
            |a: LinearRgb, b: LinearRgb| LinearRgb::new(a.r * b.r, a.g * b.g, a.b * b.b);
        plan.fold_any(&self.0, |a, b| a * b, of_colors)
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        fold(shader, &self.0, "mul")
    }
}

impl NodeKind for Divide {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| if b == 0.0 { 0.0 } else { a / b })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let [a, b] = [shader.number(&self.0[0])?, shader.number(&self.0[1])?];
        let b = shader.name("divisor", b);
        Ok(Code::number(format!(
            "select(number_div({a}, {b}, zero), 0.0, {b} == 0.0)"
        )))
    }
}

impl NodeKind for Minimum {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| PairOperation::Minimum.apply(a, b))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        fold(shader, &self.0, "min")
    }
}

impl NodeKind for Maximum {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| PairOperation::Maximum.apply(a, b))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        fold(shader, &self.0, "max")
    }
}

impl NodeKind for Absolute {
    inputs!(0);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.each(&self.0, f32::abs)
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        Ok(Code::number(format!("abs({})", shader.number(&self.0)?)))
    }
}

/// Writes an operation on the inputs, pairwise, from the first to the last.
fn fold(
    shader: &mut NodeShader<'_, '_>,
    inputs: &[Input],
    operation: &str,
) -> Result<Code, Refusal> {
    let (inputs, is_color) = shader.alike(inputs)?;
    let prefix = if is_color { "exact" } else { "number" };
    let inputs = inputs.into_iter();
    let text = inputs.reduce(|a, b| format!("{prefix}_{operation}({a}, {b}, zero)"));
    let text = text.unwrap_or_default();
    Ok(Code { text, is_color })
}
