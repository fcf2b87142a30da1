//! A component of a color as a number.

use super::{NodeKind, hsl, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{Input, RecipeError, Values};
use dapple_color::LinearRgb;
use serde::{Deserialize, Serialize};

/// Component of a color as a number, for example to drive a height by an image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChannelOf {
    /// Color; a number is a gray.
    pub input: Input,
    /// Component of the color.
    #[serde(default)]
    pub channel: ColorChannel,
}

dapple_raster::named! {
    /// Component of a color.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum ColorChannel {
        /// Red, linear.
        Red = "red",
        /// Green, linear.
        Green = "green",
        /// Blue, linear.
        Blue = "blue",
        /// Relative luminance, linear.
        #[default]
        Luminance = "luminance",
        /// Hue of the sRGB color in turns, from 0 to below 1: red is 0, green 1/3 and blue 2/3. Of a gray it is 0.
        Hue = "hue",
        /// Saturation of the sRGB color (HSV), from 0 of a gray to 1.
        Saturation = "saturation",
        /// Largest component of the sRGB color (HSV), from 0 to 1.
        Value = "value",
    }
}

impl NodeKind for ChannelOf {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let channel = self.channel;
        let inputs = vec![plan.any(&self.input)?];
        let step = plan.local(inputs, move |inputs| {
            let colors = inputs[0].colors();
            Ok(Values::Numbers(
                colors.iter().map(|&color| channel.of(color)).collect(),
            ))
        });
        Ok(step.with_numbers())
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let parts = match self.channel {
            ColorChannel::Hue | ColorChannel::Saturation | ColorChannel::Value => {
                let rgb = hsl::components_code(shader, &self.input)?;
                return Ok(Code::number(match self.channel {
                    ColorChannel::Hue => format!("color_hue({rgb}, zero)"),
                    ColorChannel::Saturation => format!("color_saturation({rgb}, zero)"),
                    _ => format!("color_ends({rgb}, zero).y"),
                }));
            }
            ColorChannel::Red => "x",
            ColorChannel::Green => "y",
            ColorChannel::Blue => "z",
            ColorChannel::Luminance => "",
        };
        let color = shader.any(&self.input)?.to_color();
        let color = shader.name("color", color);
        if !parts.is_empty() {
            return Ok(Code::number(format!("{color}.{parts}")));
        }
        let [r, g, b] = [("x", 0.2126), ("y", 0.7152), ("z", 0.0722)]
            .map(|(part, weight)| format!("number_mul({}, {color}.{part}, zero)", literal(weight)));
        Ok(Code::number(format!(
            "number_add(number_add({r}, {g}, zero), {b}, zero)"
        )))
    }
}

impl ColorChannel {
    /// Returns the component of a color.
    fn of(self, color: LinearRgb) -> f32 {
        match self {
            Self::Red => color.r,
            Self::Green => color.g,
            Self::Blue => color.b,
            Self::Luminance => color.luminance(),
            Self::Hue => hsl::hue(hsl::encoded(color)),
            Self::Saturation => {
                let [low, high] = hsl::ends(hsl::encoded(color));
                if high > 0.0 { (high - low) / high } else { 0.0 }
            }
            Self::Value => hsl::ends(hsl::encoded(color))[1],
        }
    }
}
