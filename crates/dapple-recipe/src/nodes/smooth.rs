//! Smooth minimum and maximum, which join shapes with a fillet.
//!
//! The polynomial of Inigo Quilez, "Smooth minimum", <https://iquilezles.org/articles/smin/>: it equals the minimum where
//! the inputs differ by the radius or more, and is lower by a quarter of the radius where they are equal.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use dapple_raster::{PairOperation, Range, range};
use serde::{Deserialize, Serialize};

/// Smooth minimum of all inputs, combined from the first to the last: the union of shapes given by distances.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SmoothMinimum {
    /// Inputs: numbers, at least one.
    pub inputs: Vec<Input>,
    /// Difference of two inputs at and above which the result equals the minimum; 0 for the minimum.
    #[serde(default = "radius")]
    #[cfg_attr(feature = "schema", schemars(transform = { RADIUS }))]
    pub radius: f64,
}

/// Smooth maximum of all inputs, combined from the first to the last: the intersection of shapes given by distances.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SmoothMaximum {
    /// Inputs: numbers, at least one.
    pub inputs: Vec<Input>,
    /// Difference of two inputs at and above which the result equals the maximum; 0 for the maximum.
    #[serde(default = "radius")]
    #[cfg_attr(feature = "schema", schemars(transform = { RADIUS }))]
    pub radius: f64,
}

const RADIUS: Range = range!(from 0 to 1e6);

fn radius() -> f64 {
    0.1
}

impl NodeKind for SmoothMinimum {
    fn inputs(&self) -> Vec<&Input> {
        self.inputs.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(RADIUS, "radius", self.radius)?;
        let radius = self.radius as f32;
        plan.fold(&self.inputs, move |a, b| {
            PairOperation::Minimum.apply(a, b) - fillet(a, b, radius)
        })
    }
}

impl NodeKind for SmoothMaximum {
    fn inputs(&self) -> Vec<&Input> {
        self.inputs.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(RADIUS, "radius", self.radius)?;
        let radius = self.radius as f32;
        plan.fold(&self.inputs, move |a, b| {
            PairOperation::Maximum.apply(a, b) + fillet(a, b, radius)
        })
    }
}

/// Returns the difference between the minimum and the smooth minimum of two numbers.
fn fillet(a: f32, b: f32, radius: f32) -> f32 {
    let overlap = radius - (a - b).abs();
    if overlap > 0.0 {
        overlap * overlap / (4.0 * radius)
    } else {
        0.0
    }
}
