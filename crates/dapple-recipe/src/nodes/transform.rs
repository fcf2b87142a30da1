//! Rotates, scales and shifts a node.

use super::{Frequency, NodeKind, inputs};
use crate::plan::{Builder, LinearMap, Moved, Positions, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError, RecipeErrorKind};
use dapple_pattern::direction;
use dapple_raster::{Range, range};
use dapple_wgsl::double_value;
use serde::{Deserialize, Serialize};

/// Another node, rotated about the origin, repeated more often, and shifted.
///
/// The input is evaluated at `frequency · rotated position + offset`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Transform {
    /// Node that is transformed. A node that depends on the whole tile is interpolated between its pixels.
    pub input: Input,
    /// Frequency relative to the input: one number, or one for each axis; whole numbers where the recipe repeats.
    #[serde(default)]
    pub frequency: Frequency,
    /// Shift of the positions at which the input is evaluated, in units of the plane.
    #[serde(default)]
    pub offset: [f64; 2],
    /// Clockwise rotation in degrees; a multiple of 90 where the recipe repeats.
    #[serde(default)]
    pub rotation: f64,
}

const FINITE: Range = range!(finite);

impl NodeKind for Transform {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        for frequency in self.frequency.0 {
            RecipeError::check_in(crate::plan::FREQUENCY, "frequency", frequency)?;
        }
        for offset in self.offset {
            RecipeError::check_in(FINITE, "offset", offset)?;
        }
        RecipeError::check_in(FINITE, "rotation", self.rotation)?;
        let map = LinearMap {
            direction: direction(self.rotation),
            frequency: self.frequency.0,
            offset: self.offset,
        };
        let domain = plan.domain();
        if !repeats(&map, domain.size.into(), domain.wrap) {
            return Err(RecipeError::new(RecipeErrorKind::Conflict {
                rule: "where the recipe repeats, `transform` needs whole numbers as `frequency`, and multiples of 90 as \
                    `rotation` (of 180 if the tile is not square)",
            }));
        }
        let input = plan.any(&self.input)?;
        Ok(Step::Moved(Moved {
            input,
            color: plan.is_color(input),
            positions: Positions::Linear(map),
        }))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.moved(&self.input)?;
        let mut at = shader.position([1.0; 2]);
        let [cos, sin] = direction(self.rotation);
        if [cos, sin] != [1.0, 0.0] {
            let [cos, sin] = [cos, sin].map(double_value);
            at = shader.name("position", format!("rotated_2d({at}, {cos}, {sin})"));
        }
        at = shader.scaled(&at, self.frequency.0);
        if self.offset != [0.0; 2] {
            let [x, y] = self.offset.map(double_value);
            at = shader.name("position", format!("shifted_2d({at}, {x}, {y})"));
        }
        Ok(input(&at))
    }
}

/// Returns whether a texture that has the period `extent` along the axes of `wrap` keeps this period when positions are
/// transformed by `map`.
fn repeats(map: &LinearMap, extent: [f64; 2], wrap: [bool; 2]) -> bool {
    (0..2).filter(|&axis| wrap[axis]).all(|axis| {
        // A step of one period must lead to a position at which the input has the same value.
        let mut period = [0.0; 2];
        period[axis] = extent[axis];
        let step = map.vector(period);
        (0..2).all(|axis| match wrap[axis] {
            true => (step[axis] / extent[axis]).fract() == 0.0,
            false => step[axis] == 0.0,
        })
    })
}
