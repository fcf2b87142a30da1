//! A number for each connected region of a mask.

use super::{NodeKind, NodeSeed, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_filter::regions;
use dapple_hash::{hash1, unit_f32};
use dapple_raster::Wrap;
use serde::{Deserialize, Serialize};

/// Number for each connected region in which a mask is above ½; 0 outside.
///
/// Pixels are connected along rows and columns, and across the sides of a tile that repeats. The result depends on the
/// whole tile. The order of the regions, and so their random numbers, may change with the size of a bake.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FloodFill {
    /// Mask: a number, above ½ inside the regions.
    pub input: Input,
    /// Number of a region.
    #[serde(default)]
    pub value: RegionValue,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

/// Number of a connected region.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RegionValue {
    /// Random number from 0 to 1.
    #[default]
    Random,
    /// Index of the region, from 1, in the order of the regions' first pixels, row by row.
    Index,
    /// Area, in square units of the plane.
    Area,
}

impl NodeKind for FloodFill {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (value, seed) = (self.value, plan.seed(self.seed.as_ref()));
        let repeats = plan.wrap().map(|wrap| wrap == Wrap::Repeat);
        let inputs = vec![plan.number(&self.input)?];
        Ok(plan.global(inputs, [1; 2], move |tile| {
            let regions = regions(
                tile.inputs[0].numbers(),
                tile.window.size[0] as usize,
                repeats,
            );
            let count = regions.iter().max().map_or(0, |&most| most as usize);
            let [width, height] = tile.window.pixel;
            let numbers: Vec<f32> = match value {
                RegionValue::Random => (0..count)
                    .map(|index| unit_f32((hash1(seed, [index as i64], 0) >> 32) as u32))
                    .collect(),
                RegionValue::Index => (0..count).map(|index| (index + 1) as f32).collect(),
                RegionValue::Area => {
                    let mut pixels = vec![0_u64; count];
                    for &region in regions.iter().filter(|&&region| region > 0) {
                        pixels[region as usize - 1] += 1;
                    }
                    let area = (width * height).abs();
                    let pixels = pixels.into_iter();
                    pixels.map(|count| (count as f64 * area) as f32).collect()
                }
            };
            let number = |&region: &u32| match region {
                0 => 0.0,
                _ => numbers[region as usize - 1],
            };
            Ok(Values::Numbers(regions.iter().map(number).collect()))
        }))
    }
}
