//! Nodes whose value is the coordinate along a direction.

use super::NodeKind;
use crate::RecipeError;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use dapple_raster::field_fn;
use dapple_raster::{Range, range};
use dapple_wgsl::double_value;
use serde::{Deserialize, Serialize};

/// Coordinate of a position along a direction: `(position − center) · along`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Coordinate {
    /// Position where the coordinate is 0, in units of the plane.
    pub center: [f64; 2],
    /// Direction of the coordinate; the length of the vector is the increase per unit of the plane.
    pub along: [f64; 2],
}

impl Default for Coordinate {
    fn default() -> Self {
        Self {
            center: [0.0; 2],
            along: [1.0, 0.0],
        }
    }
}

const PART: Range = range!(finite);

impl NodeKind for Coordinate {
    fn build(&self, _: &mut Builder<'_>) -> Result<Step, RecipeError> {
        for number in self.center.into_iter().chain(self.along) {
            RecipeError::check_in(PART, "part of a coordinate", number)?;
        }
        let (center, along) = (self.center, self.along);
        Ok(Step::field(field_fn(move |[x, y]| {
            ((x - center[0]) * along[0] + (y - center[1]) * along[1]) as f32
        })))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let at = shader.position([1.0; 2]);
        let [x, y] = [("x", 0), ("y", 1)].map(|(axis, index)| {
            let [center, along] = [self.center[index], self.along[index]];
            let from_center = match center == 0.0 {
                true => format!("{at}.{axis}"),
                false => format!("double_sub({at}.{axis}, {})", double_value(center)),
            };
            format!("double_mul({from_center}, {})", double_value(along))
        });
        Ok(Code::number(format!(
            "double_to_float(double_add({x}, {y}))"
        )))
    }
}
