//! Gabor noise and its phase.

use super::noise::{about_half, about_half_code};
use super::{Frequency, NodeKind, NodeSeed, outputs};
use crate::RecipeError;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, quotient};
use dapple_pattern::{GaborNoise, GaborOptions, GaborValue};
use dapple_raster::FieldExt as _;
use dapple_wgsl::{Module, double_value};
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
    #[cfg_attr(feature = "schema", schemars(transform = { GaborOptions::WAVES }))]
    pub waves: f64,
    /// Direction of the stripes, clockwise from the x axis in degrees.
    #[cfg_attr(feature = "schema", schemars(transform = { GaborOptions::ANGLE }))]
    pub angle: f64,
    /// Range of random directions around `angle` in degrees; 180 is all directions.
    #[cfg_attr(feature = "schema", schemars(transform = { GaborOptions::SPREAD }))]
    pub spread: f64,
    /// Number of waves that are placed in each cell; time is proportional to it.
    #[cfg_attr(feature = "schema", schemars(transform = { GaborOptions::IMPULSES }))]
    pub impulses: u32,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for GaborNode {
    fn default() -> Self {
        let options = GaborOptions::default();
        Self {
            frequency: Frequency([8.0; 2]),
            value: GaborValue::default(),
            waves: options.waves,
            angle: options.angle,
            spread: options.spread,
            impulses: options.impulses,
            seed: None,
        }
    }
}

impl NodeKind for GaborNode {
    outputs!(GaborValue);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let frequency = self.frequency.0;
        let options = self.options(plan.periods(frequency)?);
        let noise = GaborNoise::new(plan.seed(self.seed.as_ref()), options)?;
        let field = noise.field(self.value).frequency_per_axis(frequency);
        Ok(match self.value {
            GaborValue::Noise => Step::field(field.map(|value| about_half(value / 6.0))),
            _ => Step::field(field),
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let options = self.options(shader.periods(self.frequency.0));
        let noise = GaborNoise::new(shader.seed(self.seed.as_ref()), options)?;
        let first = shader.data(&noise.shader_words()?)?;
        shader.needs(Module::Gabor);
        let at = shader.position(self.frequency.0);
        let [x, y] = options.period.map(Option::unwrap_or_default);
        let (impulses, scale) = (self.impulses, double_value(noise.scale()));
        let gabor = format!("Gabor({first}u, {impulses}u, vec2({x}u, {y}u), {scale})");
        let gabor = shader.constant("GABOR", gabor);
        Ok(Code::number(match self.value {
            GaborValue::Noise => {
                let noise = format!("gabor_noise(data, {gabor}, {at})");
                about_half_code(&quotient(&noise, 6.0))
            }
            GaborValue::Phase => format!("gabor_phase(data, {gabor}, {at})"),
        }))
    }
}

impl GaborNode {
    /// Returns the noise options with these periods, in cells along each axis.
    fn options(&self, period: [Option<u32>; 2]) -> GaborOptions {
        GaborOptions {
            period,
            waves: self.waves,
            impulses: self.impulses,
            angle: self.angle,
            spread: self.spread,
        }
    }
}
