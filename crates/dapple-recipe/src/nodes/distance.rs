//! Nodes whose value is the distance from a center.

use super::NodeKind;
use crate::RecipeError;
use crate::plan::{Builder, Step};
use dapple_raster::field_fn;
use dapple_raster::{Range, range};
use glam::DVec2;
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
        for number in self.center {
            RecipeError::check_in(CENTER, "center", number)?;
        }
        let (center, tile) = (DVec2::from(self.center), plan.domain());
        Ok(Step::field(field_fn(move |position: [f64; 2]| {
            let mut offset = DVec2::from(position) - center;
            for axis in 0..2 {
                if tile.wrap[axis] {
                    let repeats = (offset[axis] / tile.size[axis] + 0.5).floor();
                    offset[axis] -= repeats * tile.size[axis];
                }
            }
            (offset.x * offset.x + offset.y * offset.y).sqrt() as f32
        })))
    }
}
