//! Shapes stamped at scattered points.

use super::{Frequency, NodeKind, NodeSeed, outputs};
use crate::RecipeError;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use dapple_pattern::{StampOptions, StampOverlap, StampShape, StampValue, Stamps};
use dapple_raster::FieldExt as _;
use dapple_wgsl::{Module, number_value};
use serde::{Deserialize, Serialize};

/// Shapes stamped at scattered points: gravel, leaves, grass, rivets, scales, scratches.
///
/// Points are in the cells of a lattice. Lengths are in widths of a cell; shapes are not stretched. Along an axis on
/// which the recipe repeats, the tile must have a whole number of cells. All values are 0 outside of stamps.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ScatterNode {
    /// Frequency, in cells per unit of the plane: one number, or one for each axis.
    pub frequency: Frequency,
    /// Value at a position.
    pub value: StampValue,
    /// Shape of the stamps.
    pub shape: StampShape,
    /// Number of stamps per cell; the fraction is the chance of one more.
    #[cfg_attr(feature = "schema", schemars(transform = { StampOptions::DENSITY }))]
    pub density: f64,
    /// Maximum offset of a point from the center of its cell: 0 is a regular lattice, 1 is anywhere in the cell.
    #[cfg_attr(feature = "schema", schemars(transform = { StampOptions::FRACTION }))]
    pub jitter: f64,
    /// Minimum distance between two points, in widths of a cell: points that are too close to others are left out.
    #[cfg_attr(feature = "schema", schemars(transform = { StampOptions::SPACING }))]
    pub spacing: f64,
    /// Shift of each row of cells relative to the row above, in cells.
    #[cfg_attr(feature = "schema", schemars(transform = { StampOptions::SIGNED }))]
    pub row_offset: f64,
    /// Minimum and maximum length of a stamp, in widths of a cell, at most 8.
    pub size: [f64; 2],
    /// Minimum and maximum width of a stamp relative to its length, from 0.01 to 1.
    pub aspect: [f64; 2],
    /// Minimum and maximum clockwise rotation in degrees; at 0, the length of a stamp is along the x axis.
    pub rotation: [f64; 2],
    /// Minimum and maximum height of a stamp, from 0 to 1.
    pub height: [f64; 2],
    /// Width of the bevel of flat shapes relative to half of their width.
    #[cfg_attr(feature = "schema", schemars(transform = { StampOptions::FRACTION }))]
    pub bevel: f64,
    /// Fraction of a stamp's height that is its random place in the order instead of its profile.
    #[cfg_attr(feature = "schema", schemars(transform = { StampOptions::FRACTION }))]
    pub lift: f64,
    /// Slope of the profile along a stamp; at 1, it rises from 0 at the start to its full height at the end.
    #[cfg_attr(feature = "schema", schemars(transform = { StampOptions::SIGNED }))]
    pub tilt: f64,
    /// Rule for positions that several stamps cover.
    pub overlap: StampOverlap,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for ScatterNode {
    fn default() -> Self {
        let options = StampOptions::default();
        Self {
            frequency: Frequency([8.0; 2]),
            value: StampValue::default(),
            shape: options.shape,
            density: options.density,
            jitter: options.jitter,
            spacing: options.spacing,
            row_offset: options.row_offset,
            size: options.size,
            aspect: options.aspect,
            rotation: options.rotation,
            height: options.height,
            bevel: options.bevel,
            lift: options.lift,
            tilt: options.tilt,
            overlap: options.overlap,
            seed: None,
        }
    }
}

impl NodeKind for ScatterNode {
    outputs!(StampValue);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let frequency = self.frequency.0;
        let options = self.options(plan.periods(frequency)?);
        let stamps = Stamps::new(plan.seed(self.seed.as_ref()), options)?;
        let field = stamps.field(self.value);
        Ok(Step::field(field.frequency_per_axis(frequency)))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let frequency = self.frequency.0;
        let options = self.options(shader.periods(frequency));
        let stamps = Stamps::new(shader.seed(self.seed.as_ref()), options)?;
        let table = stamps.shader_table()?;
        let first = shader.data(&table.words)?;
        let first_stamp = first + table.first_stamp / 4;
        shader.needs(Module::Stamps);
        let at = shader.position(frequency);
        let [x, y] = table.period;
        let [shape, overlap] = [self.shape as u32, self.overlap as u32];
        let [bevel, lift, tilt] =
            [self.bevel, self.lift, self.tilt].map(|number| number_value(number as f32));
        let stamps = shader.constant(
            "STAMPS",
            format!(
                "Stamps({first}u, {first_stamp}u, vec2({x}u, {y}u), {shape}u, {overlap}u, {bevel}, {lift}, {tilt})"
            ),
        );
        let hit = shader.name("stamp", format!("stamp_hit(data, {stamps}, {at}, zero)"));
        let member = match self.value {
            StampValue::Height => "height",
            StampValue::Mask => "mask",
            StampValue::Random => "random.x",
            StampValue::Random2 => "random.y",
            StampValue::Random3 => "random.z",
            StampValue::U => "uv.x",
            StampValue::V => "uv.y",
            StampValue::EdgeDistance => "edge",
            StampValue::Angle => "angle",
        };
        Ok(Code::number(format!("{hit}.{member}")))
    }
}

impl ScatterNode {
    /// Returns the scatter options with these periods, in cells along each axis.
    fn options(&self, period: [Option<u32>; 2]) -> StampOptions {
        let frequency = self.frequency.0;
        StampOptions {
            period,
            cell_height: frequency[0] / frequency[1],
            density: self.density,
            jitter: self.jitter,
            spacing: self.spacing,
            row_offset: self.row_offset,
            shape: self.shape,
            size: self.size,
            aspect: self.aspect,
            rotation: self.rotation,
            height: self.height,
            bevel: self.bevel,
            lift: self.lift,
            tilt: self.tilt,
            overlap: self.overlap,
        }
    }
}
