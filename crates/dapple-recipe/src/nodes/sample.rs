//! Evaluates a node at positions that two other nodes give.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Moved, Positions, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use dapple_wgsl::Module;
use serde::{Deserialize, Serialize};

/// Another node, evaluated at the position `(x, y) · scale`.
///
/// With the local coordinates `u` and `v` of a pattern, each brick or leaf shows the same part of the input, such as an
/// image. The result repeats where `x` and `y` do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SampleAt {
    /// Node that is evaluated. A node that depends on the whole tile is interpolated between its pixels, and an image is
    /// averaged over the area of a pixel of the result.
    pub input: Input,
    /// First coordinate of the position: a number.
    pub x: Input,
    /// Second coordinate of the position: a number.
    pub y: Input,
    /// Position for `x` and `y` of 1, in units of the plane.
    #[serde(default = "one")]
    pub scale: [f64; 2],
}

fn one() -> [f64; 2] {
    [1.0; 2]
}

const SCALE: Range = range!(finite);

impl NodeKind for SampleAt {
    inputs!(input, x, y);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        for scale in self.scale {
            RecipeError::check_in(SCALE, "scale", scale)?;
        }
        let input = plan.any(&self.input)?;
        Ok(Step::Moved(Moved {
            input,
            color: plan.is_color(input),
            positions: Positions::Given {
                by: [plan.number(&self.x)?, plan.number(&self.y)?],
                scale: self.scale,
            },
        }))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.moved(&self.input)?;
        let [x, y] = [shader.number(&self.x)?, shader.number(&self.y)?];
        shader.needs(Module::Position2d);
        let given = shader.name(
            "position",
            format!("Position2d(double_from({x}), double_from({y}))"),
        );
        let at = shader.scaled(&given, self.scale);
        Ok(input(&at))
    }
}
