//! Nodes whose value is the coordinate along a direction.

use super::NodeKind;
use crate::RecipeError;
use crate::plan::{Builder, Step};
use dapple_raster::field_fn;
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// Coordinate of a position along a direction: `(position − center) · along`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Coordinate {
    /// Position where the coordinate is 0, in units of the plane.
    pub center: [f64; 2],
    /// Direction of the coordinate; the length of the vector is the increase per unit of the plane.
    pub along: [f64; 2],
}

impl Default for Coordinate {
    fn default() -> Self {
        Self {
            center: [0.0; 2],
            along: [1.0, 0.0],
        }
    }
}

const PART: Range = range!(finite);

impl NodeKind for Coordinate {
    fn build(&self, _: &mut Builder<'_>) -> Result<Step, RecipeError> {
        for number in self.center.into_iter().chain(self.along) {
            RecipeError::check_in(PART, "part of a coordinate", number)?;
        }
        let (center, along) = (self.center, self.along);
        Ok(Step::field(field_fn(move |[x, y]| {
            ((x - center[0]) * along[0] + (y - center[1]) * along[1]) as f32
        })))
    }
}
