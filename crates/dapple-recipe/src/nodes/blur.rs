//! Gaussian blur, in all directions or along one.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, RecipeErrorKind};
use dapple_filter::{DirectionalBlur, gaussian, gaussian_halo};
use dapple_pattern::direction;
use dapple_raster::{Range, range};
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Gaussian blur of a number or a color, in all directions or along one.
///
/// The value of a pixel is the weighted mean of the pixels within three radii. If the radius is below a third of a
/// pixel, the blur changes nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Blur {
    /// Number or color to blur.
    pub input: Input,
    /// Standard deviation of the Gaussian, in units of the plane.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
    /// Direction of a directional blur in degrees, clockwise: 0 is to the right, 90 is down [default: all directions].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<f64>,
    /// Whether a directional blur smears values forward only, as rust runs down a wall.
    #[serde(default)]
    pub one_sided: bool,
}

const DIRECTION: Range = range!(finite);

impl NodeKind for Blur {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (radius, is_one_sided) = (plan.radius(Some(self.radius), 0.0)?, self.one_sided);
        let input = plan.any(&self.input)?;
        let Some(degrees) = self.along else {
            if is_one_sided {
                let rule = "a `one_sided` blur needs a direction `along`";
                return Err(RecipeError::new(RecipeErrorKind::Conflict { rule }));
            }
            let halo = move |pixel| gaussian_halo(radius, pixel);
            return Ok(plan.neighborhood(vec![input], halo, move |around| {
                Ok(around.each_channel(0, |values| gaussian(values, &around.part, radius)))
            }));
        };
        RecipeError::check_in(DIRECTION, "direction", degrees)?;
        let direction = DVec2::from(direction(degrees));
        let line = move |pixel| DirectionalBlur::new(direction, radius, is_one_sided, pixel);
        let halo = move |pixel| line(pixel).halo();
        Ok(plan.neighborhood(vec![input], halo, move |around| {
            let line = line(around.part.pixel);
            Ok(around.each_channel(0, |values| line.apply(values, &around.part)))
        }))
    }
}
