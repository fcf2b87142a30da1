//! Nodes that bring several together, and those that see a whole picture.

use crate::{Input, NodeSeed};
use dapple_color::{Interpolation, LinearRgb, Outside, Palette, RampSpace};
use dapple_tile::{Disturbance, MatchBorders, Method, Mixing, Weighting};
use serde::{Deserialize, Serialize};

/// A part of the way from one input to another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mix {
    /// What is there at 0.
    pub from: Input,
    /// What is there at 1.
    pub to: Input,
    /// The part of the way: a number, cut off at 0 and 1.
    pub by: Input,
}

/// Another node at positions that are shifted by `amount · (x, y)`.
#[doc(alias = "domain warping")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Warp {
    /// The node that is asked elsewhere. Nothing that it is made of may be global.
    pub input: Input,
    /// How far to the right, as a multiple of the amount: a number.
    pub x: Input,
    /// How far down, as a multiple of the amount: a number.
    pub y: Input,
    /// How far a 1 goes, in units of the plane; 1 by default.
    #[serde(default = "one")]
    pub amount: f64,
}

fn one() -> f64 {
    1.0
}

/// Colors for numbers: a palette, or colors of one's own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ramped {
    /// The number.
    pub input: Input,
    /// A palette; not beside `colors`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub palette: Option<Palette>,
    /// Colors in sRGB, such as `["#204060", "#ffffff"]`; not beside `palette`.
    #[serde(default, skip_serializing_if = "Vec::is_empty", with = "colors")]
    pub colors: Vec<LinearRgb>,
    /// The number at which each color is; at equal distances from 0 to 1 by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub positions: Vec<f32>,
    /// The space in which two colors are mixed; Oklab by default.
    #[serde(default)]
    pub space: RampSpace,
    /// What lies between two colors; a line by default.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// What lies outside; the color at the end by default.
    #[serde(default)]
    pub outside: Outside,
}

/// Made to repeat: of use where the input does not repeat itself, such as a photograph. It sees the whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tiled {
    /// A number or a color.
    pub input: Input,
    /// How; the periodic part by default. Lengths in it are in pixels of the bake.
    #[serde(default)]
    pub method: Method,
    /// Along which axes; both by default.
    #[serde(default = "both")]
    pub axes: [bool; 2],
}

fn both() -> [bool; 2] {
    [true; 2]
}

/// The tile as copies of a texture, each with another piece of it inside of its border: see [`Disturbance`]. It sees the whole
/// tile.
///
/// [`Disturbance`]: dapple_tile::Disturbance
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disturbed {
    /// A number or a color, which repeats: each copy is all of it, made smaller.
    pub input: Input,
    /// How many copies there are along each axis, x first; `[4, 4]` by default. They have a whole number of pixels.
    #[serde(default = "four")]
    pub copies: [u32; 2],
    /// How many pixels along each border of a copy stay as they are; 4 by default.
    #[serde(default = "frozen")]
    pub frozen: u32,
    /// How many more pixels the cut may take; 24 by default. Together at most half of a copy.
    #[serde(default = "margin")]
    pub margin: u32,
    /// The name by which it draws, instead of its own, or a seed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

fn four() -> [u32; 2] {
    [4; 2]
}

fn frozen() -> u32 {
    Disturbance::default().frozen
}

fn margin() -> u32 {
    Disturbance::default().margin
}

/// A texture with the borders of another, so that both fit beside each other: see [`MatchBorders`]. It sees the whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Framed {
    /// A number or a color.
    pub input: Input,
    /// What the borders are of: a number or a color.
    pub border: Input,
    /// How far from a border the texture changes, and which part of the other becomes it, as in [`MatchBorders`]. Lengths
    /// are in pixels of the bake.
    #[serde(default)]
    pub options: MatchBorders,
}

/// The tile as a board of pieces of several textures, chosen by random colors at their corners: see [`CornerTiles`]. It sees the
/// whole tile.
///
/// [`CornerTiles`]: dapple_tile::CornerTiles
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CornerTilesOf {
    /// Two to four numbers or colors, which repeat: each piece is as large as all of them, made smaller.
    pub inputs: Vec<Input>,
    /// How many pieces there are along each axis, x first; `[4, 4]` by default. They have a whole number of pixels.
    #[serde(default = "four")]
    pub copies: [u32; 2],
    /// The share of the side of a piece that cuts may take, above 0 and at most 1; ½ by default.
    #[serde(default = "half")]
    pub width: f64,
    /// The name by which it draws, instead of its own, or a seed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

fn half() -> f64 {
    0.5
}

/// A map from 0 to 1, each value as often as any other, that is low in the cracks of a texture: where another one shows
/// first. It sees the whole tile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlendMapOf {
    /// A number, or a color, of which the luminance counts.
    pub input: Input,
    /// The size of the features, such as the diameter of stones, in units of the plane.
    pub feature_size: f64,
    /// How steep it is before all values become equally frequent, above 0; 1 by default.
    #[serde(default = "one")]
    pub contrast: f64,
}

/// Layers blended by weights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blended {
    /// The layers, at least one.
    pub layers: Vec<BlendedLayer>,
    /// How weights become shares; as given by default.
    #[serde(default)]
    pub weighting: Weighting,
    /// How layers are mixed by their shares; linear by default. The others see the whole tile.
    #[serde(default)]
    pub mixing: Mixing,
    /// The blend tile of `weighting = { mask = … }`, from 0 to 1: a number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask: Option<Input>,
}

/// A layer of a blend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlendedLayer {
    /// A number or a color.
    pub input: Input,
    /// How much of it there is, at least 0, beside the other layers: a number; 1 by default.
    #[serde(default = "full")]
    pub weight: Input,
    /// Its height for `weighting = { height = … }`: a number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<Input>,
}

fn full() -> Input {
    Input::Number(1.0)
}

impl Blended {
    /// For each layer its input, its weight and its height, then the mask.
    pub(crate) fn inputs(&self) -> Vec<&Input> {
        let layers = self.layers.iter().flat_map(|layer| {
            let always = [&layer.input, &layer.weight];
            always.into_iter().chain(&layer.height)
        });
        layers.chain(&self.mask).collect()
    }
}

/// Lists of colors as sRGB in hexadecimal.
mod colors {
    use crate::input::hex_from_color;
    use dapple_color::LinearRgb;
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        colors: &[LinearRgb],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let texts: Vec<_> = colors.iter().map(|&color| hex_from_color(color)).collect();
        texts.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<LinearRgb>, D::Error> {
        let texts = Vec::<String>::deserialize(deserializer)?;
        let colors = texts.iter().map(|text| LinearRgb::from_hex(text));
        colors.collect::<Result<_, _>>().map_err(D::Error::custom)
    }
}
