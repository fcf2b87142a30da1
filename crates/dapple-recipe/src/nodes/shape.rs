//! Shapes, as signed distances or masks.

use super::{Frequency, NodeKind, outputs};
use crate::RecipeError;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use dapple_pattern::{Shape, ShapeKind, ShapeOptions, ShapeValue};
use dapple_raster::Named as _;
use dapple_wgsl::{Module, pattern_value};
use serde::{Deserialize, Serialize};

/// Simple shape, or a grid of its copies.
///
/// Lengths other than `size` are relative to the size. The node `output` gives the other value of the same shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ShapeNode {
    /// Kind of the shape.
    pub kind: ShapeKind,
    /// Value at a position.
    pub value: ShapeValue,
    /// Position of the center, in units of the plane.
    pub center: [f64; 2],
    /// Half of the width, in units of the plane; at most 16 times the distance of copies.
    #[cfg_attr(feature = "schema", schemars(transform = { ShapeOptions::SIZE }))]
    pub size: f64,
    /// Clockwise rotation in degrees.
    pub rotation: f64,
    /// Number of sides of a polygon, or points of a star.
    #[cfg_attr(feature = "schema", schemars(transform = { ShapeOptions::SIDES }))]
    pub sides: u32,
    /// Proportion of the shape: height to width of a box or a capsule, inner to outer radius of a star or a ring, and
    /// width of the crescent of a moon to the diameter.
    #[cfg_attr(feature = "schema", schemars(transform = { ShapeOptions::RATIO }))]
    pub ratio: f64,
    /// Radius of rounded corners; the width of the shape stays.
    #[cfg_attr(feature = "schema", schemars(transform = { ShapeOptions::ROUNDING }))]
    pub rounding: f64,
    /// Width of a shell around the border; 0 for the whole shape.
    #[cfg_attr(feature = "schema", schemars(transform = { ShapeOptions::ONION }))]
    pub onion: f64,
    /// Width of the smooth transition of a mask.
    #[cfg_attr(feature = "schema", schemars(transform = { ShapeOptions::EDGE }))]
    pub edge: f64,
    /// Number of copies per unit of the plane: one number, or one for each axis [default: one copy in the tile, which
    /// repeats where the recipe does].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<Frequency>,
}

impl Default for ShapeNode {
    fn default() -> Self {
        let options = ShapeOptions::default();
        Self {
            kind: options.kind,
            value: ShapeValue::default(),
            center: options.center,
            size: options.size,
            rotation: options.rotation,
            sides: options.sides,
            ratio: options.ratio,
            rounding: options.rounding,
            onion: options.onion,
            edge: options.edge,
            frequency: None,
        }
    }
}

impl NodeKind for ShapeNode {
    outputs!(ShapeValue);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let frequency = match self.frequency {
            Some(Frequency(frequency)) => {
                plan.periods(frequency)?;
                frequency.map(Some)
            }
            None => {
                let tile = plan.domain();
                [0, 1].map(|axis| tile.wrap[axis].then(|| 1.0 / tile.size[axis]))
            }
        };
        Ok(Step::field(
            Shape::new(self.options(frequency))?.field(self.value),
        ))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let (size, wrap) = shader.tile();
        let frequency = match self.frequency {
            Some(Frequency(frequency)) => frequency.map(Some),
            None => [0, 1].map(|axis| wrap[axis].then(|| 1.0 / size[axis])),
        };
        let shape = Shape::new(self.options(frequency))?;
        let mut words = shape.shader_words();
        // A texture has at least one texel.
        let corners = shape.shader_corners();
        words[1][0] = shader.data(if corners.is_empty() { &[0] } else { &corners })? as u32;
        shader.needs(Module::Shapes);
        let at = shader.position([1.0; 2]);
        let shape = shader.constant("SHAPE", pattern_value("Shape", &words));
        let value = self.value.name();
        Ok(Code::number(format!("shape_{value}(data, {shape}, {at})")))
    }
}

impl ShapeNode {
    /// Returns the shape options with this frequency of copies, per unit along each axis.
    fn options(&self, frequency: [Option<f64>; 2]) -> ShapeOptions {
        ShapeOptions {
            kind: self.kind,
            center: self.center,
            size: self.size,
            rotation: self.rotation,
            sides: self.sides,
            ratio: self.ratio,
            rounding: self.rounding,
            onion: self.onion,
            edge: self.edge,
            frequency,
        }
    }
}
