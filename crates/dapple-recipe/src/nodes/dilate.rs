//! Maximum and minimum over a disk, known as dilation and erosion.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use dapple_filter::{dilate, disk_halo, erode};
use serde::{Deserialize, Serialize};

/// Maximum of a number or a color within a radius, by channel: bright areas grow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Dilate {
    /// Number or color.
    pub input: Input,
    /// Radius of the disk, in units of the plane. It contains the pixels whose centers are at most this far; if it is below
    /// one pixel, nothing changes.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
}

/// Minimum of a number or a color within a radius, by channel: bright areas shrink.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Erode {
    /// Number or color.
    pub input: Input,
    /// Radius of the disk, in units of the plane. It contains the pixels whose centers are at most this far; if it is below
    /// one pixel, nothing changes.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
}

impl NodeKind for Dilate {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let radius = plan.radius(Some(self.radius), 0.0)?;
        let input = plan.any(&self.input)?;
        let halo = move |pixel| disk_halo(radius, pixel);
        Ok(plan.neighborhood(vec![input], halo, move |around| {
            Ok(around.each_channel(0, |values| dilate(values, &around.part, radius)))
        }))
    }
}

impl NodeKind for Erode {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let radius = plan.radius(Some(self.radius), 0.0)?;
        let input = plan.any(&self.input)?;
        let halo = move |pixel| disk_halo(radius, pixel);
        Ok(plan.neighborhood(vec![input], halo, move |around| {
            Ok(around.each_channel(0, |values| erode(values, &around.part, radius)))
        }))
    }
}
