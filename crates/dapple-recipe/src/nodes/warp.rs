//! Domain warping: evaluates a node at displaced positions.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Moved, Positions, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use dapple_wgsl::double_value;
use serde::{Deserialize, Serialize};

/// Another node, sampled at positions displaced by `amount · (x, y)`.
#[doc(alias = "domain warping")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Warp {
    /// Node that is sampled at the displaced positions.
    ///
    /// A node that depends on the whole tile is interpolated between its pixels.
    pub input: Input,
    /// Displacement to the right, as a multiple of `amount`: a number.
    pub x: Input,
    /// Displacement down, as a multiple of `amount`: a number.
    pub y: Input,
    /// Displacement for a value of 1, in units of the plane.
    #[serde(default = "one")]
    pub amount: f64,
}

fn one() -> f64 {
    1.0
}

const AMOUNT: Range = range!(finite);

impl NodeKind for Warp {
    inputs!(input, x, y);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(AMOUNT, "amount", self.amount)?;
        let input = plan.any(&self.input)?;
        Ok(Step::Moved(Moved {
            input,
            color: plan.is_color(input),
            positions: Positions::Displaced {
                by: [plan.number(&self.x)?, plan.number(&self.y)?],
                amount: self.amount,
            },
        }))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.moved(&self.input)?;
        let [x, y] = [shader.number(&self.x)?, shader.number(&self.y)?].map(|shift| {
            let shift = format!("double_from({shift})");
            match self.amount == 1.0 {
                true => shift,
                false => format!("double_mul({shift}, {})", double_value(self.amount)),
            }
        });
        let at = shader.position([1.0; 2]);
        let at = shader.name("position", format!("shifted_2d({at}, {x}, {y})"));
        Ok(input(&at))
    }
}
