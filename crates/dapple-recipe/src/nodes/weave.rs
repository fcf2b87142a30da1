//! Woven cloth.

use super::{Frequency, NodeKind, NodeSeed, outputs};
use crate::RecipeError;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use dapple_pattern::{Draft, Weave, WeaveOptions, WeaveValue};
use dapple_wgsl::{Module, pattern_value};
use serde::{Deserialize, Serialize};

/// Woven cloth: warp threads along y and weft threads along x, which pass over and under each other.
///
/// Along an axis on which the recipe repeats, the tile must have whole repeats of the draft. The node `output` gives
/// further values of the same threads.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct WeaveNode {
    /// Numbers of warp threads along x and of weft threads along y per unit of the plane: one number, or one for each
    /// axis.
    pub frequency: Frequency,
    /// Value at a position.
    pub value: WeaveValue,
    /// Draft: which thread lies above at a crossing.
    pub draft: Draft,
    /// Crossings that a warp thread passes over in a row, or threads in a group of `basket` [default: 2 for `twill` and
    /// `basket`, 4 for `satin`].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { WeaveOptions::CROSSINGS }))]
    pub over: Option<u32>,
    /// Crossings that a warp thread passes under in a row [default: 2 for `twill`, 1 for `satin`].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { WeaveOptions::CROSSINGS }))]
    pub under: Option<u32>,
    /// Shift of the draft between neighboring weft threads, in threads; without a common factor with the sum of `over`
    /// and `under` [default: 1 for `twill`, 2 for `satin`].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(feature = "schema", schemars(transform = { WeaveOptions::CROSSINGS }))]
    pub step: Option<u32>,
    /// Width of a thread relative to the distance of threads.
    #[cfg_attr(feature = "schema", schemars(transform = { WeaveOptions::WIDTH }))]
    pub width: f64,
    /// Cross-section of threads, from 0 (flat ribbon) to 1 (ellipse).
    #[cfg_attr(feature = "schema", schemars(transform = { WeaveOptions::ROUNDNESS }))]
    pub roundness: f64,
    /// Variation of the widths and positions of threads.
    #[cfg_attr(feature = "schema", schemars(transform = { WeaveOptions::JITTER }))]
    pub jitter: f64,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for WeaveNode {
    fn default() -> Self {
        let options = WeaveOptions::default();
        Self {
            frequency: Frequency(options.frequency),
            value: WeaveValue::default(),
            draft: options.draft,
            over: options.over,
            under: options.under,
            step: options.step,
            width: options.width,
            roundness: options.roundness,
            jitter: options.jitter,
            seed: None,
        }
    }
}

impl NodeKind for WeaveNode {
    outputs!(WeaveValue);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let options = self.options(plan.periods(self.frequency.0)?);
        let weave = Weave::new(plan.seed(self.seed.as_ref()), options)?;
        Ok(Step::field(weave.field(self.value)))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let options = self.options(shader.periods(self.frequency.0));
        let weave = Weave::new(shader.seed(self.seed.as_ref()), options)?;
        shader.needs(Module::Weave);
        let at = shader.position(self.frequency.0);
        let weave = shader.constant("WEAVE", pattern_value("Weave", &weave.shader_words()));
        let thread = shader.name("thread", format!("weave_thread({weave}, {at})"));
        let random =
            |index: u32| format!("state_number(cell_state({weave}.seed, {thread}.id), {index}u)");
        Ok(Code::number(match self.value {
            WeaveValue::Height => format!("double_to_float({thread}.height)"),
            WeaveValue::Random => random(0),
            WeaveValue::Random2 => random(1),
            WeaveValue::Direction => format!("f32({thread}.id.x)"),
            WeaveValue::U => format!("double_to_float({thread}.along)"),
            WeaveValue::V => format!("thread_part({thread}.across)"),
        }))
    }
}

impl WeaveNode {
    /// Returns the pattern options with these periods, in threads along each axis.
    fn options(&self, period: [Option<u32>; 2]) -> WeaveOptions {
        WeaveOptions {
            frequency: self.frequency.0,
            period,
            draft: self.draft,
            over: self.over,
            under: self.under,
            step: self.step,
            width: self.width,
            roundness: self.roundness,
            jitter: self.jitter,
        }
    }
}
