//! Ambient occlusion of a height.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_color::{HeightPlane, OcclusionOptions, ambient_occlusion_of_part_cancellable};
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Ambient occlusion of a height: the visible fraction of the sky, from 0 in deep holes to 1 on open ground.
///
/// It equals the occlusion map of a bake with the same relief and radius. Dirt gathers where it is low.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Occlusion {
    /// Height: a number.
    pub input: Input,
    /// Height of the value 1, in units of the plane [default: the material's relief].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RELIEF }))]
    pub relief: Option<f64>,
    /// Distance within which heights hide the sky, in units of the plane [default: 1/20 of the shorter side of the
    /// tile]. A radius below one pixel gives no occlusion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: Option<f64>,
}

impl NodeKind for Occlusion {
    inputs!(input);

    fn reads_relief(&self) -> bool {
        self.relief.is_none()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (relief, radius) = (
            plan.relief(self.relief)?,
            plan.radius(self.radius, 1.0 / 20.0)?,
        );
        let input = plan.number(&self.input)?;
        // One pixel is the whole raster of this extent.
        let options = move |pixel: DVec2| OcclusionOptions {
            radius,
            ..OcclusionOptions::from(HeightPlane {
                strength: relief,
                extent: pixel,
                ..HeightPlane::default()
            })
        };
        let halo = move |pixel| options(pixel).halo([1; 2]);
        Ok(plan.neighborhood_of_heights(input, halo, move |around| {
            let seen = ambient_occlusion_of_part_cancellable(
                &around.raster(0)?,
                around.part.halo,
                [1; 2],
                &options(around.part.pixel),
                &|| around.watch.is_cancelled(),
            )?;
            Ok(Values::Numbers(seen.into_pixels()))
        }))
    }
}
