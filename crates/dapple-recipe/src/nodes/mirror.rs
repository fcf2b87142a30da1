//! Mirrors a node at a center.

use super::{NodeKind, distance, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use dapple_wgsl::double_value;
use serde::{Deserialize, Serialize};

/// Another node, whose part to the right of and below a center is mirrored to the other side.
///
/// Along axes on which the recipe repeats, the node is also mirrored half a tile away from the center, so that half of
/// the tile is shown twice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MirroredNode {
    /// Node that is mirrored. A node that depends on the whole tile is interpolated between its pixels.
    pub input: Input,
    /// Axes along which the input is mirrored.
    #[serde(default = "both")]
    pub axes: [bool; 2],
    /// Center of the mirroring, in units of the plane.
    #[serde(default)]
    pub center: [f64; 2],
}

fn both() -> [bool; 2] {
    [true; 2]
}

impl NodeKind for MirroredNode {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (axes, center) = (self.axes, distance::center(plan, Some(self.center))?);
        let tile = plan.domain();
        plan.folded(&self.input, move |position| {
            let offset = distance::offset(position, center, &tile);
            [0, 1].map(|axis| match axes[axis] {
                true => center[axis] + offset[axis].abs(),
                false => position[axis],
            })
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.moved(&self.input)?;
        let offset = distance::offset_code(shader, Some(self.center));
        let at = shader.position([1.0; 2]);
        let [x, y] = [0, 1].map(|axis| match self.axes[axis] {
            true => {
                let center = double_value(self.center[axis]);
                format!("double_add({center}, double_abs({}))", offset[axis])
            }
            false => format!("{at}.{}", ["x", "y"][axis]),
        });
        let at = shader.name("position", format!("Position2d({x}, {y})"));
        Ok(input(&at))
    }
}
