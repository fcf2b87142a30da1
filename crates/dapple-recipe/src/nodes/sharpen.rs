//! Sharpening by an unsharp mask.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use dapple_filter::{gaussian, gaussian_halo};
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// Sharpened number or color: adds `amount` times the difference from its Gaussian blur (an unsharp mask).
///
/// Values may leave the range of the input. If the radius is below a third of a pixel, nothing changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sharpen {
    /// Number or color to sharpen.
    pub input: Input,
    /// Standard deviation of the Gaussian, in units of the plane.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
    /// Strength of the sharpening; negative blurs.
    #[serde(default = "one")]
    pub amount: f32,
}

fn one() -> f32 {
    1.0
}

const AMOUNT: Range = range!(finite);

impl NodeKind for Sharpen {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (radius, amount) = (plan.radius(Some(self.radius), 0.0)?, self.amount);
        RecipeError::check_in(AMOUNT, "amount", amount.into())?;
        let input = plan.any(&self.input)?;
        let halo = move |pixel| gaussian_halo(radius, pixel);
        Ok(plan.neighborhood(vec![input], halo, move |around| {
            Ok(around.each_channel(0, |values| {
                let mut sharp = gaussian(values, &around.part, radius);
                let width = around.part.size[0] as usize;
                for (row, sharp) in sharp.chunks_mut(width).enumerate() {
                    for (sharp, &here) in sharp.iter_mut().zip(around.part.line(values, row)) {
                        *sharp = here + amount * (here - *sharp);
                    }
                }
                sharp
            }))
        }))
    }
}
