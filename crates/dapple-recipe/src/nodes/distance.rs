//! Nodes whose value is the distance from a center, and offsets from a center for other nodes.

use super::NodeKind;
use crate::RecipeError;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use dapple_points::Domain;
use dapple_raster::field_fn;
use dapple_raster::{Range, range};
use dapple_wgsl::{Module, double_value};
use serde::{Deserialize, Serialize};

/// Distance of a position from a center, in units of the plane.
///
/// Along axes on which the recipe repeats, distances are to the nearest repeat of the center.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Distance {
    /// Position of the center, in units of the plane.
    pub center: [f64; 2],
}

const CENTER: Range = range!(finite);

impl NodeKind for Distance {
    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (center, tile) = (center(plan, Some(self.center))?, plan.domain());
        Ok(Step::field(field_fn(move |position: [f64; 2]| {
            let [x, y] = offset(position, center, &tile);
            (x * x + y * y).sqrt() as f32
        })))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        shader.needs(Module::DoubleFunctions);
        let [x, y] = offset_code(shader, Some(self.center));
        Ok(Code::number(format!(
            "double_to_float(double_length({x}, {y}))"
        )))
    }
}

/// Returns `center`; the middle of the tile if it is not set.
pub(super) fn center(
    plan: &Builder<'_>,
    center: Option<[f64; 2]>,
) -> Result<[f64; 2], RecipeError> {
    let center = center.unwrap_or_else(|| (0.5 * plan.domain().size).into());
    for number in center {
        RecipeError::check_in(CENTER, "center", number)?;
    }
    Ok(center)
}

/// Returns the offset of `position` from the nearest copy of `center`. Copies repeat along the axes on which the tile
/// repeats.
pub(super) fn offset(position: [f64; 2], center: [f64; 2], tile: &Domain) -> [f64; 2] {
    [0, 1].map(|axis| {
        let offset = position[axis] - center[axis];
        if !tile.wrap[axis] {
            return offset;
        }
        let repeats = (offset / tile.size[axis] + 0.5).floor();
        offset - repeats * tile.size[axis]
    })
}

/// Writes WGSL for the x and y of the offset from the nearest copy of a center to the position, as 64-bit floats.
pub(super) fn offset_code(
    shader: &mut NodeShader<'_, '_>,
    center: Option<[f64; 2]>,
) -> [String; 2] {
    let at = shader.position([1.0; 2]);
    let (size, wrap) = shader.tile();
    let center = center.unwrap_or(size.map(|side| 0.5 * side));
    [0, 1].map(|axis| {
        let [center, side] = [center[axis], size[axis]].map(double_value);
        let offset = format!("double_sub({at}.{}, {center})", ["x", "y"][axis]);
        let offset = shader.name("offset", offset);
        if !wrap[axis] {
            return offset;
        }
        shader.needs(Module::DoubleFunctions);
        let half = double_value(0.5);
        let repeats = format!("double_floor(double_add(double_div({offset}, {side}), {half}))");
        let from_copy = format!("double_sub({offset}, double_mul({repeats}, {side}))");
        shader.name("offset", from_copy)
    })
}
