//! Smooth minimum and maximum, which join shapes with a fillet.
//!
//! The polynomial of Inigo Quilez, "Smooth minimum", <https://iquilezles.org/articles/smin/>: it equals the minimum where
//! the inputs differ by the radius or more, and is lower by a quarter of the radius where they are equal.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal, quotient};
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

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        fold(shader, &self.inputs, self.radius, ["min", "sub"])
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

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        fold(shader, &self.inputs, self.radius, ["max", "add"])
    }
}

/// Returns the fillet: the amount by which the smooth minimum of `a` and `b` is below the minimum.
fn fillet(a: f32, b: f32, radius: f32) -> f32 {
    let overlap = radius - (a - b).abs();
    if overlap > 0.0 {
        overlap * overlap / (4.0 * radius)
    } else {
        0.0
    }
}

/// Writes WGSL for the smooth minimum or maximum of the inputs, combined pairwise from the first to the last. The
/// operations are functions of the module `Number`: `number_min` or `number_max`, and the one that subtracts or adds
/// the fillet.
fn fold(
    shader: &mut NodeShader<'_, '_>,
    inputs: &[Input],
    radius: f64,
    [selection, change]: [&str; 2],
) -> Result<Code, Refusal> {
    let (inputs, _) = shader.alike(inputs)?;
    let radius = radius as f32;
    let result = inputs.into_iter().reduce(|a, b| {
        let fillet = match radius == 0.0 {
            true => literal(0.0),
            false => {
                let gap = format!("abs(number_sub({a}, {b}, zero))");
                let overlap = format!("number_sub({}, {gap}, zero)", literal(radius));
                let overlap = shader.name("overlap", overlap);
                let square = format!("number_mul({overlap}, {overlap}, zero)");
                let fillet = quotient(&square, 4.0 * radius);
                format!("number(select(0.0, {fillet}, {overlap} > 0.0), zero)")
            }
        };
        let end = format!("number_{selection}({a}, {b}, zero)");
        shader.name("end", format!("number_{change}({end}, {fillet}, zero)"))
    });
    Ok(Code::number(result.unwrap_or_default()))
}
