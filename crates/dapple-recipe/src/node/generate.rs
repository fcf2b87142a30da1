//! Nodes that make something of nothing but a seed.

use super::ImageAlpha;
use core::fmt;
use dapple_hash::Seed;
use dapple_pups::{
    CellsOptions, CellularNoiseOptions, ColorNoiseOptions, CowOptions, IteratedOptions,
    LabelRampOptions, NetOptions, NoiseOptions, OctavesOptions, ProgressionOptions,
    ReferenceOptions, SpaceGiraffeOptions,
};
use dapple_worley::{Combination, Metric, Octaves, Scatter};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

/// Worley's cellular basis in the plane.
///
/// Distances are in cells. Along an axis on which the recipe repeats, the tile must be a whole number of cells.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WorleyNode {
    /// Cells per unit of the plane, one number or one for each axis; 1 by default.
    pub frequency: Frequency,
    /// What is shown; F1 by default.
    pub value: WorleyValue,
    /// How distances are measured; Euclidean by default.
    pub metric: Metric,
    /// How many feature points a cell has, and where; Poisson by default.
    pub scatter: Scatter,
    /// A fractal sum instead of a single texture. Its first octave has the frequency.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub octaves: Option<Octaves>,
    /// The range of values that becomes 0 to 1; none by default, which gives the distances themselves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f32; 2]>,
    /// How it moves with time; it does not by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// The name by which it draws, instead of its own, or a seed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

/// A slice of the basis in four dimensions, whose fourth axis is time: the pictures of a loop join.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// How many cells a loop goes along the fourth axis, at least 1.
    pub cells: u32,
    /// Where the slice lies along the third axis, in cells; 0 by default.
    #[serde(default)]
    pub z: f64,
}

/// Something per unit of the plane, for each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequency(pub [f64; 2]);

impl Default for Frequency {
    fn default() -> Self {
        Self([1.0; 2])
    }
}

/// What a node draws by, instead of its own name: two nodes with the same one see the same chance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NodeSeed {
    /// A seed, whatever that of the recipe is.
    Seed(Seed),
    /// A name, such as that of another node.
    Name(String),
}

/// What of the nearest feature points is shown.
///
/// In a file: `"f1"`, `"f2_minus_f1"` and so on, `"cell_value"`, `"edge_distance"`, or the four coefficients of F1 to F4.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WorleyValue {
    /// A combination of distances.
    Combination(Combination),
    /// A random number from 0 to 1 for each Voronoi cell.
    CellValue,
    /// The distance to the nearest border of a Voronoi cell, in cells, for the Euclidean metric: joints of one width. It is
    /// several times slower than F2 − F1.
    EdgeDistance,
}

impl Default for WorleyValue {
    fn default() -> Self {
        Self::Combination(Combination::F1)
    }
}

/// A partition-of-unity texture: one of the recipes of `dapple-pups`.
///
/// Its domain is the tile of the recipe and is not to be given.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum PupsNode {
    /// Random values, interpolated, from 0 to 1.
    Noise(NoiseOptions),
    /// Octaves of noise, from 0 to 1.
    Octaves(OctavesOptions),
    /// Octaves of folded noise, from 0 to 1.
    Turbulence(OctavesOptions),
    /// Cells with a random value each, from 0 to 1.
    Cells(CellsOptions),
    /// Layers of cells, from 0 to 1.
    CellularNoise(CellularNoiseOptions),
    /// Random colors, interpolated.
    ColorNoise(ColorNoiseOptions),
    /// The patches of a cow, 0 or 1.
    Cow(CowOptions),
    /// The spots of a giraffe (0) on its ground (1).
    SpaceGiraffe(SpaceGiraffeOptions),
    /// A cow whose patches get smaller to the right.
    CowProgression(ProgressionOptions),
    /// A giraffe whose spots get smaller to the right.
    GiraffeProgression(ProgressionOptions),
    /// Black cells on the left, white ones on the right.
    LabelRamp(LabelRampOptions),
    /// Black and white cells after an image.
    Reference(Referenced<ReferenceOptions>),
    /// The last of several rounds of black and white cells, each after the one before, the first after an image: edges
    /// like a coast.
    IteratedReference(Referenced<IteratedOptions>),
    /// Control points that are given one by one.
    Points(ControlPoints),
}

/// A texture after an image, which covers the tile. Of a color image the luminance counts.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    bound(deserialize = "T: Default + Deserialize<'de>")
)]
pub struct Referenced<T> {
    /// The file, as it is asked for.
    pub file: String,
    /// What becomes of its alpha when it is read; by default a partly transparent image is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<ImageAlpha>,
    /// What the texture is to be like.
    #[serde(default)]
    pub options: T,
}

/// Control points that are given one by one.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlPoints {
    /// The points, in units of the plane.
    pub points: Vec<ControlPoint>,
    /// How they are weighted; where points have an orientation, `orientations` is not to be given.
    #[serde(default)]
    pub net: NetOptions,
    /// Whether the value of the strongest point counts alone; all count by default.
    #[serde(default)]
    pub cells: Cells,
}

/// Whether a texture of control points mixes their values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cells {
    /// The weighted mean of the values.
    #[default]
    Mixed,
    /// The value of the control point with the largest weight.
    Hard,
}

/// A control point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlPoint {
    /// To the right, in units of the plane.
    pub x: f64,
    /// Down, in units of the plane.
    pub y: f64,
    /// The value of the texture there.
    pub value: f32,
    /// Where it is strong: a vector in the plane, of any length. All points have one, or none has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<[f64; 2]>,
}

/// Wavelet noise: nearly normal values with mean 0 and, for a single band, variance 1.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WaveletNode {
    /// Cells per unit of the plane, in the coarsest band; 8 by default. Along an axis on which the recipe repeats, the tile
    /// must be an even whole number of cells, from 4 on.
    pub frequency: f64,
    /// The weight of each band, coarsest first, each twice as fine as the one before; a single 1 by default.
    pub weights: Vec<f32>,
    /// The name by which it draws, instead of its own, or a seed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for WaveletNode {
    fn default() -> Self {
        Self {
            frequency: 8.0,
            weights: vec![1.0],
            seed: None,
        }
    }
}

/// Octaves of noise with values from 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Fractal {
    /// What an octave is; PUPs by default.
    pub basis: FractalBasis,
    /// About how many bumps there are per unit of the plane in the first octave; 8 by default. For gradients and
    /// wavelets, these are their cells.
    pub frequency: f64,
    /// How many octaves, 1 to 16, each twice as fine as the one before; 4 by default.
    pub octaves: u32,
    /// The amplitude of an octave as a multiple of the one before, above 0 and at most 1; ½ by default.
    #[serde(alias = "persistence")]
    pub gain: f64,
    /// The name by which it draws, instead of its own, or a seed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

impl Default for Fractal {
    fn default() -> Self {
        Self {
            basis: FractalBasis::Pups,
            frequency: 8.0,
            octaves: 4,
            gain: 0.5,
            seed: None,
        }
    }
}

/// What an octave of noise is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FractalBasis {
    /// Random values at Poisson-disk points, interpolated; the sum over its largest possible value.
    #[default]
    Pups,
    /// Perlin's gradient noise; the sum is `½ + sum / 6σ`, with `σ` its standard deviation, cut off at 0 and 1.
    #[serde(alias = "perlin")]
    Gradient,
    /// Wavelet noise; the sum is `½ + sum / 6σ`, with `σ` its standard deviation, cut off at 0 and 1.
    Wavelet,
}

/// How far along a direction a position is: `(position − center) · along`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Coordinate {
    /// Where it is 0, in units of the plane; the origin by default.
    pub center: [f64; 2],
    /// The direction, times how much it grows per unit; `[1, 0]` by default.
    pub along: [f64; 2],
}

impl Default for Coordinate {
    fn default() -> Self {
        Self {
            center: [0.0; 2],
            along: [1.0, 0.0],
        }
    }
}

/// How far from a center a position is, in units of the plane; from the nearest of its repeats where the recipe repeats.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distance {
    /// The center, in units of the plane.
    pub center: [f64; 2],
}

/// An image, laid over the tile and read between its pixels; past its edges it repeats, or goes on, as the recipe does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageNode {
    /// The file, as it is asked for; the command takes it from the folder of the recipe.
    pub file: String,
    /// What becomes of its alpha when it is read; by default a partly transparent image is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<ImageAlpha>,
}

impl Serialize for Frequency {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [x, y] = self.0;
        if x == y {
            serializer.serialize_f64(x)
        } else {
            self.0.serialize(serializer)
        }
    }
}

impl<'de> Deserialize<'de> for Frequency {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FrequencyVisitor)
    }
}

struct FrequencyVisitor;

impl<'de> Visitor<'de> for FrequencyVisitor {
    type Value = Frequency;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or one for each of the two axes")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Frequency, E> {
        Ok(Frequency([value; 2]))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Frequency, E> {
        Ok(Frequency([value as f64; 2]))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Frequency, E> {
        Ok(Frequency([value as f64; 2]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, axes: A) -> Result<Frequency, A::Error> {
        <[f64; 2]>::deserialize(SeqAccessDeserializer::new(axes)).map(Frequency)
    }
}

impl Serialize for NodeSeed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Seed(seed) => seed.serialize(serializer),
            Self::Name(name) => serializer.serialize_str(name),
        }
    }
}

impl<'de> Deserialize<'de> for NodeSeed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NodeSeedVisitor)
    }
}

struct NodeSeedVisitor;

impl Visitor<'_> for NodeSeedVisitor {
    type Value = NodeSeed;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name to draw by, or a seed from 0 on")
    }

    fn visit_u64<E>(self, seed: u64) -> Result<NodeSeed, E> {
        Ok(NodeSeed::Seed(Seed(seed)))
    }

    fn visit_i64<E: Error>(self, seed: i64) -> Result<NodeSeed, E> {
        let seed = u64::try_from(seed)
            .map_err(|_| E::invalid_value(serde::de::Unexpected::Signed(seed), &self))?;
        self.visit_u64(seed)
    }

    fn visit_str<E>(self, name: &str) -> Result<NodeSeed, E> {
        Ok(NodeSeed::Name(name.to_owned()))
    }
}

/// The names of [`WorleyValue`] in files; those of combinations are in the order of [`Combination::NAMED`].
pub(crate) const WORLEY_VALUES: [&str; 13] = [
    "f1",
    "f2",
    "f3",
    "f4",
    "f2_minus_f1",
    "f1_plus_f2",
    "f3_minus_f1",
    "f3_minus_f2",
    "f4_minus_f1",
    "f4_minus_f3",
    "2f3_minus_f2_minus_f1",
    "cell_value",
    "edge_distance",
];

impl WorleyValue {
    /// The value of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let index = WORLEY_VALUES.iter().position(|&known| known == name)?;
        Some(match (Combination::NAMED.get(index), name) {
            (Some(&(_, combination)), _) => Self::Combination(combination),
            (None, "cell_value") => Self::CellValue,
            (None, _) => Self::EdgeDistance,
        })
    }

    /// Its name, where it has one.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        WORLEY_VALUES
            .into_iter()
            .find(|name| Self::from_name(name) == Some(self))
    }

    /// All names, in the order of their definition.
    #[must_use]
    pub fn names() -> [&'static str; 13] {
        WORLEY_VALUES
    }
}

impl Serialize for WorleyValue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (self.name(), self) {
            (Some(name), _) => serializer.serialize_str(name),
            (None, Self::Combination(combination)) => {
                combination.coefficients().serialize(serializer)
            }
            (None, Self::CellValue | Self::EdgeDistance) => unreachable!("these have names"),
        }
    }
}

impl<'de> Deserialize<'de> for WorleyValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WorleyValueVisitor)
    }
}

struct WorleyValueVisitor;

impl<'de> Visitor<'de> for WorleyValueVisitor {
    type Value = WorleyValue;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name such as \"f2_minus_f1\", or the four coefficients of F1 to F4")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<WorleyValue, E> {
        WorleyValue::from_name(name).ok_or_else(|| E::unknown_variant(name, &WORLEY_VALUES))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, coefficients: A) -> Result<WorleyValue, A::Error> {
        let coefficients = <[f32; 4]>::deserialize(SeqAccessDeserializer::new(coefficients))?;
        Ok(WorleyValue::Combination(Combination::new(coefficients)))
    }
}
