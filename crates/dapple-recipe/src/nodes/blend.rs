//! Blends layers by weights.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError, RecipeErrorKind, Values};
use dapple_tile::{Blend, IsCancelled, Layer, Mixing, Weighting, blend_cancellable};
use dapple_wgsl::{Module, double_value};
use serde::{Deserialize, Serialize};

/// Layers blended by weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Blended {
    /// Layers, at least one.
    pub layers: Vec<BlendedLayer>,
    /// Rule that converts the weights of layers to shares of the result.
    #[serde(default)]
    pub weighting: Weighting,
    /// Rule that combines the layers by their shares.
    ///
    /// All rules except `linear` depend on the whole tile.
    #[serde(default)]
    pub mixing: Mixing,
    /// Blend tile for `weighting = { mask = … }`: a number from 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask: Option<Input>,
}

/// Layer of a blend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BlendedLayer {
    /// Texture of the layer: a number or a color.
    pub input: Input,
    /// Weight of the layer relative to the other layers: a number, at least 0.
    #[serde(default = "full")]
    pub weight: Input,
    /// Height of the layer for `weighting = { height = … }`: a number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<Input>,
}

fn full() -> Input {
    Input::Number(1.0)
}

impl NodeKind for Blended {
    fn inputs(&self) -> Vec<&Input> {
        let layers = self.layers.iter().flat_map(|layer| {
            let always = [&layer.input, &layer.weight];
            always.into_iter().chain(&layer.height)
        });
        layers.chain(&self.mask).collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let count = self.layers.len();
        if count == 0 {
            let (what, needed) = ("layers", "at least 1");
            return Err(RecipeError::new(RecipeErrorKind::Count {
                what,
                count,
                needed,
            }));
        }
        let layers = Layers {
            how: Blend::new(self.weighting, self.mixing),
            heights: self.layers.iter().map(|l| l.height.is_some()).collect(),
            mask: self.mask.is_some(),
        };
        let any = self.layers.iter().map(|layer| plan.any(&layer.input));
        let mut inputs = any.collect::<Result<Vec<_>, _>>()?;
        let weights = self.layers.iter().map(|layer| &layer.weight);
        let heights = self.layers.iter().filter_map(|layer| layer.height.as_ref());
        for number in weights.chain(heights).chain(&self.mask) {
            inputs.push(plan.number(number)?);
        }
        // Linear mixing computes each pixel separately. The other rules need means over the whole tile.
        Ok(if self.mixing == Mixing::Linear {
            plan.local(inputs, move |inputs| {
                layers.blend(inputs, [inputs[0].len() as u32, 1], &|| false)
            })
        } else {
            plan.global(inputs, [1; 2], move |tile| {
                layers.blend(tile.inputs, tile.window.size, &tile.is_cancelled())
            })
        })
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        if self.mixing != Mixing::Linear {
            return Err(shader.no_shader());
        }
        shader.needs(Module::Blend);
        let shares = self.shares_code(shader)?;
        let inputs: Vec<_> = self
            .layers
            .iter()
            .map(|layer| layer.input.clone())
            .collect();
        let (values, is_color) = shader.alike(&inputs)?;
        let mut sums = "blend_start()".to_owned();
        for (share, value) in shares.iter().zip(values) {
            let color = match is_color {
                true => format!("{value}.xyz"),
                false => format!("vec3({value})"),
            };
            sums = shader.name("layers", format!("blend_add({sums}, {share}, {color})"));
        }
        let color = format!("blend_color({sums}, zero)");
        Ok(match is_color {
            true => Code::color(color),
            false => Code::number(format!("{color}.x")),
        })
    }
}

impl Blended {
    /// Writes WGSL for the blend weight of each layer, normalized to a sum of 1. Depending on the weighting, they are
    /// computed from the layers' weights, their heights and the mask.
    fn shares_code(&self, shader: &mut NodeShader<'_, '_>) -> Result<Vec<String>, Refusal> {
        let weights = self.layers.iter().map(|layer| shader.number(&layer.weight));
        let weights = weights.collect::<Result<Vec<_>, _>>()?;
        let mask = self.mask.as_ref().map(|mask| shader.number(mask));
        let mask = mask.transpose()?;
        match self.weighting {
            Weighting::Given => Ok(normalized_code(shader, &weights)),
            Weighting::Height { depth } => {
                let shares = normalized_code(shader, &weights);
                let mut levels = Vec::new();
                for (layer, share) in self.layers.iter().zip(&shares) {
                    let height = match (&layer.height, &mask) {
                        (Some(height), _) => shader.number(height)?,
                        (None, Some(mask)) => mask.clone(),
                        (None, None) => return Err(Refusal::new("a layer has no height")),
                    };
                    levels.push(shader.name("level", format!("blend_level({share}, {height})")));
                }
                let higher = |top: String, level: &String| format!("double_max({level}, {top})");
                let top = levels[1..].iter().fold(levels[0].clone(), higher);
                let top = shader.name("top", top);
                let depth = double_value(depth);
                let layers = shares.iter().zip(&levels);
                let near: Vec<_> = layers
                    .map(|(share, level)| {
                        let near = format!("blend_near({share}, {level}, {top}, {depth})");
                        shader.name("near", near)
                    })
                    .collect();
                Ok(normalized_code(shader, &near))
            }
            Weighting::Mask { gain } => {
                let Some(mask) = mask else {
                    return Err(Refusal::new("it has no mask"));
                };
                Ok(masked_code(
                    shader,
                    &weights,
                    &mask,
                    Weighting::half_width(gain),
                ))
            }
        }
    }
}

/// Writes WGSL for the running sums of `weights`, and returns the name of each sum.
fn sums_code(shader: &mut NodeShader<'_, '_>, weights: &[String]) -> Vec<String> {
    let mut sum = double_value(0.0);
    let mut sums = Vec::new();
    for weight in weights {
        sum = shader.name("sum", format!("double_add({sum}, double_from({weight}))"));
        sums.push(sum.clone());
    }
    sums
}

/// Writes WGSL for `weights` divided by their sum, and returns the names.
fn normalized_code(shader: &mut NodeShader<'_, '_>, weights: &[String]) -> Vec<String> {
    let sum = sums_code(shader, weights).pop().unwrap_or_default();
    let shares = weights.iter();
    let shares = shares.map(|weight| format!("blend_share({weight}, {sum})"));
    shares.map(|share| shader.name("share", share)).collect()
}

/// Writes WGSL for the blend weights of layers that a mask selects. Each layer covers an interval of mask values as
/// long as its weight; `half_width` is half the width of the transition between layers.
fn masked_code(
    shader: &mut NodeShader<'_, '_>,
    weights: &[String],
    mask: &str,
    half_width: f64,
) -> Vec<String> {
    let sums = sums_code(shader, weights);
    let sum = sums.last().cloned().unwrap_or_default();
    let half_width = double_value(half_width);
    let mut below = double_value(0.0);
    let mut shares = Vec::new();
    for part in sums {
        let step = format!("blend_step(double_div({part}, {sum}), {mask}, {half_width})");
        let up_to = shader.name("step", step);
        shares.push(shader.name("share", format!("blend_between({up_to}, {below})")));
        below = up_to;
    }
    shares
}

/// The layout of a blend's inputs: first the textures of all layers, then the weights of all layers, the heights of the
/// layers that have one, and the mask if there is one.
#[derive(Clone, Debug)]
struct Layers {
    how: Blend,
    /// For each layer, whether it has a height.
    heights: Vec<bool>,
    /// Whether there is a mask.
    mask: bool,
}

impl Layers {
    /// Blends the layers. `inputs` are images of `size` columns and rows.
    fn blend(
        &self,
        inputs: &[&Values],
        size: [u32; 2],
        is_cancelled: &IsCancelled,
    ) -> Result<Values, RecipeError> {
        let count = self.heights.len();
        let maps = Values::maps(&inputs[..count], size)?;
        let maps: Vec<_> = maps.into_iter().map(|map| [map]).collect();
        let rasters = inputs[count..].iter().map(|values| values.raster(size));
        let rasters = rasters.collect::<Result<Vec<_>, _>>()?;
        let mut heights = rasters[count..].iter();
        let layer = |index: usize| Layer {
            maps: &maps[index],
            weight: &rasters[index],
            height: if self.heights[index] {
                heights.next()
            } else {
                None
            },
        };
        let layers: Vec<_> = (0..count).map(layer).collect();
        let mask = rasters.last().filter(|_| self.mask);
        Values::of_map(blend_cancellable(&layers, mask, &self.how, is_cancelled)?)
    }
}
