//! Sums, products and other arithmetic of inputs at each position.

use super::NodeKind;
use crate::plan::{Builder, Step};
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
}

impl NodeKind for Subtract {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| a - b)
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
}

impl NodeKind for Divide {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| if b == 0.0 { 0.0 } else { a / b })
    }
}

impl NodeKind for Minimum {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| PairOperation::Minimum.apply(a, b))
    }
}

impl NodeKind for Maximum {
    fn inputs(&self) -> Vec<&Input> {
        self.0.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.fold(&self.0, |a, b| PairOperation::Maximum.apply(a, b))
    }
}

impl NodeKind for Absolute {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.0]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        plan.each(&self.0, f32::abs)
    }
}
