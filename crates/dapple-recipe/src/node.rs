//! The nodes of a recipe: generators, and what is done with what others made.

mod adjust;
mod alpha;
mod combine;
mod generate;

pub use adjust::{Levels, LevelsCurve, Power, ProfileOf, Wave, Waveform};
pub use alpha::ImageAlpha;
pub use combine::{
    BlendMapOf, Blended, BlendedLayer, CornerTilesOf, Disturbed, Framed, Mix, Ramped, Tiled, Warp,
};
pub use generate::{
    Cells, ControlPoint, ControlPoints, Coordinate, Distance, Fractal, FractalBasis, Frequency,
    ImageNode, Motion, NodeSeed, PupsNode, Referenced, WaveletNode, WorleyNode, WorleyValue,
};

use crate::Input;
use dapple_color::LinearRgb;
use serde::{Deserialize, Serialize};

/// A node of a recipe: a table with one entry, whose name is the kind.
///
/// Most nodes make a number at every position. Those that make a color are `ramp`, `color`, `image` of a color image,
/// and `pups = { color_noise = … }`; `add`, `multiply`, `mix`, `tile`, `disturb`, `match_borders`, `corner_tiles`, `warp` and `blend` make a
/// color where they are given one, and take a number beside it as a gray.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Node {
    /// Worley's cellular basis.
    Worley(WorleyNode),
    /// A partition-of-unity texture.
    Pups(PupsNode),
    /// Wavelet noise.
    Wavelet(WaveletNode),
    /// Octaves of noise from 0 to 1, of PUPs or of wavelets.
    Noise(Fractal),
    /// How far along a direction a position is.
    Coordinate(Coordinate),
    /// How far from a center a position is.
    Distance(Distance),
    /// An image file, laid over the tile.
    Image(ImageNode),
    /// The same color everywhere.
    #[serde(with = "hex")]
    Color(LinearRgb),
    /// The sum of all inputs.
    Add(Vec<Input>),
    /// The first less the second.
    Subtract([Input; 2]),
    /// The product of all inputs.
    Multiply(Vec<Input>),
    /// The first over the second; 0 where that is 0.
    Divide([Input; 2]),
    /// The smallest of all inputs.
    Minimum(Vec<Input>),
    /// The largest of all inputs.
    Maximum(Vec<Input>),
    /// Without its sign.
    Absolute(Input),
    /// A power.
    Power(Power),
    /// A wave of a number.
    Wave(Wave),
    /// A range stretched to another.
    Levels(Levels),
    /// A cross-section of a bump: spots or channels.
    Profile(ProfileOf),
    /// A part of the way from one input to another.
    Mix(Mix),
    /// Another node at positions that are shifted.
    Warp(Warp),
    /// Colors for numbers.
    Ramp(Ramped),
    /// Made to repeat.
    Tile(Tiled),
    /// Copies of a texture that differ inside.
    Disturb(Disturbed),
    /// A texture with the borders of another.
    MatchBorders(Framed),
    /// Pieces of several textures, in random order.
    CornerTiles(CornerTilesOf),
    /// A map that says where another texture shows first.
    BlendMap(BlendMapOf),
    /// Layers blended by weights.
    Blend(Blended),
}

/// The names of the kinds, as they are in files.
pub const KINDS: [&str; 28] = [
    "worley",
    "pups",
    "wavelet",
    "noise",
    "coordinate",
    "distance",
    "image",
    "color",
    "add",
    "subtract",
    "multiply",
    "divide",
    "minimum",
    "maximum",
    "absolute",
    "power",
    "wave",
    "levels",
    "profile",
    "mix",
    "warp",
    "ramp",
    "tile",
    "disturb",
    "match_borders",
    "corner_tiles",
    "blend_map",
    "blend",
];

impl Node {
    /// The image file that the node names, if it names one.
    #[must_use]
    pub fn image_file(&self) -> Option<&str> {
        match self {
            Self::Image(image) => Some(&image.file),
            Self::Pups(PupsNode::Reference(node)) => Some(&node.file),
            Self::Pups(PupsNode::IteratedReference(node)) => Some(&node.file),
            _ => None,
        }
    }

    /// What becomes of the alpha of that file, where the node says so.
    #[must_use]
    pub fn image_alpha(&self) -> Option<ImageAlpha> {
        match self {
            Self::Image(image) => image.alpha,
            Self::Pups(PupsNode::Reference(node)) => node.alpha,
            Self::Pups(PupsNode::IteratedReference(node)) => node.alpha,
            _ => None,
        }
    }

    /// What the node is given, in a fixed order.
    #[must_use]
    pub fn inputs(&self) -> Vec<&Input> {
        match self {
            Self::Worley(_)
            | Self::Pups(_)
            | Self::Wavelet(_)
            | Self::Noise(_)
            | Self::Coordinate(_)
            | Self::Distance(_)
            | Self::Image(_)
            | Self::Color(_) => Vec::new(),
            Self::Add(inputs)
            | Self::Multiply(inputs)
            | Self::Minimum(inputs)
            | Self::Maximum(inputs) => inputs.iter().collect(),
            Self::Subtract(inputs) | Self::Divide(inputs) => inputs.iter().collect(),
            Self::Absolute(input) => vec![input],
            Self::Power(node) => vec![&node.input],
            Self::Wave(node) => vec![&node.input],
            Self::Levels(node) => vec![&node.input],
            Self::Profile(node) => vec![&node.input],
            Self::Mix(node) => vec![&node.from, &node.to, &node.by],
            Self::Warp(node) => vec![&node.input, &node.x, &node.y],
            Self::Ramp(node) => vec![&node.input],
            Self::Tile(node) => vec![&node.input],
            Self::Disturb(node) => vec![&node.input],
            Self::MatchBorders(node) => vec![&node.input, &node.border],
            Self::CornerTiles(node) => node.inputs.iter().collect(),
            Self::BlendMap(node) => vec![&node.input],
            Self::Blend(node) => node.inputs(),
        }
    }
}

/// Colors as sRGB in hexadecimal.
mod hex {
    use crate::input::hex_from_color;
    use dapple_color::LinearRgb;
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    pub(super) fn serialize<S: Serializer>(
        color: &LinearRgb,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&hex_from_color(*color))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<LinearRgb, D::Error> {
        let text = String::deserialize(deserializer)?;
        LinearRgb::from_hex(&text).map_err(D::Error::custom)
    }
}
