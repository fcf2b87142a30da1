//! Worley's cellular basis.

use super::{NodeKind, NodeSeed};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{RecipeError, RecipeErrorKind};
use core::fmt;
use dapple_raster::{Field, FieldExt};
use dapple_raster::{Range, range};
use dapple_wgsl::{Module, number_value, worley_value};
use dapple_worley::{
    Cellular, Combination, Dimensions, Metric, OctaveSeeds, Octaves, Scatter, Space, Worley,
    Worley2, Worley4,
};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Worley's cellular basis in the plane.
///
/// Distances are in cells. Along an axis on which the recipe repeats, the tile must have a whole number of cells.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct WorleyNode {
    /// Frequency, in cells per unit of the plane: one number, or one for each axis.
    pub frequency: Frequency,
    /// Value at a position, computed from the distances to the nearest feature points.
    pub value: WorleyValue,
    /// Distance metric.
    pub metric: Metric,
    /// Distribution of feature points over the cells.
    pub scatter: Scatter,
    /// Octaves of a fractal sum [default: none, a single texture].
    ///
    /// The first octave has the node's frequency.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub octaves: Option<Octaves>,
    /// Range of values that is mapped to 0 to 1 [default: none, values are distances].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f32; 2]>,
    /// Looping motion over time [default: none].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

/// Looping motion: a plane slice through a 4-D basis, whose fourth axis is time.
///
/// The last frame of a loop continues to the first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Number of cells along the time axis in one loop, at least 1.
    pub cells: u32,
    /// Position of the slice along the third axis, in cells.
    #[serde(default)]
    pub z: f64,
}

/// Frequency along each axis, in cells per unit of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequency(pub [f64; 2]);

impl Default for Frequency {
    fn default() -> Self {
        Self([1.0; 2])
    }
}

/// Value at a position, computed from the nearest feature points.
///
/// In a recipe file, the value is written as `"f1"`, `"f2_minus_f1"` and so on, `"cell_value"`, `"edge_distance"`, or
/// the four coefficients of F1 to F4.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WorleyValue {
    /// Linear combination of the distances F1 to F4.
    Combination(Combination),
    /// Random number from 0 to 1 for each Voronoi cell.
    CellValue,
    /// Euclidean distance to the nearest border between Voronoi cells, in cells.
    ///
    /// This value gives joints of uniform width, and is several times slower than F2 − F1.
    EdgeDistance,
}

impl Default for WorleyValue {
    fn default() -> Self {
        Self::Combination(Combination::F1)
    }
}

impl NodeKind for WorleyNode {
    fn outputs(&self) -> &'static [&'static str] {
        &WORLEY_VALUES
    }

    fn with_output(&self, value: &str) -> Option<Box<dyn NodeKind>> {
        let value = WorleyValue::from_name(value)?;
        // A range belongs to the value for which it was chosen.
        Some(Box::new(Self {
            value,
            range: None,
            ..self.clone()
        }))
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let seed = plan.seed(self.seed.as_ref());
        let [x, y] = plan.periods(self.frequency.0)?;
        let field = match self.motion {
            None => {
                let worley = Worley2::new(seed).with_period([x, y])?;
                self.plane_field(worley)?
            }
            Some(Motion { cells, z }) => {
                RecipeError::check_in(PLACE, "place along z", z)?;
                let worley = Worley4::new(seed).with_period([x, y, None, Some(cells)])?;
                self.moving_field(worley, [z, plan.time() * f64::from(cells)])?
            }
        };
        Ok(Step::field(field.frequency_per_axis(self.frequency.0)))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let seed = shader.seed(self.seed.as_ref());
        let [x, y] = shader.periods(self.frequency.0);
        match self.motion {
            None => self.code(shader, Worley2::new(seed).with_period([x, y])?, 0.0),
            Some(Motion { cells, z }) => {
                let periods = [x, y, None, Some(cells)];
                self.code(shader, Worley4::new(seed).with_period(periods)?, z)
            }
        }
    }
}

impl WorleyNode {
    /// Returns the cellular basis with the node's metric and scatter.
    fn basis<const N: usize>(&self, worley: Worley<N>) -> Result<Worley<N>, RecipeError>
    where
        Dimensions: Space<N>,
    {
        match self.value {
            WorleyValue::Combination(_) => {}
            WorleyValue::CellValue => self.check_single(true)?,
            WorleyValue::EdgeDistance => self.check_single(self.metric == Metric::Euclidean)?,
        }
        Ok(worley
            .with_metric(self.metric)?
            .with_scatter(self.scatter)?)
    }

    /// Builds the field of the node's value from a 2-D cellular basis.
    fn plane_field(&self, worley: Worley2) -> Result<Arc<dyn Field>, RecipeError> {
        let worley = self.basis(worley)?;
        let combination = match self.value {
            WorleyValue::Combination(combination) => combination,
            WorleyValue::CellValue => return Ok(Arc::new(worley.cell_values())),
            WorleyValue::EdgeDistance => return Ok(Arc::new(worley.edge_distances())),
        };
        let cellular = worley.combine(combination);
        Ok(match (self.octaves, self.range) {
            (None, None) => Arc::new(cellular),
            (None, Some(range)) => Arc::new(cellular.with_range(range)?),
            (Some(octaves), None) => Arc::new(cellular.fractal(octaves)?),
            (Some(octaves), Some(range)) => Arc::new(cellular.fractal(octaves)?.with_range(range)?),
        })
    }

    /// Builds the field of the node's value from a slice through a 4-D cellular basis. `place` is the slice's position
    /// along the third and fourth axes, in cells.
    fn moving_field(
        &self,
        worley: Worley4,
        place: [f64; 2],
    ) -> Result<Arc<dyn Field>, RecipeError> {
        let worley = self.basis(worley)?;
        let combination = match self.value {
            WorleyValue::Combination(combination) => combination,
            WorleyValue::CellValue => return Ok(Arc::new(worley.cell_values().slice(place))),
            WorleyValue::EdgeDistance => return Ok(Arc::new(worley.edge_distances().slice(place))),
        };
        let cellular = worley.combine(combination);
        let solid: Arc<dyn Field<4>> = match (self.octaves, self.range) {
            (None, None) => Arc::new(cellular),
            (None, Some(range)) => Arc::new(cellular.with_range(range)?),
            (Some(octaves), None) => Arc::new(cellular.fractal(octaves)?),
            (Some(octaves), Some(range)) => Arc::new(cellular.fractal(octaves)?.with_range(range)?),
        };
        Ok(Arc::new(solid.slice(place)))
    }

    /// Writes WGSL for the node's value from a 2-D cellular basis, or from a 4-D basis at time 0. `z` is the position
    /// of the slice along the third axis, in cells.
    fn code<const N: usize>(
        &self,
        shader: &mut NodeShader<'_, '_>,
        worley: Worley<N>,
        z: f64,
    ) -> Result<Code, Refusal>
    where
        Dimensions: Space<N>,
    {
        let worley = self.basis(worley)?;
        let combination = match self.value {
            WorleyValue::Combination(combination) => combination,
            WorleyValue::CellValue => return self.cell_value_code(shader, &worley, z),
            WorleyValue::EdgeDistance if N > 2 => {
                let reason = "distances to edges in four dimensions have no shader";
                return Err(Refusal::new(reason));
            }
            WorleyValue::EdgeDistance => return self.edge_distance_code(shader, &worley),
        };
        let Some(octaves) = self.octaves else {
            let mut cellular = worley.combine(combination);
            if let Some(range) = self.range {
                cellular = cellular.with_range(range)?;
            }
            return self.cellular_code(shader, &cellular, z);
        };
        // Sum the octaves, each with its own period, and its own seed unless they share one.
        let mut sum = literal(0.0);
        let (mut ratio, mut weight) = (1.0, 1.0);
        for index in 0..octaves.count {
            let periods = worley.periods();
            let periods = periods.map(|cells| Some((f64::from(cells?) * ratio) as u32));
            let mut octave = worley.clone().with_period(periods)?;
            if octaves.seeds == OctaveSeeds::Own {
                octave = octave.with_seed(worley.seed().child("octave", index.into()));
            }
            let features = self.features(shader, &octave, combination.depth(), ratio, z)?;
            let value = weighted(&features, combination.coefficients(), 0.0);
            let value = format!("number_mul({value}, {}, zero)", literal(weight as f32));
            sum = shader.name("sum", format!("number_add({sum}, {value}, zero)"));
            ratio *= octaves.lacunarity;
            weight *= octaves.gain;
        }
        Ok(Code::number(match self.range {
            None => sum,
            Some([low, high]) => {
                let [scale, shift] = [1.0 / (high - low), -low / (high - low) + 0.0].map(literal);
                format!("number_add({shift}, number_mul({sum}, {scale}, zero), zero)")
            }
        }))
    }

    /// Writes WGSL for a combination of distances.
    pub(crate) fn cellular_code<const N: usize>(
        &self,
        shader: &mut NodeShader<'_, '_>,
        field: &Cellular<N>,
        z: f64,
    ) -> Result<Code, Refusal>
    where
        Dimensions: Space<N>,
    {
        let (weights, shift) = field.shader_tone();
        let features = self.features(shader, field.worley(), weights.depth(), 1.0, z)?;
        let value = weighted(&features, weights.coefficients(), shift);
        Ok(Code::number(value))
    }

    /// Writes WGSL for the random number of the nearest feature point.
    pub(crate) fn cell_value_code<const N: usize>(
        &self,
        shader: &mut NodeShader<'_, '_>,
        worley: &Worley<N>,
        z: f64,
    ) -> Result<Code, Refusal>
    where
        Dimensions: Space<N>,
    {
        let features = self.features(shader, worley, 1, 1.0, z)?;
        Ok(Code::number(format!("cell_value({features}[0].id)")))
    }

    /// Writes WGSL for the distance to the nearest cell border, in 2-D.
    pub(crate) fn edge_distance_code<const N: usize>(
        &self,
        shader: &mut NodeShader<'_, '_>,
        worley: &Worley<N>,
    ) -> Result<Code, Refusal>
    where
        Dimensions: Space<N>,
    {
        shader.needs(Module::WorleyEdges2d);
        let (worley, place) = self.placed(shader, worley, 1.0)?;
        let value = format!("edge_distance_2d({worley}, {place}, zero)");
        Ok(Code::number(value))
    }

    /// Writes WGSL for the lookup of feature points: returns the name of the constant with the basis's parameters, and
    /// the name of the position in cells. The position is scaled by the node's frequency and by `ratio`, the relative
    /// frequency of an octave.
    fn placed<const N: usize>(
        &self,
        shader: &mut NodeShader<'_, '_>,
        worley: &Worley<N>,
        ratio: f64,
    ) -> Result<(String, String), Refusal>
    where
        Dimensions: Space<N>,
    {
        let worley = worley_value(&worley.shader_words()?);
        let at = shader.position(self.frequency.0);
        let at = shader.scaled(&at, [ratio; 2]);
        let place = shader.name("place", format!("worley_place_2d({at})"));
        Ok((shader.constant("WORLEY", worley), place))
    }

    /// Writes shader code for the nearest feature points, at least `depth` of them. The position is scaled by the node's
    /// frequency and by `ratio`, the relative frequency of an octave.
    fn features<const N: usize>(
        &self,
        shader: &mut NodeShader<'_, '_>,
        worley: &Worley<N>,
        depth: usize,
        ratio: f64,
        z: f64,
    ) -> Result<String, Refusal>
    where
        Dimensions: Space<N>,
    {
        let (worley, place) = self.placed(shader, worley, ratio)?;
        if N == 2 {
            if depth > 2 {
                return Err(Refusal::new("the distances F3 and F4 have no shader"));
            }
            shader.needs(Module::Worley2d);
            let features = format!("worley_2d({worley}, {place}, zero)");
            return Ok(shader.name("features", features));
        }
        shader.needs(Module::Worley4d);
        let (cell, fraction) = split(z * ratio)?;
        let place = format!(
            "Place4d(vec4({place}.cell, {cell}, 0), vec4({place}.fraction, {fraction}, 0.0))"
        );
        let features = format!("worley_4d({worley}, {place}, {depth}u, zero)");
        Ok(shader.name("features", features))
    }

    /// Returns an error if a single value (`cell_value` or `edge_distance`) is combined with options that apply to
    /// combinations of distances only, or with a metric that it does not support.
    fn check_single(&self, has_metric: bool) -> Result<(), RecipeError> {
        let rule = if self.octaves.is_some() || self.range.is_some() {
            "`cell_value` and `edge_distance` have neither `octaves` nor a `range`"
        } else if !has_metric {
            "`edge_distance` is of the Euclidean metric"
        } else {
            return Ok(());
        };
        Err(RecipeError::new(RecipeErrorKind::Conflict { rule }))
    }
}

const PLACE: Range = range!(finite);

/// Returns the cell of a coordinate, and the fraction within the cell as a literal, rounded down to a multiple of 2^-21
/// cells.
fn split(coordinate: f64) -> Result<(i32, String), Refusal> {
    const STEPS: f64 = (1 << 21) as f64;
    let steps = ((coordinate - coordinate.floor()) * STEPS).floor();
    // The fraction just below a whole number may be rounded up to 1.
    let cell = coordinate.floor() + f64::from(u8::from(steps == STEPS));
    if cell.abs() >= f64::from(i32::MAX) {
        return Err(Refusal::new(
            "its slice is too far from the origin for a shader",
        ));
    }
    Ok((
        cell as i32,
        number_value((steps.rem_euclid(STEPS) / STEPS) as f32),
    ))
}

/// Writes WGSL for `shift` plus a weighted sum of the distances F1 to F4. `features` is the name of the array of
/// feature points.
fn weighted(features: &str, weights: [f32; 4], shift: f32) -> String {
    let mut sum = literal(shift);
    for (index, &weight) in weights.iter().enumerate() {
        if weight != 0.0 {
            let distance = format!("{features}[{index}].distance");
            let part = match weight == 1.0 {
                true => distance,
                false => format!("number_mul({distance}, {}, zero)", literal(weight)),
            };
            sum = format!("number_add({sum}, {part}, zero)");
        }
    }
    sum
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

/// The names of [`WorleyValue`], as recipes write them. Combinations come first, in the order of
/// [`Combination::NAMED`].
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
    /// Returns the value called `name`.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let index = WORLEY_VALUES.iter().position(|&known| known == name)?;
        Some(match (Combination::NAMED.get(index), name) {
            (Some(&(_, combination)), _) => Self::Combination(combination),
            (None, "cell_value") => Self::CellValue,
            (None, _) => Self::EdgeDistance,
        })
    }

    /// Returns the name of the value, if it has one.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        WORLEY_VALUES
            .into_iter()
            .find(|name| Self::from_name(name) == Some(self))
    }

    /// Returns the names of all values, in the order of their definition.
    #[must_use]
    pub fn names() -> [&'static str; 13] {
        WORLEY_VALUES
    }
}

impl Serialize for WorleyValue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (self, self.name()) {
            (Self::Combination(combination), None) => {
                combination.coefficients().serialize(serializer)
            }
            (_, name) => serializer.serialize_str(name.unwrap_or_default()),
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
