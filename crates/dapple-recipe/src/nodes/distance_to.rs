//! Distance to a mask, up to a radius.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_filter::{disk_halo, distances};
use serde::{Deserialize, Serialize};

/// Distance to the nearest pixel at which a mask is above ½, in units of the plane, at most the radius.
///
/// It is exact between the centers of pixels: 0 inside the mask, and at least one pixel outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DistanceTo {
    /// Mask: a number, above ½ inside.
    pub input: Input,
    /// Largest distance, in units of the plane. It is the result where no pixel of the mask is nearer.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
}

impl NodeKind for DistanceTo {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let radius = plan.radius(Some(self.radius), 0.0)?;
        let input = plan.number(&self.input)?;
        let halo = move |pixel| disk_halo(radius, pixel);
        Ok(plan.neighborhood(vec![input], halo, move |around| {
            Ok(Values::Numbers(distances(
                around.inputs[0].numbers(),
                &around.part,
                radius as f32,
            )))
        }))
    }
}
