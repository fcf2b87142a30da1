//! Bricks, tiles and planks.

use super::{Frequency, NodeKind, NodeSeed, outputs};
use crate::RecipeError;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use dapple_pattern::{Bond, BrickOptions, BrickValue, Bricks};
use dapple_wgsl::{Module, pattern_value};
use serde::{Deserialize, Serialize};

/// Bricks, tiles or planks in a regular bond.
///
/// Lengths are in units of the shorter side of a brick. Along an axis on which the recipe repeats, the tile must have a
/// whole number of bricks: an even number of courses for most bonds, and for `herringbone` and `basket` a multiple of
/// twice the length. The node `output` gives further values of the same bricks.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct BricksNode {
    /// Number of bricks along x and of courses along y per unit of the plane: one number, or one for each axis. For
    /// `herringbone` and `basket`, the number of squares.
    pub frequency: Frequency,
    /// Value at a position.
    pub value: BrickValue,
    /// Arrangement of the bricks.
    pub bond: Bond,
    /// Shift of every other course, in bricks; for `running`, `roof_tiles` and `slates`.
    #[cfg_attr(feature = "schema", schemars(transform = { BrickOptions::OFFSET }))]
    pub offset: f64,
    /// Length of a brick in squares; for `herringbone` and `basket`.
    #[cfg_attr(feature = "schema", schemars(transform = { BrickOptions::LENGTH }))]
    pub length: u32,
    /// Variation of the lengths of planks, from equal to half and one and a half of the mean.
    #[cfg_attr(feature = "schema", schemars(transform = { BrickOptions::VARIATION }))]
    pub variation: f64,
    /// Width of the joints, in units of the shorter side.
    #[cfg_attr(feature = "schema", schemars(transform = { BrickOptions::JOINT }))]
    pub joint: f64,
    /// Width of the rise from the joint to the face of a brick, in units of the shorter side.
    #[cfg_attr(feature = "schema", schemars(transform = { BrickOptions::BEVEL }))]
    pub bevel: f64,
    /// Radius of the corners, in units of the shorter side.
    #[cfg_attr(feature = "schema", schemars(transform = { BrickOptions::ROUNDING }))]
    pub rounding: f64,
    /// Random displacement of each edge of each brick; at 1, up to a quarter of the face.
    #[cfg_attr(feature = "schema", schemars(transform = { BrickOptions::JITTER }))]
    pub jitter: f64,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for BricksNode {
    fn default() -> Self {
        let options = BrickOptions::default();
        Self {
            frequency: Frequency(options.frequency),
            value: BrickValue::default(),
            bond: options.bond,
            offset: options.offset,
            length: options.length,
            variation: options.variation,
            joint: options.joint,
            bevel: options.bevel,
            rounding: options.rounding,
            jitter: options.jitter,
            seed: None,
        }
    }
}

impl NodeKind for BricksNode {
    outputs!(BrickValue);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let options = self.options(plan.periods(self.frequency.0)?);
        let bricks = Bricks::new(plan.seed(self.seed.as_ref()), options)?;
        Ok(Step::field(bricks.field(self.value)))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let (module, kind) = match self.bond {
            Bond::Hexagons => (Module::Hexagons, "hexagon"),
            Bond::RoofTiles | Bond::Slates => (Module::RoofTiles, "roof"),
            _ => (Module::Rectangles, "rectangle"),
        };
        let options = self.options(shader.periods(self.frequency.0));
        let bricks = Bricks::new(shader.seed(self.seed.as_ref()), options)?;
        shader.needs(module);
        let at = shader.position(self.frequency.0);
        let name = shader.constant("BRICKS", pattern_value("Bricks", &bricks.shader_words()));
        let mut arguments = name.clone();
        if self.bond == Bond::Hexagons {
            let sides = pattern_value("array", &bricks.hexagon_words());
            let sides = shader.constant("SIDES", format!("HexagonSides({sides})"));
            arguments += &format!(", {sides}");
        }
        if self.value == BrickValue::EdgeDistance {
            return Ok(Code::number(format!(
                "{kind}_edge_distance({arguments}, {at})"
            )));
        }
        let brick = shader.name("brick", format!("{kind}_brick({arguments}, {at})"));
        let random = |index: u32| format!("brick_random({name}, {brick}.id, {index}u)");
        Ok(Code::number(match self.value {
            BrickValue::Height | BrickValue::EdgeDistance => {
                format!("double_to_float(double_unit({brick}.height))")
            }
            BrickValue::Random => random(0),
            BrickValue::Random2 => random(1),
            BrickValue::Random3 => random(2),
            BrickValue::U => format!("double_to_float({brick}.u)"),
            BrickValue::V => format!("double_to_float({brick}.v)"),
            BrickValue::Column => format!("f32({brick}.id.x)"),
            BrickValue::Row => format!("f32({brick}.id.y)"),
            BrickValue::Direction => format!("select(0.0, 1.0, {brick}.is_upright)"),
        }))
    }
}

impl BricksNode {
    /// Returns the pattern options with these periods, in bricks along each axis.
    fn options(&self, period: [Option<u32>; 2]) -> BrickOptions {
        BrickOptions {
            frequency: self.frequency.0,
            period,
            bond: self.bond,
            offset: self.offset,
            length: self.length,
            variation: self.variation,
            joint: self.joint,
            bevel: self.bevel,
            rounding: self.rounding,
            jitter: self.jitter,
        }
    }
}
