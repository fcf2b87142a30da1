//! Polar coordinates: bends a node around a center.

use super::{NodeKind, distance, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use dapple_wgsl::{Module, double_value};
use serde::{Deserialize, Serialize};

/// Another node, bent around a center: its width runs around the center, and its height outward.
///
/// The input is evaluated at `x = angle · repeat · width of the tile` and `y = distance from the center`. The angle is
/// clockwise in turns, and 0 to the right. Along axes on which the recipe repeats, the center is the nearest of its
/// copies; halfway between two copies, the angle jumps. Where the recipe does not repeat along x, the input must, or
/// there is a seam at the angle 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Polar {
    /// Node that is bent. A node that depends on the whole tile is interpolated between its pixels.
    pub input: Input,
    /// Position of the center, in units of the plane [default: the middle of the tile].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 2]>,
    /// Number of times that the width of the tile fits around the center.
    #[serde(default = "one")]
    #[cfg_attr(feature = "schema", schemars(transform = { REPEAT }))]
    pub repeat: u32,
}

fn one() -> u32 {
    1
}

const REPEAT: Range = range!(from 1 to 1024);

impl NodeKind for Polar {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(REPEAT, "number of repeats", self.repeat.into())?;
        let (center, tile) = (distance::center(plan, self.center)?, plan.domain());
        let around = f64::from(self.repeat) * tile.size.x;
        plan.folded(&self.input, move |position| {
            let [x, y] = distance::offset(position, center, &tile);
            let turns = libm::atan2(y, x) / core::f64::consts::TAU;
            // From 0 to below 1, like the tile
            let turns = turns - turns.floor();
            [turns * around, (x * x + y * y).sqrt()]
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.moved(&self.input)?;
        let [x, y] = distance::offset_code(shader, self.center);
        shader.needs(Module::DoubleAngle);
        let turn = double_value(core::f64::consts::TAU);
        let turns = shader.name(
            "turns",
            format!("double_div(double_angle({y}, {x}), {turn})"),
        );
        let ([width, _], _) = shader.tile();
        let around = double_value(f64::from(self.repeat) * width);
        let around = format!("double_mul(double_sub({turns}, double_floor({turns})), {around})");
        let at = format!("Position2d({around}, double_length({x}, {y}))");
        let at = shader.name("position", at);
        Ok(input(&at))
    }
}
