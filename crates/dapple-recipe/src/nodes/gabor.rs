//! Gabor noise and its phase.

use super::noise::about_half;
use super::{Frequency, NodeKind, NodeSeed, outputs};
use crate::RecipeError;
use crate::plan::{Builder, Step};
use dapple_pattern::{GaborNoise, GaborValue};
use dapple_raster::FieldExt as _;
use serde::{Deserialize, Serialize};

/// Gabor noise: waves of about one length and direction, such as wood fiber, brushed metal or ripples of sand.
///
/// Noise is from 0 to 1: `½ + noise / 6σ`, clamped. The phase is from 0 to below 1; a `wave` of it has stripes of equal
/// strength (phasor noise). Along an axis on which the recipe repeats, the tile must have a whole number of cells.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct GaborNode {
    /// Frequency, in cells per unit of the plane: one number, or one for each axis, which stretches the noise.
    pub frequency: Frequency,
    /// Value at a position.
    pub value: GaborValue,
    /// Number of waves per cell. The more, the closer are all waves to this length and to their direction.
    #[cfg_attr(feature = "schema", schemars(transform = { GaborNoise::WAVES }))]
    pub waves: f64,
    /// Direction of the stripes, clockwise from the x axis in degrees.
    #[cfg_attr(feature = "schema", schemars(transform = { GaborNoise::ANGLE }))]
    pub angle: f64,
    /// Range of random directions around `angle` in degrees; 180 is all directions.
    #[cfg_attr(feature = "schema", schemars(transform = { GaborNoise::SPREAD }))]
    pub spread: f64,
    /// Number of waves that are placed in each cell; time is proportional to it.
    #[cfg_attr(feature = "schema", schemars(transform = { GaborNoise::IMPULSES }))]
    pub impulses: u32,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for GaborNode {
    fn default() -> Self {
        Self {
            frequency: Frequency([8.0; 2]),
            value: GaborValue::default(),
            waves: 2.0,
            angle: 0.0,
            spread: 20.0,
            impulses: 8,
            seed: None,
        }
    }
}

impl NodeKind for GaborNode {
    outputs!(GaborValue);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let frequency = self.frequency.0;
        let period = plan.periods(frequency)?;
        let noise = GaborNoise::new(plan.seed(self.seed.as_ref()))
            .with_period(period)?
            .with_waves(self.waves)?
            .with_angle(self.angle)?
            .with_spread(self.spread)?
            .with_impulses(self.impulses)?;
        let field = noise.field(self.value).frequency_per_axis(frequency);
        Ok(match self.value {
            GaborValue::Noise => Step::field(field.map(|value| about_half(value / 6.0))),
            _ => Step::field(field),
        })
    }
}
