//! Kaleidoscope: repeats a sector of a node around a center, mirrored at its middle.

use super::{NodeKind, distance, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError};
use core::f64::consts::TAU;
use dapple_raster::{Range, range};
use dapple_wgsl::{Module, double_value};
use serde::{Deserialize, Serialize};

/// Another node, whose sector to the right of a center is repeated around the center; each sector is symmetric.
///
/// Along axes on which the recipe repeats, the center is the nearest of its copies. Where a pattern with the symmetry of
/// the sectors does not fit the tile, there is an edge halfway between two copies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Kaleidoscope {
    /// Node that is shown. A node that depends on the whole tile is interpolated between its pixels.
    pub input: Input,
    /// Number of sectors.
    #[serde(default = "six")]
    #[cfg_attr(feature = "schema", schemars(transform = { SECTORS }))]
    pub sectors: u32,
    /// Position of the center, in units of the plane [default: the middle of the tile].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 2]>,
}

fn six() -> u32 {
    6
}

const SECTORS: Range = range!(from 1 to 256);

impl NodeKind for Kaleidoscope {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(SECTORS, "number of sectors", self.sectors.into())?;
        let (center, tile) = (distance::center(plan, self.center)?, plan.domain());
        let sectors = f64::from(self.sectors);
        let middles = self.middles();
        plan.folded(&self.input, move |position| {
            let [x, y] = distance::offset(position, center, &tile);
            let sector = (libm::atan2(y, x) / TAU * sectors + 0.5).floor() as i64;
            let (sin, cos) = middles[sector.rem_euclid(middles.len() as i64) as usize];
            // Rotate the sector to the right, and fold it at its middle.
            let [x, y] = [x * cos + y * sin, (y * cos - x * sin).abs()];
            [center[0] + x, center[1] + y]
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.moved(&self.input)?;
        let (size, _) = shader.tile();
        let center = self.center.unwrap_or(size.map(|side| 0.5 * side));
        let [x, y] = distance::offset_code(shader, self.center);
        shader.needs(Module::DoubleAngle);
        let middles = self.middles().into_iter();
        let middles = middles.map(|(sin, cos)| [cos, sin].map(double_value).join(", "));
        let middles: Vec<_> = middles.map(|pair| format!("vec4({pair})")).collect();
        let middles = shader.constant("MIDDLES", format!("array({})", middles.join(", ")));
        let [turn, sectors, half] = [TAU, f64::from(self.sectors), 0.5].map(double_value);
        let turns = format!("double_div(double_angle({y}, {x}), {turn})");
        let sector = format!("double_floor(double_add(double_mul({turns}, {sectors}), {half}))");
        let count = self.sectors;
        // The number of a sector is from minus half of the count to half of it.
        let sector = shader.name(
            "sector",
            format!("(double_to_int({sector}) + {count}) % {count}"),
        );
        let [cx, cy] = center.map(double_value);
        let body = format!(
            "(x: vec2<u32>, y: vec2<u32>, sector: i32) -> Position2d {{\n    var middles = {middles};\n    \
             let middle = middles[sector];\n    \
             let turned = rotated_2d(Position2d(x, y), middle.xy, middle.zw);\n    \
             return Position2d(double_add({cx}, turned.x), double_add({cy}, double_abs(turned.y)));\n}}"
        );
        let folded = shader.function("folded", &body);
        let at = shader.name("position", format!("{folded}({x}, {y}, {sector})"));
        Ok(input(&at))
    }
}

impl Kaleidoscope {
    /// Returns the sine and cosine of each sector's middle direction.
    fn middles(&self) -> Vec<(f64, f64)> {
        let sectors = f64::from(self.sectors);
        let angles = (0..self.sectors).map(|sector| TAU * f64::from(sector) / sectors);
        angles.map(libm::sincos).collect()
    }
}
